#include "live.hpp"

#include "draw.hpp"
#include "saphira/viewer/schema.hpp"

namespace saphira::viewer {

namespace {

constexpr double kGridPeriod = 1.0;  // [s]

}  // namespace

Live::Live(bus::Node& node) : node_(node), scene_(kGridPeriod) {
  for (const bus::TopicEntry& topic : bus::known_topics())
    if (topic.qos != "recall")  // these repeat others
      channels_.push_back({topic.name, topic.type, schema_of(topic.type)});
  topics_ = channels_.size();
  for (const DrawnChannel& drawn : drawn_channels())
    channels_.push_back({drawn.topic, drawn.type, drawn_schema(drawn.type)});
}

std::string Live::subscribe(std::size_t channel) {
  if (channel < topics_) {
    try {
      echoes_[channel] = std::make_unique<bus::Echo>(node_, channels_[channel].topic);
    } catch (const std::exception& error) {
      echoes_.erase(channel);
      return channels_[channel].topic + ": " + error.what();
    }
    return {};
  }
  std::string refused;
  scene_ = Scene(kGridPeriod);
  for (const std::string& topic : drawn_topics()) {
    try {
      drawn_[topic] = std::make_unique<bus::Echo>(node_, topic);
    } catch (const std::exception& error) {
      drawn_.erase(topic);
      refused += topic + ": " + error.what() + "; ";
    }
  }
  return refused;
}

void Live::poll(std::int64_t now_ns, const Wants& wants, const Put& put) {
  std::erase_if(echoes_, [&](const auto& each) { return !wants(each.first); });
  for (const auto& [channel, echo] : echoes_)
    for (const std::string& json : echo->take_json())
      put(channel, json);
  bool draws = false;
  for (std::size_t channel = topics_; channel < channels_.size(); ++channel)
    draws = draws || wants(channel);
  if (!draws)
    drawn_.clear();
  for (const auto& [topic, echo] : drawn_)
    for (const std::string& json : echo->take_json())
      for (const DrawnMessage& message : draw(scene_, topic, json, now_ns))
        put(topics_ + message.channel, message.json);
}

}  // namespace saphira::viewer

#include "recorder.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace saphira::recorder {

namespace {

constexpr std::string_view kDisposed = R"({"_disposed":true,)";  // as bus::Echo

bool is_command(const bus::TopicEntry& topic) {
  return topic.qos == "motion" || topic.qos == "command";
}

}  // namespace

std::vector<bus::TopicEntry> recorded_topics(const std::vector<std::string>& only) {
  const std::vector<bus::TopicEntry> all = bus::known_topics();
  for (const std::string& name : only)
    if (std::none_of(all.begin(), all.end(),
                     [&](const bus::TopicEntry& topic) { return topic.name == name; }))
      throw std::invalid_argument("no topic \"" + name + "\"; saphira list shows them");
  std::vector<bus::TopicEntry> topics;
  for (const bus::TopicEntry& topic : all)
    if (only.empty() ? topic.qos != "recall"
                     : std::find(only.begin(), only.end(), topic.name) != only.end())
      topics.push_back(topic);
  return topics;
}

Recorder::Recorder(bus::Node& node, Writer& writer, const std::vector<bus::TopicEntry>& topics)
    : writer_(writer) {
  for (const bus::TopicEntry& topic : topics) {
    try {
      auto echo = std::make_unique<bus::Echo>(node, topic.name);
      const std::uint16_t channel =
          writer_.add_channel({topic.name, topic.type, node.options().robot});
      sources_.push_back({std::move(echo), channel, topic.name == bus::topics::kPresence.name});
    } catch (const std::runtime_error& error) {
      refused_.push_back(topic.name + ": " + error.what());
    }
  }
}

void Recorder::poll(std::int64_t now_ns) {
  for (const Source& source : sources_)
    for (std::string& json : source.echo->take_json()) {
      writer_.add({source.channel, now_ns, std::move(json)});
      has_heard_ = has_heard_ || !source.is_presence;
    }
}

Contents contents_of(std::istream& in) {
  Contents contents;
  Reader reader(in);
  while (const auto sample = reader.next()) {
    const Channel& channel = reader.channel(sample->channel);
    const bool is_first = contents.samples.empty();
    contents.robot = channel.robot;
    contents.first_ns = is_first ? sample->time_ns : std::min(contents.first_ns, sample->time_ns);
    contents.last_ns = std::max(contents.last_ns, sample->time_ns);
    ++contents.samples[channel.topic];
  }
  contents.cut_off = reader.is_cut_off();
  return contents;
}

Player::Player(bus::Node& node, Reader& reader, const Contents& contents)
    : reader_(reader), first_ns_(contents.first_ns) {
  const std::vector<bus::TopicEntry> known = bus::known_topics();
  for (const auto& [topic, count] : contents.samples) {
    const auto entry = std::find_if(known.begin(), known.end(),
                                    [&](const auto& each) { return each.name == topic; });
    if (entry == known.end() || is_command(*entry))
      left_out_.insert(topic);
    else
      scribes_.try_emplace(topic, node, topic);
  }
}

bool Player::poll(double seconds) {
  const auto until = first_ns_ + static_cast<std::int64_t>(seconds * 1e9);
  while (waiting_ || (waiting_ = reader_.next())) {
    if (waiting_->time_ns > until)
      return true;
    const std::string& topic = reader_.channel(waiting_->channel).topic;
    if (const auto scribe = scribes_.find(topic); scribe != scribes_.end()) {
      try {
        if (waiting_->json.starts_with(kDisposed))
          scribe->second.dispose("{" + waiting_->json.substr(kDisposed.size()));
        else
          scribe->second.write(waiting_->json);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(topic + ": " + error.what());
      }
      ++written_;
    }
    waiting_.reset();
  }
  return false;
}

}  // namespace saphira::recorder

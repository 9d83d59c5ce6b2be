#include "saphira/viewer/protocol.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace saphira::viewer {

namespace {

using nlohmann::json;

constexpr std::size_t kMostSubscriptions = 1000;
constexpr std::size_t kMostTexts = 100;
constexpr int kError = 2;  // level of a status
constexpr char kMessage = 1;

template <class T>
void put(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU);
}

/// A member that is a list of objects or numbers; empty where it is none.
json list_of(const json& message, const char* name) {
  const auto found = message.find(name);
  return found != message.end() && found->is_array() ? *found : json::array();
}

/// -1: it is no number of the protocol.
std::int64_t number_of(const json& value) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > UINT32_MAX)
    return -1;
  return value.get<std::int64_t>();
}

std::int64_t number_of(const json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return found == object.end() ? -1 : number_of(*found);
}

}  // namespace

Client::Client(const std::string& name, const std::vector<Channel>& channels, std::size_t most)
    : channels_(channels.size()), most_(most) {
  const json info{{"op", "serverInfo"},
                  {"name", name},
                  {"capabilities", json::array()},
                  {"supportedEncodings", json::array()},
                  {"metadata", json::object()}};
  json advertised = json::array();
  for (std::size_t i = 0; i < channels.size(); ++i)
    advertised.push_back({{"id", i},
                          {"topic", channels[i].topic},
                          {"encoding", "json"},
                          {"schemaName", channels[i].type},
                          {"schema", channels[i].schema},
                          {"schemaEncoding", "jsonschema"}});
  first_.push_back({false, info.dump()});
  first_.push_back({false, json{{"op", "advertise"}, {"channels", advertised}}.dump()});
}

void Client::refuse(const std::string& reason) {
  if (first_.size() < kMostTexts)
    first_.push_back(
        {false, json{{"op", "status"}, {"level", kError}, {"message", reason}}.dump()});
}

std::optional<std::vector<std::size_t>> Client::take(const std::string& text) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object() || !message.contains("op") || !message["op"].is_string())
    return std::nullopt;
  const std::string op = message["op"];
  std::vector<std::size_t> added;
  if (op == "subscribe") {
    for (const json& each : list_of(message, "subscriptions")) {
      const std::int64_t id = number_of(each, "id");
      const std::int64_t channel = number_of(each, "channelId");
      if (id < 0 || channel < 0)
        return std::nullopt;
      const auto place = static_cast<std::size_t>(channel);
      if (place >= channels_)
        refuse("there is no channel " + std::to_string(place));
      else if (subscribed_.size() >= kMostSubscriptions)
        refuse("more than " + std::to_string(kMostSubscriptions) + " subscriptions");
      else if (subscribed_.emplace(static_cast<std::uint32_t>(id), place).second)
        added.push_back(place);
    }
  } else if (op == "unsubscribe") {
    for (const json& each : list_of(message, "subscriptionIds"))
      if (const std::int64_t id = number_of(each); id >= 0)
        subscribed_.erase(static_cast<std::uint32_t>(id));
  } else {
    refuse("this server shows the robot and takes nothing: \"" + op.substr(0, 40) +
           "\" is ignored");
  }
  return added;
}

bool Client::wants(std::size_t channel) const {
  return std::ranges::any_of(subscribed_,
                             [channel](const auto& each) { return each.second == channel; });
}

void Client::offer(std::size_t channel, std::int64_t time_ns, const std::string& json) {
  for (const auto& [id, of] : subscribed_) {
    if (of != channel)
      continue;
    std::string frame(1, kMessage);
    put(frame, id);
    put(frame, time_ns);
    frame += json;
    waiting_ += frame.size();
    samples_.push_back(std::move(frame));
  }
  while (waiting_ > most_ && samples_.size() > 1) {
    waiting_ -= samples_.front().size();
    samples_.pop_front();
    ++dropped_;
  }
}

std::optional<Client::Frame> Client::next() {
  Frame frame;
  if (!first_.empty()) {
    frame = std::move(first_.front());
    first_.pop_front();
    return frame;
  }
  if (samples_.empty())
    return std::nullopt;
  waiting_ -= samples_.front().size();
  frame = {true, std::move(samples_.front())};
  samples_.pop_front();
  return frame;
}

}  // namespace saphira::viewer

#include "last_minute.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "draw.hpp"
#include "recorder.hpp"
#include "saphira/viewer/schema.hpp"

namespace saphira::recorder {

namespace {

constexpr std::int64_t kCycle = 100'000'000;  // [ns]

// The topics whose last minute is kept, and what they repeat.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kKept{
    {{"recall/robot", "robot/state"},
     {"recall/grant", "drive/grant"},
     {"recall/behaviors", "behaviors/state"},
     {"recall/intentions", "intentions"}}};

std::string_view repeated_by(std::string_view topic) {
  for (const auto& [kept, live] : kKept)
    if (topic == kept)
      return live;
  return topic;
}

/// Without commands, and presence, which says nothing afterwards.
bool is_wanted(const bus::TopicEntry& topic) {
  return topic.qos != "motion" && topic.qos != "command" && topic.qos != "presence" &&
         topic.name != bus::topics::kRecallGoals.name &&
         std::ranges::none_of(kKept, [&](const auto& each) { return topic.name == each.second; });
}

std::pair<std::uint64_t, std::uint64_t> stamp_in(const std::string& json) {
  unsigned long long epoch = 0;
  unsigned long long cycle = 0;
  const std::size_t at = json.find("\"stamp\":");
  if (at == std::string::npos ||
      std::sscanf(json.c_str() + at, R"("stamp":{"epoch":%llu,"cycle":%llu)", &epoch, &cycle) != 2)
    return {};
  return {epoch, cycle};
}

}  // namespace

LastMinute::LastMinute(bus::Node& node) : goals_(node.reader(bus::topics::kRecallGoals)) {
  for (const bus::TopicEntry& topic : bus::known_topics()) {
    if (!is_wanted(topic))
      continue;
    try {
      sources_.push_back({std::make_unique<bus::Echo>(node, topic.name),
                          std::string(repeated_by(topic.name)), topic.type});
      if (topic.name == bus::topics::kGoalStatus.name)
        goal_source_ = sources_.size() - 1;
    } catch (const std::exception&) {
      // On a secured bus this program may not read it.
    }
  }
}

void LastMinute::keep(std::size_t source, std::string json, std::int64_t now_ns) {
  const auto stamp = stamp_in(json);
  if (sources_[source].topic == bus::topics::kRobotState.name && stamp > newest_) {
    newest_ = stamp;
    newest_ns_ = now_ns;
  }
  heard_.push_back({source, std::move(json), stamp});
}

void LastMinute::poll(std::int64_t now_ns) {
  for (std::size_t i = 0; i < sources_.size(); ++i)
    for (std::string& json : sources_[i].echo->take_json())
      keep(i, std::move(json), now_ns);
  goals_.visit([&](const v1::GoalStatusSet& set, const bus::SampleInfo&) {
    for (const v1::GoalStatus& goal : set.goals)
      keep(goal_source_, bus::type_of<v1::GoalStatus>().json(&goal, ""), now_ns);
  });
}

bool LastMinute::write(bus::Node& node, Writer& writer) {
  if (newest_.second == 0)
    return false;
  struct Timed {
    std::int64_t time_ns;
    const Heard* heard;
  };
  std::vector<Timed> samples;
  std::int64_t oldest = newest_ns_;
  for (const Heard& heard : heard_) {
    const bool is_timed = heard.stamp.first == newest_.first && heard.stamp.second > 0 &&
                          heard.stamp.second <= newest_.second;
    samples.push_back(
        {is_timed
             ? newest_ns_ - static_cast<std::int64_t>(newest_.second - heard.stamp.second) * kCycle
             : 0,
         &heard});
    if (is_timed && sources_[heard.source].topic == bus::topics::kRobotState.name)
      oldest = std::min(oldest, samples.back().time_ns);
  }
  // All else was so before the minute, as far as anybody knows.
  for (Timed& sample : samples)
    sample.time_ns = std::max(sample.time_ns, oldest);
  std::ranges::stable_sort(
      samples, [](const Timed& one, const Timed& other) { return one.time_ns < other.time_ns; });
  std::map<std::string, std::uint16_t> channels;
  const std::string& robot = node.options().robot;
  viewer::Scene scene(kGridPeriod);
  std::vector<std::uint16_t> drawn;
  for (const viewer::DrawnChannel& each : viewer::drawn_channels())
    drawn.push_back(
        writer.add_channel({each.topic, each.type, robot}, viewer::drawn_schema(each.type)));
  for (const auto& [time_ns, heard] : samples) {
    const Source& source = sources_[heard->source];
    auto channel = channels.find(source.topic);
    if (channel == channels.end())
      channel = channels
                    .emplace(source.topic, writer.add_channel({source.topic, source.type, robot},
                                                              viewer::schema_of(source.type)))
                    .first;
    for (viewer::DrawnMessage& each : viewer::draw(scene, source.topic, heard->json, time_ns))
      writer.add({drawn[each.channel], time_ns, std::move(each.json)});
    writer.add({channel->second, time_ns, heard->json});
  }
  return true;
}

}  // namespace saphira::recorder

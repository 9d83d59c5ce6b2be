#include "recorder.hpp"

#include <algorithm>
#include <stdexcept>

#include "draw.hpp"
#include "saphira/base/format.hpp"
#include "saphira/viewer/schema.hpp"

namespace saphira::recorder {

namespace {

constexpr std::int64_t kLongestGap =
    10'000'000'000;  // [ns] without any sample; presence has 10 a second
constexpr std::int64_t kShortGap = 100'000'000;  // [ns] that is played in its place

/// The part [ns] of the time between two samples that is played.
std::int64_t played(std::int64_t step_ns) {
  return step_ns < 0 || step_ns > kLongestGap ? kShortGap : step_ns;
}

/// Goals move a robot as commands do.
bool is_command(const bus::TopicEntry& topic) {
  return topic.qos == "motion" || topic.qos == "command" ||
         std::string_view(topic.name) == bus::topics::kGoals.name;
}

}  // namespace

std::vector<bus::TopicEntry> recorded_topics(const std::vector<std::string>& only) {
  const std::vector<bus::TopicEntry> all = bus::known_topics();
  for (const std::string& name : only)
    if (std::ranges::none_of(all, [&](const bus::TopicEntry& topic) { return topic.name == name; }))
      throw std::invalid_argument("no topic \"" + name + "\"; saphira list shows them");
  std::vector<bus::TopicEntry> topics;
  for (const bus::TopicEntry& topic : all)
    if (only.empty() ? topic.qos != "recall" : std::ranges::find(only, topic.name) != only.end())
      topics.push_back(topic);
  return topics;
}

Recorder::Recorder(bus::Node& node, Writer& writer, const std::vector<bus::TopicEntry>& topics)
    : writer_(writer), scene_(kGridPeriod) {
  for (const bus::TopicEntry& topic : topics) {
    try {
      auto echo = std::make_unique<bus::Echo>(node, topic.name);
      const std::uint16_t channel = writer_.add_channel(
          {topic.name, topic.type, node.options().robot}, viewer::schema_of(topic.type));
      sources_.push_back({std::move(echo), topic.name, channel});
    } catch (const std::exception& error) {
      refused_.push_back(topic.name + ": " + error.what());
    }
  }
  for (const viewer::DrawnChannel& drawn : viewer::drawn_channels())
    drawn_.push_back(writer_.add_channel({drawn.topic, drawn.type, node.options().robot},
                                         viewer::drawn_schema(drawn.type)));
}

void Recorder::poll(std::int64_t now_ns) {
  for (const Source& source : sources_)
    for (std::string& json : source.echo->take_json()) {
      for (viewer::DrawnMessage& drawn : viewer::draw(scene_, source.topic, json, now_ns))
        writer_.add({drawn_[drawn.channel], now_ns, std::move(drawn.json)});
      writer_.add({source.channel, now_ns, std::move(json)});
      has_heard_ = has_heard_ || source.topic != bus::topics::kPresence.name;
    }
}

Contents contents_of(std::istream& in) {
  Contents contents;
  std::int64_t last_ns = 0;
  Reader reader(in);
  while (const auto sample = reader.next()) {
    const Channel& channel = reader.channel(sample->channel);
    if (contents.samples.empty())
      contents.first_ns = last_ns = sample->time_ns;
    contents.robot = channel.robot;
    contents.seconds += static_cast<double>(played(sample->time_ns - last_ns)) / 1e9;
    last_ns = sample->time_ns;
    ++contents.samples[channel.topic];
  }
  contents.cut_off = reader.is_cut_off();
  return contents;
}

Player::Player(bus::Node& node, Reader& reader, const Contents& contents, const Options& options)
    : reader_(reader),
      played_ns_(static_cast<std::int64_t>(options.from * 1e9)),
      from_ns_(played_ns_) {
  if (options.from > contents.seconds)
    throw std::invalid_argument(
        format("it is %.1f s long: nothing is left from %g s on", contents.seconds, options.from));
  const std::vector<bus::TopicEntry> known = bus::known_topics();
  for (const auto& [topic, count] : contents.samples) {
    const auto entry =
        std::ranges::find_if(known, [&](const auto& each) { return each.name == topic; });
    if (entry == known.end() || is_command(*entry) ||
        (!options.only.empty() && !options.only.contains(topic)))
      left_out_.insert(topic);
    else
      scribes_.try_emplace(topic, node, topic);
    if (entry != known.end() && (entry->qos == "latched" || entry->qos == "status"))
      kept_.insert(topic);
  }
}

bool Player::poll(double seconds) {
  played_ns_ += static_cast<std::int64_t>(seconds * 1e9);
  while (true) {
    if (!waiting_) {
      waiting_ = reader_.next();
      if (!waiting_)
        return false;
      const std::int64_t step = waiting_->time_ns - last_ns_.value_or(waiting_->time_ns);
      if (played(step) != step)
        gaps_.push_back({static_cast<double>(due_ns_) / 1e9, static_cast<double>(step) / 1e9});
      last_ns_ = waiting_->time_ns;
      due_ns_ += played(step);
    }
    if (due_ns_ > played_ns_)
      return true;
    write(reader_.channel(waiting_->channel).topic, waiting_->json);
    waiting_.reset();
  }
}

void Player::write(const std::string& topic, const std::string& json) {
  const auto scribe = scribes_.find(topic);
  if (scribe == scribes_.end() || (due_ns_ < from_ns_ && !kept_.contains(topic)))
    return;
  try {
    if (json.starts_with(bus::kDisposed))
      scribe->second.dispose("{" + json.substr(bus::kDisposed.size()));
    else
      scribe->second.write(json);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(topic + ": " + error.what());
  }
  ++written_;
}

}  // namespace saphira::recorder

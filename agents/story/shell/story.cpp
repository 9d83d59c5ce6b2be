#include "story/shell/story.hpp"

#include <algorithm>
#include <cmath>

#include "maps/shell/convert.hpp"
#include "saphira/agent_interface/dialogue.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/format.hpp"

namespace saphira::story {
namespace {

constexpr double kThought = 1.0;    // [s] before an answer
constexpr double kStanding = 0.03;  // [m/s] a robot no faster than this stands
constexpr double kPause = 1.5;      // [s] of standing, before the next line

}  // namespace

std::string story_line(double time, const std::string& place, const std::string& line) {
  return format("%7.1f s  %-16.30s ", time, place.c_str()) + line;
}

bool is_story_line(std::string_view line) {
  return line.size() > 10 && line.substr(7, 4) == " s  " && line[5] == '.';
}

std::string_view said_in(std::string_view line) {
  // A place may be of several words, a name is one.
  return line.substr(line.rfind(' ', line.find(": ")) + 1);
}

Story::Story(bus::Node& node, Cast cast, StoryOptions options)
    : node_(node),
      cast_(std::move(cast)),
      options_(std::move(options)),
      waiting_for_(options_.services.begin(), options_.services.end()) {}

void Story::take() {
  if (const auto robot = robots_.take_newest()) {
    stamp_ = robot->stamp;
    time_ = seconds_of(stamp_.cycle);
    if (std::abs(robot->velocity) > kStanding)
      stands_since_ = time_;
  }
  if (const auto map = maps_.take_newest())
    map_ = maps::from_bus(*map);
  if (const auto registration = registrations_.take_newest()) {
    const auto& pose = registration->pose_in_map;
    pose_in_map_ = {pose.x, pose.y, pose.th};
    place_ = agent_interface::place_at(map_, pose_in_map_.position());
  }
  for (const auto& sample : statuses_.take())
    if (sample.data.state == v1::SERVICE_RUNNING)
      waiting_for_.erase(sample.data.name);
  for (const auto& sample : said_.take())
    if (!sample.info.disposed)
      listen(sample.data);
}

bool Story::step(double now) {
  now_ = now;
  take();
  if (answer_ && time_ >= answer_time_) {
    say(*answer_);
    answer_.reset();
  }
  if (time_ > options_.time_limit) {
    outcome_ = "it took longer than the time limit";
    return true;
  }
  if (!ready() || waits_)
    return false;
  if (next_ == cast_.lines().size()) {
    ended_ = true;
    return true;
  }
  say_next();
  return false;
}

void Story::say_next() {
  const auto& lines = cast_.lines();
  const Cast::Line& line = lines[next_];
  if (line.near && !stands_at(*line.near)) {
    if (errand_ && errand_->over)
      errand_ = Errand{errand_->line, say(errand_->line)};
    return;
  }
  ++next_;
  const std::uint64_t number = say(line);
  if (!line.near && next_ < lines.size() && lines[next_].near) {
    errand_ = Errand{line, number};
  } else {
    line_ = number;
    waits_ = true;
  }
}

bool Story::stands_at(const Cast::Spot& spot) const {
  if (time_ - stands_since_ < kPause)
    return false;
  const Vec2 robot = pose_in_map_.position();
  return std::ranges::any_of(map_.features, [&](const maps::Feature& feature) {
    return feature.name == spot.place &&
           (feature.type == lps::PointType::door
                ? (feature.pose_in_map.position() - robot).norm() <= spot.distance
                : maps::contains(feature, robot));
  });
}

std::uint64_t Story::say(const Cast::Line& line) {
  v1::Utterance utterance{.stamp = stamp_,
                          .id = {node_.instance(), ++number_},
                          .speaker = line.speaker,
                          .text = line.text,
                          .means = v1::UTTERANCE_ACTED,
                          .confidence = 1.0,
                          .time = now_};
  show(line.speaker + ": " + line.text);
  heard_.write(utterance);
  return number_;
}

void Story::listen(const v1::Utterance& said) {
  show("flakey: " + std::string(said.text));
  if (said.end && said.answers.writer == node_.instance() && said.answers.number == line_) {
    waits_ = false;
    outcome_ = said.text;
  } else if (said.end && errand_ && said.answers.writer == node_.instance() &&
             said.answers.number == errand_->number) {
    errand_->over = true;
  } else if (const auto answer = cast_.answer(said.text, place_)) {
    answer_ = answer;
    answer_time_ = time_ + kThought;
  }
}

void Story::show(const std::string& line) {
  ++utterances_;
  hash_.add(line + "\n");
  if (options_.show)
    options_.show(time_, place_, line);
}

}  // namespace saphira::story

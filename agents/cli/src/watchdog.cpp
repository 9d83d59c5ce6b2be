#include "saphira/cli/watchdog.hpp"

#include <algorithm>

namespace saphira::cli {

namespace {

// Nodes send a heartbeat once a second: a longer pause is not regular.
constexpr std::chrono::seconds kLate{4};
// Consecutive lives of a child without hearing the robot: then the child is not the cause.
constexpr int kDeafLives = 2;

std::string seconds(std::chrono::seconds time) {
  return std::to_string(time.count()) + " s";
}

}  // namespace

bool Watchdog::Voice::steps_since(Time since, Time now) const {
  return stepped && *stepped <= since && now - advanced <= kLate;
}

bool Watchdog::Voice::waits_for(std::chrono::seconds time, Time now) const {
  return waits && now - *waits >= time;
}

bool Watchdog::Child::was_deaf() const {
  return !voices.empty() && std::ranges::all_of(voices, [](const auto& item) {
    return item.second.waits && !item.second.heard;
  });
}

Watchdog::Watchdog(std::vector<std::string> robots) {
  for (std::string& robot : robots)
    children_.push_back({std::move(robot), {}, 0});
}

void Watchdog::forget(std::size_t child) {
  Child& gone = children_[child];
  const bool bridge =
      std::ranges::any_of(gone.voices, [](const auto& item) { return item.second.bridge; });
  gone.deaf_lives = gone.was_deaf() ? gone.deaf_lives + 1 : 0;
  gone.voices.clear();
  if (!bridge)
    return;
  for (Child& other : children_)
    if (other.robot == gone.robot)
      other.deaf_lives = 0;
}

void Watchdog::hear(std::size_t child, const Heartbeat& beat, Time now) {
  auto& voices = children_[child].voices;
  if ((beat.flags & Heartbeat::kEnds) != 0) {
    voices.erase(beat.instance);
    return;
  }
  Voice& voice = voices[beat.instance];
  ++voice.beats;
  voice.bridge = (beat.flags & Heartbeat::kWritesRobot) != 0;
  if (beat.cycle != voice.cycle) {
    voice.heard = true;
    if (!voice.stepped || now - voice.advanced > kLate)
      voice.stepped = now;
    voice.advanced = now;
    voice.cycle = beat.cycle;
  }
  if ((beat.flags & Heartbeat::kWaitsForRobot) == 0)
    voice.waits.reset();
  else if (!voice.waits)
    voice.waits = now;
  voice.last = now;
}

void Watchdog::slept(Time now) {
  for (Child& child : children_)
    for (auto& [instance, voice] : child.voices) {
      voice.last = now;
      voice.stepped.reset();
      if (voice.waits)
        voice.waits = now;
    }
}

void Watchdog::starved(std::size_t child, std::chrono::nanoseconds waited, Time now) {
  for (auto& [instance, voice] : children_[child].voices) {
    voice.last = std::min(now, voice.last + std::chrono::duration_cast<Time::duration>(waited));
    if (voice.waits)
      voice.waits =
          std::min(now, *voice.waits + std::chrono::duration_cast<Time::duration>(waited));
  }
}

std::optional<std::string> Watchdog::trouble(std::size_t child, Time now) const {
  for (const auto& [instance, voice] : children_[child].voices) {
    if (voice.beats >= kRegular && now - voice.last >= kSilent)
      return "it hung: no sign of life for " + seconds(kSilent);
    if (!voice.bridge && deaf(child, voice, now))
      return "it was deaf: no robot/state for " +
             seconds(voice.waits_for(kAllDeaf, now) ? kAllDeaf : kDeaf) +
             ", while the robot was there";
    if (voice.bridge && mute(children_[child].robot, voice, now))
      return "it was mute: its robot was there for " + seconds(kMute) +
             ", and programs of this robot did not hear it";
  }
  return std::nullopt;
}

template <class Is>
bool Watchdog::any(const std::string& robot, std::optional<std::size_t> but, Is is) const {
  for (std::size_t i = 0; i < children_.size(); ++i)
    if (i != but && children_[i].robot == robot &&
        std::ranges::any_of(children_[i].voices,
                            [&](const auto& item) { return is(children_[i], item.second); }))
      return true;
  return false;
}

bool Watchdog::deaf(std::size_t child, const Voice& voice, Time now) const {
  if (!voice.waits_for(kDeaf, now))
    return false;
  const std::string& robot = children_[child].robot;
  const auto hears = [&](const Child&, const Voice& other) {
    return !other.bridge && other.steps_since(*voice.waits, now);
  };
  const auto has_robot = [&](const Child&, const Voice& other) {
    return other.bridge && other.steps_since(now - kDeaf, now);
  };
  return any(robot, child, hears) ||
         (voice.waits_for(kAllDeaf, now) && any(robot, child, has_robot));
}

bool Watchdog::mute(const std::string& robot, const Voice& bridge, Time now) const {
  if (!bridge.steps_since(now - kMute, now))
    return false;
  const auto waits = [&](const Child&, const Voice& other) { return other.waits_for(kMute, now); };
  const auto hears = [&](const Child&, const Voice& other) {
    return !other.bridge && !other.waits && other.steps_since(now, now);
  };
  const auto never_hears = [&](const Child& child, const Voice& other) {
    return child.deaf_lives >= kDeafLives && other.waits_for(kDeaf, now) && !other.heard;
  };
  return any(robot, std::nullopt, never_hears) ||
         (any(robot, std::nullopt, waits) && !any(robot, std::nullopt, hears));
}

}  // namespace saphira::cli

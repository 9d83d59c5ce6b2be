#include "saphira/cli/watchdog.hpp"

#include <algorithm>

namespace saphira::cli {

namespace {

// Nodes say something once a second: this is late for what is regular.
constexpr std::chrono::seconds kLate{4};

}  // namespace

Watchdog::Watchdog(std::vector<std::string> robots) {
  for (std::string& robot : robots)
    children_.push_back({std::move(robot), {}});
}

void Watchdog::forget(std::size_t child) {
  children_[child].voices.clear();
}

void Watchdog::hear(std::size_t child, const Heartbeat& beat, Time now) {
  auto& voices = children_[child].voices;
  if ((beat.flags & Heartbeat::kEnds) != 0) {
    voices.erase(beat.instance);
    return;
  }
  Voice& voice = voices[beat.instance];
  ++voice.beats;
  if (beat.cycle != voice.cycle) {
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

std::optional<std::string> Watchdog::trouble(std::size_t child, Time now) const {
  for (const auto& [instance, voice] : children_[child].voices) {
    if (voice.beats >= kRegular && now - voice.last >= kSilent)
      return "it hung: no sign of life for " + std::to_string(kSilent.count()) + " s";
    if (voice.waits && now - *voice.waits >= kDeaf && others_hear(child, *voice.waits, now))
      return "it was deaf: no robot/state for " + std::to_string(kDeaf.count()) +
             " s, while others of this robot had it";
  }
  return std::nullopt;
}

bool Watchdog::others_hear(std::size_t child, Time since, Time now) const {
  for (std::size_t i = 0; i < children_.size(); ++i) {
    if (i == child || children_[i].robot != children_[child].robot)
      continue;
    const auto& voices = children_[i].voices;
    if (std::any_of(voices.begin(), voices.end(), [&](const auto& item) {
          const Voice& voice = item.second;
          return voice.stepped && *voice.stepped <= since && now - voice.advanced <= kLate;
        }))
      return true;
  }
  return false;
}

}  // namespace saphira::cli

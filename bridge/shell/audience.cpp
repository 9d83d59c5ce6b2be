#include "audience.hpp"

#include <algorithm>

#include "saphira/bus/status_words.hpp"

namespace saphira::bridge {

void Audience::hear(const bus::WriterId& writer, const v1::ServiceStatus& status, double now) {
  const auto [known, is_new] = programs_.try_emplace(writer);
  Program& program = known->second;
  const bool waits = bus::waits_for_robot(status);
  program.steps = !waits && !is_new && program.stamp != status.stamp;
  program.stamp = status.stamp;
  if (!waits)
    program.waits.reset();
  else if (!program.waits)
    program.waits = now;
}

bool Audience::begins_anew(double now) {
  const auto steps = [](const auto& item) { return item.second.steps; };
  const auto waits = [&](const auto& item) {
    return item.second.waits && now - *item.second.waits >= kMute;
  };
  if ((anew_ && now - *anew_ < kAgain) || std::ranges::none_of(programs_, waits) ||
      std::ranges::any_of(programs_, steps))
    return false;
  anew_ = now;
  return true;
}

}  // namespace saphira::bridge

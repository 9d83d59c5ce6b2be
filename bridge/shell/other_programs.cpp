#include "other_programs.hpp"

#include <algorithm>

#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/status_words.hpp"

namespace saphira::bridge {

void Audience::update(const bus::WriterId& writer, const v1::ServiceStatus& status, double now) {
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

OtherPrograms::OtherPrograms(bus::Node& node)
    : node_(node), statuses_(node.reader(bus::topics::kStatus)) {}

void OtherPrograms::take() {
  const double now = BootClock::seconds();
  const Checked member = node_.identity();
  for (const auto& sample : statuses_.take()) {
    if (sample.data.instance == node_.status().instance)
      continue;
    if (sample.data.name == node_.status().name &&
        may_be_of_a_kind(member, sample.info.sender.get()))
      note(sample.data, sample.info);
    else if (sample.info.disposed)
      audience_.lose(sample.info.writer);
    else
      audience_.update(sample.info.writer, sample.data, now);
  }
  for (const bus::WriterId& writer : statuses_.take_lost()) {
    others_.erase(writer);
    audience_.lose(writer);
  }
  // This bridge has its robot, and nobody hears it: the bus is broken.
  if (has_robot() && audience_.begins_anew(now)) {
    node_.warn("no program hears robot/state, and some wait for it: begins anew on the bus");
    node_.begin_anew();
  }
}

// In lockstep the robot waits for the services.
bool OtherPrograms::has_robot() const {
  const v1::ServiceStatus& own = node_.status();
  return bus::serves(own) && own.stamp.cycle > 0 && !node_.options().lockstep;
}

void OtherPrograms::note(const v1::ServiceStatus& other, const bus::SampleInfo& info) {
  if (info.disposed || !bus::serves(other)) {
    others_.erase(info.writer);
    return;
  }
  const auto [known, is_new] = others_.try_emplace(
      info.writer, "process " + std::to_string(other.pid) + " at " + other.host);
  if (is_new)
    node_.error("another bridge, " + known->second + ", has a robot of the name \"" +
                node_.options().robot + "\": give one of them another name (--robot)");
}

}  // namespace saphira::bridge

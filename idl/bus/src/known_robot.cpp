#include "saphira/bus/known_robot.hpp"

#include <algorithm>

#include "saphira/bus/topics.hpp"

namespace saphira::bus {

KnownRobot::KnownRobot(Node& node) : node_(node), reader_(node.reader(topics::kRobotDescription)) {}

bool KnownRobot::take(std::uint64_t epoch) {
  reader_.visit([&](const v1::RobotDescription& description, const SampleInfo& info) {
    if (info.disposed)
      return;
    recent_.push_back(description);
    if (recent_.size() > kRecent)
      recent_.pop_front();
  });
  const auto found = std::find_if(recent_.begin(), recent_.end(), [&](const auto& description) {
    return description.stamp().epoch() == epoch;
  });
  if (found != recent_.end()) {
    description_ = *found;
    return true;
  }
  node_.status().state() = v1::SERVICE_WAITING;
  node_.status().reason() = std::string("waits for ") + topics::kRobotDescription.name;
  return false;
}

KnownRobot::Knowledge KnownRobot::of(std::uint64_t epoch, const Stop& stop) {
  if (description_ && description_->stamp().epoch() == epoch)
    return Knowledge::same;
  bool here = take(epoch);
  // The description of an epoch that was left is replaced by the next one's, and comes no more.
  const auto may_come = [&] {
    return std::none_of(recent_.begin(), recent_.end(), [&](const auto& description) {
      return description.stamp().epoch() > epoch;
    });
  };
  while (!here && may_come() && node_.options().lockstep && !stop.requested()) {
    node_.publish_status();
    node_.wait(std::chrono::milliseconds(500), &stop);
    here = take(epoch);
  }
  if (!here)
    return Knowledge::none;
  node_.status().state() = v1::SERVICE_RUNNING;
  node_.status().reason().clear();
  return Knowledge::fresh;
}

}  // namespace saphira::bus

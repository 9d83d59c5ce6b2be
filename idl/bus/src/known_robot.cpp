#include "saphira/bus/known_robot.hpp"

#include "saphira/bus/topics.hpp"

namespace saphira::bus {

KnownRobot::KnownRobot(Node& node) : node_(node), reader_(node.reader(topics::kRobotDescription)) {}

bool KnownRobot::take(std::uint64_t epoch) {
  if (auto newest = reader_.take_newest())
    newest_ = std::move(*newest);
  if (newest_ && newest_->stamp().epoch() == epoch)
    return true;
  node_.status().state() = v1::SERVICE_WAITING;
  node_.status().reason() = std::string("waits for ") + topics::kRobotDescription.name;
  return false;
}

KnownRobot::Knowledge KnownRobot::of(std::uint64_t epoch, const Stop& stop) {
  if (description_ && description_->stamp().epoch() == epoch)
    return Knowledge::same;
  bool here = take(epoch);
  // The description of an epoch that was left is replaced by the next one's, and comes no more.
  const auto may_come = [&] { return !newest_ || newest_->stamp().epoch() < epoch; };
  while (!here && may_come() && node_.options().lockstep && !stop.requested()) {
    node_.publish_status();
    node_.wait(std::chrono::milliseconds(500), &stop);
    here = take(epoch);
  }
  if (!here)
    return Knowledge::none;
  description_ = newest_;
  node_.status().state() = v1::SERVICE_RUNNING;
  node_.status().reason().clear();
  return Knowledge::fresh;
}

}  // namespace saphira::bus

#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "goals.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/idl/intention.hpp"
#include "scripted_robot.hpp"

namespace saphira::intentions {

/// The goal go_to of a place [m] in odom.
inline v1::Goal go_to(double x, double y) {
  return test::goal("go_to", {bus::point("position", x, y, 0.0, v1::FRAME_ODOM)});
}

inline IntendedBehavior from_bus(const v1::IntendedBehavior& behavior) {
  return {behavior.name,
          behavior.schema,
          behavior.priority,
          behavior.running,
          saphira::from_bus(behavior.parameters),
          behavior.intention,
          behavior.blocking};
}

/// The bridge and the behaviors service in one, in the simplest form, on the bus.
class ScriptedBus {
 public:
  explicit ScriptedBus(bus::Node& node)
      : description_(node.writer(bus::topics::kRobotDescription)),
        state_(node.writer(bus::topics::kRobotState)),
        behaviors_(node.writer(bus::topics::kBehaviors)),
        schemas_(node.writer(bus::topics::kBehaviorSchemas)),
        intentions_(node.reader(bus::topics::kIntentions)) {
    have({});
  }

  /// Announces these behaviors.
  void have(const std::vector<std::string>& names) {
    v1::BehaviorSchemas sample;
    for (const std::string& name : names) {
      sample.schemas.emplace_back();
      sample.schemas.back().name = name;
    }
    schemas_.write(sample);
  }

  ScriptedRobot world;
  std::uint64_t epoch = 100;
  std::uint64_t cycle = 0;

  /// The robot's next cycle.
  void publish_state() {
    ++cycle;
    if (std::exchange(described_, epoch) != epoch) {
      description_.write(
          {.stamp = stamp(), .front_buffer = 30, .side_buffer = 20, .front_max_range = 2.5});
    }
    state_.write({.stamp = stamp(),
                  .odom = world.robot.odom,
                  .pose_in_odom = {world.robot.pose_in_odom.x, world.robot.pose_in_odom.y,
                                   world.robot.pose_in_odom.th},
                  .velocity = world.robot.velocity,
                  .rotation_velocity = world.robot.rotation_velocity,
                  .status = v1::MOTORS_MOVING});
  }

  /// Carries out this cycle's intent, if it has come: publishes the behaviors sample of the cycle
  /// and moves the world on.
  bool act() {
    for (const auto& sample : intentions_.take()) {
      if (sample.data.stamp.cycle == cycle && sample.data.stamp.epoch == epoch)
        intended = sample.data;
    }
    if (!intended || intended->stamp.cycle != cycle || intended->stamp.epoch != epoch)
      return false;
    std::vector<IntendedBehavior> behaviors;
    for (const v1::IntendedBehavior& behavior : intended->behaviors)
      behaviors.push_back(from_bus(behavior));
    world.move(behaviors);
    v1::BehaviorSet sample{.stamp = stamp(), .control = true};
    for (const BehaviorLevel& level : world.levels) {
      sample.behaviors.push_back({.name = level.name, .goal = level.goal});
    }
    behaviors_.write(sample);
    return true;
  }

  std::optional<v1::Intentions> intended;  ///< the newest that were acted on

 private:
  v1::Stamp stamp() const { return v1::Stamp{.epoch = epoch, .cycle = cycle}; }

  std::uint64_t described_ = 0;  ///< the epoch
  bus::Writer<v1::RobotDescription> description_;
  bus::Writer<v1::RobotState> state_;
  bus::Writer<v1::BehaviorSet> behaviors_;
  bus::Writer<v1::BehaviorSchemas> schemas_;
  bus::Reader<v1::Intentions> intentions_;
};

}  // namespace saphira::intentions

#include "convert.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "behaviors/shell/convert.hpp"
#include "bridge/shell/enums.hpp"
#include "geometry/shell/convert.hpp"
#include "lps/shell/convert.hpp"
#include "saphira.h"

namespace saphira::c {
namespace {

constexpr double kDrawnFor = 1.0;  // [s]
constexpr double kPixel = 0.025;   // [m] size of a pixel of the manual's window

/// Manual Table 6-4.
std::array<std::uint8_t, 3> color_of(int number) {
  static const std::map<int, std::array<std::uint8_t, 3>> colors{
      {0, {255, 215, 0}},  {3, {255, 240, 130}}, {5, {210, 0, 0}},      {8, {255, 110, 110}},
      {10, {0, 190, 200}}, {11, {85, 107, 47}},  {12, {255, 69, 0}},    {13, {255, 0, 255}},
      {15, {178, 60, 50}}, {100, {0, 0, 0}},     {101, {255, 255, 255}}};
  const auto found = colors.find(number);
  return found == colors.end() ? std::array<std::uint8_t, 3>{70, 130, 180}  // steel blue
                               : found->second;
}

v1::IntentionState intention_state(int state) {
  switch (state) {
    case sfINIT:
      return v1::INTENTION_INIT;
    case sfINTERRUPT:
      return v1::INTENTION_INTERRUPTED;
    case sfSUCCESS:
      return v1::INTENTION_SUCCESS;
    case sfFAILURE:
      return v1::INTENTION_FAILURE;
    case sfTIMEOUT:
      return v1::INTENTION_TIMEOUT;
    default:
      return state == sfSUSPEND || state < 0 ? v1::INTENTION_SUSPENDED : v1::INTENTION_RUNNING;
  }
}

}  // namespace

protocol::RobotParameters parameters_of(const v1::RobotDescription& robot) {
  protocol::RobotParameters parameters;
  parameters.file = robot.parameter_file;
  parameters.name = robot.name;
  parameters.robot_class = robot.robot_class;
  parameters.subclass = robot.robot_subclass;
  parameters.radius = robot.radius;
  parameters.diagonal = robot.diagonal;
  parameters.max_velocity = robot.max_velocity;
  parameters.max_rotation_velocity = robot.max_rotation_velocity;
  parameters.acceleration = robot.acceleration;
  parameters.deceleration = robot.deceleration;
  parameters.rotation_acceleration = robot.rotation_acceleration;
  parameters.front_buffer = robot.front_buffer;
  parameters.side_buffer = robot.side_buffer;
  parameters.front_max_range = robot.front_max_range;
  for (const lps::SonarMount& mount : lps::mounts_from_bus(robot))
    parameters.sonars.push_back({static_cast<std::uint8_t>(mount.sonar), mount.in_robot});
  return parameters;
}

reflector::State state_of(const v1::RobotState& robot) {
  reflector::State state;
  state.cycle = robot.stamp.cycle;
  state.odom = robot.odom;
  state.pose_in_odom = from_bus(robot.pose_in_odom);
  state.target_velocity = robot.target_velocity;
  state.target_heading_in_odom = robot.target_heading_in_odom;
  state.motor_packets_per_s = robot.motor_packets_per_s;
  state.sonar_readings_per_s = robot.sonar_readings_per_s;
  protocol::Information& now = state.information;
  now.motors = bridge::kMotors.ours(robot.status, protocol::Motors::kStopped);
  now.th = state.pose_in_odom.th;
  now.velocity = robot.velocity;
  now.rotation_velocity = robot.rotation_velocity;
  now.left_velocity = robot.left_velocity;
  now.right_velocity = robot.right_velocity;
  now.battery = robot.battery;
  now.left_stalled = robot.left_stalled;
  now.right_stalled = robot.right_stalled;
  now.bumpers = robot.bumpers;
  now.ptu = robot.ptu;
  now.say = robot.say;
  now.timer = robot.timer;
  now.analog = robot.analog;
  now.digital_input = robot.digital_input;
  now.digital_output = robot.digital_output;
  for (const v1::SonarReading& sonar : robot.sonars)
    now.sonars.push_back({sonar.sonar, static_cast<double>(sonar.range), sonar.echo});
  return state;
}

v1::MotorCommand command_of(const reflector::Motion& motion) {
  return {.active = true,
          .translation = bridge::kTranslations.theirs(motion.translation),
          .velocity = motion.velocity,
          .distance = motion.distance,
          .move = motion.move,
          .rotation = bridge::kRotations.theirs(motion.rotation),
          .rotation_velocity = motion.rotation_velocity,
          .heading = motion.heading};
}

protocol::VisionPacket seen_in(const v1::VisionChannels& channels) {
  protocol::VisionPacket seen;
  for (std::size_t i = 0; i < std::min(seen.channels.size(), channels.channels.size()); ++i) {
    const v1::VisionChannel& from = channels.channels[i];
    protocol::VisionChannel& to = seen.channels[i];
    to.mode = bridge::kVisionModes.ours(from.mode, protocol::VisionChannel::Mode::kBlob);
    to.x = from.x;
    to.y = from.y;
    to.area = from.area;
    to.height = from.height;
    to.width = from.width;
    to.first = from.first;
    to.count = from.count;
  }
  return seen;
}

v1::Drawing drawing_of(const Drawn& drawn) {
  v1::Drawing drawing{.frame = v1::FRAME_ROBOT,
                      .shape = drawn.line ? v1::DRAWING_LINE : v1::DRAWING_RECTANGLE};
  v1::DrawnPoint corner{.x = drawn.x / 1000.0, .y = drawn.y / 1000.0};
  drawing.points.push_back(corner);
  corner.x = (drawn.x + drawn.dx) / 1000.0;
  corner.y = (drawn.y + drawn.dy) / 1000.0;
  drawing.points.push_back(corner);
  const auto color = color_of(drawn.pen.line);
  drawing.red = color[0];
  drawing.green = color[1];
  drawing.blue = color[2];
  drawing.width = drawn.pen.width * kPixel;
  drawing.lifetime = kDrawnFor;
  return drawing;
}

v1::ProgramMind mind_of(const SharedMind& mind) {
  v1::ProgramMind sample{.behaviors = behaviors::to_bus(mind.behaviors)};
  v1::Intentions& intentions = sample.intended;
  intentions.behavior_control = mind.behaviors.control;
  for (const SharedIntention& one : mind.intentions) {
    intentions.nodes.push_back({.id = one.id,
                                .parent = one.parent,
                                .name = one.name,
                                .schema = one.behavior.empty() ? one.name : one.behavior,
                                .state = intention_state(one.state),
                                .label = !one.behavior.empty() ? "B"
                                         : one.state >= kFirstOwnState
                                             ? "state " + std::to_string(one.state)
                                             : ""});
  }
  for (const behaviors::BehaviorState& one : mind.behaviors.behaviors) {
    v1::IntendedBehavior intended{.name = one.name,
                                  .schema = one.schema,
                                  .priority = one.blended.priority,
                                  .running = one.running};
    for (const SharedIntention& intention : mind.intentions)
      if (intention.behavior == one.name)
        intended.intention = intention.id;
    intentions.behaviors.push_back(intended);
  }
  return sample;
}

std::optional<Call> device_call(const protocol::Bytes& packet) {
  // Header (2), count, command, kind of argument, argument, sum (2).
  constexpr std::size_t kCommand = 3;
  if (packet.size() < kCommand + 6)
    return std::nullopt;
  const int low = packet[kCommand + 2];
  const int high = packet[kCommand + 3];
  const auto call = [](const bus::RequestTopic& topic, const char* functor,
                       std::vector<v1::Argument> arguments) {
    return Call{topic, bus::request(functor, std::move(arguments))};
  };
  switch (static_cast<protocol::Number>(packet[kCommand])) {
    case protocol::Number::kDigitalOutput:
      return call(bus::topics::kDigitalOutput, "output",
                  {bus::number("bits", low), bus::number("mask", high)});
    case protocol::Number::kPtu:
      return call(bus::topics::kServo, "servo", {bus::number("width", low + 256 * high)});
    case protocol::Number::kTimer:
      return call(bus::topics::kTimer, "timer", {bus::number("pin", low)});
    case protocol::Number::kGripper:
      return call(bus::topics::kGripper, "gripper",
                  {bus::text("action", "number"), bus::number("value", low + 256 * high)});
    case protocol::Number::kVision: {
      const auto text = packet.begin() + kCommand + 3;
      const auto end = std::min(text + low, packet.end() - 2);
      return call(bus::topics::kVisionSystem, "say",
                  {bus::text("text", std::string(text, std::max(text, end)))});
    }
    default:
      return std::nullopt;
  }
}

}  // namespace saphira::c

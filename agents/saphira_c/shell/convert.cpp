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
  auto parameters = translated<protocol::RobotParameters>(robot);
  parameters.file = robot.parameter_file;
  parameters.subclass = robot.robot_subclass;
  parameters.sonars.clear();
  for (const lps::SonarMount& mount : lps::mounts_from_bus(robot))
    parameters.sonars.push_back({static_cast<std::uint8_t>(mount.sonar), mount.in_robot});
  return parameters;
}

reflector::State state_of(const v1::RobotState& robot) {
  auto state = translated<reflector::State>(robot);
  state.cycle = robot.stamp.cycle;
  protocol::Information& now = state.information;
  take(now, robot);
  now.motors = bridge::kMotors.ours(robot.status, protocol::Motors::kStopped);
  now.th = state.pose_in_odom.th;
  now.sonars.clear();
  for (const v1::SonarReading& sonar : robot.sonars)
    now.sonars.push_back({sonar.sonar, static_cast<double>(sonar.range), sonar.echo});
  return state;
}

v1::MotorCommand command_of(const reflector::Motion& motion) {
  auto command = translated<v1::MotorCommand>(motion);
  command.active = true;
  return command;
}

protocol::VisionPacket seen_in(const v1::VisionChannels& channels) {
  protocol::VisionPacket seen;
  for (std::size_t i = 0; i < std::min(seen.channels.size(), channels.channels.size()); ++i)
    take(seen.channels[i], channels.channels[i]);
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

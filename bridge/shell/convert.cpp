#include "convert.hpp"

#include <algorithm>
#include <limits>

#include "enums.hpp"
#include "geometry/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/enum_pairs.hpp"

namespace saphira::bridge {

namespace {

constexpr auto kRoles = pairs_by_name<authority::Role, v1::Role>();
constexpr auto kGuardActions = pairs_by_name<authority::GuardAction, v1::GuardAction>();
// The bounds of the sequences.
constexpr std::size_t kMostSonars = 64;
constexpr std::size_t kMostRefusals = 16;
constexpr std::size_t kMostRequests = 64;
constexpr std::size_t kMostCounts = 64;

template <class T>
T short_of(unsigned value) {
  return static_cast<T>(std::min<unsigned>(value, std::numeric_limits<T>::max()));
}

template <class T>
std::vector<T> first(std::vector<T> values, std::size_t count) {
  values.resize(std::min(values.size(), count));
  return values;
}

v1::SonarReading reading_of(const protocol::Sonar& sonar) {
  return {.sonar = sonar.number, .range = static_cast<float>(sonar.range), .echo = sonar.echo};
}

}  // namespace

v1::RobotState to_bus(const reflector::State& state, const v1::Stamp& stamp,
                      std::uint64_t bad_packets) {
  const protocol::Information& in = state.information;
  v1::RobotState out{.stamp = stamp,
                     .odom = state.odom,
                     .pose_in_odom = saphira::to_bus(state.pose_in_odom),
                     .velocity = in.velocity,
                     .rotation_velocity = in.rotation_velocity,
                     .left_velocity = in.left_velocity,
                     .right_velocity = in.right_velocity,
                     .target_velocity = state.target_velocity,
                     .target_heading_in_odom = state.target_heading_in_odom,
                     .status = kMotors.theirs(in.motors),
                     .left_stalled = in.left_stalled,
                     .right_stalled = in.right_stalled,
                     .bumpers = in.bumpers,
                     .battery = in.battery,
                     .ptu = in.ptu,
                     .head = in.head,
                     .say = in.say,
                     .timer = in.timer,
                     .analog = in.analog,
                     .digital_input = in.digital_input,
                     .digital_output = in.digital_output,
                     .sonars = converted(in.sonars, reading_of, kMostSonars),
                     .motor_packets_per_s = short_of<std::uint16_t>(state.motor_packets_per_s),
                     .sonar_readings_per_s = short_of<std::uint16_t>(state.sonar_readings_per_s)};
  out.vision_packets_per_s = 0;  // Shell counts them
  out.bad_packets = static_cast<std::uint32_t>(bad_packets);
  return out;
}

v1::SonarBuckets to_bus(const std::vector<reflector::Bucket>& buckets, std::uint64_t odom,
                        const v1::Stamp& stamp) {
  v1::SonarBuckets out{.stamp = stamp, .odom = odom};
  const auto each = [](const reflector::Bucket& bucket) {
    return v1::SonarBucket{.reading = reading_of(bucket.reading),
                           .cycle = bucket.cycle,
                           .pose_in_odom = saphira::to_bus(bucket.pose_in_odom),
                           .x = bucket.point.x(),
                           .y = bucket.point.y()};
  };
  out.buckets = converted(buckets, each, kMostSonars);
  return out;
}

v1::VisionChannels to_bus(const protocol::VisionPacket& packet) {
  return {.channels = converted(packet.channels, [](const protocol::VisionChannel& channel) {
            return v1::VisionChannel{.mode = kVisionModes.theirs(channel.mode),
                                     .x = channel.x,
                                     .y = channel.y,
                                     .area = channel.area,
                                     .width = channel.width,
                                     .height = channel.height,
                                     .first = channel.first,
                                     .count = channel.count};
          })};
}

v1::RobotDescription to_bus(const protocol::RobotParameters& p,
                            const protocol::RobotIdentity& identity, const v1::Stamp& stamp,
                            const std::string& link, bool lockstep) {
  v1::RobotDescription out{.stamp = stamp,
                           .name = identity.name,
                           .robot_class = identity.robot_class,
                           .robot_subclass = identity.subclass,
                           .parameter_file = p.file,
                           .link = link,
                           .radius = p.radius,
                           .diagonal = p.diagonal,
                           .max_velocity = p.max_velocity,
                           .max_rotation_velocity = p.max_rotation_velocity,
                           .acceleration = p.acceleration,
                           .deceleration = p.deceleration,
                           .rotation_acceleration = p.rotation_acceleration,
                           .front_buffer = static_cast<std::uint16_t>(p.front_buffer),
                           .side_buffer = static_cast<std::uint16_t>(p.side_buffer),
                           .front_max_range = p.front_max_range,
                           .head_reach = p.head_reach,
                           .lockstep = lockstep};
  const auto sonar = [](const protocol::SonarUnit& unit) {
    return v1::SonarPose{.sonar = unit.number,
                         .pose_in_robot = saphira::to_bus(unit.pose_in_robot)};
  };
  out.sonars = converted(p.sonars, sonar, kMostSonars);
  return out;
}

v1::Grant to_bus(const authority::Grant& grant, const DriverSetpoints& told,
                 const authority::Guarded& guarded, const std::vector<authority::Refusal>& refused,
                 const v1::Stamp& stamp) {
  v1::Grant out{
      .stamp = stamp,
      .role = kRoles.theirs(grant.role),
      .source = grant.source,
      .reason = grant.reason,
      .expires_in = grant.expires_in,
      .command_age = grant.command_age,
      .guard = kGuardActions.theirs(guarded.action),
      .guard_reason = guarded.reason,
      .asked_velocity = told.setpoints.velocity,
      .velocity = guarded.velocity,
      .rotation = told.setpoints.turn_to_heading ? v1::ROTATION_HEADING : v1::ROTATION_VELOCITY,
      .rotation_velocity = guarded.rotation_velocity,
      .heading = told.setpoints.heading_in_odom,
      .distance_left = told.distance_left,
      .answers = grant.answers,
      .number = grant.number,
      .estopped = grant.estopped,
      .estop_source = grant.estop_source,
      .waits_for_hand_back = grant.waits_for_hand_back,
      .stop = grant.stop,
      .stop_source = grant.stop_source};
  const auto refusal = [](const authority::Refusal& one) {
    return v1::Refusal{.role = kRoles.theirs(one.role), .source = one.source, .reason = one.reason};
  };
  out.refused = converted(refused, refusal, kMostRefusals);
  return out;
}

std::string trouble(const v1::MotorCommand& command) {
  if (std::string wrong = trouble(to_motion(command), command.contact_speed); !wrong.empty())
    return wrong;
  if (command.translation > v1::TRANSLATION_POSITION)
    return "unknown translation mode";
  if (command.rotation > v1::ROTATION_RELATIVE_HEADING)
    return "unknown rotation mode";
  return {};
}

reflector::Motion to_motion(const v1::MotorCommand& command) {
  reflector::Motion out;
  out.translation = kTranslations.ours(command.translation, reflector::Translation::none);
  out.rotation = kRotations.ours(command.rotation, reflector::Rotation::none);
  out.velocity = command.velocity;
  out.distance = command.distance;
  out.move = command.move;
  out.rotation_velocity = command.rotation_velocity;
  out.heading = command.heading;
  return out;
}

DriveCommand to_drive(const v1::MotorCommand& command, authority::Role role,
                      const authority::WriterId& writer) {
  DriveCommand out{{}, to_motion(command), command.contact_speed, {}, trouble(command)};
  out.command.role = role;
  out.command.writer = writer;
  // Anybody may write any text, or none.
  out.command.source =
      command.source.empty() ? "a program without a name" : command.source.substr(0, 255);
  out.command.epoch = command.stamp.epoch;
  out.command.cycle = command.stamp.cycle;
  out.command.number = command.number;
  out.command.active = command.active;
  out.command.hand_back = command.hand_back;
  out.command.heeds = command.heeds;
  for (const v1::Edge& edge : command.edges)
    out.edges.push_back({{edge.x1, edge.y1}, {edge.x2, edge.y2}});
  return out;
}

v1::Devices to_bus(const std::vector<reflector::DeviceRequest>& requests,
                   const reflector::Devices::Reports& reports,
                   const protocol::Information& information, const v1::Stamp& stamp) {
  v1::Devices out{.stamp = stamp};
  const auto asked = [&](const reflector::DeviceRequest& request) {
    v1::DeviceRequest result{.source = request.source,
                             .asked = request.asked,
                             .answer = saphira::to_bus(request.answer)};
    result.answer.asker = request.asker;
    result.answer.number = request.number;
    result.answer.service = "bridge";
    result.answer.stamp = stamp;
    result.sent = request.sent;
    return result;
  };
  out.requests = converted(requests, asked, kMostRequests);
  out.front_bumpers = information.front_bumpers;
  out.rear_bumpers = information.rear_bumpers;
  out.has_flags = information.motors_on.has_value();
  out.motors_on = information.motors_on.value_or(false);
  out.emergency_stop = information.emergency_stop.value_or(false);
  out.faults = information.faults.value_or(0);
  out.charging = information.charge_state.value_or(0);
  out.has_compass = information.compass.has_value();
  out.compass = information.compass.value_or(0.0);
  out.has_charge = information.state_of_charge.has_value();
  out.charge = information.state_of_charge.value_or(0.0);
  out.has_temperature = information.temperature.has_value();
  out.temperature = information.temperature.value_or(0.0);
  out.gripper_state = information.gripper_bits;
  if (const auto& configuration = reports.configuration) {
    out.has_configuration = true;
    out.serial_number = configuration->serial;
    out.firmware = configuration->firmware;
    out.information_period = configuration->cycle;
    out.watchdog = configuration->watchdog;
  }
  if (const auto& encoders = reports.encoders) {
    out.has_encoders = true;
    out.left_encoder = encoders->left;
    out.right_encoder = encoders->right;
  }
  if (const auto& io = reports.io) {
    out.has_io = true;
    out.digital_inputs = first(io->digital_inputs, 16);
    out.digital_outputs = first(io->digital_outputs, 16);
    out.analog_inputs = first(io->analogs, 32);
  }
  if (const auto& gripper = reports.gripper) {
    out.has_gripper = true;
    out.gripper_kind = gripper->kind;
    out.gripper_state = gripper->state;
    out.grasp_time = gripper->grasp_time;
  }
  const auto packets = [](const auto& unread) {
    return v1::PacketCount{.type = unread.first, .count = unread.second};
  };
  out.unread_packets = converted(reports.unread, packets, kMostCounts);
  return out;
}

}  // namespace saphira::bridge

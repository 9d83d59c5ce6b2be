#include "convert.hpp"

#include <algorithm>
#include <limits>

#include "enums.hpp"
#include "geometry/shell/convert.hpp"
#include "requests/shell/convert.hpp"

namespace saphira::bridge {

namespace {

// The bounds of the sequences.
constexpr std::size_t kMostSonars = 64;
constexpr std::size_t kMostRefusals = 16;
constexpr std::size_t kMostRequests = 64;
constexpr std::size_t kMostCounts = 64;

template <class T>
T short_of(unsigned value) {
  return static_cast<T>(std::min<unsigned>(value, std::numeric_limits<T>::max()));
}

v1::SonarReading reading_of(const protocol::Sonar& sonar) {
  return {.sonar = sonar.number, .range = static_cast<float>(sonar.range), .echo = sonar.echo};
}

}  // namespace

v1::RobotState to_bus(const reflector::State& state, const v1::Stamp& stamp,
                      std::uint64_t bad_packets) {
  const protocol::Information& in = state.information;
  auto out = translated<v1::RobotState>(in);
  take(out, state);
  out.stamp = stamp;
  out.status = kMotors.theirs(in.motors);
  out.sonars = converted(in.sonars, reading_of, kMostSonars);
  out.motor_packets_per_s = short_of<std::uint16_t>(state.motor_packets_per_s);
  out.sonar_readings_per_s = short_of<std::uint16_t>(state.sonar_readings_per_s);
  out.vision_packets_per_s = 0;  // Shell counts them
  out.bad_packets = static_cast<std::uint32_t>(bad_packets);
  return out;
}

v1::SonarBuckets to_bus(const std::vector<reflector::Bucket>& buckets, std::uint64_t odom,
                        const v1::Stamp& stamp) {
  v1::SonarBuckets out{.stamp = stamp, .odom = odom};
  const auto each = [](const reflector::Bucket& bucket) {
    auto one = translated<v1::SonarBucket>(bucket);
    one.reading = reading_of(bucket.reading);
    one.x = bucket.point.x();
    one.y = bucket.point.y();
    return one;
  };
  out.buckets = converted(buckets, each, kMostSonars);
  return out;
}

v1::VisionChannels to_bus(const protocol::VisionPacket& packet) {
  return translated<v1::VisionChannels>(packet);
}

v1::RobotDescription to_bus(const protocol::RobotParameters& p,
                            const protocol::RobotIdentity& identity, const v1::Stamp& stamp,
                            const std::string& link, bool lockstep) {
  auto out = translated<v1::RobotDescription>(p);
  take(out, identity);
  out.stamp = stamp;
  out.robot_subclass = identity.subclass;
  out.parameter_file = p.file;
  out.link = link;
  out.lockstep = lockstep;
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
  auto out = translated<v1::Grant>(grant);
  out.stamp = stamp;
  take(out.guard, guarded.action);
  out.guard_reason = guarded.reason;
  out.asked_velocity = told.setpoints.velocity;
  out.velocity = guarded.velocity;
  out.rotation = told.setpoints.turn_to_heading ? v1::ROTATION_HEADING : v1::ROTATION_VELOCITY;
  out.rotation_velocity = guarded.rotation_velocity;
  out.heading = told.setpoints.heading_in_odom;
  out.distance_left = told.distance_left;
  take(out.refused, refused);
  shorten(out.refused, kMostRefusals);
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
  return translated<reflector::Motion>(command);
}

DriveCommand to_drive(const v1::MotorCommand& command, authority::Role role,
                      const authority::WriterId& writer) {
  DriveCommand out{translated<authority::Command>(command),
                   to_motion(command),
                   command.contact_speed,
                   {},
                   trouble(command)};
  out.command.role = role;
  out.command.writer = writer;
  // Anybody may write any text, or none.
  out.command.source =
      command.source.empty() ? "a program without a name" : command.source.substr(0, 255);
  out.command.epoch = command.stamp.epoch;
  out.command.cycle = command.stamp.cycle;
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
    out.digital_inputs = io->digital_inputs;
    out.digital_outputs = io->digital_outputs;
    out.analog_inputs = io->analogs;
    shorten(out.digital_inputs, 16);
    shorten(out.digital_outputs, 16);
    shorten(out.analog_inputs, 32);
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

#include "saphira/reflector/reflector.hpp"

#include <algorithm>
#include <cmath>

namespace saphira::reflector {

namespace {

constexpr double kCountTick = 1e-6;
// A position ends more gently than a server's stop: the server's own way of braking is not known
// exactly, and passengers like it.
constexpr double kGentle = 0.5;   // [m/s2]
constexpr double kBraking = 0.5;  // [s] and the line's delay

}  // namespace

void Reflector::configure(const protocol::RobotParameters& parameters) {
  parameters_ = parameters;
  // As set in the session (Devices::begin).
  parameters_.deceleration = std::max(parameters.deceleration, parameters.stop_deceleration);
  parameters_.rotation_deceleration =
      std::max(parameters.rotation_deceleration, parameters.stop_rotation_deceleration);
  odometry_.configure({.distance_unit = parameters.distance_unit,
                       .max_velocity = parameters.max_velocity,
                       .max_rotation_velocity = parameters.max_rotation_velocity});
  motion_.configure({parameters.max_velocity, parameters.max_rotation_velocity,
                     std::min(kGentle, parameters.deceleration)});
}

bool Reflector::recognize(const protocol::InformationPacket& packet) {
  if (!parameters_.protocol_is_assumed || !packet.trailing.battery)
    return false;
  parameters_.protocol = protocol::Protocol::kArcos;
  parameters_.protocol_is_assumed = false;
  return true;
}

Slack Reflector::slack() const {
  const double time = parameters_.watchdog + kBraking;
  return {std::abs(state_.information.velocity) * time,
          std::abs(state_.information.rotation_velocity) * time};
}

void Reflector::open(double now, std::optional<OdometryMemory> memory, std::uint64_t fresh,
                     const Slack& slack) {
  state_ = {};
  odometry_.connect(memory, fresh, slack);
  motion_.stop();
  channels_.connect();
  devices_.connect();
  devices_.begin(parameters_);
  last_packet_ = now;
  last_sent_ = now;
  packet_times_.clear();
  sonar_times_.clear();
}

const State& Reflector::packet(const protocol::InformationPacket& packet, double now,
                               std::uint64_t fresh) {
  state_.information = protocol::interpret(packet, parameters_);
  const RawPose raw{packet.x, packet.y, state_.information.th};
  // Since the command to begin at the origin the robot has moved for at most one cycle.
  const double unit = parameters_.distance_unit;
  const bool origin = std::abs(protocol::position_difference(0, packet.x)) * unit < 0.1 &&
                      std::abs(protocol::position_difference(0, packet.y)) * unit < 0.1 &&
                      std::abs(raw.th) < 0.2;
  const bool began = odometry_.update(raw, now - last_packet_, fresh);
  if (began) {
    motion_.stop();  // headings and ways were in the old frame
    state_.buckets.clear();
  } else {
    motion_.moved(odometry_.advance());
  }
  devices_.reflect(packet, state_.information, origin);
  last_packet_ = now;

  ++state_.cycle;
  state_.odom = odometry_.odom();
  state_.pose_in_odom = odometry_.pose_in_odom();
  fill_buckets();
  state_.target_velocity = channels_.sent_velocity();
  state_.target_heading_in_odom = norm2_angle(state_.information.control + odometry_.rotation());
  channels_.cycle({state_.information.velocity, state_.information.rotation_velocity,
                   state_.information.control});

  packet_times_.push_back(now);
  sonar_times_.emplace_back(now, packet.sonars.size());
  while (packet_times_.front() <= now - 1.0 + kCountTick)
    packet_times_.pop_front();
  while (sonar_times_.front().first <= now - 1.0 + kCountTick)
    sonar_times_.pop_front();
  state_.motor_packets_per_s = static_cast<unsigned>(packet_times_.size());
  state_.sonar_readings_per_s = 0;
  for (const auto& [time, count] : sonar_times_)
    state_.sonar_readings_per_s += static_cast<unsigned>(count);
  return state_;
}

void Reflector::fill_buckets() {
  for (const protocol::Sonar& sonar : state_.information.sonars)
    for (const protocol::SonarUnit& unit : parameters_.sonars)
      if (unit.number == sonar.number) {
        const auto place = std::lower_bound(
            state_.buckets.begin(), state_.buckets.end(), sonar.number,
            [](const Bucket& bucket, int number) { return bucket.reading.number < number; });
        const Vec2 point =
            unit.pose_in_robot.position() + sonar.range * unit.pose_in_robot.direction();
        const Bucket bucket{sonar, state_.cycle, state_.pose_in_odom, point};
        if (place != state_.buckets.end() && place->reading.number == sonar.number)
          *place = bucket;
        else
          state_.buckets.insert(place, bucket);
      }
}

void Reflector::emergency_stop() {
  motion_.stop();
  channels_.want({}, odometry_.rotation());
  channels_.brake(protocol::has_emergency_stop(parameters_));
}

void Reflector::hold(const Setpoints& setpoints) {
  channels_.brake(false);
  channels_.want(setpoints, odometry_.rotation());
}

std::vector<protocol::Command> Reflector::due(double now, std::size_t room) {
  std::vector<protocol::Command> out;
  for (const Order& order : channels_.due(now))
    out.push_back(to_command(order));
  for (protocol::Command& command : devices_.due(now, room))
    out.push_back(std::move(command));
  if (out.empty() && now - last_sent_ >= Channels::kRepeat - kCountTick)
    out.emplace_back(protocol::Pulse{});
  if (!out.empty())
    last_sent_ = now;
  return out;
}

}  // namespace saphira::reflector

#include "saphira/protocol/impossible.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "saphira/base/cycle.hpp"
#include "saphira/base/format.hpp"

namespace saphira::protocol {

namespace {

// A robot that is pushed, or runs downhill, exceeds its own speed.
constexpr double kFaster = 2.0;
constexpr double kPush = 1.0;               // [m/s]
constexpr double kSpin = kPi;               // [rad/s]
constexpr double kTurn = 2.0 * kPi * 1.05;  // no server counts headings beyond a full turn
constexpr int kHighestVoltage = 600;        // [0.1 V] of any robot's battery
constexpr int kColdest = -40;               // [deg C] of a controller that works
constexpr int kUnknownTemperature = -127;   // and below
constexpr int kAnalogs = 1023;              // ten bits
constexpr int kGripperKinds = 2;
constexpr int kFarthestPixel = 540;  // three a degree: half a turn to each side

std::string number(double value) {
  return format("%.3g", value);
}

std::string wrong_speed(double speed, const RobotParameters& p) {
  if (std::abs(speed) <= kFaster * p.max_velocity + kPush)
    return {};
  return "a speed of " + number(speed) + " m/s; " + p.file + " allows " + number(p.max_velocity);
}

std::string wrong_turn(double rotation, const RobotParameters& p) {
  if (std::abs(rotation) <= kFaster * p.max_rotation_velocity + kSpin)
    return {};
  return "a turn of " + number(rotation) + " rad/s; " + p.file + " allows " +
         number(p.max_rotation_velocity);
}

/// The most readings in one packet: each sonar once, or, with few sonars that fire over and over,
/// the firings of the arrays in a cycle.
std::size_t most_readings(const RobotParameters& p) {
  const auto firings = static_cast<std::size_t>(kCycle / p.sonar_period + 2.0);
  return std::max(p.sonars.size(), firings * static_cast<std::size_t>(p.sonar_arrays));
}

std::string impossible_motion(const InformationPacket& packet, const RobotParameters& p) {
  const double left = packet.left_velocity * p.velocity_unit;
  const double right = packet.right_velocity * p.velocity_unit;
  if (std::string what = wrong_speed((left + right) / 2.0, p); !what.empty())
    return what;
  if (std::string what = wrong_turn((right - left) / 2.0 * p.rotation_per_difference, p);
      !what.empty())
    return what;
  if (std::abs(packet.th * p.angle_unit) > kTurn)
    return "a heading of " + number(packet.th * p.angle_unit) + " rad, more than a whole turn";
  return {};
}

std::string take_out_readings(InformationPacket& packet, const RobotParameters& p) {
  const auto is_unknown = [&p](const RawSonar& reading) {
    return std::ranges::none_of(
        p.sonars, [&reading](const SonarUnit& unit) { return unit.number == reading.number; });
  };
  const auto first = std::ranges::find_if(packet.sonars, is_unknown);
  if (first == packet.sonars.end())
    return {};
  std::string what = "sonar number " + std::to_string(first->number) + "; its table has " +
                     std::to_string(p.sonars.size()) + " (" + p.file + ")";
  std::erase_if(packet.sonars, is_unknown);
  return what;
}

std::string take_out_servo(InformationPacket& packet, const RobotParameters& p) {
  if (p.protocol == Protocol::kArcos || packet.ptu == 0 ||
      (packet.ptu >= kShortestPulse && packet.ptu <= kLongestPulse))
    return {};
  const std::string what = "a servo at " + std::to_string(packet.ptu) + " us";
  packet.ptu = 0;
  // Servers since P2OS may have flags there.
  return p.protocol == Protocol::kPsos ? what : "";
}

std::string take_out_trailing(TrailingFields& more, const RobotParameters& p) {
  std::string what;
  if (p.protocol != Protocol::kArcos)
    return what;
  // The layout behind an impossible field is in doubt.
  const auto keep = [&what](auto& field, const auto& wrong_with) {
    if (what.empty() && field)
      what = wrong_with(*field);
    if (!what.empty())
      field.reset();
  };
  const auto anything = [](auto) { return std::string(); };
  keep(more.battery, [](int tenths) {
    return tenths > kHighestVoltage ? "a battery of " + number(tenths / 10.0) + " V" : "";
  });
  keep(more.charge_state, anything);
  keep(more.rotation, [&p](int tenths) { return wrong_turn(radians(tenths / 10.0), p); });
  keep(more.faults, anything);
  keep(more.lateral, [&p](int millimetres) { return wrong_speed(millimetres / 1000.0, p); });
  keep(more.temperature, [](int degrees) {
    return degrees > kUnknownTemperature && degrees < kColdest
               ? "a controller of " + std::to_string(degrees) + " degrees"
               : "";
  });
  keep(more.state_of_charge, [](int percent) {
    return percent > 100 ? "a battery charged to " + std::to_string(percent) + " %" : "";
  });
  keep(more.time, anything);
  keep(more.flags3, anything);
  return what;
}

Impossible whole(const std::string& what) {
  return {"the robot sends " + what, true};
}

struct Look {
  const RobotParameters& parameters;

  std::optional<Impossible> operator()(InformationPacket& packet) const {
    if (packet.sonars.size() > most_readings(parameters))
      return whole(std::to_string(packet.sonars.size()) +
                   " sonar readings in a packet; its table has " +
                   std::to_string(parameters.sonars.size()) + " (" + parameters.file + ")");
    if (const std::string what = impossible_motion(packet, parameters); !what.empty())
      return whole(what);
    std::string all;
    for (const std::string& what :
         {take_out_readings(packet, parameters), take_out_servo(packet, parameters),
          take_out_trailing(packet.trailing, parameters)})
      if (all.empty())
        all = what;
    return all.empty() ? std::nullopt : std::optional(Impossible{"the robot sends " + all, false});
  }

  std::optional<Impossible> operator()(const OtherPacket& packet) const {
    const std::string_view name = packet_type_name(packet.type);
    if (is_information(packet.type))
      return whole("an information packet that ends within its sonar readings");
    if (is_read(static_cast<PacketType>(packet.type)))
      return whole("a packet " + std::string(name) + " that ends within its fields");
    return std::nullopt;
  }

  std::optional<Impossible> operator()(const IoPacket& packet) const {
    for (const std::uint16_t analog : packet.analogs)
      if (analog > kAnalogs)
        return whole("an analog input of " + std::to_string(analog) + "; ten bits have 1023");
    return std::nullopt;
  }

  std::optional<Impossible> operator()(const GripperPacket& packet) const {
    if (packet.kind > kGripperKinds)
      return whole("a gripper of kind " + std::to_string(packet.kind) + "; there are 0 to 2");
    return std::nullopt;
  }

  std::optional<Impossible> operator()(const VisionPacket& packet) const {
    for (const VisionChannel& channel : packet.channels)
      for (const int at : {channel.x, channel.y})
        if (std::abs(at) > kFarthestPixel)
          return whole("a blob " + std::to_string(at) + " pixels off the middle of its picture");
    return std::nullopt;
  }

  // Every value of their fields is possible.
  template <class T>
  std::optional<Impossible> operator()(const T&) const {
    return std::nullopt;
  }
};

}  // namespace

std::optional<Impossible> take_out_impossible(ServerPacket& packet,
                                              const RobotParameters& parameters) {
  return std::visit(Look{parameters}, packet);
}

}  // namespace saphira::protocol

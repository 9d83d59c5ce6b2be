#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "saphira/bridge/core.hpp"
#include "saphira/protocol/command.hpp"

namespace saphira::bridge::test {

/// A core with a robot that answers SYNC, a clock, and drivers. All outputs of the core are kept in
/// `said`, in order.
struct Scene {
  explicit Scene(CoreSettings settings = {}) : core(settings) {
    robot.protocol = protocol::Protocol::kP2os;
    robot.file = "p3dx.p";
    // The first one looks straight ahead.
    for (const double bearing : {0.0, 45.0, 30.0, 15.0, -15.0, -30.0, -45.0, 180.0}) {
      const auto unit = static_cast<std::uint8_t>(robot.sonars.size());
      robot.sonars.push_back({unit, {0.15, 0.0, radians(bearing)}});
      shown.sonars.push_back({unit, 28835});  // no echo
    }
    shown.motors = protocol::Motors::kMoving;
    shown.x = 1000;
  }

  // ---- The shell's part.

  void deliver() {
    for (std::vector<Output> outputs = core.take(); !outputs.empty(); outputs = core.take()) {
      for (Output& output : outputs) {
        if (auto* const send = std::get_if<Send>(&output))
          hear(send->bytes);
        const bool identified = std::holds_alternative<Identified>(output);
        if (std::holds_alternative<CloseLink>(output))
          around.link_open = false;
        said.push_back(std::move(output));
        if (identified && has_parameters)
          core.open(robot, 1000, now);
        else if (identified)
          core.refuse_robot("no parameter file for it", now);
      }
    }
  }
  /// Time passes, and the loop goes round.
  void pass(double seconds) {
    now += seconds;
    core.loop(now);
    deliver();
    if (around.link_open && !to_bridge.empty()) {
      core.received(std::exchange(to_bridge, {}), now);
      do
        deliver();
      while (core.work(now));
    }
    core.tick(now, around);
    do
      deliver();
    while (core.work(now));
  }
  void pass_slowly(double seconds) {
    for (double left = seconds; left > 1e-9; left -= 0.05)
      pass(std::min(left, 0.05));
  }
  void answer() {
    core.answer(now);
    deliver();
    core.step(now);
    deliver();
  }
  void connect() {
    around.link_open = true;
    for (int i = 0; i < 6; ++i)
      pass(0.01);
  }

  // ---- The robot.

  void hear(const protocol::Bytes& bytes) {
    protocol::PacketParser parser;
    parser.feed(bytes);
    while (const auto body = parser.next()) {
      const auto sync = protocol::sync_number(*body);
      if (!core.in_session() && sync && !mute)
        say(*sync == 2 ? protocol::encode_sync2_reply({"r", "Pioneer", "p3dx"})
                       : protocol::encode_sync(*sync));
      sent.push_back(protocol::decode_command(*body));
    }
  }
  void say(const protocol::Bytes& bytes) {
    to_bridge.insert(to_bridge.end(), bytes.begin(), bytes.end());
  }
  /// The next information packet comes.
  void cycle() {
    say(protocol::encode(shown));
    pass(0.1);
  }

  // ---- The drivers.

  DriveCommand wish(authority::Role role, double velocity) {
    DriveCommand in;
    in.command.role = role;
    in.command.source = authority::name(role);
    in.command.epoch = core.stamp().epoch;
    in.command.cycle = core.stamp().cycle;
    in.command.number = ++number;
    in.command.active = true;
    in.motion.translation = reflector::Translation::velocity;
    in.motion.rotation = reflector::Rotation::velocity;
    in.motion.velocity = in.motion.rotation_velocity = velocity;
    return in;
  }
  void tell(const DriveCommand& command) {
    core.command(command, now);
    answer();
  }
  void drive(authority::Role role, double velocity = 0.1) { tell(wish(role, velocity)); }
  /// Cycles with a driver that answers each.
  void cycles(int count, authority::Role role, double velocity = 0.1) {
    for (int i = 0; i < count; ++i) {
      cycle();
      drive(role, velocity);
    }
  }

  // ---- The outputs.

  template <class What>
  std::vector<What> all() const {
    std::vector<What> found;
    for (const Output& output : said)
      if (const auto* const what = std::get_if<What>(&output))
        found.push_back(*what);
    return found;
  }
  template <class What>
  bool has() const {
    return !all<What>().empty();
  }
  bool noted(const std::string& part) const {
    const std::vector<Note> notes = all<Note>();
    return std::any_of(notes.begin(), notes.end(),
                       [&](const Note& note) { return note.text.find(part) != std::string::npos; });
  }
  int times_sent(const protocol::Command& command) const {
    return static_cast<int>(std::count(sent.begin(), sent.end(), command));
  }
  bool was_sent(const protocol::Command& command) const {
    return std::find(sent.begin(), sent.end(), command) != sent.end();
  }
  bool was_stopped() const {
    return was_sent(protocol::Velocity{0.0}) && was_sent(protocol::RotationVelocity{0.0});
  }
  bool was_moved() const {
    return std::any_of(sent.begin(), sent.end(), [](const protocol::Command& command) {
      const auto* const velocity = std::get_if<protocol::Velocity>(&command);
      return velocity != nullptr && velocity->value != 0.0;
    });
  }
  Condition condition() const {
    const std::vector<StatusReport> reports = all<StatusReport>();
    return reports.empty() ? Condition{} : reports.back().condition;
  }
  /// Forgets all outputs and sent packets.
  void forget() {
    said.clear();
    sent.clear();
  }

  Core core;
  protocol::RobotParameters robot;
  bool has_parameters = true;
  bool mute = false;  ///< the robot does not answer
  Surroundings around;
  double now = 100.0;
  std::uint64_t number = 0;
  protocol::InformationPacket shown;  ///< the next packet
  protocol::Bytes to_bridge;
  std::vector<Output> said;
  std::vector<protocol::Command> sent;
};

/// A scene with a robot that has been driven for a while.
struct Driven : Scene {
  explicit Driven(authority::Role role = authority::Role::behaviors) {
    connect();
    cycles(12, role);
    forget();
  }
};

}  // namespace saphira::bridge::test

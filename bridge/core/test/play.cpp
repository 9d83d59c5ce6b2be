#include "play.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "rules.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/fnv1a.hpp"

namespace saphira::bridge::test {

namespace {

using authority::Role;

/// The next events, byte by byte; zeros at the end.
class Script {
 public:
  explicit Script(protocol::ByteView bytes) : bytes_(bytes) {}
  bool over() const { return at_ >= bytes_.size(); }
  unsigned byte() { return over() ? 0U : bytes_[at_++]; }
  unsigned choice(unsigned count) { return byte() % count; }
  bool flag() { return (byte() & 1U) != 0; }
  protocol::ByteView rest(std::size_t most) {
    const std::size_t count = std::min(most, bytes_.size() - at_);
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }

 private:
  protocol::ByteView bytes_;
  std::size_t at_ = 0;
};

protocol::RobotParameters parameters_of(unsigned kind) {
  protocol::RobotParameters robot{.protocol = static_cast<protocol::Protocol>(kind % 3),
                                  .sonar_arrays = 1};
  for (std::uint8_t i = 0; i < 8; ++i)
    robot.sonars.push_back({i, {0.15, 0.0, radians(45.0 * i)}});
  return robot;
}

CoreSettings settings_of(unsigned bits) {
  CoreSettings settings;
  settings.lockstep = (bits & 1U) != 0 && (bits & 2U) != 0;  // one play in four
  settings.free_step = (bits & 4U) != 0;
  settings.guard = (bits & 8U) == 0;
  settings.contact_speed = (bits & 16U) != 0 ? 0.15 : 0.0;
  if ((bits & 32U) != 0)
    settings.quiet = 0.4;
  return settings;
}

class Player {
 public:
  Player(protocol::ByteView bytes, unsigned restores_every)
      : script_(bytes),
        restores_every_(restores_every),
        settings_(settings_of(script_.byte())),
        robot_(parameters_of(script_.byte())),
        serial_(script_.flag()),
        core_(settings_),
        rules_(settings_, played_) {}

  Played go() {
    pass(0.02);
    for (unsigned events = 1; !script_.over() && played_.wrong.empty(); ++events) {
      event();
      if (restores_every_ > 0 && events % restores_every_ == 0) {
        Core anew(settings_);
        restore(saved(core_), anew);
        core_ = std::move(anew);
      }
    }
    core_.end(now_);
    deliver();
    rules_.settled(core_);
    played_.sent = sent_.value();
    return played_;
  }

 private:
  void event();
  void pass(double seconds);
  void deliver();
  void work();
  void hear(const protocol::Bytes& sent);
  void identified();

  void cycle();
  void information(bool strange);
  void drive(Role role, bool strange);
  void tell(const DriveCommand& command);
  void answer();
  void packet();
  void ask_devices();

  Script script_;
  unsigned restores_every_;
  Fnv1a sent_;
  Played played_;
  CoreSettings settings_;
  protocol::RobotParameters robot_;
  bool serial_;
  Core core_;
  Rules rules_;

  double now_ = 100.0;
  double last_loop_ = 100.0;
  bool link_open_ = true;
  bool namesake_ = false;
  bool refuse_ = false;  // the next robot has no parameter file
  std::uint64_t number_ = 0;
  protocol::Bytes to_bridge_;
  protocol::InformationPacket shown_;
};

/// The robot's server: it answers SYNC, and moves as commanded.
void Player::hear(const protocol::Bytes& sent) {
  protocol::PacketParser parser;
  parser.feed(sent);
  while (const auto body = parser.next()) {
    if (!core_.in_session()) {
      if (const auto sync = protocol::sync_number(*body)) {
        const protocol::Bytes answer = *sync == 2
                                           ? protocol::encode_sync2_reply({"name", "class", "sub"})
                                           : protocol::encode_sync(*sync);
        to_bridge_.insert(to_bridge_.end(), answer.begin(), answer.end());
      }
      continue;
    }
    const protocol::Command command = protocol::decode_command(*body);
    if (const auto* const velocity = std::get_if<protocol::Velocity>(&command))
      shown_.left_velocity = shown_.right_velocity =
          static_cast<std::int16_t>(std::lround(velocity->value / robot_.velocity_unit));
  }
}

void Player::identified() {
  if (std::exchange(refuse_, false))
    return core_.refuse_robot("no parameter file", now_);
  answer();
  core_.open(robot_, 1000, now_);
}

void Player::deliver() {
  for (std::vector<Output> outputs = core_.take(); !outputs.empty(); outputs = core_.take()) {
    for (const Output& output : outputs) {
      rules_.output(output);
      if (const auto* const send = std::get_if<Send>(&output)) {
        for (const std::uint8_t byte : send->bytes)
          sent_.add(byte);
        hear(send->bytes);
      }
      if (std::holds_alternative<Identified>(output))
        identified();
      else if (std::holds_alternative<Answered>(output))
        core_.answered(now_);
      else if (std::holds_alternative<CloseLink>(output))
        link_open_ = false;
    }
  }
  rules_.settled(core_);
}

void Player::work() {
  deliver();
  while (core_.work(now_))
    deliver();
}

/// The shell's loop, once.
void Player::pass(double seconds) {
  now_ += seconds;
  rules_.at(now_);
  if (now_ - last_loop_ > 0.25)
    rules_.gap();
  last_loop_ = now_;
  core_.loop(now_);
  deliver();
  if (link_open_ && !to_bridge_.empty()) {
    core_.received(std::exchange(to_bridge_, {}), now_);
    work();
  }
  if (link_open_)
    rules_.tick();
  else if (core_.may_connect(now_))
    link_open_ = true;
  Surroundings around{.link_open = link_open_, .serial = serial_};
  if (namesake_)
    around.namesake = "another";
  core_.tick(now_, around);
  work();
  rules_.answered(core_);
}

void Player::answer() {
  core_.answer(now_);
  deliver();
  core_.step(now_);
  deliver();
}

void Player::tell(const DriveCommand& command) {
  rules_.command(command);
  core_.command(command, now_);
  answer();
  rules_.answered(core_);
}

/// A command of a correct program, unless `strange`.
void Player::drive(Role role, bool strange) {
  constexpr std::array speeds{0.0, 0.1, 0.3, -0.2, 1.5, 1e5};
  const unsigned what = script_.byte();
  DriveCommand in;
  in.command.role = role;
  in.command.writer[0] = static_cast<std::uint8_t>(strange ? what & 3U : 0U);
  in.command.source = "program";
  in.command.epoch = core_.stamp().epoch;
  in.command.cycle = core_.stamp().cycle;
  in.command.number = ++number_;
  in.command.active = !strange || (what & 4U) == 0;
  in.command.hand_back = strange && (what & 8U) != 0;
  if ((what & 16U) != 0)
    in.command.heeds = core_.grant().stop;
  in.motion.translation = static_cast<reflector::Translation>(script_.choice(3));
  in.motion.rotation = static_cast<reflector::Rotation>(script_.choice(4));
  const std::size_t usual = strange ? speeds.size() : speeds.size() - 1;
  in.motion.velocity = speeds[script_.byte() % usual];
  in.motion.heading = in.motion.rotation_velocity = in.motion.distance =
      speeds[script_.byte() % usual];
  in.motion.move = number_ / 8;
  if (strange) {
    const unsigned odd = script_.byte();
    if (odd % 5 == 0)
      in.motion.velocity = std::numeric_limits<double>::quiet_NaN();
    if (odd % 5 == 1)
      in.contact_speed = 0.1;
    if (odd % 7 == 0)
      in.command.epoch -= odd;
    if (odd % 7 == 1)
      in.command.epoch = in.command.cycle = 0;
    if (odd % 7 == 2)
      in.command.cycle -= std::min<std::uint64_t>(in.command.cycle, odd);
    if (odd % 7 == 3)
      ++in.command.cycle;
    if (odd % 11 == 0)
      in.command.number -= std::min<std::uint64_t>(in.command.number, odd);
    if (odd % 11 == 1)
      in.wrong = "an unknown mode";
  }
  tell(in);
}

void Player::information(bool strange) {
  protocol::InformationPacket packet = shown_;
  packet.motors = protocol::Motors::kMoving;
  const unsigned what = script_.byte();
  // 4 counts are 0.2 mm.
  shown_.x = static_cast<std::uint16_t>((shown_.x + 4 * (what & 15U)) & 0x7FFFU);
  if ((what & 16U) != 0)
    packet.sonars.push_back(
        {static_cast<std::uint8_t>(what & 7U), static_cast<std::uint16_t>(64U * script_.byte())});
  packet.sonars.push_back({static_cast<std::uint8_t>((what >> 5U) & 7U), 28835});  // no echo
  packet.x = shown_.x;
  if (strange) {
    packet.motors = static_cast<protocol::Motors>(1 + script_.choice(3));
    packet.x = static_cast<std::uint16_t>(128U * script_.byte());
    packet.th = static_cast<std::int16_t>(16U * script_.byte());
    packet.left_velocity = static_cast<std::int16_t>(8U * script_.byte());
    packet.ptu = static_cast<std::uint16_t>(script_.byte());
    packet.right_stall = static_cast<std::uint8_t>(script_.byte());
  }
  const protocol::Bytes bytes = protocol::encode(packet);
  to_bridge_.insert(to_bridge_.end(), bytes.begin(), bytes.end());
}

/// The most frequent events.
void Player::cycle() {
  information(false);
  pass(0.1);
  drive(Role::behaviors, false);
}

/// A packet of any kind.
void Player::packet() {
  const protocol::ByteView body = script_.rest(1 + script_.choice(40));
  if (body.empty())
    return;
  const protocol::Bytes bytes = protocol::frame(body);
  to_bridge_.insert(to_bridge_.end(), bytes.begin(), bytes.end());
}

void Player::ask_devices() {
  const unsigned value = script_.byte();
  const std::array<const char*, 4> actions{"open", "lift up", "halt", "number"};
  const std::array<const char*, 4> packets{"configuration", "encoders", "io", "gripper"};
  const std::array<Request, 8> requests{
      {{"servo", {number("width", 8.0 * value)}},
       {"gripper", {text("action", actions[value % 4]), number("value", value)}},
       {"sonar", {truth("on", value % 2 != 0), number("sonar", 1.0), number("sonar", value)}},
       {"tones", {number("duration", 0.02 * value), number("pitch", value)}},
       {"set_origin"},
       {"motors", {truth("on", value % 2 != 0)}},
       {"report", {text("packet", packets[value % 4]), text("often", "always")}},
       {"serial", {number("port", 1 + value % 3), text("data", "0102"), number("answer", value)}}}};
  Request request = requests[script_.choice(8)];
  request.source = "a person";
  request.number = ++number_;
  core_.request(request, now_);
}

void Player::event() {
  const unsigned what = script_.choice(32);
  switch (what) {
    case 0:
      return pass(0.001 * script_.byte());
    case 1:
      return pass(0.02 * script_.byte());
    case 2:
      return information(true);
    case 3: {
      const protocol::ByteView bytes = script_.rest(1 + script_.choice(16));
      to_bridge_.insert(to_bridge_.end(), bytes.begin(), bytes.end());
      return;
    }
    case 4:
      return packet();
    case 5:
      return drive(Role::teleop, false);
    case 6:
      return drive(Role::direct, false);
    case 7:
      return drive(authority::kRoles[script_.choice(4)], true);
    case 8:
      return drive(Role::behaviors, true);
    case 9: {  // an emergency stop, and its release
      DriveCommand in;
      in.command.role = Role::estop;
      in.command.writer[0] = static_cast<std::uint8_t>(script_.choice(2));
      in.command.source = "a person";
      in.command.active = script_.flag();
      return tell(in);
    }
    case 10:
    case 11:
      core_.request({.functor = "reset", .arguments = {}, .source = "a person"}, now_);
      rules_.released(core_.latches().estopped);
      return answer();
    case 12: {
      const Role role = authority::kRoles[script_.choice(4)];
      authority::WriterId writer{};
      writer[0] = static_cast<std::uint8_t>(script_.choice(4));
      rules_.writer_lost(role, writer);
      core_.writer_lost(role, writer, now_);
      return answer();
    }
    case 13:
      if (script_.choice(4) == 0 && link_open_) {
        link_open_ = false;
        core_.link_closed("cut", now_);
        deliver();
      }
      return;
    case 14:
      namesake_ = script_.choice(8) == 0;
      refuse_ = script_.choice(8) == 0;
      return;
    case 15:
      return ask_devices();
    case 16:
      core_.room(script_.byte());
      return;
    case 17: {  // hand-back by a person
      DriveCommand in;
      in.command.role = Role::teleop;
      in.command.source = "a person";
      in.command.epoch = core_.stamp().epoch;
      in.command.cycle = core_.stamp().cycle;
      in.command.number = ++number_;
      in.command.hand_back = true;
      return tell(in);
    }
    case 18: {
      const std::uint64_t until = core_.stamp().cycle + script_.choice(8);
      rules_.permit(until);
      core_.permit(until);
      return answer();
    }
    case 19:
      return pass(0.05);
    case 21: {
      Request request{.functor = "stop", .source = "a person"};
      request.number = ++number_;
      core_.request(request, now_);
      rules_.stopped({0, number_});
      return answer();
    }
    case 20:  // the robot is not heard
      for (unsigned passes = script_.choice(16); passes > 0; --passes)
        pass(0.1);
      return;
    default:
      return cycle();
  }
}

}  // namespace

Played play(protocol::ByteView bytes, unsigned restores_every) {
  return Player(bytes, restores_every).go();
}

}  // namespace saphira::bridge::test

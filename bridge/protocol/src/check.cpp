#include "saphira/protocol/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "saphira/base/format.hpp"

namespace saphira::protocol {

namespace {

constexpr std::string_view kWake = "WMS2\r";
constexpr double kLate = 1.0;          // [s]
constexpr double kGone = 8.0;          // [s] ARIA's patience
constexpr double kWatchdog = 2.0;      // [s] manual 5.2
constexpr int kMaxAfterClose = 1;      // information packets that may be on their way
constexpr std::size_t kSmallest = 25;  // body of an information packet without sonars
constexpr std::array<std::size_t, 10> kTrailingEnds{0, 2, 3, 5, 7, 9, 10, 11, 15, 19};

std::string hex(unsigned value) {
  return format("0x%02X", value);
}

/// A zero setpoint.
bool stops(ByteView body) {
  const Command command = decode_command(body);
  const auto* const velocity = std::get_if<Velocity>(&command);
  const auto* const rotation = std::get_if<RotationVelocity>(&command);
  return (velocity != nullptr && velocity->value == 0.0) ||
         (rotation != nullptr && rotation->value == 0.0);
}

std::string name_of(std::uint8_t number) {
  const CommandRule* found = rule(number);
  return (found != nullptr ? std::string(found->name) : std::string("command")) + " (" +
         std::to_string(number) + ")";
}

std::string type_name(std::uint8_t type) {
  const std::string_view name = packet_type_name(type);
  return (name.empty() ? std::string("packet") : std::string(name) + " packet") + " (" + hex(type) +
         ")";
}

std::size_t index(Side side) {
  return static_cast<std::size_t>(side);
}

}  // namespace

std::string to_string(const Finding& finding) {
  return std::string(finding.side == Side::kClient ? "client" : "server") + " byte " +
         std::to_string(finding.offset) + ": " +
         (finding.kind == Finding::Kind::kViolation ? "violation: " : "note: ") + finding.text;
}

Checker::Checker(FindParameters find_parameters) : find_parameters_(std::move(find_parameters)) {}

void Checker::add(Finding::Kind kind, Side side, std::string text) {
  if (kind == Finding::Kind::kViolation)
    ++violations_;
  findings_.push_back({kind, side, at_, std::move(text)});
}

void Checker::feed(Side side, ByteView bytes, std::optional<double> time) {
  time_ = time;
  Stream& stream = streams_[index(side)];
  stream.pending.insert(stream.pending.end(), bytes.begin(), bytes.end());
  cut(side);
}

void Checker::disconnect() {
  for (const Side side : {Side::kClient, Side::kServer}) {
    Stream& stream = streams_[index(side)];
    at_ = stream.offset;
    if (!stream.pending.empty())
      violation(side, "the connection ends within a packet, after " +
                          std::to_string(stream.pending.size()) + " bytes of it");
    stream.offset += stream.pending.size();
    stream.pending.clear();
  }
  close();
  closed_ = false;
}

void Checker::close() {
  state_ = State::kSync0;
  std::fill(std::begin(echoes_due_), std::end(echoes_due_), 0);
  last_.reset();
  last_packet_.reset();
  last_command_.reset();
  silent_ = false;
  asked_.clear();
  after_close_ = 0;
  closed_ = true;
}

void Checker::junk(Side side, std::size_t count) {
  Stream& stream = streams_[index(side)];
  at_ = stream.offset;
  const std::string text(stream.pending.begin(),
                         stream.pending.begin() + static_cast<std::ptrdiff_t>(count));
  // One client family sends this to wake modems before it synchronizes; servers skip it.
  if (side == Side::kClient && state_ == State::kSync0 &&
      kWake.find(text) != std::string_view::npos)
    note(side, "\"WMS2\" before the synchronization");
  else
    violation(side, std::to_string(count) + " bytes that belong to no packet, from " +
                        hex(stream.pending[0]));
  stream.pending.erase(stream.pending.begin(),
                       stream.pending.begin() + static_cast<std::ptrdiff_t>(count));
  stream.offset += count;
}

void Checker::cut(Side side) {
  Stream& stream = streams_[index(side)];
  while (!stream.pending.empty()) {
    const Bytes& p = stream.pending;
    std::size_t start = 0;
    while (start < p.size() &&
           (p[start] != kHeader0 || (start + 1 < p.size() && p[start + 1] != kHeader1)))
      ++start;
    if (start > 0) {
      junk(side, start);
      continue;
    }
    if (p.size() < 3)
      return;
    const std::size_t count = p[2];
    if (count < 3 || count > kMaxCount) {
      at_ = stream.offset;
      violation(side, "a byte count of " + std::to_string(count) + "; expected 3 to 200");
      junk(side, 2);
      continue;
    }
    if (p.size() < 3 + count)
      return;
    at_ = stream.offset;
    const Bytes body(p.begin() + 3, p.begin() + static_cast<std::ptrdiff_t>(1 + count));
    const unsigned sent = static_cast<unsigned>(p[1 + count]) << 8U | p[2 + count];
    stream.pending.erase(stream.pending.begin(),
                         stream.pending.begin() + static_cast<std::ptrdiff_t>(3 + count));
    stream.offset += 3 + count;
    if (sent != checksum(body))
      violation(side, "checksum " + hex(sent) + "; expected " + hex(checksum(body)));
    else if (side == Side::kClient)
      client_packet(body);
    else
      server_packet(body);
  }
}

// ---- The client.

void Checker::client_packet(ByteView body) {
  if (state_ == State::kOpen) {
    command(body);
    return;
  }
  const auto number = sync_number(body);
  if (state_ == State::kSynchronized && !(number && (*number == 0 || *number == 2))) {
    command(body);
    return;
  }
  if (!number) {
    // A careful client: a server that is still in a session takes SYNC0 for a PULSE.
    if (stops(body))
      note(Side::kClient, "a zero setpoint before the synchronization");
    else
      violation(Side::kClient, name_of(body[0]) + " before the synchronization");
    return;
  }
  if (*number == 2 && state_ != State::kSync2) {
    if (state_ == State::kSynchronized) {
      // SYNC2 again or CLOSE: the same bytes. Only the server's answer tells them apart.
      ++echoes_due_[2];
      return;
    }
    note(Side::kClient, "CLOSE before the synchronization");
    close();
    return;
  }
  if (body.size() != 1)
    violation(Side::kClient, "SYNC" + std::to_string(*number) + " with an argument");
  const int expected = state_ == State::kSync0 ? 0 : state_ == State::kSync1 ? 1 : 2;
  if (*number > expected)
    violation(Side::kClient, "SYNC" + std::to_string(*number) + " before the echo of SYNC" +
                                 std::to_string(*number - 1));
  closed_ = false;
  if (*number == 0)
    state_ = State::kSync0;
  ++echoes_due_[*number];
}

void Checker::command(ByteView body) {
  ++commands_[body[0]];
  if (time_ && last_command_ && *time_ - *last_command_ > kWatchdog && state_ == State::kOpen)
    note(Side::kClient, "silent for " + std::to_string(*time_ - *last_command_) +
                            " s: the robot has stopped by itself");
  last_command_ = time_;
  const CommandRule* found = rule(body[0]);
  if (found == nullptr) {
    violation(Side::kClient, "command " + std::to_string(body[0]) + " is in no table");
    return;
  }
  argument(*found, body);
  if (state_ != State::kOpen && found->number != Number::kOpen && found->number != Number::kPulse &&
      found->number != Number::kClose)
    note(Side::kClient, name_of(body[0]) + " before OPEN");
  if (parameters_ && parameters_->protocol == Protocol::kPsos && found->origin == Origin::kLater)
    note(Side::kClient, name_of(body[0]) + " to a server that does not know it");
  remember(decode_command(body));
}

void Checker::argument(const CommandRule& rule, ByteView body) {
  const std::string name = name_of(body[0]);
  const auto wrong = [&](const std::string& expected) {
    violation(Side::kClient, name + ": expected " + expected);
  };
  const std::size_t size = body.size();
  const std::uint8_t type = size > 1 ? body[1] : 0;
  switch (rule.form) {
    case ArgumentForm::kRaw:
      return;
    case ArgumentForm::kNone:
      if (size != 1)
        wrong("no argument");
      return;
    case ArgumentForm::kString: {
      if (type != 0x2B || size < 3) {
        wrong("a string (argument type 0x2B)");
        return;
      }
      const ByteView text = body.subspan(2);
      const bool terminated = std::ranges::find(text, 0) == text.end() - 1;
      const bool counted = text[0] == text.size() - 1;
      if (!terminated && !counted)
        wrong("a string that ends with NUL, or that begins with its length");
      if (rule.number == Number::kPolling) {
        const auto polling = decode_command(body);
        const auto* sonars = std::get_if<Polling>(&polling);
        if (text.size() - 1 > 12)
          wrong("at most 12 sonars");
        else if (sonars != nullptr && parameters_ && !parameters_->sonars.empty())
          for (const std::uint8_t sonar : sonars->sonars)
            if (sonar >= parameters_->sonars.size())
              violation(Side::kClient, name + ": sonar " + std::to_string(sonar) + " of " +
                                           std::to_string(parameters_->sonars.size()));
      }
      return;
    }
    case ArgumentForm::kOptional:
      // Some clients send the type without an argument.
      if (size == 1 || (size == 2 && (type == 0x3B || type == 0x1B)))
        return;
      [[fallthrough]];
    case ArgumentForm::kInteger:
    case ArgumentForm::kPair:
      break;
  }
  if (size != 4 || (type != 0x3B && type != 0x1B)) {
    wrong("an integer (argument type 0x3B or 0x1B, two bytes)");
    return;
  }
  const int magnitude = body[2] | body[3] << 8;
  if (rule.form == ArgumentForm::kPair) {
    if (type != 0x3B)
      wrong("argument type 0x3B before its two bytes");
    return;
  }
  const int value = type == 0x1B ? -magnitude : magnitude;
  if (value < rule.low || value > rule.high)
    violation(Side::kClient, name + ": " + std::to_string(value) + "; expected " +
                                 std::to_string(rule.low) + " to " + std::to_string(rule.high) +
                                 (rule.unit.empty() ? "" : " ") + std::string(rule.unit));
}

// Commands that change the packets that the server may send.
void Checker::remember(const Command& command) {
  const auto ask = [this](PacketType type, int mode) {
    Asked& asked = asked_[type];
    // A packet that was requested with each cycle may still be on its way after the end of that.
    if (asked.with_each && mode != 2)
      ++asked.once;
    asked.with_each = mode == 2;
    if (mode == 1)
      ++asked.once;
  };
  if (command == Command(Open{})) {
    state_ = State::kOpen;
  } else if (command == Command(Close{})) {
    close();
  } else if (command == Command(SetOrigin{}) || command == Command(SimReset{})) {
    last_.reset();
  } else if (const auto* integer = std::get_if<Integer>(&command)) {
    static constexpr std::pair<Number, PacketType> reports[]{
        {Number::kConfigRequest, PacketType::kConfig},
        {Number::kEncoderRequest, PacketType::kEncoder},
        {Number::kIoRequest, PacketType::kIo},
        {Number::kGripperRequest, PacketType::kGripper},
        {Number::kBatteryRequest, PacketType::kBattery},
        {Number::kJoystickRequest, PacketType::kJoystick},
        {Number::kGyroRequest, PacketType::kGyro},
        {Number::kSimStatus, PacketType::kSimStatus}};
    for (const auto& [number, report] : reports)
      if (number == integer->number)
        ask(report, number == Number::kConfigRequest ? 1
                    : number == Number::kGyroRequest ? (integer->value != 0 ? 2 : 0)
                                                     : integer->value);
  }
}

// ---- The server.

void Checker::server_packet(ByteView body) {
  if (state_ != State::kOpen && sync_answer(body))
    return;
  ++packets_[body[0]];
  if (is_information(body[0])) {
    if (state_ != State::kOpen) {
      if (closed_ && ++after_close_ <= kMaxAfterClose)
        return;
      violation(Side::kServer,
                closed_ ? "information packet after CLOSE" : "information packet before OPEN");
      return;
    }
    information(body);
    return;
  }
  device_packet(body);
}

bool Checker::sync_answer(ByteView body) {
  const auto number = sync_number(body);
  if (!number)
    return false;
  if (echoes_due_[*number] == 0) {
    violation(Side::kServer, "SYNC" + std::to_string(*number) + " that the client has not sent");
    return true;
  }
  --echoes_due_[*number];
  if (*number < 2) {
    if (body.size() != 1)
      violation(Side::kServer, "the echo of SYNC" + std::to_string(*number) +
                                   " has bytes that the client did not send");
    state_ = *number == 0 ? State::kSync1 : State::kSync2;
    return true;
  }
  state_ = State::kSynchronized;
  if (body.size() == 1) {
    note(Side::kServer, "no name, class and subclass in the answer to SYNC2 (before PSOS 4.1)");
    return true;
  }
  if (std::count(body.begin() + 1, body.end(), 0) != 3 || body.back() != 0)
    violation(Side::kServer, "the answer to SYNC2: expected three strings, each ended by NUL");
  identity_ = decode_sync2_reply(body);
  if (identity_ && find_parameters_)
    parameters_ = find_parameters_(*identity_);
  if (find_parameters_ && !parameters_)
    note(Side::kServer, "no parameter file for class \"" + identity_->robot_class +
                            "\", subclass \"" + identity_->subclass + "\"");
  return true;
}

void Checker::information(ByteView body) {
  const auto packet = decode_information(body);
  if (!packet) {
    violation(Side::kServer, "information packet that ends within its sonar readings");
    return;
  }
  const std::size_t smallest = kSmallest + 3 * packet->sonars.size();
  if (body.size() < smallest)
    violation(Side::kServer, "information packet of " + std::to_string(body.size()) +
                                 " bytes; expected at least " + std::to_string(smallest) +
                                 " with " + std::to_string(packet->sonars.size()) +
                                 " sonar readings");
  else if (packet->unknown_bytes > 0 &&
           std::ranges::find(kTrailingEnds, body.size() - smallest) == kTrailingEnds.end())
    note(Side::kServer,
         std::to_string(packet->unknown_bytes) + " bytes behind the fields that are known");
  if (body[0] == 0x31 || body[0] == 0x34)
    note(Side::kServer, type_name(body[0]) + " is not taken as an information packet by ARIA");
  for (const std::size_t at : {2U, 4U})
    if ((body[at] & 0x80U) != 0)
      violation(Side::kServer, "position of more than 15 bits");
  if (packet->battery == 0)
    violation(Side::kServer, "a battery of 0 V");
  // A busy machine may be late; after this long, clients take the robot for gone.
  if (const double pause = last_packet_ && time_ ? *time_ - *last_packet_ : 0.0; pause > kLate) {
    const std::string text =
        "no information packet for " + std::to_string(pause) + " s; expected 0.1 s";
    pause > kGone ? violation(Side::kServer, text) : note(Side::kServer, text);
  }
  last_packet_ = time_;
  if (parameters_)
    position(*packet);
  last_ = *packet;
}

// The rules that depend on the robot.
void Checker::position(const InformationPacket& packet) {
  const RobotParameters& p = *parameters_;
  for (const RawSonar& sonar : packet.sonars)
    if (sonar.number >= p.sonars.size())
      violation(Side::kServer, "reading of sonar " + std::to_string(sonar.number) + " of " +
                                   std::to_string(p.sonars.size()));
  if (std::abs(packet.th * p.angle_unit) > 2.0 * kPi + p.angle_unit)
    violation(Side::kServer, "a heading of more than a whole turn");
  // A wheel turns faster than the robot's middle moves while it rotates.
  const double fastest =
      p.max_velocity + p.max_rotation_velocity / p.rotation_per_difference + p.velocity_unit;
  for (const std::int16_t wheel : {packet.left_velocity, packet.right_velocity})
    if (std::abs(wheel * p.velocity_unit) > fastest)
      violation(Side::kServer, "a wheel of " + std::to_string(wheel * p.velocity_unit) +
                                   " m/s; the robot's file allows " + std::to_string(fastest));
  if (p.protocol == Protocol::kPsos && (packet.left_stall > 1 || packet.right_stall > 1))
    violation(Side::kServer, "stall bytes other than 0 and 1 from a PSOS server");
  if (p.protocol != Protocol::kArcos && packet.trailing.battery)
    note(Side::kServer, "trailing fields from a server before ARCOS");
  if (!last_)
    return;
  const double dx = position_difference(last_->x, packet.x) * p.distance_unit;
  const double dy = position_difference(last_->y, packet.y) * p.distance_unit;
  // Two periods, in case a packet was lost on the way.
  const double most = 1.2 * p.max_velocity * 0.2 + 2.0 * p.distance_unit + 0.02;
  if (std::hypot(dx, dy) > most)
    violation(Side::kServer, "the position jumps by " + std::to_string(std::hypot(dx, dy)) + " m");
}

void Checker::device_packet(ByteView body) {
  const auto type = static_cast<PacketType>(body[0]);
  if (packet_type_name(body[0]).empty()) {
    note(Side::kServer, type_name(body[0]) + " is in no table");
    return;
  }
  if (state_ != State::kOpen && !closed_) {
    const auto found = asked_.find(type);
    if (found == asked_.end())
      violation(Side::kServer, type_name(body[0]) + " before OPEN");
  }
  const ServerPacket packet = decode_packet(body);
  switch (type) {
    case PacketType::kConfig:
    case PacketType::kEncoder:
    case PacketType::kIo:
    case PacketType::kGripper:
    case PacketType::kGyro:
    case PacketType::kJoystick:
    case PacketType::kBattery:
    case PacketType::kSimStatus: {
      if (std::holds_alternative<OtherPacket>(packet)) {
        violation(Side::kServer, type_name(body[0]) + " that ends too early");
        return;
      }
      if (closed_)
        return;
      const auto found = asked_.find(type);
      if (type == PacketType::kSimStatus)
        break;  // also unasked for, while the simulator's time stands
      if (found == asked_.end() || (!found->second.with_each && found->second.once == 0))
        violation(Side::kServer, type_name(body[0]) + " that nobody has asked for");
      else if (!found->second.with_each)
        --found->second.once;
      break;
    }
    default:
      break;
  }
}

std::string Checker::summary() const {
  std::string out;
  if (identity_)
    out += "robot: name \"" + identity_->name + "\", class \"" + identity_->robot_class +
           "\", subclass \"" + identity_->subclass + "\"\n";
  for (const auto& [number, count] : commands_)
    out += "client: " + std::to_string(count) + " x " + name_of(number) + "\n";
  for (const auto& [type, count] : packets_)
    out += "server: " + std::to_string(count) + " x " + type_name(type) + "\n";
  out += std::to_string(violations_) + " violations, " +
         std::to_string(findings_.size() - violations_) + " notes\n";
  return out;
}

}  // namespace saphira::protocol

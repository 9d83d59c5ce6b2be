#include "saphira/reflector/devices.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saphira/base/overloaded.hpp"
#include "saphira/protocol/impossible.hpp"
#include "saphira/protocol/vision_setting.hpp"

namespace saphira::reflector {

namespace {

constexpr double kRetryTick = 1e-6;

// ARIA's and Player's numbers of the gripper's actions, in the order of GripperAction.
constexpr std::array<std::uint16_t, 11> kGripperNumbers{1, 2, 3, 4, 5, 6, 7, 8, 15, 16, 17};
/// The number of a device's setting: each is requested, and shown, by itself.
int action_of(const Wish& wish) {
  if (const auto* server = std::get_if<ServerWish>(&wish))
    return static_cast<int>(server->action);
  if (const auto* serial = std::get_if<SerialWish>(&wish))
    return serial->port;
  if (const auto* vision = std::get_if<VisionWish>(&wish)) {
    const protocol::VisionSetting set = protocol::parse_vision_setting(vision->text);
    return 3 * static_cast<int>(set.what) + set.channel;
  }
  return 0;
}

}  // namespace

void Devices::plan(Item& item, const Wish& wish, const protocol::RobotParameters& parameters,
                   std::uint8_t digital_output) {
  using protocol::PacketType;
  const bool later = parameters.protocol != protocol::Protocol::kPsos;
  const bool arcos = parameters.protocol == protocol::Protocol::kArcos;
  const auto refuse = [&](const std::string& why) {
    item.request.answer = {AnswerCode::refused, item.request.asked + ": refused; " + why};
  };
  const auto send = [&](std::vector<protocol::Command> commands, Proof proof, int value = 0,
                        int mask = 0) {
    item.commands = std::move(commands);
    item.proof = proof;
    item.value = value;
    item.mask = mask;
  };
  const auto report = [&](protocol::Command command, int value, PacketType type) {
    send({std::move(command)}, value == 0 ? Proof::thrice : Proof::packet, static_cast<int>(type));
  };
  const std::string not_in_psos = "a server of this robot's generation (PSOS) has no such command";
  std::visit(
      Overloaded{
          [&](const ServoWish& w) {
            if (w.look) {
              const std::uint16_t pulse = protocol::pulse_of_head(parameters, *w.look);
              if (pulse == 0)
                return refuse(
                    parameters.head_reach == 0.0
                        ? "this robot's parameter file has no head (HeadReach)"
                        : "its head turns by " +
                              std::to_string(std::lround(degrees(parameters.head_reach))) +
                              " degrees to either side at most");
              return send({protocol::Ptu{pulse}}, Proof::servo, pulse);
            }
            if (!later && w.width != 0 &&
                (w.width < protocol::kShortestPulse || w.width > protocol::kLongestPulse))
              return refuse("expected a pulse of " + std::to_string(protocol::kShortestPulse) +
                            " to " + std::to_string(protocol::kLongestPulse) + " us, or 0");
            send({protocol::Ptu{w.width}}, later ? Proof::thrice : Proof::servo, w.width);
          },
          [&](const GripperWish& w) {
            if (w.action == GripperAction::number)
              return send({protocol::Gripper{w.value}}, Proof::thrice);
            if (!later)
              return refuse("a robot of this generation (PSOS) takes numbers: 0, 1, 4, 5");
            const protocol::Gripper gripper{kGripperNumbers.at(static_cast<std::size_t>(w.action))};
            if (w.action == GripperAction::pressure || w.action == GripperAction::carry)
              return send({gripper, protocol::GripperValue{w.value}}, Proof::once);
            send({gripper}, Proof::thrice);
          },
          [&](const OutputWish& w) {
            const auto bits =
                static_cast<std::uint8_t>((digital_output & ~w.mask) | (w.bits & w.mask));
            send({protocol::DigitalOutput{bits, later ? w.mask : std::uint8_t{0}}}, Proof::output,
                 w.bits & w.mask, w.mask);
          },
          [&](const AnalogWish& w) {
            if (!later)
              return refuse("this robot has one analog input");
            send({protocol::AnalogSelect{w.port}}, arcos ? Proof::analog : Proof::thrice, w.port);
          },
          [&](const TimerWish& w) { send({protocol::Timer{w.pin}}, Proof::once); },
          [&](const SonarWish& w) {
            protocol::Polling polling{w.polling};
            for (const std::uint8_t sonar : polling.sonars)
              if (std::none_of(parameters.sonars.begin(), parameters.sonars.end(),
                               [&](const auto& unit) { return unit.number == sonar; }))
                return refuse("the robot has no sonar " + std::to_string(sonar));
            if (later) {
              std::vector<protocol::Command> commands{protocol::SonarSwitch{w.on, 0}};
              if (w.on && !polling.sonars.empty())
                commands.emplace_back(polling);
              return send(std::move(commands), arcos ? Proof::sonar : Proof::thrice, w.on ? 1 : 0);
            }
            if (!w.on)
              polling.sonars.clear();
            else if (polling.sonars.empty())
              for (const protocol::SonarUnit& unit : parameters.sonars)
                polling.sonars.push_back(unit.number);
            send({polling}, Proof::thrice);
          },
          [&](const SoundWish& w) {
            if (!later)
              return refuse(not_in_psos);
            if (w.tones.empty())
              return send({protocol::Sound{w.stored}}, Proof::once);
            protocol::Say say;
            for (const Tone& tone : w.tones) {
              say.text.push_back(tone.duration);
              say.text.push_back(tone.pitch);
            }
            send({say}, Proof::once);
          },
          [&](const ServerWish& w) {
            if (w.action == ServerAction::set_origin)
              return send({protocol::SetOrigin{}}, Proof::origin);
            if (!later)
              return refuse(not_in_psos);
            switch (w.action) {
              case ServerAction::set_origin:
                break;
              case ServerAction::motors:
                return send({protocol::Enable{w.value != 0}}, arcos ? Proof::motors : Proof::thrice,
                            w.value);
              case ServerAction::bump_stall:
                return send({protocol::BumpStall{w.value}}, Proof::thrice);
              case ServerAction::configuration:
                return report(protocol::ConfigRequest{1}, 1, PacketType::kConfig);
              case ServerAction::encoders:
                return report(protocol::EncoderRequest{w.value}, w.value, PacketType::kEncoder);
              case ServerAction::io:
                return report(protocol::IoRequest{w.value}, w.value, PacketType::kIo);
              case ServerAction::gripper:
                return report(protocol::GripperRequest{w.value}, w.value, PacketType::kGripper);
            }
          },
          [&](const SerialWish& w) {
            if (!later)
              return refuse(not_in_psos);
            std::vector<protocol::Command> commands;
            const auto add = [&](auto write, auto read) {
              write.text = w.data;
              read.value = w.answer;
              if (!w.data.empty())
                commands.emplace_back(write);
              if (w.answer > 0)
                commands.emplace_back(read);
            };
            if (w.port == 1)
              add(protocol::Aux1Send{}, protocol::Aux1Read{});
            else if (w.port == 2)
              add(protocol::Aux2Send{}, protocol::Aux2Read{});
            else
              add(protocol::Aux3Send{}, protocol::Aux3Read{});
            send(std::move(commands), Proof::once);
          },
          [&](const VisionWish& w) {
            send({protocol::VisionCommand(protocol::Bytes(w.text.begin(), w.text.end()))},
                 Proof::thrice);
          },
      },
      wish);
}

void Devices::begin(const protocol::RobotParameters& parameters) {
  if (parameters.protocol == protocol::Protocol::kPsos)
    return;
  for (const ServerWish wish :
       {ServerWish{ServerAction::motors, 1}, ServerWish{ServerAction::configuration, 0}}) {
    Item& item = put({.functor = {}, .source = "bridge"}, wish, parameters);
    item.quiet = true;
    note(item);
    if (wish.action != ServerAction::configuration)
      continue;
    // Before the question for the configuration, so that the answer shows the accepted values.
    std::vector<protocol::Command> brakes;
    if (parameters.stop_deceleration > 0.0)
      brakes.emplace_back(protocol::Acceleration{-parameters.stop_deceleration});
    if (parameters.stop_rotation_deceleration > 0.0)
      brakes.emplace_back(protocol::RotationAcceleration{-parameters.stop_rotation_deceleration});
    item.commands.insert(item.commands.begin(), brakes.begin(), brakes.end());
  }
}

void Devices::connect() {
  for (auto& [key, item] : items_)
    if (!ended(item.request.answer.code))
      end(item, AnswerCode::lost, "the connection to the robot ended");
  digital_output_ = 0;
  reports_ = {};
}

void Devices::request(const Request& request, const Wish& wish,
                      const protocol::RobotParameters& parameters) {
  note(put(request, wish, parameters));
}

Devices::Item& Devices::put(const Request& request, const Wish& wish,
                            const protocol::RobotParameters& parameters) {
  Item& item = items_[{wish.index(), action_of(wish)}];
  if (!ended(item.request.answer.code) && !item.quiet) {
    item.request.answer = {AnswerCode::lost, item.request.asked + ": a request of " +
                                                 request.source + " took its place"};
    answered_.push_back(item.request);
  }
  item = {};
  item.request = {request.asker,
                  request.number,
                  request.source,
                  text(wish),
                  {AnswerCode::underway, text(wish) + ": not shown yet"},
                  0,
                  static_cast<Device>(wish.index())};
  item.deadline = request.deadline;
  plan(item, wish, parameters, digital_output_);
  return item;
}

void Devices::end(Item& item, AnswerCode code, const std::string& words) {
  item.request.answer = {code, item.request.asked + ": " + words};
  item.commands.clear();
  note(item);
}

void Devices::note(const Item& item) {
  changed_ = true;
  if (item.quiet)
    return;
  answered_.push_back(item.request);
  if (!well(item.request.answer.code))
    troubles_.push_back("a request of " + item.request.source + ": " + item.request.answer.text);
}

bool Devices::shown(const Item& item, const protocol::InformationPacket& packet,
                    const protocol::Information& information, bool origin) const {
  switch (item.proof) {
    case Proof::output:
      return (packet.digital_output & item.mask) == item.value;
    case Proof::servo:
      return packet.ptu == item.value;
    case Proof::origin:
      return origin;
    case Proof::motors:
      return information.motors_on == (item.value != 0);
    case Proof::sonar:  // ARCOS has its flags where the servo's width was
      return ((packet.ptu & protocol::kFlagSonars) != 0) == (item.value != 0);
    case Proof::analog:  // and the chosen port in the timer's low byte
      return (packet.timer & 0xFFU) == static_cast<unsigned>(item.value);
    case Proof::once:
    case Proof::thrice:
    case Proof::packet:
      break;
  }
  return false;
}

void Devices::reflect(const protocol::InformationPacket& packet,
                      const protocol::Information& information, bool origin) {
  digital_output_ = packet.digital_output;
  for (auto& [key, item] : items_)
    if (!ended(item.request.answer.code) && item.request.sent > 0 &&
        shown(item, packet, information, origin))
      end(item, AnswerCode::done, "the robot shows it");
}

void Devices::reflect(const protocol::ServerPacket& packet, std::uint8_t type) {
  const auto take = [&](auto& kept, const auto& came) {
    changed_ = changed_ || kept != came;
    kept = came;
    for (auto& [key, item] : items_)
      if (!ended(item.request.answer.code) && item.request.sent > 0 &&
          item.proof == Proof::packet && item.value == type)
        end(item, AnswerCode::done, "the robot shows it");
  };
  if (const auto* configuration = std::get_if<protocol::ConfigPacket>(&packet))
    take(reports_.configuration, *configuration);
  else if (const auto* encoders = std::get_if<protocol::EncoderPacket>(&packet))
    take(reports_.encoders, *encoders);
  else if (const auto* io = std::get_if<protocol::IoPacket>(&packet))
    take(reports_.io, *io);
  else if (const auto* gripper = std::get_if<protocol::GripperPacket>(&packet))
    take(reports_.gripper, *gripper);
  else  // news when it is the first of its type; the number of them alone is none
    changed_ = ++reports_.unread[type] == 1 || changed_;
}

bool Devices::pending(double now) const {
  return std::any_of(items_.begin(), items_.end(), [&](const auto& entry) {
    const Item& item = entry.second;
    return !ended(item.request.answer.code) &&
           (item.request.sent == 0 || now - item.at >= kRetry - kRetryTick);
  });
}

std::vector<protocol::Command> Devices::due(double now, std::size_t room) {
  std::vector<protocol::Command> out;
  for (auto& [key, item] : items_) {
    if (ended(item.request.answer.code) ||
        (item.request.sent != 0 && now - item.at < kRetry - kRetryTick))
      continue;
    if (item.deadline > 0.0 && now - item.first.value_or(now) >= item.deadline) {
      end(item, AnswerCode::too_late, "given up; the robot has not shown it before the deadline");
      continue;
    }
    if (item.request.sent >= (item.quiet ? 3 : kTries)) {
      end(item, AnswerCode::given_up,
          "given up after " + std::to_string(item.request.sent) +
              " times; the robot does not show it");
      continue;
    }
    std::size_t size = 0;
    for (const protocol::Command& command : item.commands)
      size += protocol::encode(command).size();
    if (size > room)
      continue;
    room -= size;
    ++item.request.sent;
    item.first = item.first.value_or(now);
    item.at = now;
    out.insert(out.end(), item.commands.begin(), item.commands.end());
    if (item.proof == Proof::once || (item.proof == Proof::thrice && item.request.sent == 3))
      end(item, AnswerCode::sent, "sent; no packet of this robot would show it");
  }
  return out;
}

std::vector<DeviceRequest> Devices::requests() const {
  std::vector<DeviceRequest> out;
  for (const auto& [key, item] : items_)
    out.push_back(item.request);
  return out;
}

}  // namespace saphira::reflector

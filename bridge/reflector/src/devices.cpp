#include "saphira/reflector/devices.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace saphira::reflector {

namespace {

constexpr double kTick = 1e-6;

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

// ARIA's and Player's numbers of the gripper's actions, in the order of GripperAction.
constexpr std::array<std::uint16_t, 11> kGripperNumbers{1, 2, 3, 4, 5, 6, 7, 8, 15, 16, 17};
constexpr std::array kGripperWords{"open",  "close",  "stop", "lift up",  "lift down", "lift stop",
                                   "store", "deploy", "halt", "pressure", "carry",     "number"};
constexpr std::array kServerWords{"set origin",           "motors",          "bump stall",
                                  "report configuration", "report encoders", "report io",
                                  "report gripper"};

std::string hex(std::uint8_t value) {
  char out[8];
  std::snprintf(out, sizeof out, "0x%02X", value);
  return out;
}

/// Which of a device's settings it is: each is asked for, and shown, by itself.
int action_of(const Wish& wish) {
  if (const auto* servo = std::get_if<ServoWish>(&wish))
    return servo->servo;
  if (const auto* server = std::get_if<ServerWish>(&wish))
    return static_cast<int>(server->action);
  if (const auto* serial = std::get_if<SerialWish>(&wish))
    return serial->port;
  return 0;
}

bool ended(RequestState state) {
  return state != RequestState::sending;
}

}  // namespace

std::string text(const Wish& wish) {
  return std::visit(
      Overloaded{
          [](const ServoWish& w) {
            return (w.servo == 0 ? "servo " : "servo " + std::to_string(w.servo) + " ") +
                   std::to_string(w.width) + " us";
          },
          [](const GripperWish& w) {
            std::string out =
                std::string("gripper ") + kGripperWords.at(static_cast<std::size_t>(w.action));
            if (w.action >= GripperAction::pressure)
              out += " " + std::to_string(w.value);
            return out;
          },
          [](const OutputWish& w) {
            return "output " + hex(w.bits) + (w.mask == 0xFF ? "" : " mask " + hex(w.mask));
          },
          [](const AnalogWish& w) { return "analog " + std::to_string(w.port); },
          [](const TimerWish& w) { return "timer " + std::to_string(w.pin); },
          [](const SonarWish& w) {
            std::string out = w.on ? "sonar on" : "sonar off";
            for (const std::uint8_t sonar : w.polling)
              out += " " + std::to_string(sonar);
            return out;
          },
          [](const SoundWish& w) {
            return w.tones.empty() ? "sound " + std::to_string(w.stored)
                                   : "sound of " + std::to_string(w.tones.size()) + " tones";
          },
          [](const ServerWish& w) {
            return std::string(kServerWords.at(static_cast<std::size_t>(w.action))) +
                   (w.action == ServerAction::set_origin || w.action == ServerAction::configuration
                        ? ""
                        : " " + std::to_string(w.value));
          },
          [](const SerialWish& w) {
            return "serial " + std::to_string(w.port) + " " + std::to_string(w.data.size()) +
                   " bytes";
          },
      },
      wish);
}

void Devices::plan(Item& item, const Wish& wish, const protocol::RobotParameters& parameters,
                   std::uint8_t digital_output) {
  const auto refuse = [&](const std::string& why) {
    item.request.state = RequestState::refused;
    item.request.reason = why;
  };
  std::visit(Overloaded{
                 [&](const ServoWish& w) {
                   if (w.servo != 0)
                     return refuse("this robot has one servo, number 0");
                   item.commands = {protocol::Ptu{w.width}};
                   item.proof = Proof::servo;
                   item.value = w.width;
                 },
                 [&](const GripperWish& w) {
                   const std::uint16_t code =
                       w.action == GripperAction::number
                           ? w.value
                           : kGripperNumbers.at(static_cast<std::size_t>(w.action));
                   item.commands = {protocol::Gripper{code}};
                   item.proof = Proof::thrice;
                 },
                 [&](const OutputWish& w) {
                   const auto bits =
                       static_cast<std::uint8_t>((digital_output & ~w.mask) | (w.bits & w.mask));
                   item.commands = {protocol::DigitalOutput{bits}};
                   item.proof = Proof::output;
                   item.value = w.bits & w.mask;
                   item.mask = w.mask;
                 },
                 [&](const AnalogWish&) { refuse("this robot has one analog input"); },
                 [&](const TimerWish& w) {
                   if (w.pin > 7)
                     return refuse("expected a pin in 0..7");
                   item.commands = {protocol::Timer{w.pin}};
                   item.proof = Proof::once;
                 },
                 [&](const SonarWish& w) {
                   protocol::Polling polling{w.polling};
                   if (!w.on)
                     polling.sonars.clear();
                   else if (polling.sonars.empty())
                     for (const protocol::SonarUnit& unit : parameters.sonars)
                       polling.sonars.push_back(unit.number);
                   for (const std::uint8_t sonar : polling.sonars)
                     if (std::none_of(parameters.sonars.begin(), parameters.sonars.end(),
                                      [&](const auto& unit) { return unit.number == sonar; }))
                       return refuse("the robot has no sonar " + std::to_string(sonar));
                   item.commands = {polling};
                   item.proof = Proof::thrice;
                 },
                 [&](const SoundWish&) { refuse("this robot plays no sounds"); },
                 [&](const ServerWish& w) {
                   if (w.action != ServerAction::set_origin)
                     return refuse("this robot has no such thing");
                   item.commands = {protocol::SetOrigin{}};
                   item.proof = Proof::origin;
                 },
                 [&](const SerialWish&) { refuse("this robot has no serial ports"); },
             },
             wish);
}

void Devices::connect() {
  for (auto& [key, item] : items_)
    if (!ended(item.request.state))
      end(item, RequestState::lost, "the connection to the robot ended");
  digital_output_ = 0;
}

void Devices::request(const std::string& source, std::uint64_t number, const Wish& wish,
                      const protocol::RobotParameters& parameters) {
  Item item;
  item.request = {wish.index(), source, number, text(wish), RequestState::sending, {}, 0};
  plan(item, wish, parameters, digital_output_);
  note(item.request);
  items_[{wish.index(), action_of(wish)}] = std::move(item);
}

void Devices::refuse(std::size_t device, const std::string& source, std::uint64_t number,
                     const std::string& text, const std::string& reason) {
  Item& item = items_[{device, -1}];
  item.request = {device, source, number, text, RequestState::refused, reason, 0};
  note(item.request);
}

void Devices::end(Item& item, RequestState state, const std::string& reason) {
  item.request.state = state;
  item.request.reason = reason;
  item.commands.clear();
  note(item.request);
}

void Devices::note(const Request& request) {
  changed_ = true;
  if (request.reason.empty())
    return;
  const std::string what = request.text.empty() ? "device command" : request.text;
  troubles_.push_back(what + " of " + request.source +
                      (request.state == RequestState::refused ? " refused: " : ": ") +
                      request.reason);
}

void Devices::reflect(const protocol::InformationPacket& packet, bool origin) {
  digital_output_ = packet.digital_output;
  for (auto& [key, item] : items_) {
    if (ended(item.request.state) || item.request.sent == 0)
      continue;
    const bool shown =
        (item.proof == Proof::output && (packet.digital_output & item.mask) == item.value) ||
        (item.proof == Proof::servo && packet.ptu == item.value) ||
        (item.proof == Proof::origin && origin);
    if (shown)
      end(item, RequestState::shown);
  }
}

void Devices::reflect(std::uint8_t type) {
  for (auto& [key, item] : items_)
    if (!ended(item.request.state) && item.request.sent > 0 && item.proof == Proof::packet &&
        item.value == type)
      end(item, RequestState::shown);
}

bool Devices::pending(double now) const {
  return std::any_of(items_.begin(), items_.end(), [&](const auto& entry) {
    const Item& item = entry.second;
    return !ended(item.request.state) &&
           (item.request.sent == 0 || now - item.at >= kRetry - kTick);
  });
}

std::vector<protocol::Command> Devices::due(double now) {
  std::vector<protocol::Command> out;
  for (auto& [key, item] : items_) {
    if (ended(item.request.state) || (item.request.sent != 0 && now - item.at < kRetry - kTick))
      continue;
    if (item.request.sent >= kTries) {
      end(item, RequestState::given_up, "the robot does not show it");
      continue;
    }
    ++item.request.sent;
    item.at = now;
    out.insert(out.end(), item.commands.begin(), item.commands.end());
    if (item.proof == Proof::once || (item.proof == Proof::thrice && item.request.sent == 3))
      end(item, RequestState::sent);
  }
  return out;
}

std::vector<Request> Devices::requests() const {
  std::vector<Request> out;
  for (const auto& [key, item] : items_)
    out.push_back(item.request);
  return out;
}

}  // namespace saphira::reflector

#include "saphira/reflector/wishes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/overloaded.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/protocol/vision_setting.hpp"

namespace saphira::reflector {

namespace {

constexpr std::size_t kMostTones = 20;
constexpr std::size_t kMostPolled = 12;
constexpr std::size_t kMostBytes = 180;
constexpr double kTone = 0.02;  // [s] the steps of a tone

// In the order of GripperAction, ServerAction and of how often a packet is sent.
constexpr std::array kGripperActions{"open",      "close",     "stop",  "lift up",
                                     "lift down", "lift stop", "store", "deploy",
                                     "halt",      "pressure",  "carry", "number"};
constexpr std::array kServerWords{"set origin",           "motors",          "bump stall",
                                  "report configuration", "report encoders", "report io",
                                  "report gripper"};

constexpr std::array kReports{"configuration", "encoders", "io", "gripper"};
constexpr std::array kOften{"off", "once", "always"};

std::string hex(std::uint8_t value) {
  return format("0x%02X", value);
}

template <std::size_t count>
std::vector<std::string> all(const std::array<const char*, count>& words) {
  return {words.begin(), words.end()};
}

/// The index of a text argument among the words.
template <std::size_t count>
int which(const std::array<const char*, count>& words, const std::string& word) {
  return static_cast<int>(std::find(words.begin(), words.end(), word) - words.begin());
}

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    const auto byte = number_in<std::uint8_t>(std::string_view(hex).substr(i, 2), 16);
    if (hex.size() % 2 != 0 || !byte)
      throw std::invalid_argument(
          "serial: argument \"data\": expected two hexadecimal digits for each byte, found " +
          quoted(hex));
    bytes.push_back(*byte);
  }
  return bytes;
}

SoundWish tones_of(const Arguments& with) {
  const std::vector<double> durations = numbers_of(with, "duration");
  const std::vector<double> pitches = numbers_of(with, "pitch");
  if (durations.empty() || durations.size() > kMostTones || durations.size() != pitches.size())
    throw std::invalid_argument("tones: expected 1 to 20 durations and as many pitches, found " +
                                std::to_string(durations.size()) + " and " +
                                std::to_string(pitches.size()));
  SoundWish wish;
  for (std::size_t i = 0; i < durations.size(); ++i)
    wish.tones.push_back({static_cast<std::uint8_t>(std::round(durations[i] / kTone)),
                          static_cast<std::uint8_t>(pitches[i])});
  return wish;
}

SonarWish sonar_of(const Arguments& with) {
  SonarWish wish{truth_of(with, "on"), {}};
  for (const double sonar : numbers_of(with, "sonar"))
    wish.polling.push_back(static_cast<std::uint8_t>(sonar));
  if (wish.polling.size() > kMostPolled)
    throw std::invalid_argument(
        "sonar: expected at most 12 sonars in the polling sequence, found " +
        std::to_string(wish.polling.size()));
  return wish;
}

ServerWish report_of(const Arguments& with) {
  const auto what = static_cast<ServerAction>(static_cast<int>(ServerAction::configuration) +
                                              which(kReports, text_of(with, "packet")));
  const std::string& often = text_of(with, "often");
  return {what,
          what == ServerAction::configuration ? 0 : which(kOften, often.empty() ? "once" : often)};
}

SerialWish serial_of(const Arguments& with) {
  SerialWish wish{static_cast<std::uint8_t>(number_of(with, "port")),
                  bytes_of(text_of(with, "data")),
                  static_cast<std::uint8_t>(number_of(with, "answer"))};
  if (wish.data.size() > kMostBytes)
    throw std::invalid_argument("serial: expected at most 180 bytes, found " +
                                std::to_string(wish.data.size()));
  return wish;
}

}  // namespace

const std::vector<Functor>& functors(Device device) {
  static const std::array<std::vector<Functor>, std::variant_size_v<Wish>> all_functors{{
      {{"servo",
        "turns the position servo (command 41)",
        {whole_parameter("width", "pulse width [us]; later robots: in their own units", 0.0,
                         65535.0)}},
       {"look",
        "turns the head with the cameras (command 41)",
        {number_parameter("angle", "[rad] from straight ahead, to the left", -kPi, kPi)}}},
      {{"gripper",
        "moves the gripper (command 33); a Pioneer 1 takes numbers alone: 0, 1, 4, 5",
        {text_parameter("action", "what it is to do", all(kGripperActions)),
         optional(whole_parameter(
             "value", "of pressure, carry and number, in the robot's own units", 0.0, 65535.0))}}},
      {{"output",
        "sets the digital outputs (command 30)",
        {whole_parameter("bits", "as they are to be", 0.0, 255.0),
         optional(whole_parameter("mask", "0: leave that bit as it is", 0.0, 255.0), 255.0)}}},
      {{"analog",
        "chooses the input that RobotState.analog shows (command 35)",
        {whole_parameter("port", "of the robot", 0.0, 255.0)}}},
      {{"timer",
        "begins RobotState.timer, which an event at the pin ends (command 31)",
        {whole_parameter("pin", "of the user input", 0.0, 7.0)}}},
      {{"sonar",
        "which sonars fire (commands 3 and 28)",
        {truth_parameter("on", "no: none fires"),
         list(whole_parameter("sonar", "these fire, in this order; none given: all, in order", 0.0,
                              255.0))}}},
      {{"sound",
        "plays a sound that is stored in the robot (command 90)",
        {whole_parameter("stored", "its number", 0.0, 255.0)}},
       {"tones",
        "plays tones (command 15)",
        {list(number_parameter("duration", "[s]", kTone, 255 * kTone)),
         list(whole_parameter("pitch", "half a period, in the robot's own units; 0: silence", 0.0,
                              255.0))}}},
      {{"set_origin", "the server's position becomes (0, 0, 0) (command 7)"},
       {"motors", "switches the motors (command 4)", {truth_parameter("on", "on or off")}},
       {"bump_stall",
        "which bumpers stall the motors (command 44)",
        {whole_parameter("value", "none, front, rear, both", 0.0, 3.0)}},
       {"report",
        "what the robot sends besides its information packets (commands 18, 19, 37, 40)",
        {text_parameter("packet", "which", all(kReports)),
         optional(text_parameter("often", "how often; not given: once", all(kOften)))}}},
      {{"serial",
        "sends bytes to a serial port of the robot (commands 42, 66, 60)",
        {whole_parameter("port", "of the robot", 1.0, 3.0),
         optional(text_parameter("data", "two hexadecimal digits a byte, at most 180 bytes")),
         optional(whole_parameter("answer",
                                  "so many bytes are asked of the port afterwards (43, 67, 61)",
                                  0.0, 255.0))}}},
      {{"say",
        "a setting of the Fast Track vision system (VISION_COM); the bridge has --vision",
        {text_parameter("text", "such as pioneer_a_mode=1 or line_min_mass=8 (manual 9.1)")}}},
  }};
  return all_functors.at(static_cast<std::size_t>(device));
}

Wish wish_of(const Request& request) {
  const std::string& what = request.functor;
  const Arguments& with = request.arguments;
  const auto byte = [&](const char* name) {
    return static_cast<std::uint8_t>(number_of(with, name));
  };
  const auto value = [&](const char* name) {
    return static_cast<std::uint16_t>(number_of(with, name));
  };
  if (what == "servo")
    return ServoWish{value("width"), {}};
  if (what == "look")
    return ServoWish{0, number_of(with, "angle")};
  if (what == "gripper")
    return GripperWish{static_cast<GripperAction>(which(kGripperActions, text_of(with, "action"))),
                       value("value")};
  if (what == "output")
    return OutputWish{byte("mask"), byte("bits")};
  if (what == "analog")
    return AnalogWish{byte("port")};
  if (what == "timer")
    return TimerWish{byte("pin")};
  if (what == "sonar")
    return sonar_of(with);
  if (what == "sound")
    return SoundWish{{}, byte("stored")};
  if (what == "tones")
    return tones_of(with);
  if (what == "set_origin")
    return ServerWish{ServerAction::set_origin, 0};
  if (what == "motors")
    return ServerWish{ServerAction::motors, truth_of(with, "on") ? 1 : 0};
  if (what == "bump_stall")
    return ServerWish{ServerAction::bump_stall, byte("value")};
  if (what == "report")
    return report_of(with);
  if (what == "say") {
    const std::string& text = text_of(with, "text");
    try {
      protocol::parse_vision_setting(text);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(std::string("say: argument \"text\": ") + error.what());
    }
    return VisionWish{text};
  }
  return serial_of(with);
}

std::string text(const Wish& wish) {
  return std::visit(
      Overloaded{
          [](const ServoWish& w) {
            return w.look ? "look to " + std::to_string(std::lround(degrees(*w.look))) + " degrees"
                          : "servo " + std::to_string(w.width) + " us";
          },
          [](const GripperWish& w) {
            std::string out =
                std::string("gripper ") + kGripperActions.at(static_cast<std::size_t>(w.action));
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
          [](const VisionWish& w) { return "vision " + w.text; },
      },
      wish);
}

}  // namespace saphira::reflector

#include "saphira/reflector/wishes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/protocol/vision_setting.hpp"

namespace saphira::reflector {

namespace {

using protocol::PacketType;
using Commands = std::vector<protocol::Command>;

constexpr std::size_t kMostTones = 20;
constexpr std::size_t kMostPolled = 12;
constexpr std::size_t kMostBytes = 180;
constexpr double kTone = 0.02;  // [s] the steps of a tone
constexpr const char* kNotInPsos = "a server of this robot's generation (PSOS) has no such command";

// ARIA's and Player's numbers of the gripper's actions.
constexpr auto kGripperActions =
    std::to_array<std::pair<const char*, std::uint16_t>>({{"open", 1},
                                                          {"close", 2},
                                                          {"stop", 3},
                                                          {"lift up", 4},
                                                          {"lift down", 5},
                                                          {"lift stop", 6},
                                                          {"store", 7},
                                                          {"deploy", 8},
                                                          {"halt", 15},
                                                          {"pressure", 16},
                                                          {"carry", 17},
                                                          {"number", 0}});
constexpr std::array kReports{"configuration", "encoders", "io", "gripper"};
constexpr std::array kOften{"off", "once", "always"};
/// The settings of the server. Those of its reports follow.
enum Setting { kOrigin, kMotors, kBumpStall, kReport };

/// The robot that a wish is for.
struct Robot {
  const protocol::RobotParameters& parameters;
  std::uint8_t digital_output;
  bool later() const { return parameters.protocol != protocol::Protocol::kPsos; }
  bool arcos() const { return parameters.protocol == protocol::Protocol::kArcos; }
};

std::string hex(std::uint8_t value) {
  return format("0x%02X", value);
}

std::vector<std::string> gripper_actions() {
  std::vector<std::string> words;
  for (const auto& [word, number] : kGripperActions)
    words.emplace_back(word);
  return words;
}

/// The index of a text argument among the words.
template <std::size_t count>
int which(const std::array<const char*, count>& words, const std::string& word) {
  return static_cast<int>(std::find(words.begin(), words.end(), word) - words.begin());
}

std::uint8_t byte_of(const Arguments& with, const char* name) {
  return static_cast<std::uint8_t>(number_of(with, name));
}

std::uint16_t value_of(const Arguments& with, const char* name) {
  return static_cast<std::uint16_t>(number_of(with, name));
}

Wish sent(std::string text, Commands commands, Proof proof, int value = 0, int mask = 0) {
  return {.text = std::move(text),
          .commands = std::move(commands),
          .proof = proof,
          .value = value,
          .mask = mask};
}

Wish refused(std::string text, std::string why) {
  return {.text = std::move(text), .refusal = std::move(why)};
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

Wish servo(const Arguments& with, const Robot& robot) {
  const std::uint16_t width = value_of(with, "width");
  const std::string text = "servo " + std::to_string(width) + " us";
  if (robot.later())
    return sent(text, {protocol::Ptu{width}}, Proof::thrice, width);
  if (width != 0 && (width < protocol::kShortestPulse || width > protocol::kLongestPulse))
    return refused(text, "expected a pulse of " + std::to_string(protocol::kShortestPulse) +
                             " to " + std::to_string(protocol::kLongestPulse) + " us, or 0");
  return sent(text, {protocol::Ptu{width}}, Proof::servo, width);
}

Wish look(const Arguments& with, const Robot& robot) {
  const double angle = number_of(with, "angle");
  const std::string text = "look to " + std::to_string(std::lround(degrees(angle))) + " degrees";
  const double reach = robot.parameters.head_reach;
  if (const std::uint16_t pulse = protocol::pulse_of_head(robot.parameters, angle); pulse != 0)
    return sent(text, {protocol::Ptu{pulse}}, Proof::servo, pulse);
  return refused(text, reach == 0.0
                           ? "this robot's parameter file has no head (HeadReach)"
                           : "its head turns by " + std::to_string(std::lround(degrees(reach))) +
                                 " degrees to either side at most");
}

Wish gripper(const Arguments& with, const Robot& robot) {
  const std::string& action = text_of(with, "action");
  const std::uint16_t value = value_of(with, "value");
  const std::string text = "gripper " + action;
  const std::string with_value = text + " " + std::to_string(value);
  constexpr const char* kOfNumbers = "a robot of this generation (PSOS) takes numbers: 0, 1, 4, 5";
  constexpr std::array<std::uint16_t, 4> kNumbers{0, 1, 4, 5};
  if (action == "number" && !robot.later() && std::ranges::find(kNumbers, value) == kNumbers.end())
    return refused(with_value, kOfNumbers);
  if (action == "number")
    return sent(with_value, {protocol::Gripper{value}}, Proof::thrice);
  const bool takes_value = action == "pressure" || action == "carry";
  if (!robot.later())
    return refused(takes_value ? with_value : text, kOfNumbers);
  const auto* const known =
      std::ranges::find(kGripperActions, action, &std::pair<const char*, std::uint16_t>::first);
  const protocol::Gripper command{known->second};
  if (takes_value)
    return sent(with_value, {command, protocol::GripperValue{value}}, Proof::once);
  return sent(text, {command}, Proof::thrice);
}

Wish output(const Arguments& with, const Robot& robot) {
  const std::uint8_t bits = byte_of(with, "bits");
  const std::uint8_t mask = byte_of(with, "mask");
  const auto all = static_cast<std::uint8_t>((robot.digital_output & ~mask) | (bits & mask));
  return sent("output " + hex(bits) + (mask == 0xFF ? "" : " mask " + hex(mask)),
              {protocol::DigitalOutput{all, robot.later() ? mask : std::uint8_t{0}}}, Proof::output,
              bits & mask, mask);
}

Wish analog(const Arguments& with, const Robot& robot) {
  const std::uint8_t port = byte_of(with, "port");
  const std::string text = "analog " + std::to_string(port);
  if (!robot.later())
    return refused(text, "this robot has one analog input");
  return sent(text, {protocol::AnalogSelect{port}}, robot.arcos() ? Proof::analog : Proof::thrice,
              port);
}

Wish timer(const Arguments& with, const Robot& /*robot*/) {
  const std::uint8_t pin = byte_of(with, "pin");
  return sent("timer " + std::to_string(pin), {protocol::Timer{pin}}, Proof::once);
}

Wish sonar(const Arguments& with, const Robot& robot) {
  const bool on = truth_of(with, "on");
  std::string text = on ? "sonar on" : "sonar off";
  const std::vector<double> polled = numbers_of(with, "sonar");
  if (polled.size() > kMostPolled)
    throw std::invalid_argument(
        "sonar: expected at most 12 sonars in the polling sequence, found " +
        std::to_string(polled.size()));
  protocol::Polling polling;
  for (const double sonar : polled) {
    polling.sonars.push_back(static_cast<std::uint8_t>(sonar));
    text += " " + std::to_string(polling.sonars.back());
  }
  const std::vector<protocol::SonarUnit>& units = robot.parameters.sonars;
  for (const std::uint8_t number : polling.sonars)
    if (std::ranges::find(units, number, &protocol::SonarUnit::number) == units.end())
      return refused(text, "the robot has no sonar " + std::to_string(number));
  if (robot.later()) {
    Commands commands{protocol::SonarSwitch{on, 0}};
    if (on && !polling.sonars.empty())
      commands.emplace_back(polling);
    return sent(text, std::move(commands), robot.arcos() ? Proof::sonar : Proof::thrice,
                on ? 1 : 0);
  }
  if (!on)
    polling.sonars.clear();
  else if (polling.sonars.empty())
    for (const protocol::SonarUnit& unit : units)
      polling.sonars.push_back(unit.number);
  return sent(text, {polling}, Proof::thrice);
}

Wish sound(const Arguments& with, const Robot& robot) {
  const std::uint8_t stored = byte_of(with, "stored");
  const std::string text = "sound " + std::to_string(stored);
  return robot.later() ? sent(text, {protocol::Sound{stored}}, Proof::once)
                       : refused(text, kNotInPsos);
}

Wish tones(const Arguments& with, const Robot& robot) {
  const std::vector<double> durations = numbers_of(with, "duration");
  const std::vector<double> pitches = numbers_of(with, "pitch");
  if (durations.empty() || durations.size() > kMostTones || durations.size() != pitches.size())
    throw std::invalid_argument("tones: expected 1 to 20 durations and as many pitches, found " +
                                std::to_string(durations.size()) + " and " +
                                std::to_string(pitches.size()));
  protocol::Say say;
  for (std::size_t i = 0; i < durations.size(); ++i) {
    say.text.push_back(static_cast<std::uint8_t>(std::round(durations[i] / kTone)));
    say.text.push_back(static_cast<std::uint8_t>(pitches[i]));
  }
  const std::string text = "sound of " + std::to_string(durations.size()) + " tones";
  return robot.later() ? sent(text, {say}, Proof::once) : refused(text, kNotInPsos);
}

/// Of the server itself, where it is of a later generation.
Wish of_later(Setting setting, const Robot& robot, const std::string& text,
              const protocol::Command& command, Proof proof, int value) {
  Wish wish = robot.later() ? sent(text, {command}, proof, value) : refused(text, kNotInPsos);
  wish.setting = setting;
  return wish;
}

Wish set_origin(const Arguments& /*with*/, const Robot& /*robot*/) {
  return sent("set origin", {protocol::SetOrigin{}}, Proof::origin);
}

Wish motors(const Arguments& with, const Robot& robot) {
  const bool on = truth_of(with, "on");
  return of_later(kMotors, robot, on ? "motors 1" : "motors 0", protocol::Enable{on},
                  robot.arcos() ? Proof::motors : Proof::thrice, on ? 1 : 0);
}

Wish bump_stall(const Arguments& with, const Robot& robot) {
  const int value = byte_of(with, "value");
  return of_later(kBumpStall, robot, "bump stall " + std::to_string(value),
                  protocol::BumpStall{value}, Proof::thrice, value);
}

Wish report(const Arguments& with, const Robot& robot) {
  const std::string& packet = text_of(with, "packet");
  const std::string& often = text_of(with, "often");
  const int mode = often.empty() || packet == "configuration" ? 1 : which(kOften, often);
  const int what = which(kReports, packet);
  constexpr std::array<std::pair<protocol::Number, PacketType>, kReports.size()> kPackets{
      {{protocol::Number::kConfigRequest, PacketType::kConfig},
       {protocol::Number::kEncoderRequest, PacketType::kEncoder},
       {protocol::Number::kIoRequest, PacketType::kIo},
       {protocol::Number::kGripperRequest, PacketType::kGripper}}};
  const auto& [number, type] = kPackets.at(static_cast<std::size_t>(what));
  return of_later(
      static_cast<Setting>(kReport + what), robot,
      "report " + packet + (packet == "configuration" ? "" : " " + std::to_string(mode)),
      protocol::Integer{number, mode}, mode == 0 ? Proof::thrice : Proof::packet,
      static_cast<int>(type));
}

Wish serial(const Arguments& with, const Robot& robot) {
  using protocol::Number;
  constexpr std::array kSend{Number::kAux1Send, Number::kAux2Send, Number::kAux3Send};
  constexpr std::array kRead{Number::kAux1Read, Number::kAux2Read, Number::kAux3Read};
  const std::uint8_t port = byte_of(with, "port");
  const std::vector<std::uint8_t> data = bytes_of(text_of(with, "data"));
  if (data.size() > kMostBytes)
    throw std::invalid_argument("serial: expected at most 180 bytes, found " +
                                std::to_string(data.size()));
  Commands commands;
  if (!data.empty())
    commands.emplace_back(protocol::Text{kSend.at(port - 1U), data});
  if (const int answer = byte_of(with, "answer"); answer > 0)
    commands.emplace_back(protocol::Integer{kRead.at(port - 1U), answer});
  const std::string text =
      "serial " + std::to_string(port) + " " + std::to_string(data.size()) + " bytes";
  Wish wish =
      robot.later() ? sent(text, std::move(commands), Proof::once) : refused(text, kNotInPsos);
  wish.setting = port;
  return wish;
}

Wish say(const Arguments& with, const Robot& /*robot*/) {
  const std::string& text = text_of(with, "text");
  try {
    const protocol::VisionSetting set = protocol::parse_vision_setting(text);
    Wish wish =
        sent("vision " + text, {protocol::VisionCommand(protocol::Bytes(text.begin(), text.end()))},
             Proof::thrice);
    wish.setting = 3 * static_cast<int>(set.what) + set.channel;
    return wish;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("say: argument \"text\": ") + error.what());
  }
}

/// A request, and its meaning.
struct Row {
  Device device;
  Wish (*wish)(const Arguments& with, const Robot& robot);
  Functor functor;
};

const std::vector<Row>& rows() {
  static const std::vector<Row> all{
      {Device::servo,
       servo,
       {"servo",
        "turns the position servo (command 41)",
        {whole_parameter("width", "pulse width [us]; later robots: in their own units", 0.0,
                         65535.0)}}},
      {Device::servo,
       look,
       {"look",
        "turns the head with the cameras (command 41)",
        {number_parameter("angle", "[rad] from straight ahead, to the left", -kPi, kPi)}}},
      {Device::gripper,
       gripper,
       {"gripper",
        "moves the gripper (command 33); a Pioneer 1 takes numbers alone: 0, 1, 4, 5",
        {text_parameter("action", "the action", gripper_actions()),
         optional(whole_parameter(
             "value", "of pressure, carry and number, in the robot's own units", 0.0, 65535.0))}}},
      {Device::output,
       output,
       {"output",
        "sets the digital outputs (command 30)",
        {whole_parameter("bits", "as they are to be", 0.0, 255.0),
         optional(whole_parameter("mask", "0: leave that bit as it is", 0.0, 255.0), 255.0)}}},
      {Device::analog,
       analog,
       {"analog",
        "chooses the input that RobotState.analog shows (command 35)",
        {whole_parameter("port", "of the robot", 0.0, 255.0)}}},
      {Device::timer,
       timer,
       {"timer",
        "begins RobotState.timer, which an event at the pin ends (command 31)",
        {whole_parameter("pin", "of the user input", 0.0, 7.0)}}},
      {Device::sonar,
       sonar,
       {"sonar",
        "which sonars fire (commands 3 and 28)",
        {truth_parameter("on", "no: none fires"),
         list(whole_parameter("sonar", "these fire, in this order; none given: all, in order", 0.0,
                              255.0))}}},
      {Device::sound,
       sound,
       {"sound",
        "plays a sound that is stored in the robot (command 90)",
        {whole_parameter("stored", "its number", 0.0, 255.0)}}},
      {Device::sound,
       tones,
       {"tones",
        "plays tones (command 15)",
        {list(number_parameter("duration", "[s]", kTone, 255 * kTone)),
         list(whole_parameter("pitch", "half a period, in the robot's own units; 0: silence", 0.0,
                              255.0))}}},
      {Device::server,
       set_origin,
       {"set_origin", "the server's position becomes (0, 0, 0) (command 7)"}},
      {Device::server,
       motors,
       {"motors", "switches the motors (command 4)", {truth_parameter("on", "on or off")}}},
      {Device::server,
       bump_stall,
       {"bump_stall",
        "which bumpers stall the motors (command 44)",
        {whole_parameter("value", "none, front, rear, both", 0.0, 3.0)}}},
      {Device::server,
       report,
       {"report",
        "the packets that the robot sends beside its information packets (commands 18, 19, 37, 40)",
        {text_parameter("packet", "which", {kReports.begin(), kReports.end()}),
         optional(text_parameter("often", "how often; not given: once",
                                 {kOften.begin(), kOften.end()}))}}},
      {Device::serial,
       serial,
       {"serial",
        "sends bytes to a serial port of the robot (commands 42, 66, 60)",
        {whole_parameter("port", "of the robot", 1.0, 3.0),
         optional(text_parameter("data", "two hexadecimal digits a byte, at most 180 bytes")),
         optional(whole_parameter("answer",
                                  "so many bytes are asked of the port afterwards (43, 67, 61)",
                                  0.0, 255.0))}}},
      {Device::vision,
       say,
       {"say",
        "a setting of the Fast Track vision system (VISION_COM); the bridge has --vision",
        {text_parameter("text", "such as pioneer_a_mode=1 or line_min_mass=8 (manual 9.1)")}}},
  };
  return all;
}

}  // namespace

const std::vector<Functor>& functors(Device device) {
  static const auto by_device = [] {
    std::array<std::vector<Functor>, kEnumerators<Device>.size()> all;
    for (const Row& row : rows())
      all.at(static_cast<std::size_t>(row.device)).push_back(row.functor);
    return all;
  }();
  return by_device.at(static_cast<std::size_t>(device));
}

Wish wish_of(const Request& request, const protocol::RobotParameters& parameters,
             std::uint8_t digital_output) {
  const auto row =
      std::ranges::find(rows(), request.functor, [](const Row& each) { return each.functor.name; });
  if (row == rows().end())
    throw std::invalid_argument("no device takes " + request.functor);
  Wish wish = row->wish(request.arguments, {parameters, digital_output});
  wish.device = row->device;
  return wish;
}

}  // namespace saphira::reflector

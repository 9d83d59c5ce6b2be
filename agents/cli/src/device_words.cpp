#include "saphira/cli/device_words.hpp"

#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "saphira/base/format.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::cli {

const char* const kDeviceWords =
    "  servo WIDTH                    pulse width [us]\n"
    "  look DEGREES                   turns the head with the cameras, from straight ahead to the "
    "left\n"
    "  gripper open|close|stop|up|down|lift-stop|store|deploy|halt|NUMBER\n"
    "  gripper pressure|carry VALUE   in the robot's own units\n"
    "  output BITS [MASK]             such as 0x5A, or 0x01 0x01 for bit 0 alone\n"
    "  analog PORT\n"
    "  timer PIN\n"
    "  sonar on|off [N N ...]         numbers: these fire, in this order\n"
    "  sound N | sound SECONDS:PITCH ...\n"
    "  motors on|off\n"
    "  origin\n"
    "  bumpers 0..3                   which of them stall the motors\n"
    "  report configuration\n"
    "  report encoders|io|gripper [off|once|always]\n"
    "  serial PORT TEXT|0xHEX... [--answer N]\n"
    "  vision TEXT                    such as pioneer_a_mode=1 (a camera with channels of "
    "colours)\n";

namespace {

[[noreturn]] void fail(const std::string& expected, const std::string& found) {
  throw std::invalid_argument("expected " + expected +
                              (found.empty() ? "" : ", found \"" + found + "\""));
}

long whole(const std::string& word, long low, long high, const std::string& what) {
  const bool hex = word.starts_with("0x") || word.starts_with("0X");
  const auto value = number_in<long>(std::string_view(word).substr(hex ? 2 : 0), hex ? 16 : 10);
  if (!value || *value < low || *value > high)
    fail(what + " in " + std::to_string(low) + ".." + std::to_string(high), word);
  return *value;
}

std::uint8_t byte(const std::string& word, const std::string& what, long high = 255) {
  return static_cast<std::uint8_t>(whole(word, 0, high, what));
}

bool on_off(const std::string& word) {
  if (word != "on" && word != "off")
    fail("on or off", word);
  return word == "on";
}

/// An argument that is a whole number, as typed.
Argument whole_of(const char* name, const std::string& word, long high, const std::string& what) {
  return {name, static_cast<double>(whole(word, 0, high, what))};
}

/// The words after the device, each taken once.
class Words {
 public:
  explicit Words(const std::vector<std::string>& words) : words_(words) {}
  bool more() const { return at_ < words_.size(); }
  std::string next(const std::string& what) {
    if (!more())
      fail(what, "");
    return words_[at_++];
  }
  /// An argument that is a whole number.
  Argument number(const char* name, long high, const std::string& what) {
    return whole_of(name, next(what), high, what);
  }
  void end() const {
    if (more())
      fail("nothing more", words_[at_]);
  }

 private:
  const std::vector<std::string>& words_;
  std::size_t at_ = 1;
};

Request gripper(Words& words) {
  constexpr const char* kExpected =
      "open, close, stop, up, down, lift-stop, store, deploy, halt, pressure, carry, or a number";
  // The bridge's words where they are others.
  static const std::map<std::string, std::string> lift{
      {"up", "lift up"}, {"down", "lift down"}, {"lift-stop", "lift stop"}};
  const std::string word = words.next("an action of the gripper");
  if (word == "pressure" || word == "carry")
    return {"gripper", {{"action", word}, words.number("value", 0xFFFF, "a value")}};
  if (const auto found = lift.find(word); found != lift.end())
    return {"gripper", {{"action", found->second}}};
  for (const char* const same : {"open", "close", "stop", "store", "deploy", "halt"})
    if (word == same)
      return {"gripper", {{"action", word}}};
  return {"gripper",
          {{"action", std::string("number")}, whole_of("value", word, 0xFFFF, kExpected)}};
}

Request sound(Words& words) {
  const std::string first = words.next("the number of a sound, or tones as SECONDS:PITCH");
  if (first.find(':') == std::string::npos)
    return {"sound", {whole_of("stored", first, 255, "the number of a sound")}};
  Request out{"tones"};
  for (std::string word = first;; word = words.next("a tone")) {
    const std::size_t colon = word.find(':');
    const auto seconds = number_in<double>(std::string_view(word).substr(0, colon));
    if (colon == std::string::npos || !seconds || !(*seconds >= 0.02 && *seconds <= 5.1))
      fail("a tone as SECONDS:PITCH, such as 0.5:60, of 0.02 to 5.1 s", word);
    out.arguments.emplace_back("duration", *seconds);
    out.arguments.push_back(whole_of("pitch", word.substr(colon + 1), 255, "a pitch"));
    if (!words.more())
      break;
  }
  if (out.arguments.size() > 40)
    fail("at most 20 tones", std::to_string(out.arguments.size() / 2));
  return out;
}

Request report(Words& words) {
  const std::string what = words.next("configuration, encoders, io or gripper");
  if (what != "configuration" && what != "encoders" && what != "io" && what != "gripper")
    fail("configuration, encoders, io or gripper", what);
  const std::string often = what != "configuration" && words.more() ? words.next("") : "once";
  if (often != "off" && often != "once" && often != "always")
    fail("off, once or always", often);
  return {"report", {{"packet", what}, {"often", often}}};
}

Request serial(Words& words) {
  const long port = whole(words.next("a port"), 1, 3, "a port");
  std::string data;
  long answer = 0;
  while (words.more()) {
    const std::string word = words.next("");
    if (word == "--answer") {
      answer = byte(words.next("a number of bytes"), "a number of bytes");
    } else if (word.starts_with("0x")) {
      if (word.size() % 2 != 0)
        fail("two digits a byte", word);
      for (std::size_t i = 2; i < word.size(); i += 2)
        data += format("%02x", byte("0x" + word.substr(i, 2), "a byte"));
    } else {
      for (const char c : word)
        data += format("%02x", static_cast<std::uint8_t>(c));
    }
  }
  if (data.size() > 360)
    fail("at most 180 bytes", std::to_string(data.size() / 2));
  if (data.empty() && answer == 0)
    fail("the bytes to send", "");
  return {"serial",
          {{"port", static_cast<double>(port)},
           {"data", data},
           {"answer", static_cast<double>(answer)}}};
}

Request sonar(Words& words) {
  Request out{"sonar", {{"on", on_off(words.next("on or off"))}}};
  while (truth_of(out.arguments, "on") && words.more())
    out.arguments.push_back(whole_of("sonar", words.next(""), 63, "a sonar"));
  if (out.arguments.size() > 13)
    fail("at most 12 sonars", std::to_string(out.arguments.size() - 1));
  return out;
}

Request output(Words& words) {
  Request out{"output", {words.number("bits", 255, "bits")}};
  if (words.more())
    out.arguments.push_back(words.number("mask", 255, "a mask"));
  return out;
}

Request look(Words& words) {
  const char* const what = "an angle [degrees]";
  const auto angle = static_cast<double>(whole(words.next(what), -180, 180, what));
  return {"look", {{"angle", radians(angle)}}};
}

struct Device {
  const char* name;
  const bus::RequestTopic& topic;
  Request (*request)(Words& words);
};
const std::vector<Device>& devices() {
  using namespace bus::topics;
  static const std::vector<Device> all{
      {"servo", kServo,
       [](Words& w) {
         return Request{"servo", {w.number("width", 0xFFFF, "a pulse width [us]")}};
       }},
      {"look", kServo, look},
      {"gripper", kGripper, gripper},
      {"output", kDigitalOutput, output},
      {"analog", kAnalog,
       [](Words& w) {
         return Request{"analog", {w.number("port", 255, "a port")}};
       }},
      {"timer", kTimer,
       [](Words& w) {
         return Request{"timer", {w.number("pin", 7, "a pin")}};
       }},
      {"sonar", kSonar, sonar},
      {"sound", kSound, sound},
      {"motors", kServer,
       [](Words& w) {
         return Request{"motors", {{"on", on_off(w.next("on or off"))}}};
       }},
      {"origin", kServer, [](Words&) { return Request{"set_origin"}; }},
      {"bumpers", kServer,
       [](Words& w) {
         return Request{"bump_stall", {whole_of("value", w.next("0..3"), 3, "which bumpers")}};
       }},
      {"report", kServer, report},
      {"serial", kSerial, serial},
      {"vision", kVisionSystem, [](Words& w) {
         return Request{"say", {{"text", w.next("a setting, such as pioneer_a_mode=1")}}};
       }}};
  return all;
}

std::string bits(unsigned value) {
  std::string out = "0b";
  for (int i = 7; i >= 0; --i)
    out += (value >> static_cast<unsigned>(i) & 1U) != 0 ? '1' : '0';
  return out;
}

template <class T>
std::string list(const std::vector<T>& values, bool as_bits) {
  std::string out;
  for (const T value : values)
    out += (out.empty() ? "" : " ") + (as_bits ? bits(value) : std::to_string(value));
  return out.empty() ? "none" : out;
}

// Of the gripper's state (idl/device.idl).
constexpr std::array<std::pair<unsigned, const char*>, 6> kGripperBits{{{0U, "open"},
                                                                        {1U, "closed"},
                                                                        {2U, "paddles move"},
                                                                        {4U, "lift up"},
                                                                        {5U, "lift down"},
                                                                        {6U, "lift moves"}}};

std::string gripper_words(unsigned state) {
  std::string out;
  for (const auto& [bit, word] : kGripperBits)
    if ((state >> bit & 1U) != 0)
      out += (out.empty() ? "" : ", ") + std::string(word);
  return bits(state) + (out.empty() ? "" : " (" + out + ")");
}

}  // namespace

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const Device& device : devices())
    names.emplace_back(device.name);
  return names;
}

DeviceCommand parse_device(const std::vector<std::string>& words) {
  if (words.empty())
    fail("a device", "");
  Words rest(words);
  for (const Device& device : devices())
    if (words[0] == device.name) {
      DeviceCommand out{&device.topic, device.request(rest)};
      rest.end();
      return out;
    }
  throw std::invalid_argument("expected a device (" + joined(device_names()) + ")" +
                              (words[0].empty() ? "" : ", found \"" + words[0] + "\"") +
                              did_you_mean(words[0], device_names()));
}

std::vector<std::vector<std::string>> device_rows(const v1::RobotState& robot,
                                                  const v1::Devices* d) {
  std::vector<std::vector<std::string>> rows{{"device", "shows"}};
  const auto add = [&](const char* name, const std::string& value) {
    rows.push_back({name, value});
  };
  std::string battery = format("%.1f V", robot.battery);
  if (d != nullptr && d->has_charge)
    battery += format(", %.0f %% charged", d->charge * 100.0);
  if (d != nullptr && d->charging != 0)
    battery += ", charging";
  add("battery", battery);
  if (d != nullptr && d->has_flags)
    add("motors", std::string(d->motors_on ? "on" : "off") +
                      (d->emergency_stop ? ", EMERGENCY STOP PRESSED" : ""));
  else
    add("motors", robot.status == v1::MOTORS_NO_POWER ? "off" : "on");
  // Rounded to tens: the sonar of the last turn is no news.
  const unsigned rate = (robot.sonar_readings_per_s + 5U) / 10U * 10U;
  add("sonar", rate == 0 ? "silent" : "about " + std::to_string(rate) + " readings/s");
  add("servo",
      std::to_string(robot.ptu) + " us" +
          (robot.head == 0.0 ? ""
                             : format(", the cameras look to %.0f degrees", degrees(robot.head))));
  add("digital input", bits(robot.digital_input));
  add("digital output", bits(robot.digital_output));
  add("analog", format("%.2f V", robot.analog * 5.0 / 255.0));
  add("timer", std::to_string(robot.timer));
  if (d == nullptr)
    return rows;
  if (d->front_bumpers != 0 || d->rear_bumpers != 0)
    add("bumpers", "front " + bits(d->front_bumpers) + " rear " + bits(d->rear_bumpers));
  if (d->has_gripper || d->gripper_state != 0)
    add("gripper", gripper_words(d->gripper_state));
  if (d->has_io) {
    add("inputs", list(d->digital_inputs, true));
    add("outputs", list(d->digital_outputs, true));
    add("analogs", list(d->analog_inputs, false));
  }
  if (d->has_encoders)
    add("encoders",
        std::to_string(d->left_encoder) + " " + std::to_string(d->right_encoder) + " ticks");
  if (d->has_compass)
    add("compass", format("%.0f deg", degrees(d->compass)));
  if (d->has_temperature)
    add("temperature", format("%.0f C", d->temperature));
  if (d->faults != 0)
    add("faults", bits(d->faults >> 8U) + " " + bits(d->faults & 0xFFU));
  if (d->has_configuration)
    add("controller", "serial number " + d->serial_number +
                          (d->firmware.empty() ? "" : ", firmware " + d->firmware) + ", watchdog " +
                          std::to_string(d->watchdog) + " ms");
  for (const v1::PacketCount& packets : d->unread_packets)
    add("unread packets", format("0x%02X: ", packets.type) + std::to_string(packets.count));
  for (const v1::DeviceRequest& request : d->requests)
    add("request", request.answer.text + " (" + request.source + ")");
  return rows;
}

}  // namespace saphira::cli

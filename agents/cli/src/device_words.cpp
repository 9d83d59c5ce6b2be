#include "saphira/cli/device_words.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "saphira/geometry/pose.hpp"

namespace saphira::cli {

const char* const kDeviceWords =
    "  servo WIDTH                    pulse width [us]\n"
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
    "  serial PORT TEXT|0xHEX... [--answer N]\n";

namespace {

constexpr std::array kGripperWords{"open",  "close",  "stop", "up",       "down", "lift-stop",
                                   "store", "deploy", "halt", "pressure", "carry"};

[[noreturn]] void fail(const std::string& expected, const std::string& found) {
  throw std::invalid_argument("expected " + expected +
                              (found.empty() ? "" : ", found \"" + found + "\""));
}

long whole(const std::string& word, long low, long high, const std::string& what) {
  const bool hex = word.starts_with("0x") || word.starts_with("0X");
  const char* begin = word.data() + (hex ? 2 : 0);
  const char* end = word.data() + word.size();
  long value = 0;
  const auto [at, error] = std::from_chars(begin, end, value, hex ? 16 : 10);
  if (error != std::errc{} || at != end || value < low || value > high)
    fail(what + " in " + std::to_string(low) + ".." + std::to_string(high), word);
  return value;
}

std::uint8_t byte(const std::string& word, const std::string& what, long high = 255) {
  return static_cast<std::uint8_t>(whole(word, 0, high, what));
}

bool on_off(const std::string& word) {
  if (word != "on" && word != "off")
    fail("on or off", word);
  return word == "on";
}

/// The words behind the device, each taken once.
class Words {
 public:
  explicit Words(const std::vector<std::string>& words) : words_(words) {}
  bool more() const { return at_ < words_.size(); }
  std::string next(const std::string& what) {
    if (!more())
      fail(what, "");
    return words_[at_++];
  }
  void end() const {
    if (more())
      fail("nothing more", words_[at_]);
  }

 private:
  const std::vector<std::string>& words_;
  std::size_t at_ = 1;
};

v1::GripperCommand gripper(Words& words) {
  v1::GripperCommand out;
  const std::string word = words.next("what the gripper is to do");
  for (std::size_t i = 0; i < kGripperWords.size(); ++i) {
    if (word != kGripperWords.at(i))
      continue;
    out.action(static_cast<v1::GripperAction>(i));
    if (out.action() >= v1::GRIPPER_PRESSURE)
      out.value(static_cast<std::uint16_t>(whole(words.next("a value"), 0, 0xFFFF, "a value")));
    return out;
  }
  out.action(v1::GRIPPER_NUMBER);
  out.value(static_cast<std::uint16_t>(
      whole(word, 0, 0xFFFF,
            "open, close, stop, up, down, lift-stop, store, deploy, halt, "
            "pressure, carry, or a number")));
  return out;
}

v1::SoundCommand sound(Words& words) {
  v1::SoundCommand out;
  const std::string first = words.next("the number of a sound, or tones as SECONDS:PITCH");
  if (first.find(':') == std::string::npos) {
    out.stored(byte(first, "the number of a sound"));
    return out;
  }
  for (std::string word = first;; word = words.next("a tone")) {
    const std::size_t colon = word.find(':');
    v1::Tone tone;
    double seconds = 0.0;
    const auto [at, error] =
        std::from_chars(word.data(), word.data() + std::min(colon, word.size()), seconds);
    if (colon == std::string::npos || error != std::errc{} || at != word.data() + colon ||
        !(seconds >= 0.02 && seconds <= 5.1))
      fail("a tone as SECONDS:PITCH, such as 0.5:60, of 0.02 to 5.1 s", word);
    tone.duration(seconds);
    tone.pitch(byte(word.substr(colon + 1), "a pitch"));
    out.tones().push_back(tone);
    if (!words.more())
      break;
  }
  if (out.tones().size() > 20)
    fail("at most 20 tones", std::to_string(out.tones().size()));
  return out;
}

v1::ServerCommand report(Words& words) {
  v1::ServerCommand out;
  const std::string what = words.next("configuration, encoders, io or gripper");
  if (what == "configuration") {
    out.action(v1::SERVER_REPORT_CONFIGURATION);
    return out;
  }
  if (what == "encoders")
    out.action(v1::SERVER_REPORT_ENCODERS);
  else if (what == "io")
    out.action(v1::SERVER_REPORT_IO);
  else if (what == "gripper")
    out.action(v1::SERVER_REPORT_GRIPPER);
  else
    fail("configuration, encoders, io or gripper", what);
  const std::string often = words.more() ? words.next("") : "once";
  if (often != "off" && often != "once" && often != "always")
    fail("off, once or always", often);
  out.value(often == "off"    ? v1::REPORT_OFF
            : often == "once" ? v1::REPORT_ONCE
                              : v1::REPORT_ALWAYS);
  return out;
}

v1::SerialCommand serial(Words& words) {
  v1::SerialCommand out;
  out.port(static_cast<std::uint8_t>(whole(words.next("a port"), 1, 3, "a port")));
  while (words.more()) {
    const std::string word = words.next("");
    if (word == "--answer") {
      out.answer(byte(words.next("a number of bytes"), "a number of bytes"));
    } else if (word.starts_with("0x")) {
      if (word.size() % 2 != 0)
        fail("two digits a byte", word);
      for (std::size_t i = 2; i < word.size(); i += 2)
        out.data().push_back(byte("0x" + word.substr(i, 2), "a byte"));
    } else {
      for (const char c : word)
        out.data().push_back(static_cast<std::uint8_t>(c));
    }
  }
  if (out.data().size() > 180)
    fail("at most 180 bytes", std::to_string(out.data().size()));
  if (out.data().empty() && out.answer() == 0)
    fail("what is to be sent", "");
  return out;
}

DeviceCommand parse(const std::string& device, Words& words) {
  if (device == "servo") {
    v1::ServoCommand out;
    out.width(static_cast<std::uint16_t>(
        whole(words.next("a pulse width [us]"), 0, 0xFFFF, "a pulse width [us]")));
    return out;
  }
  if (device == "gripper")
    return gripper(words);
  if (device == "output") {
    v1::DigitalOutputCommand out;
    out.bits(byte(words.next("bits"), "bits"));
    out.mask(words.more() ? byte(words.next(""), "a mask") : std::uint8_t{0xFF});
    return out;
  }
  if (device == "analog") {
    v1::AnalogCommand out;
    out.port(byte(words.next("a port"), "a port"));
    return out;
  }
  if (device == "timer") {
    v1::TimerCommand out;
    out.pin(byte(words.next("a pin"), "a pin", 7));
    return out;
  }
  if (device == "sonar") {
    v1::SonarCommand out;
    out.on(on_off(words.next("on or off")));
    while (out.on() && words.more())
      out.polling().push_back(byte(words.next(""), "a sonar", 63));
    if (out.polling().size() > 12)
      fail("at most 12 sonars", std::to_string(out.polling().size()));
    return out;
  }
  if (device == "sound")
    return sound(words);
  if (device == "report")
    return report(words);
  if (device == "serial")
    return serial(words);
  v1::ServerCommand out;
  if (device == "motors") {
    out.action(v1::SERVER_MOTORS);
    out.value(on_off(words.next("on or off")) ? 1 : 0);
  } else if (device == "origin") {
    out.action(v1::SERVER_SET_ORIGIN);
  } else if (device == "bumpers") {
    out.action(v1::SERVER_BUMP_STALL);
    out.value(byte(words.next("0..3"), "which bumpers", 3));
  } else {
    fail(
        "a device (servo, gripper, output, analog, timer, sonar, sound, motors, origin, bumpers, "
        "report, serial)",
        device);
  }
  return out;
}

std::string text(const char* format, double value) {
  std::array<char, 64> out{};
  std::snprintf(out.data(), out.size(), format, value);
  return out.data();
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

DeviceCommand parse_device(const std::vector<std::string>& words) {
  if (words.empty())
    fail("a device", "");
  Words rest(words);
  DeviceCommand out = parse(words[0], rest);
  rest.end();
  return out;
}

std::string describe(const v1::DeviceRequest& request) {
  std::string out = request.text().empty() ? "the command" : request.text();
  switch (request.state()) {
    case v1::REQUEST_SENDING:
      out += ": sent " + std::to_string(request.sent()) + " times, not shown yet";
      break;
    case v1::REQUEST_SHOWN:
      out += ": the robot shows it";
      break;
    case v1::REQUEST_SENT:
      out += ": sent; no packet of this robot would show it";
      break;
    case v1::REQUEST_GIVEN_UP:
      out += ": given up after " + std::to_string(request.sent()) + " times; " + request.reason();
      break;
    case v1::REQUEST_REFUSED:
      out += ": refused; " + request.reason();
      break;
    case v1::REQUEST_LOST:
      out += ": " + request.reason();
      break;
  }
  return out;
}

std::vector<std::vector<std::string>> device_rows(const v1::RobotState& robot,
                                                  const std::optional<v1::Devices>& devices) {
  std::vector<std::vector<std::string>> rows{{"device", "shows"}};
  const auto add = [&](const char* name, const std::string& value) {
    rows.push_back({name, value});
  };
  const auto& d = devices;
  std::string battery = text("%.1f V", robot.battery());
  if (d && d->has_charge())
    battery += text(", %.0f %% charged", d->charge() * 100.0);
  if (d && d->charging() != 0)
    battery += ", charging";
  add("battery", battery);
  if (d && d->has_flags())
    add("motors", std::string(d->motors_on() ? "on" : "off") +
                      (d->emergency_stop() ? ", EMERGENCY STOP PRESSED" : ""));
  else
    add("motors", robot.status() == v1::MOTORS_NO_POWER ? "off" : "on");
  // To tens: which sonar's turn falls into the second is no news.
  const unsigned rate = (robot.sonar_readings_per_s() + 5U) / 10U * 10U;
  add("sonar", rate == 0 ? "silent" : "about " + std::to_string(rate) + " readings/s");
  add("servo", std::to_string(robot.ptu()) + " us");
  add("digital input", bits(robot.digital_input()));
  add("digital output", bits(robot.digital_output()));
  add("analog", text("%.2f V", robot.analog() * 5.0 / 255.0));
  add("timer", std::to_string(robot.timer()));
  if (!d)
    return rows;
  if (d->front_bumpers() != 0 || d->rear_bumpers() != 0)
    add("bumpers", "front " + bits(d->front_bumpers()) + " rear " + bits(d->rear_bumpers()));
  if (d->has_gripper() || d->gripper_state() != 0)
    add("gripper", gripper_words(d->gripper_state()));
  if (d->has_io()) {
    add("inputs", list(d->digital_inputs(), true));
    add("outputs", list(d->digital_outputs(), true));
    add("analogs", list(d->analog_inputs(), false));
  }
  if (d->has_encoders())
    add("encoders",
        std::to_string(d->left_encoder()) + " " + std::to_string(d->right_encoder()) + " ticks");
  if (d->has_compass())
    add("compass", text("%.0f deg", degrees(d->compass())));
  if (d->has_temperature())
    add("temperature", text("%.0f C", d->temperature()));
  if (d->faults() != 0)
    add("faults", bits(d->faults() >> 8U) + " " + bits(d->faults() & 0xFFU));
  if (d->has_configuration())
    add("controller", "serial number " + d->serial_number() +
                          (d->firmware().empty() ? "" : ", firmware " + d->firmware()) +
                          ", watchdog " + std::to_string(d->watchdog()) + " ms");
  for (const v1::PacketCount& packets : d->unread_packets()) {
    std::array<char, 16> type{};
    std::snprintf(type.data(), type.size(), "0x%02X", packets.type());
    add("unread packets", std::string(type.data()) + ": " + std::to_string(packets.count()));
  }
  for (const v1::DeviceRequest& request : d->requests())
    add("request", describe(request) + " (" + request.source() + ")");
  return rows;
}

}  // namespace saphira::cli

// The requests of requests.txt: the test is their asker and the robot.
#include <gtest/gtest.h>

#include "arguments.hpp"
#include "lines.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/text.hpp"
#include "saphira/reflector/devices.hpp"
#include "trouble.hpp"

namespace saphira::reflector {
namespace {

using protocol::Command;

/// "output bits=6"; yes and no are truths.
Request request_of(std::istringstream& in) {
  Request request;
  std::string arguments;
  std::getline(in >> request.functor, arguments);
  request.arguments = saphira::test::arguments_of(arguments);
  for (Argument& argument : request.arguments)
    if (argument.text == "yes" || argument.text == "no")
      argument = Argument(argument.name, argument.text == "yes");
  request.source = "test";
  request.asker = 7;
  return request;
}

/// As the bridge checks a request. Throws std::invalid_argument with the mistake.
Request checked(Request request) {
  for (const Device device : kEnumerators<Device>) {
    const auto refused = refusal(functors(device), request);
    if (refused && refused->code == AnswerCode::unknown_functor)
      continue;
    if (refused)
      throw std::invalid_argument(refused->text);
    EXPECT_EQ(wish_of(request, {}, 0).device, device);
    return request;
  }
  throw std::invalid_argument("unknown");
}

/// The meaning of the request, or its error.
std::string meant(const Request& request) {
  try {
    return wish_of(checked(request), {}, 0).text;
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

/// As it is sent: its name, and its argument; a string that cannot be printed byte by byte.
std::string in_words(const Command& command) {
  const protocol::Bytes packet = protocol::encode(command);
  std::string words(protocol::rule(packet.at(3))->name);
  if (packet.size() < 7)
    return words;
  if (packet.at(4) != 0x2B)
    return words + (packet[4] == 0x1B ? " -" : " ") + std::to_string(packet[5] | packet[6] << 8);
  // Its end is a NUL; otherwise its length comes first.
  const bool ends = packet[3] == static_cast<std::uint8_t>(protocol::Number::kPolling);
  const protocol::Bytes text(packet.begin() + (ends ? 5 : 6), packet.end() - (ends ? 3 : 2));
  if (std::ranges::all_of(text, [](std::uint8_t byte) { return byte > ' '; }))
    return words + " " + std::string(text.begin(), text.end());
  return words + " " + joined(text, " ", [](std::uint8_t byte) { return std::to_string(byte); });
}

/// One case.
class Asker : public saphira::test::LinePlayer {
 public:
  Asker() {
    devices_.connect();
    events_ = {ON("robot", robot(in)),
               ON("shows", shows(in)),
               ON("deadline", deadline_ = read<double>(in)),
               ON("room", room_ = read<std::size_t>(in)),
               ON("ask", ask(in)),
               ON("begin", devices_.begin(parameters_)),
               ON("connect", devices_.connect()),
               ON("cycles", cycles(read<int>(in))),
               ON("hears", hears(in)),
               {"means", [](auto& in) { means(in); }}};
    facts_ = {IS("sent", sent()),
              IS("answers", answers()),
              IS("changed", yes(devices_.take_changed())),
              IS("troubles", joined(devices_.take_troubles(), " | ")),
              IS("firmware", devices_.reports().configuration->firmware),
              IS("unread", std::to_string(devices_.reports().unread.at(0x9A)))};
  }

 private:
  void robot(std::istringstream& in) {
    for (std::string word; in >> word;) {
      const std::size_t sign = std::min(word.find('='), word.size() - 1);
      const std::string name = word.substr(0, sign);
      const double value = std::stod(word.substr(sign + 1));
      if (name == "generation")
        parameters_.protocol = static_cast<protocol::Protocol>(std::lround(value));
      else if (name == "head")
        parameters_.head_reach = radians(value);
      else if (name == "stops")
        parameters_.stop_deceleration = value;
      else if (name == "stops-turning")
        parameters_.stop_rotation_deceleration = value;
      else if (name == "sonars")
        for (std::uint8_t i = 0; i < value; ++i)
          parameters_.sonars.push_back({i, {}});
      else
        throw std::invalid_argument("not understood: " + name);
    }
  }
  /// In its packets.
  void shows(std::istringstream& in) {
    const auto what = read<std::string>(in);
    const auto value = static_cast<std::uint16_t>(read<unsigned>(in));
    if (what == "output")
      packet_.digital_output = static_cast<std::uint8_t>(value);
    else if (what == "servo" || what == "flags")
      packet_.ptu = value;
    else if (what == "port")
      packet_.timer = value;
    else if (what == "origin")
      origin_ = value != 0;
    else
      throw std::invalid_argument("not understood: " + what);
  }
  void ask(std::istringstream& in) {
    Request request = request_of(in);
    request.number = ++number_;
    request.deadline = deadline_;
    devices_.request(checked(request), parameters_);
  }
  void cycles(int count) {
    for (; count > 0; --count) {
      devices_.reflect(packet_, protocol::interpret(packet_, parameters_), origin_);
      for (const Command& command : devices_.due(now_ += 0.1, room_))
        sent_.push_back(in_words(command));
    }
  }
  void hears(std::istringstream& in) {
    if (read<std::string>(in) == "unknown")
      return devices_.reflect(protocol::OtherPacket{0x9A, {}}, 0x9A);
    protocol::ConfigPacket configuration{.firmware = "1.9"};
    devices_.reflect(configuration, static_cast<std::uint8_t>(protocol::PacketType::kConfig));
  }
  /// "means REQUEST => its meaning, or the error; ... at its end is any end".
  static void means(std::istringstream& in) {
    const std::string line = rest(in);
    const std::size_t arrow = line.find(" => ");
    std::string wanted = line.substr(arrow + 4);
    std::istringstream request(line.substr(0, arrow));
    std::string is = meant(request_of(request));
    if (wanted.ends_with("..."))
      is = is.substr(0, wanted.size() - 3) + "...";
    EXPECT_EQ(is, wanted);
  }
  /// Since the last time, in the order of the first; how often in front.
  std::string sent() {
    std::vector<std::string> words;
    for (const std::string& each : sent_)
      if (std::ranges::find(words, each) == words.end())
        words.push_back(each);
    const std::vector<std::string> all = std::exchange(sent_, {});
    return joined(words, ", ", [&](const std::string& each) {
      return std::to_string(std::ranges::count(all, each)) + " " + each;
    });
  }
  std::string answers() const {
    return joined(devices_.requests(), " | ", [](const DeviceRequest& request) {
      const auto code = static_cast<std::size_t>(request.answer.code);
      return std::string(kEnumeratorNames<AnswerCode>.at(code)) + ", " + request.answer.text;
    });
  }

  protocol::RobotParameters parameters_;
  Devices devices_;
  protocol::InformationPacket packet_;
  bool origin_ = false;
  double now_ = 0.0;
  double deadline_ = 0.0;
  std::size_t room_ = SIZE_MAX;
  std::uint64_t number_ = 0;
  std::vector<std::string> sent_;
};

TEST(Requests, AreBounded) {
  const auto trouble = [](const Request& request) {
    return saphira::test::trouble([&] { wish_of(request, {}, 0); });
  };
  EXPECT_EQ(trouble({"serial", {{"port", 1.0}, {"data", std::string(362, '0')}}}),
            "serial: expected at most 180 bytes, found 181");
  Request many{"sonar", {{"on", true}}};
  for (int i = 0; i < 13; ++i)
    many.arguments.emplace_back("sonar", 1.0);
  EXPECT_EQ(trouble(many), "sonar: expected at most 12 sonars in the polling sequence, found 13");
}

TEST(Requests, AreDocumented) {
  const std::string text = read_file(saphira::test::source("docs/requests.md"));
  for (const Device device : kEnumerators<Device>)
    EXPECT_NE(text.find(help(functors(device))), std::string::npos) << help(functors(device));
}

TEST(Requests, AreAnsweredAsWritten) {
  EXPECT_EQ(saphira::test::play<Asker>("bridge/reflector/test/requests.txt"), 20);
}

}  // namespace
}  // namespace saphira::reflector

#include "saphira/reflector/wishes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "process.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/text.hpp"

namespace saphira::reflector {
namespace {

/// The meaning of the request, or its error.
std::string meant(Request request) {
  for (const Device device : kEnumerators<Device>) {
    const auto refused = refusal(functors(device), request);
    if (refused && refused->code == AnswerCode::unknown_functor)
      continue;
    if (refused)
      return refused->text;
    try {
      const Wish wish = wish_of(request);
      EXPECT_EQ(wish.index(), static_cast<std::size_t>(device));
      return text(wish);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }
  return "unknown";
}

TEST(Wishes, AreMadeOfRequests) {
  EXPECT_EQ(meant({"servo", {{"width", 1500.0}}}), "servo 1500 us");
  EXPECT_EQ(meant({"gripper", {{"action", std::string("lift down")}}}), "gripper lift down");
  EXPECT_EQ(meant({"gripper", {{"action", std::string("carry")}, {"value", 50.0}}}),
            "gripper carry 50");
  EXPECT_EQ(meant({"output", {{"bits", 90.0}}}), "output 0x5A");
  EXPECT_EQ(meant({"output", {{"bits", 1.0}, {"mask", 1.0}}}), "output 0x01 mask 0x01");
  EXPECT_EQ(meant({"analog", {{"port", 3.0}}}), "analog 3");
  EXPECT_EQ(meant({"timer", {{"pin", 7.0}}}), "timer 7");
  EXPECT_EQ(meant({"sonar", {{"on", true}, {"sonar", 5.0}, {"sonar", 0.0}}}), "sonar on 5 0");
  EXPECT_EQ(meant({"sonar", {{"on", false}}}), "sonar off");
  EXPECT_EQ(meant({"sound", {{"stored", 4.0}}}), "sound 4");
  EXPECT_EQ(meant({"tones", {{"duration", 0.5}, {"pitch", 60.0}}}), "sound of 1 tones");
  EXPECT_EQ(meant({"set_origin"}), "set origin");
  EXPECT_EQ(meant({"motors", {{"on", true}}}), "motors 1");
  EXPECT_EQ(meant({"bump_stall", {{"value", 3.0}}}), "bump stall 3");
  EXPECT_EQ(meant({"report", {{"packet", std::string("configuration")}}}), "report configuration");
  EXPECT_EQ(meant({"report", {{"packet", std::string("io")}}}), "report io 1");
  EXPECT_EQ(meant({"report", {{"packet", std::string("gripper")}, {"often", std::string("off")}}}),
            "report gripper 0");
  EXPECT_EQ(meant({"serial", {{"port", 2.0}, {"data", std::string("8130ff")}}}),
            "serial 2 3 bytes");
  EXPECT_EQ(meant({"say", {{"text", std::string("pioneer_a_mode=1")}}}), "vision pioneer_a_mode=1");
}

TEST(Wishes, OfNumbersAreThoseOfTheRobot) {
  const Wish sound =
      wish_of({"tones", {{"duration", 0.5}, {"pitch", 60.0}, {"duration", 0.02}, {"pitch", 0.0}}});
  EXPECT_EQ(std::get<SoundWish>(sound).tones.at(0).duration, 25);
  EXPECT_EQ(std::get<SoundWish>(sound).tones.at(1).duration, 1);
  const Wish serial =
      wish_of({"serial", {{"port", 3.0}, {"data", std::string("00fF")}, {"answer", 9.0}}});
  EXPECT_EQ(std::get<SerialWish>(serial).data, (std::vector<std::uint8_t>{0, 255}));
  EXPECT_EQ(std::get<SerialWish>(serial).answer, 9);
}

TEST(Wishes, SayWhatWasExpected) {
  EXPECT_EQ(
      meant({"say", {{"text", std::string("pioneer_a_mode=3")}}}).find("say: argument \"text\": "),
      0U);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double wrong : {0.0, -1.0, 6.0, nan})
    EXPECT_NE(meant({"tones", {{"duration", wrong}, {"pitch", 60.0}}}).find("expected a number"),
              std::string::npos);
  EXPECT_EQ(meant({"tones", {{"duration", 0.5}}}),
            "tones: expected 1 to 20 durations and as many pitches, found 1 and 0");
  EXPECT_EQ(meant({"timer", {{"pin", 9.0}}}),
            "timer: argument \"pin\": expected a whole number from 0 to 7 (of the user input), "
            "found 9");
  EXPECT_NE(meant({"gripper", {{"action", std::string("wave")}}}).find("carry or number"),
            std::string::npos);
  EXPECT_NE(meant({"motors", {{"on", 2.0}}}).find("expected yes or no (on or off), found 2"),
            std::string::npos);
  EXPECT_NE(meant({"serial", {{"port", 0.0}}}).find("from 1 to 3"), std::string::npos);
  for (const char* const wrong : {"1", "123", "0x", "1g", " 1", "-1"})
    EXPECT_NE(meant({"serial", {{"port", 1.0}, {"data", std::string(wrong)}}})
                  .find("two hexadecimal digits"),
              std::string::npos)
        << wrong;
  EXPECT_EQ(meant({"serial", {{"port", 1.0}, {"data", std::string(362, '0')}}}),
            "serial: expected at most 180 bytes, found 181");
  Request many{"sonar", {{"on", true}}};
  for (int i = 0; i < 13; ++i)
    many.arguments.emplace_back("sonar", 1.0);
  EXPECT_EQ(meant(many), "sonar: expected at most 12 sonars in the polling sequence, found 13");
}

TEST(Wishes, AreDocumented) {
  const std::string text = read_file(test::source("docs/requests.md"));
  for (const Device device : kEnumerators<Device>)
    EXPECT_NE(text.find(help(functors(device))), std::string::npos) << help(functors(device));
}

}  // namespace
}  // namespace saphira::reflector

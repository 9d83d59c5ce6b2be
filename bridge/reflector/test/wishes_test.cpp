#include "saphira/reflector/wishes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "process.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira::reflector {
namespace {

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

TEST(Wishes, AreBounded) {
  const auto trouble = [](const Request& request) {
    return test::trouble([&] { wish_of(request); });
  };
  EXPECT_EQ(trouble({"serial", {{"port", 1.0}, {"data", std::string(362, '0')}}}),
            "serial: expected at most 180 bytes, found 181");
  Request many{"sonar", {{"on", true}}};
  for (int i = 0; i < 13; ++i)
    many.arguments.emplace_back("sonar", 1.0);
  EXPECT_EQ(trouble(many), "sonar: expected at most 12 sonars in the polling sequence, found 13");
  Request never{"tones", {{"duration", std::nan("")}, {"pitch", 60.0}}};
  const auto refused = refusal(functors(Device::sound), never);
  ASSERT_TRUE(refused);
  EXPECT_NE(refused->text.find("expected a number"), std::string::npos) << refused->text;
}

TEST(Wishes, AreDocumented) {
  const std::string text = read_file(test::source("docs/requests.md"));
  for (const Device device : kEnumerators<Device>)
    EXPECT_NE(text.find(help(functors(device))), std::string::npos) << help(functors(device));
}

}  // namespace
}  // namespace saphira::reflector

// Requests to the devices, and their reports.

#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::bridge::test {
namespace {

using authority::Role;

Request servo(std::uint64_t number, double width) {
  return {.functor = "servo",
          .arguments = {saphira::number("width", width)},
          .source = "a person",
          .number = number};
}

std::optional<Answer> ask(Scene& scene, const Request& request) {
  std::optional<Answer> outcome = scene.core.request(request, scene.now);
  scene.answer();
  return outcome;
}

TEST(DevicesOfTheCore, WhatIsAskedForIsUnderWayAndSent) {
  Driven scene;
  EXPECT_EQ(ask(scene, servo(4, 1500)), std::nullopt);
  const auto answered = scene.all<LaterAnswer>();
  ASSERT_EQ(answered.size(), 1U);
  EXPECT_EQ(answered[0].number, 4U);
  EXPECT_EQ(answered[0].device, reflector::Device::servo);
  EXPECT_EQ(answered[0].answer, (Answer{AnswerCode::underway, "servo 1500 us: not shown yet"}));
  const auto told = scene.all<DevicesChanged>();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].stamp, scene.core.stamp());
  ASSERT_FALSE(told[0].requests.empty());
  EXPECT_EQ(told[0].requests[0].source, "a person");
  scene.cycles(1, Role::behaviors);
  EXPECT_TRUE(scene.was_sent(protocol::Ptu{1500}));
}

TEST(DevicesOfTheCore, TheEndOfAStopHasItsRequestsNumber) {
  Driven scene;
  for (const std::uint64_t number : {7, 0})  // 0: of an asker that does not count
    scene.core.request({.functor = "stop", .source = "a person", .number = number}, scene.now);
  scene.cycles(10, Role::behaviors);
  const auto ends = scene.all<LaterAnswer>();
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[0].number, 7U);
  EXPECT_EQ(ends[1].number, 0U);
  EXPECT_EQ(ends[1].device, std::nullopt);
}

TEST(DevicesOfTheCore, WithoutARobotThereIsNobodyToDoIt) {
  Scene scene;
  EXPECT_EQ(ask(scene, servo(4, 1500)), (Answer{AnswerCode::nobody, "no robot is connected"}));
  EXPECT_FALSE(scene.has<LaterAnswer>());
}

TEST(DevicesOfTheCore, WhatDoesNotFitTogetherIsRefused) {
  Driven scene;
  const Request tones{"tones", {number("duration", 0.1)}};
  EXPECT_EQ(ask(scene, tones).value().code, AnswerCode::bad_argument);
}

TEST(DevicesOfTheCore, ANewerRequestTakesThePlaceOfAnOlderOne) {
  Driven scene;
  ask(scene, servo(4, 1500));
  scene.forget();
  ask(scene, servo(5, 1600));
  const auto told = scene.all<LaterAnswer>();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].number, 4U);
  EXPECT_EQ(told[0].answer,
            (Answer{AnswerCode::lost, "servo 1500 us: a request of a person took its place"}));
  EXPECT_EQ(told[1].number, 5U);
}

TEST(DevicesOfTheCore, TheVisionSystemIsAskedWhereItIsUsed) {
  const Request mode{"say", {text("text", "pioneer_a_mode=2")}};
  Driven without;
  EXPECT_EQ(ask(without, mode).value().code, AnswerCode::refused);
  Scene scene({.vision = true});
  scene.connect();
  EXPECT_EQ(ask(scene, mode), std::nullopt);
  ASSERT_TRUE(scene.has<VisionSet>());
  EXPECT_EQ(scene.all<VisionSet>()[0].text, "pioneer_a_mode=2");
}

TEST(DevicesOfTheCore, PacketsThatNobodyReadsAreToldOnce) {
  Driven scene;
  const auto news = [&] {
    scene.forget();
    scene.say(protocol::frame(protocol::Bytes{0x9A, 0}));
    scene.pass(0.01);
    scene.answer();
    return scene.all<DevicesChanged>().size();
  };
  EXPECT_EQ(news(), 1U);
  EXPECT_EQ(scene.all<DevicesChanged>()[0].reports.unread.at(0x9A), 1U);
  EXPECT_EQ(news(), 0U) << "their number alone is no news";
}

TEST(DevicesOfTheCore, ARobotOfAnotherCycleIsToldOnce) {
  Driven scene;
  protocol::ConfigPacket set{.serial = "P3", .cycle = 50};
  for (int i = 0; i < 2; ++i) {
    scene.say(protocol::encode(set));
    scene.pass(0.05);
  }
  const std::vector<Note> notes = scene.all<Note>();
  for (const std::string text : {"the robot's serial number is P3", "set its SInfoCycle to 100"})
    EXPECT_EQ(
        std::count_if(notes.begin(), notes.end(),
                      [&](const Note& note) { return note.text.find(text) != std::string::npos; }),
        1)
        << text;
}

}  // namespace
}  // namespace saphira::bridge::test

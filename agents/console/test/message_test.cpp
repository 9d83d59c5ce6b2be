#include "saphira/console/message.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "trouble.hpp"

namespace saphira::console {
namespace {

std::string wrong(std::string_view text) {
  const Message message = parse_message(text);
  const auto* const why = std::get_if<Wrong>(&message);
  return why == nullptr ? "" : why->why;
}

template <class Kind>
Kind read(const char* text) {
  return std::get<Kind>(parse_message(text));
}

TEST(Message, EachKindIsRead) {
  const auto sample = read<teleop::Control::Sample>(
      R"({"type":"drive","number":7,"at":1.5,"active":true,"velocity":-0.1,"rotation":0.2,"cycle":9})");
  EXPECT_EQ(sample.number, 7U);
  EXPECT_DOUBLE_EQ(sample.device_time, 1.5);
  EXPECT_TRUE(sample.active);
  EXPECT_DOUBLE_EQ(sample.velocity, -0.1);
  EXPECT_DOUBLE_EQ(sample.rotation, 0.2);
  EXPECT_EQ(sample.cycle, 9U);
  EXPECT_EQ(read<Hello>(R"({"type":"hello","key":"k","name":"ann"})").name, "ann");
  EXPECT_EQ(read<Hello>(R"({"type":"hello","key":"k","name":"ann","ticket":"t"})").ticket, "t");
  EXPECT_EQ(read<Ack>(R"({"type":"ack","frame":3})").frame, 3U);
  EXPECT_TRUE(read<TakeControl>(R"({"type":"take","force":true})").force);
  EXPECT_EQ(read<Rename>(R"({"type":"rename","name":"ann"})").name, "ann");
  EXPECT_EQ(read<Say>(R"({"type":"say","text":"hello"})").text, "hello");
  read<AskForControl>(R"({"type":"ask"})");
  EXPECT_EQ(read<GiveControl>(R"({"type":"give","to":7})").to, 7U);
  EXPECT_NE(wrong(R"({"type":"give"})"), "");
  read<ReleaseControl>(R"({"type":"release"})");
  read<HandBack>(R"({"type":"hand_back"})");
  read<StopRobot>(R"({"type":"stop","reference":1})");
  read<EmergencyStop>(R"({"type":"estop"})");
  read<ResetEmergencyStop>(R"({"type":"estop_reset"})");
  EXPECT_EQ(read<AskGoal>(R"({"type":"goal","reference":1,"words":"go 3 1"})").words, "go 3 1");
  EXPECT_EQ(read<CancelGoal>(R"({"type":"cancel","reference":1,"id":"a:1"})").id, "a:1");
  const auto process = read<AskProcess>(
      R"({"type":"process","reference":1,"service":"s","process":"p","functor":"f"})");
  EXPECT_EQ(process.process, "p");
  EXPECT_EQ(read<ChangeMap>(R"({"type":"map","reference":1,"words":"remove 3"})").words,
            "remove 3");
  EXPECT_TRUE(read<ShowRobots>(R"({"type":"robots","shown":true})").shown);
  EXPECT_EQ(read<StopRobots>(R"({"type":"stop_robots","reference":1,"robot":"b"})").robot, "b");
  EXPECT_EQ(read<SaveMap>(R"({"type":"save_map","reference":4})").reference, 4U);
  const auto piece = read<LoadMap>(
      R"({"type":"load_map","reference":5,"name":"a.map","text":"WALL\n","more":true})");
  EXPECT_EQ(piece.text, "WALL\n");
  EXPECT_TRUE(piece.more);
  EXPECT_FALSE(read<PointOut>(R"({"type":"point_out","x":1,"y":2,"in_map":false})").in_map);
}

TEST(Message, WhatIsNoneSaysWhatWasExpected) {
  for (const char* text : {"", "{", "[]", "7", "null", "\"drive\"", "{}{}", "\xff\xfe"})
    EXPECT_EQ(wrong(text), "expected one JSON object") << text;
  EXPECT_EQ(wrong("{}"), "\"type\" is missing");
  EXPECT_EQ(wrong(R"({"type":"fly"})"), "\"type\" is not known: fly");
  EXPECT_NE(wrong(R"({"type":"ack","frame":-1})"), "");
  EXPECT_NE(wrong(R"({"type":"ack","frame":1.5})"), "");
  EXPECT_NE(wrong(R"({"type":"take","force":1})"), "");
  EXPECT_NE(wrong(R"({"type":"ping","at":1e999})"), "");
  EXPECT_NE(wrong(R"({"type":"goal","reference":1,"words":7})"), "");
  EXPECT_NE(wrong(R"({"type":"hello","key":"k","name":")" + std::string(100, 'x') + "\"}"), "");
}

TEST(Message, DeepNestingIsNoTrouble) {
  EXPECT_NE(wrong(std::string(4000, '[')), "");
  EXPECT_NE(wrong(R"({"type":)" + std::string(1000, '[') + std::string(1000, ']') + "}"), "");
}

TEST(Message, TheWordsOfAGoal) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(words_of(""), Words{});
  EXPECT_EQ(words_of("  go\t3\n 1 "), (Words{"go", "3", "1"}));
  EXPECT_EQ(words_of(R"(go-to-place place="meeting room" speed=0.2)"),
            (Words{"go-to-place", "place=meeting room", "speed=0.2"}));
  EXPECT_EQ(words_of(R"(go "meeting room")"), (Words{"go", "meeting room"}));
  EXPECT_EQ(words_of(R"(a="" "")"), (Words{"a=", ""}));
  EXPECT_EQ(words_of(R"(a="the \"big\" room" b="c:\\d e")"),
            (Words{R"(a=the "big" room)", R"(b=c:\d e)"}));
  EXPECT_EQ(words_of(R"(a=c:\d b=Karen's)"), (Words{R"(a=c:\d)", "b=Karen's"}));
  EXPECT_EQ(test::trouble_of<std::invalid_argument>([] { words_of(R"(go "meeting room)"); }),
            R"(expected a closing " behind "meeting room)");
}

TEST(Message, ThePagesGetTheStateOfControl) {
  EXPECT_EQ(to_json({3, "ann", {{4, "\"bob\""}}, "ann took control", ""}),
            R"({"asked":[{"id":4,"name":"\"bob\""}],"holder":3,"let_go":"","name":"ann",)"
            R"("note":"ann took control"})");
}

TEST(Upload, IsWholeWithItsLastPieceAndBeginsAnewWithAnotherFile) {
  Upload upload;
  EXPECT_FALSE(upload.take({1, "a.map", "lost ", true}));
  EXPECT_FALSE(upload.take({2, "a.map", "one ", true}));
  EXPECT_EQ(upload.take({2, "a.map", "two", false}), "one two");
  EXPECT_EQ(upload.take({3, "a.map", "", false}), "");
}

TEST(Upload, IsBounded) {
  Upload upload;
  const std::string piece(3000, 'x');
  int pieces = 0;
  EXPECT_THROW(for (; pieces < 1000; ++pieces) upload.take({1, "a.map", piece, true}),
               std::invalid_argument);
  EXPECT_EQ(pieces, 333);
  EXPECT_EQ(upload.take({1, "a.map", "rest", false}), "rest");
}

TEST(Message, WhoWatchesMayStopAndWhatConcernsOthersIsToOperate) {
  using security::DoorRight;
  for (const Message& message : {Message(StopRobot{}), Message(EmergencyStop{}), Message(Ping{}),
                                 Message(ShowRobots{}), Message(StopRobots{}), Message(SaveMap{})})
    EXPECT_EQ(right_for(message), DoorRight::watch);
  for (const Message& message :
       {Message(teleop::Control::Sample{}), Message(TakeControl{}), Message(AskGoal{}),
        Message(CancelGoal{}), Message(Say{}), Message(HandBack{}), Message(PointOut{})})
    EXPECT_EQ(right_for(message), DoorRight::drive);
  for (const Message& message : {Message(ResetEmergencyStop{}), Message(AskProcess{}),
                                 Message(ChangeMap{}), Message(LoadMap{})})
    EXPECT_EQ(right_for(message), DoorRight::operate);
}

}  // namespace
}  // namespace saphira::console

#include "saphira/cli/talk_words.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

v1::Argument named(const std::string& name, v1::ArgumentKind kind) {
  return {.name = name, .kind = kind};
}

TEST(TalkWords, AnAnswerIsOneObject) {
  v1::Answer answer{.service = "calendar", .code = v1::ANSWER_DONE};
  EXPECT_EQ(to_json(answer), R"({"agent":"calendar","code":"done","text":"","values":{}})");

  v1::Argument place = named("place", v1::ARGUMENT_TEXT);
  place.text = "library";
  v1::Argument open = named("open", v1::ARGUMENT_TRUTH);
  open.number = 1.0;
  v1::Argument position = named("position", v1::ARGUMENT_POINT);
  position.point.x = 1.5;
  position.point.y = -2.0;
  position.frame = v1::FRAME_MAP;
  v1::Argument hour = named("hour", v1::ARGUMENT_NUMBER);
  hour.number = 9.5;
  v1::Argument later = hour;
  later.number = 10.5;
  v1::Argument last = hour;
  last.number = 11.5;
  answer.text = "found";
  answer.results = {place, open, position, hour, later, last, named("who", v1::ARGUMENT_UNBOUND)};
  EXPECT_EQ(to_json(answer),
            R"({"agent":"calendar","code":"done","text":"found","values":{"place":"library",)"
            R"("open":true,"position":{"x":1.5,"y":-2.0,"th":0.0,"frame":"map"},)"
            R"("hour":[9.5,10.5,11.5],"who":null}})");

  v1::Answer refused{
      .service = "calendar", .code = v1::ANSWER_BAD_ARGUMENT, .text = "no such person"};
  EXPECT_EQ(to_json(refused),
            R"({"agent":"calendar","code":"bad_argument","text":"no such person","values":{}})");
}

TEST(TalkWords, TheRobotsActivitiesAreTheLastLine) {
  v1::CapabilityParameter place;
  place.name = "place";
  place.kind = v1::ARGUMENT_UNBOUND;
  place.meaning = "a text";
  v1::CapabilityParameter hour;
  hour.name = "hour";
  hour.kind = v1::ARGUMENT_NUMBER;
  v1::CapabilityParameter anything;
  anything.name = "anything";
  anything.kind = v1::ARGUMENT_UNBOUND;
  v1::Capability capability{
      .functor = "meet", .summary = "meets somebody", .parameters = {place, hour, anything}};
  v1::Agent robot;
  robot.name = "robot";
  robot.capabilities = {capability, capability};
  v1::Agent calendar;
  calendar.name = "calendar";
  calendar.summary = "knows the day";
  calendar.capabilities = {capability};
  EXPECT_EQ(describe({robot, calendar}),
            "calendar  knows the day\n"
            "  meet([place], [hour], [anything])  meets somebody\n"
            "    place: a text\n"
            "    hour: a number\n"
            "robot  2 activities: saphira goal activities lists them\n");
}

TEST(TalkWords, EqualValuesOfTwoAgentsAreTwoAnswers) {
  v1::Answer answer{.service = "calendar", .text = "on its way"};
  EXPECT_TRUE(repeats(answer, answer)) << "it says again that it is at work";
  EXPECT_FALSE(repeats(answer, v1::Answer()));
  answer.results = {named("place", v1::ARGUMENT_TEXT)};
  EXPECT_FALSE(repeats(answer, answer));
}

std::string told(const std::vector<std::string>& words) {
  const v1::Request request = parse_question(words);
  std::string text = request.functor;
  for (const v1::Argument& argument : request.arguments)
    text += " " + argument.name + "=" +
            (argument.kind == v1::ARGUMENT_POINT    ? "point"
             : argument.kind == v1::ARGUMENT_NUMBER ? "number"
             : argument.kind == v1::ARGUMENT_TEXT   ? argument.text
                                                    : "?" + argument.text);
  return text;
}

TEST(TalkWords, SeveralFunctorsAreOneRequest) {
  EXPECT_EQ(told({"place_of", "person=karen", "place=?"}), "place_of person=karen place=?");
  EXPECT_EQ(told({"place_of(person=karen, place=?P)", "go-to-place(dest=?P)"}),
            "place_of person=karen place=?P and=go-to-place dest=?P");
  EXPECT_EQ(told({"where()", "tell(text=I am late, sorry, to=?Who,at=1,2,3,n=4)"}),
            "where and=tell text=I am late, sorry to=?Who at=point n=number");
  EXPECT_EQ(told({"say", "text=how?"}), "say text=how?");
  EXPECT_THROW(told({"place_of(person=karen)", "go-to-place"}), std::invalid_argument);
  EXPECT_THROW(told({"place_of(person)"}), std::invalid_argument);
  EXPECT_THROW(told({"place_of(person=?two words)"}), std::invalid_argument);
}

TEST(TalkWords, SentencesOfBeforeAreNotForAListener) {
  v1::Utterance said{.answers = {.writer = 7}};
  EXPECT_TRUE(is_for(said, 9.0, 7, 2.0)) << "its answer";
  EXPECT_TRUE(is_for(said, 1.9, 8, 2.0));
  EXPECT_FALSE(is_for(said, 2.1, 8, 2.0));
}

TEST(TalkWords, ATriggerHasItsIdAndItsSource) {
  v1::Trigger trigger{.kind = v1::TRIGGER_TIME, .period = 5.0, .action = "note"};
  EXPECT_EQ(describe(trigger, "1f3a:2"), "trigger 1f3a:2 of somebody: every 5 s: note");
  trigger.source = "ann";
  trigger.kind = v1::TRIGGER_EVENT;
  trigger.condition = "door_opened";
  EXPECT_EQ(describe(trigger, "1f3a:2"), "trigger 1f3a:2 of ann: when door_opened happens: note");
  EXPECT_EQ(describe(trigger, "1f3a:2", false),
            "trigger 1f3a:2 of ann: when door_opened happens: note; it fires no more: it has fired "
            "its times, was withdrawn, or its period is below 0.1 s");
  EXPECT_TRUE(is_among("1f3a:2", "1:4 1f3a:2"));
  EXPECT_FALSE(is_among("1f3a:2", "1:4 1f3a:22"));
  EXPECT_FALSE(is_among("1f3a:2", ""));
}

}  // namespace
}  // namespace saphira::cli

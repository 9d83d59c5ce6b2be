#include "saphira/agent_interface/facilitator.hpp"

#include <gtest/gtest.h>

#include "only.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/random.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::uint64_t kSelf = 9;
constexpr std::uint64_t kPerson = 1;

Argument open_slot(const std::string& name) {
  Argument argument;
  argument.name = name;
  argument.kind = ArgumentKind::unbound;
  return argument;
}

AgentInfo agent(std::uint64_t id, const std::string& name, bool acts = false, double cost = 0.0) {
  const Functor place_of{
      "place_of",
      "where a person is",
      {text_parameter("person", "a name"), optional(text_parameter("place", "of the map"))}};
  return {id, name, "address of " + name, {{place_of, acts, cost}}};
}

Request place_of(std::uint64_t number, std::uint64_t asker = kPerson) {
  Request request;
  request.functor = "place_of";
  request.arguments = {text("person", "karen"), open_slot("place")};
  request.source = "a person";
  request.asker = asker;
  request.number = number;
  return request;
}

Request wanting(Request request, double answers) {
  request.arguments.push_back(number("answers", answers));
  return request;
}

Answer library() {
  return {AnswerCode::done, "", {text("place", "library")}};
}

TEST(Facilitators, PassOnNoAnswerThatIsNotAsDeclared) {
  const auto answered = [](const Answer& answer, bool acts) {
    Facilitator facilitator(kSelf);
    facilitator.announce(agent(1, "a", acts));
    facilitator.ask(place_of(1), 0.0);
    facilitator.step(0.0);
    facilitator.hear("address of a", kPerson, 1, answer, 0.1);
    const auto solved = facilitator.step(0.1).solved;
    EXPECT_EQ(solved.size(), 1U);
    return solved.empty() ? Answer{} : solved[0].answer;
  };
  const auto done = [](Arguments results) {
    return Answer{AnswerCode::done, "", std::move(results)};
  };
  EXPECT_EQ(answered(library(), false), library());
  for (const Answer& wrong : {done({number("place", 3.0)}), done({text("room", "library")}),
                              done({text("place",
                                         "lib\xff"
                                         "rary")}),
                              Answer{AnswerCode::done,
                                     "b\xff"
                                     "d",
                                     {}}}) {
    const Answer refused = answered(wrong, false);
    EXPECT_EQ(refused.code, AnswerCode::refused);
    EXPECT_TRUE(refused.results.empty());
    EXPECT_TRUE(refused.text.starts_with("the answer of agent a is not as it has declared: "))
        << refused.text;
    EXPECT_EQ(answered(wrong, true).code, AnswerCode::done) << "an action is done";
    EXPECT_TRUE(answered(wrong, true).results.empty());
  }
}

AgentInfo agent_that_notes() {
  AgentInfo result = agent(1, "a");
  result.capabilities.push_back({{"note", "", {optional(text_parameter("place", ""))}}, true, 0.0});
  return result;
}

Trigger note_place_of_karen() {
  return {{1, 3},
          "ann",
          TriggerKind::data,
          1.0,
          "place_of",
          {text("person", "karen"), open_slot("place")},
          "note",
          {open_slot("place")},
          0};
}

struct Facilitation : testing::Test {
  Facilitator::Outputs ask(const Request& request) {
    facilitator.ask(request, now);
    return facilitator.step(now);
  }
  Facilitator::Outputs hear(const std::string& name, const Request& request, const Answer& answer) {
    facilitator.hear("address of " + name, request.asker, request.number, answer, now);
    return facilitator.step(now);
  }
  Facilitator facilitator{kSelf};
  double now = 100.0;
};

TEST_F(Facilitation, AsksTheCheapestAgentAndSaysWhichOneAnswered) {
  facilitator.announce(agent(1, "calendar", false, 2.0));
  facilitator.announce(agent(2, "badge reader", false, 1.0));
  const auto asked = ask(place_of(5));
  EXPECT_EQ(test::only(asked.requests).service, "address of badge reader");
  EXPECT_EQ(test::only(asked.requests).asker, kPerson);
  const auto solved = test::only(hear("badge reader", place_of(5), library()).solved);
  EXPECT_EQ(solved.service, "badge reader");
  EXPECT_EQ(solved.answer, library());
  EXPECT_EQ(facilitator.open(), 0u);
}

TEST_F(Facilitation, WhatOneAgentRefusesIsAskedOfTheNext) {
  facilitator.announce(agent(1, "a"));
  facilitator.announce(agent(2, "b"));
  ask(place_of(5));
  const auto next = hear("a", place_of(5), {AnswerCode::refused, "no idea", {}});
  EXPECT_EQ(test::only(next.requests).service, "address of b");
  EXPECT_TRUE(next.solved.empty());
  const auto end = hear("b", place_of(5), {AnswerCode::refused, "nor I", {}});
  EXPECT_EQ(test::only(end.solved).answer.text, "nor I");
}

TEST_F(Facilitation, CollectsAnswersOfAllWithTheirOrigin) {
  facilitator.announce(agent(1, "a"));
  facilitator.announce(agent(2, "b"));
  const Request request = wanting(place_of(5), 0.0);
  const auto asked = ask(request);
  ASSERT_EQ(asked.requests.size(), 2u);
  EXPECT_EQ(find(asked.requests[0].arguments, "answers"), nullptr);
  const auto first = test::only(hear("b", request, library()).solved);
  EXPECT_EQ(first.service, "b");
  EXPECT_EQ(first.answer.code, AnswerCode::underway);
  const auto last = hear("a", request, library()).solved;
  ASSERT_EQ(last.size(), 2u);
  EXPECT_EQ(last[1].answer.code, AnswerCode::done);
  EXPECT_EQ(last[1].answer.text, "2 answers");
}

TEST_F(Facilitation, SaysWhatIsNotKnownAndWhatDoesNotFit) {
  facilitator.announce(agent(1, "a"));
  Request request = place_of(1);
  request.functor = "place_off";
  EXPECT_EQ(ask(request).solved.at(0).answer.text,
            "no agent can do \"place_off\": did you mean place_of?");
  request = place_of(2);
  request.arguments[0] = number("person", 3.0);
  const Answer misfit = ask(request).solved.at(0).answer;
  EXPECT_EQ(misfit.code, AnswerCode::bad_argument);
  EXPECT_NE(misfit.text.find("\"person\""), std::string::npos) << misfit.text;
  request = place_of(3);
  request.service = "nobody";
  EXPECT_EQ(ask(request).solved.at(0).answer.text, "there is no agent \"nobody\"");
}

TEST_F(Facilitation, WhatADeadAgentOwedIsAskedOfAnother) {
  facilitator.announce(agent(1, "a"));
  facilitator.announce(agent(2, "b"));
  ask(place_of(5));
  facilitator.leave(1);
  const auto next = facilitator.step(now);
  EXPECT_EQ(test::only(next.requests).service, "address of b");
  facilitator.leave(2);
  const auto end = facilitator.step(now);
  EXPECT_EQ(test::only(end.solved).answer.code, AnswerCode::lost);
  EXPECT_EQ(test::only(end.solved).answer.text, "agent b left before it answered");
}

TEST_F(Facilitation, AnActionIsNotBegunASecondTimeByAnother) {
  facilitator.announce(agent(1, "a", true));
  facilitator.announce(agent(2, "b", true));
  ask(place_of(5));
  facilitator.leave(1);
  const auto end = facilitator.step(now);
  EXPECT_TRUE(end.requests.empty());
  EXPECT_EQ(test::only(end.solved).answer.code, AnswerCode::lost);
}

TEST_F(Facilitation, AsksAgainUntilSomethingIsHeardAndEndsAtTheDeadline) {
  facilitator.announce(agent(1, "a"));
  Request request = place_of(5);
  request.deadline = 2.0;
  ask(request);
  EXPECT_TRUE(facilitator.step(now).requests.empty());
  now = *facilitator.due();
  EXPECT_EQ(facilitator.step(now).requests.size(), 1u);
  hear("a", request, {AnswerCode::underway, "", {}});
  EXPECT_EQ(*facilitator.due(), 102.0);
  now = 102.0;
  const auto end = test::only(facilitator.step(now).solved);
  EXPECT_EQ(end.answer.code, AnswerCode::too_late);
  EXPECT_EQ(end.answer.text, "a did not answer in time");
}

TEST_F(Facilitation, ARepeatedRequestIsAnsweredAgainAndAskedOnce) {
  facilitator.announce(agent(1, "a"));
  EXPECT_EQ(ask(place_of(5)).requests.size(), 1u);
  EXPECT_TRUE(ask(place_of(5)).requests.empty());
  hear("a", place_of(5), library());
  const auto again = ask(place_of(5));
  EXPECT_TRUE(again.requests.empty());
  EXPECT_EQ(test::only(again.solved).answer, library());
}

Request withdrawal(std::uint64_t number) {
  Request request = place_of(number);
  request.functor = kWithdraw;
  request.arguments.clear();
  return request;
}

TEST_F(Facilitation, AWithdrawnActionEndsWithTheAnswerOfItsAgent) {
  facilitator.announce(agent(1, "a", true));
  facilitator.announce(agent(2, "b", true));
  ask(place_of(5));
  hear("a", place_of(5), {AnswerCode::underway, "on its way"});
  const auto told = ask(withdrawal(5));
  EXPECT_TRUE(told.solved.empty());
  EXPECT_EQ(test::only(told.requests).service, "address of a");
  EXPECT_EQ(test::only(told.requests).functor, kWithdraw);
  EXPECT_EQ(test::only(told.requests).number, 5u);
  EXPECT_TRUE(test::only(told.requests).arguments.empty());
  EXPECT_TRUE(ask(place_of(5)).requests.empty()) << "the request once more";
  const auto end = hear("a", place_of(5), {AnswerCode::refused, "withdrawn before it was begun"});
  EXPECT_TRUE(end.requests.empty()) << "no other agent begins it";
  EXPECT_EQ(test::only(end.solved).answer.text, "withdrawn before it was begun");
  EXPECT_EQ(ask(withdrawal(5)).solved.at(0).answer.code, AnswerCode::refused) << "told again";
}

TEST_F(Facilitation, AWithdrawalIsRepeatedInsteadOfTheRequest) {
  facilitator.announce(agent(1, "a", true));
  ask(place_of(5));
  ask(withdrawal(5));
  now += 0.4;
  const auto again = test::only(facilitator.step(now).requests);
  EXPECT_EQ(again.functor, kWithdraw);
}

TEST_F(Facilitation, AnAgentThatKnowsNoWithdrawalEndsItsAction) {
  facilitator.announce(agent(1, "a", true));
  ask(place_of(5));
  ask(withdrawal(5));
  EXPECT_TRUE(hear("a", place_of(5), {AnswerCode::unknown_functor, "withdraw?"}).solved.empty());
  EXPECT_EQ(hear("a", place_of(5), library()).solved.at(0).answer, library());
}

TEST_F(Facilitation, WhatNobodyHasBegunEndsAtOnceWhenItIsWithdrawn) {
  facilitator.announce(agent(1, "a"));
  facilitator.announce(agent(2, "b"));
  ask(wanting(place_of(5), 0.0));  // facts
  const auto end = ask(withdrawal(5));
  EXPECT_TRUE(end.requests.empty());
  EXPECT_EQ(test::only(end.solved).answer,
            (Answer{AnswerCode::refused, "withdrawn; nothing was done"}));
  ask(wanting(place_of(7), 0.0));
  hear("a", wanting(place_of(7), 0.0), library());
  EXPECT_EQ(ask(withdrawal(7)).solved.at(0).answer.text, "1 answer; withdrawn");
  const auto unknown = ask(withdrawal(6));
  EXPECT_TRUE(unknown.requests.empty());
  EXPECT_TRUE(unknown.solved.empty());
  EXPECT_EQ(facilitator.open(), 0u);
}

TEST_F(Facilitation, WhoFloodsHurtsItselfOnly) {
  facilitator.announce(agent(1, "a"));
  std::size_t refused = 0;
  for (std::uint64_t i = 1; i <= 100; ++i)
    refused += ask(place_of(i)).solved.size();
  EXPECT_EQ(refused, 36u);
  EXPECT_EQ(ask(place_of(1, 2)).requests.size(), 1u);
}

TEST_F(Facilitation, TriggersOfTimeEventsAndDataAskForTheirActions) {
  facilitator.announce(agent_that_notes());
  Trigger trigger{{1, 1}, "ann", TriggerKind::time, 5.0, "", {}, "note", {}, 1};
  facilitator.set(trigger, now);
  EXPECT_TRUE(facilitator.step(now).requests.empty());
  now += 5.0;
  EXPECT_EQ(facilitator.step(now).requests.size(), 1u);
  now += 50.0;
  EXPECT_TRUE(facilitator.step(now).requests.empty()) << "it was to fire once";

  trigger = {{1, 2},
             "ann",
             TriggerKind::event,
             1.0,
             "moved",
             {open_slot("place"), text("person", "karen")},
             "note",
             {open_slot("place")},
             0};
  facilitator.set(trigger, now);
  facilitator.happened("moved", {text("person", "john"), text("place", "kitchen")}, now);
  EXPECT_TRUE(facilitator.step(now).requests.empty());
  facilitator.happened("moved", {text("person", "karen"), text("place", "kitchen")}, now);
  const auto moved = facilitator.step(now).requests;
  EXPECT_EQ(text_of(test::only(moved).arguments, "place"), "kitchen");
  facilitator.hear(test::only(moved).service, test::only(moved).asker, test::only(moved).number, {},
                   now);
  facilitator.take_back({1, 2});
  facilitator.happened("moved", {text("person", "karen"), text("place", "kitchen")}, now);
  EXPECT_TRUE(facilitator.step(now).requests.empty());

  facilitator.set(note_place_of_karen(), now);
  std::vector<std::string> noted;
  for (const char* const place : {"library", "library", "kitchen"}) {
    now += 1.0;
    for (const Request& request : facilitator.step(now).requests)
      if (request.functor == "place_of")
        facilitator.hear(request.service, request.asker, request.number,
                         {AnswerCode::done, "", {text("place", place)}}, now);
    for (const Request& request : facilitator.step(now).requests)
      if (request.functor == "note")
        noted.push_back(text_of(request.arguments, "place"));
  }
  EXPECT_EQ(noted, std::vector<std::string>{"kitchen"});
}

/// Agents come, go and answer at random. Each request has one end, and no more answers than wanted;
/// no agent starts an action that another one may have done.
TEST_F(Facilitation, ATriggerOfDataFiresWhenAValueIsFirstKnown) {
  facilitator.announce(agent_that_notes());
  facilitator.set(note_place_of_karen(), now);
  const Answer unknown{AnswerCode::refused, "nobody has told me"};
  const Answer late{AnswerCode::too_late, "no answer"};
  std::vector<double> fired;
  for (const Answer& answer :
       {unknown, unknown, late, library(), library(), late, library(), unknown, library()}) {
    now += 1.0;
    for (const Request& request : facilitator.step(now).requests)
      facilitator.hear(request.service, request.asker, request.number,
                       request.functor == "note" ? Answer{} : answer, now);
    for (const Request& request : facilitator.step(now).requests)
      if (request.functor == "note") {
        fired.push_back(now);
        facilitator.hear(request.service, request.asker, request.number, {}, now);
      }
  }
  EXPECT_EQ(fired, (std::vector<double>{104.0, 109.0}));
}

TEST(FacilitationAtTheStart, ARequestWaitsForAgentsThatMayComeYet) {
  Facilitator facilitator(kSelf, 102.0);
  facilitator.ask(place_of(5), 100.0);
  facilitator.ask(place_of(6), 100.5);
  EXPECT_TRUE(facilitator.step(100.5).solved.empty());
  EXPECT_EQ(facilitator.due(), 102.0);
  facilitator.announce(agent(1, "calendar"));
  const auto asked = facilitator.step(100.6);
  EXPECT_TRUE(asked.solved.empty());
  ASSERT_EQ(asked.requests.size(), 2u);
  EXPECT_EQ(asked.requests[0].service, "address of calendar");
  Request other = place_of(7);
  other.functor = "weather";
  facilitator.ask(other, 101.5);
  EXPECT_TRUE(facilitator.step(101.9).solved.empty());
  const auto none = test::only(facilitator.step(102.0).solved);
  EXPECT_EQ(none.answer.code, AnswerCode::nobody);
  facilitator.leave(1);
  other.number = 9;
  facilitator.ask(other, 103.0);
  EXPECT_EQ(facilitator.step(103.0).solved.back().answer.code, AnswerCode::nobody) << "at once";
}

Trigger every_five_seconds(std::uint64_t times) {
  return {{1, 4}, "ann", TriggerKind::time, 5.0, "", {}, "note", {}, times};
}

/// How often a trigger fires in 50 s. The agent answers at once.
std::size_t firings(Facilitator& facilitator, double& now) {
  std::size_t fired = 0;
  for (int i = 0; i < 10; ++i) {
    now += 5.0;
    for (const Request& request : facilitator.step(now).requests) {
      ++fired;
      facilitator.hear(request.service, request.asker, request.number, {}, now);
    }
  }
  return fired;
}

TEST_F(Facilitation, ATriggerFiresItsTimesWhateverIsHeardAgain) {
  facilitator.announce(agent_that_notes());
  facilitator.set(every_five_seconds(2), now);
  facilitator.step(now);
  now += 5.0;
  const auto first = facilitator.step(now);
  EXPECT_TRUE(first.changed);
  facilitator.hear(test::only(first.requests).service, kSelf, test::only(first.requests).number, {},
                   now);
  facilitator.set(every_five_seconds(2), now);  // its sample came once more
  facilitator.miss({1, 4});                     // its writer was not heard for a moment
  facilitator.set(every_five_seconds(2), now);
  EXPECT_EQ(firings(facilitator, now), 1u);
  facilitator.set(every_five_seconds(3), now);
  EXPECT_EQ(firings(facilitator, now), 3u) << "it was changed";
  facilitator.take_back({1, 4});
  EXPECT_TRUE(facilitator.step(now).changed);
  EXPECT_EQ(saved(facilitator), saved(Facilitator(kSelf)));
}

TEST_F(Facilitation, ATriggerFiresItsTimesOverARestart) {
  facilitator.announce(agent_that_notes());
  facilitator.set(every_five_seconds(12), now);
  EXPECT_EQ(firings(facilitator, now), 10u);
  Facilitator next(kSelf + 1);
  restore(saved(facilitator), next);
  next.announce(agent_that_notes());
  next.set(every_five_seconds(12), now);
  EXPECT_EQ(firings(next, now), 2u);
}

std::string live(Facilitator& facilitator, double now) {
  Request request = place_of(77);
  request.functor = kLiveTriggers;
  facilitator.ask(request, now);
  const auto out = facilitator.step(now);
  return out.solved.empty() ? "nothing" : text_of(out.solved.back().answer.results, "live");
}

TEST_F(Facilitation, TheTriggersThatMayFireYetAreTold) {
  facilitator.announce(agent_that_notes());
  EXPECT_EQ(live(facilitator, now), "");
  facilitator.set(every_five_seconds(1), now);
  Trigger other = every_five_seconds(0);
  other.id = {0x1f3a, 5};
  facilitator.set(other, now);
  EXPECT_EQ(live(facilitator, now), "1:4 1f3a:5");
  firings(facilitator, now);
  EXPECT_EQ(live(facilitator, now), "1f3a:5") << "the other one is spent";
}

TEST_F(Facilitation, AShortPeriodIsNotSet) {
  facilitator.announce(agent_that_notes());
  facilitator.step(now);
  for (const double period : {0.0, -5.0, 0.01}) {
    Trigger trigger = every_five_seconds(0);
    trigger.period = period;
    facilitator.set(trigger, now);
    const auto out = facilitator.step(now);
    ASSERT_EQ(out.notes.size(), 1u) << period;
    EXPECT_NE(out.notes[0].find("period: expected 0.1 s or more, found"), std::string::npos);
    EXPECT_EQ(firings(facilitator, now), 0u) << period;
    facilitator.set(every_five_seconds(0), now);  // which the next one replaces
    facilitator.step(now);
  }
}

TEST_F(Facilitation, ATriggerThatIsCalledOffFiresNoMoreUntilItIsChanged) {
  facilitator.announce(agent_that_notes());
  facilitator.set(every_five_seconds(0), now);
  facilitator.step(now);
  facilitator.call_off({1, 4});
  facilitator.set(every_five_seconds(0), now);  // its holder is heard again
  EXPECT_EQ(firings(facilitator, now), 0u);
  Facilitator next(kSelf + 1);
  restore(saved(facilitator), next);
  next.announce(agent_that_notes());
  next.set(every_five_seconds(0), now);
  EXPECT_EQ(firings(next, now), 0u) << "after a restart";
  facilitator.set(every_five_seconds(3), now);
  EXPECT_EQ(firings(facilitator, now), 3u);
}

TEST_F(Facilitation, TheActionOfATriggerEndsWithTheTrigger) {
  facilitator.announce(agent_that_notes());
  for (const bool lost : {true, false}) {
    facilitator.set(every_five_seconds(0), now);
    now += 5.0;
    const auto fired = facilitator.step(now);
    const Request action = test::only(fired.requests);
    facilitator.hear(action.service, kSelf, action.number, {AnswerCode::underway, ""}, now);
    if (lost)
      facilitator.miss({1, 4});
    else
      facilitator.take_back({1, 4});
    const auto told = test::only(facilitator.step(now).requests);
    EXPECT_EQ(told.functor, kWithdraw);
    EXPECT_EQ(told.number, action.number);
    facilitator.hear(action.service, kSelf, action.number, {AnswerCode::given_up, "stopped"}, now);
    facilitator.step(now);
  }
}

/// A facilitator that was killed after it has asked `sweeper` for an action, and is back.
struct FacilitationAgain : Facilitation {
  FacilitationAgain() {
    facilitator.announce(agent(2, "sweeper", true));
    facilitator.ask(place_of(5), now);
    EXPECT_TRUE(facilitator.step(now).changed) << "it is kept before the request is sent";
    const std::string kept = saved(facilitator);
    facilitator = Facilitator(kSelf + 1, now + 2.0);
    restore(kept, facilitator);
    facilitator.announce(agent(1, "a cheaper one", true));
  }
};

TEST_F(FacilitationAgain, ABegunActionIsAskedOfItsAgentAlone) {
  EXPECT_TRUE(ask(place_of(5)).requests.empty()) << "the agent may come yet";
  facilitator.announce(agent(2, "sweeper", true));
  const auto asked = test::only(facilitator.step(now).requests);
  EXPECT_EQ(asked.service, "address of sweeper");
  EXPECT_EQ(asked.number, 5u) << "by which the agent knows it";
  const auto end = hear("sweeper", place_of(5), library());
  EXPECT_EQ(end.solved.at(0).answer, library());
  EXPECT_EQ(ask(place_of(6)).requests.at(0).service, "address of a cheaper one") << "a new one";
}

TEST_F(FacilitationAgain, ABegunActionOfAnAgentThatIsGoneIsLost) {
  ask(place_of(5));
  now += 2.0;
  const auto end = facilitator.step(now);
  EXPECT_TRUE(end.requests.empty());
  EXPECT_EQ(test::only(end.solved).answer,
            (Answer{AnswerCode::lost,
                    "the agent that was asked is gone; whether it was done is not known"}));
}

TEST_F(FacilitationAgain, ABegunActionIsWithdrawnFromItsAgent) {
  ask(withdrawal(5));
  EXPECT_TRUE(ask(withdrawal(5)).solved.empty()) << "whether it was done is not known yet";
  facilitator.announce(agent(2, "sweeper", true));
  const auto told = test::only(facilitator.step(now).requests);
  EXPECT_EQ(told.service, "address of sweeper");
  EXPECT_EQ(told.functor, kWithdraw);
  EXPECT_EQ(hear("sweeper", place_of(5), {AnswerCode::given_up, "stopped"}).solved.size(), 1u);
}

TEST_F(Facilitation, AnActionThatAnAgentRefusedMayBeBegunByAnother) {
  facilitator.announce(agent(1, "a", true));
  ask(place_of(5));
  hear("a", place_of(5), {AnswerCode::refused, "no"});
  EXPECT_EQ(saved(facilitator), saved(Facilitator(kSelf)));
}

TEST_F(Facilitation, AnAgentThatSaysThatItIsAtWorkHasTheTimeThatItNeeds) {
  facilitator.announce(agent(1, "robot", true));
  ask(place_of(5));
  const auto told =
      test::only(hear("robot", place_of(5), {AnswerCode::underway, "on its way"}).solved);
  EXPECT_EQ(told.answer.text, "on its way");
  EXPECT_EQ(told.service, "robot");
  Request short_one = place_of(6);
  short_one.deadline = 20.0;
  ask(short_one);
  hear("robot", short_one, {AnswerCode::underway, ""});
  std::vector<std::uint64_t> late;
  for (int i = 0; i < 100; ++i) {
    now += 5.0;
    for (const Solved& solved : facilitator.step(now).solved)
      late.push_back(solved.number);
    hear("robot", place_of(5), {AnswerCode::underway, ""});
    hear("robot", short_one, {AnswerCode::underway, ""});
  }
  EXPECT_EQ(late, std::vector<std::uint64_t>{6}) << "the one with a deadline";
  const auto solved = test::only(hear("robot", place_of(5), library()).solved);
  EXPECT_EQ(solved.answer, library());
}

TEST_F(Facilitation, ARequiredArgumentIsNotLeftOpen) {
  facilitator.announce(agent(1, "a"));
  Request request = place_of(5);
  request.arguments[0] = open_slot("person");
  const auto out = ask(request);
  EXPECT_TRUE(out.requests.empty());
  EXPECT_EQ(test::only(out.solved).answer,
            (Answer{AnswerCode::bad_argument,
                    "place_of: argument \"person\" is missing: expected a text (a name)"}));
}

TEST_F(Facilitation, AnAnswerThatIsNobodysIsWarnedOfOnce) {
  facilitator.announce(agent(1, "a"));
  facilitator.announce(agent(2, "b"));
  ask(place_of(5));
  EXPECT_TRUE(hear("b", place_of(5), library()).warnings.empty()) << "an agent that was not asked";
  for (const std::size_t warnings : {1u, 0u}) {
    facilitator.hear("a", kPerson, 5, library(), now);
    const auto out = facilitator.step(now);
    EXPECT_TRUE(out.solved.empty());
    ASSERT_EQ(out.warnings.size(), warnings);
    for (const std::string& warning : out.warnings) {
      EXPECT_EQ(warning.find("an answer of \"a\" to place_of person=\"karen\" place=? does"), 0u)
          << warning;
    }
  }
  EXPECT_EQ(hear("a", place_of(5), library()).solved.size(), 1u);
}

Argument variable(const std::string& name, const std::string& variable) {
  Argument argument = open_slot(name);
  argument.text = variable;
  return argument;
}

/// place_of(person=karen, place=?P), go(place=?P)
Request go_to_karen(std::uint64_t number) {
  Request request = place_of(number);
  request.arguments = {text("person", "karen"), variable("place", "P"), text(kAnd, "go"),
                       variable("place", "P")};
  return request;
}

/// a and b know places, and robot goes there; in this order.
struct Conjunctions : Facilitation {
  Conjunctions() {
    facilitator.announce(agent(1, "a"));
    facilitator.announce(agent(2, "b"));
    facilitator.announce({3,
                          "robot",
                          "address of robot",
                          {{{"go",
                             "goes there",
                             {text_parameter("place", "of the map"),
                              optional(number_parameter("metres", "of the way", 0.0, 100.0))}},
                            true},
                           {{"near",
                             "a place beside another",
                             {text_parameter("place", "of the map"),
                              optional(text_parameter("other", "beside it"))}}}}});
  }
  static Answer at(const std::string& place) {
    return {AnswerCode::done, "", {text("place", place)}};
  }
  /// The one request that was sent, for people: "a: place_of person="karen" place=?".
  std::string sent(const Facilitator::Outputs& out) {
    EXPECT_EQ(out.requests.size(), 1u);
    if (out.requests.empty())
      return {};
    newest = out.requests.back();
    EXPECT_EQ(newest.asker, kSelf);
    return newest.service.substr(std::string("address of ").size()) + ": " + describe(newest);
  }
  Facilitator::Outputs answer(const Answer& answer) {
    facilitator.hear(newest.service, newest.asker, newest.number, answer, now);
    return facilitator.step(now);
  }
  Request newest;
};

TEST_F(Conjunctions, AnAnswerOfThePartBeforeIsUsedInTheNext) {
  EXPECT_EQ(sent(ask(go_to_karen(5))), "a: place_of person=\"karen\" place=?");
  EXPECT_TRUE(ask(go_to_karen(5)).requests.empty()) << "the request once more";
  EXPECT_EQ(sent(answer(at("library"))), "robot: go place=\"library\"");
  const auto underway = test::only(answer({AnswerCode::underway, "on its way"}).solved);
  EXPECT_EQ(underway.number, 5u);
  EXPECT_EQ(underway.answer.text, "on its way");
  const auto end =
      test::only(answer({AnswerCode::done, "arrived", {number("metres", 3.0)}}).solved);
  EXPECT_EQ(end.asker, kPerson);
  EXPECT_EQ(end.number, 5u);
  EXPECT_EQ(end.service, "robot");
  EXPECT_EQ(end.answer,
            (Answer{AnswerCode::done, "arrived", {text("P", "library"), number("metres", 3.0)}}));
  EXPECT_EQ(facilitator.open(), 0u);
  EXPECT_EQ(ask(go_to_karen(5)).solved.at(0).answer.text, "arrived") << "told again";
}

TEST_F(Conjunctions, WhereAPartHasNoAnswerTheNextAnswerOfTheOneBeforeIsTried) {
  EXPECT_EQ(sent(ask(go_to_karen(5))), "a: place_of person=\"karen\" place=?");
  Answer two = at("cellar");
  two.results.push_back(text("place", "attic"));
  EXPECT_EQ(sent(answer(two)), "robot: go place=\"cellar\"");
  EXPECT_EQ(sent(answer({AnswerCode::refused, "no such place"})), "robot: go place=\"attic\"");
  EXPECT_EQ(sent(answer({AnswerCode::refused, "no such place"})),
            "b: place_of person=\"karen\" place=?");
  EXPECT_EQ(sent(answer(at("lift"))), "robot: go place=\"lift\"");
  const auto end = test::only(answer({AnswerCode::refused, "too narrow"}).solved);
  EXPECT_EQ(end.service, "robot");
  EXPECT_EQ(end.answer,
            (Answer{AnswerCode::refused, "part 2 of 2, go place=\"lift\": too narrow"}));
}

TEST_F(Conjunctions, AnActionThatMayHaveBegunIsNotTriedWithOtherValues) {
  sent(ask(go_to_karen(5)));
  sent(answer(at("cellar")));
  const auto end = answer({AnswerCode::given_up, "the door is closed"});
  EXPECT_TRUE(end.requests.empty());
  EXPECT_EQ(test::only(end.solved).answer.code, AnswerCode::given_up);
  EXPECT_EQ(test::only(end.solved).answer.text,
            "part 2 of 2, go place=\"cellar\": the door is closed");
  sent(ask(go_to_karen(6)));
  sent(answer(at("cellar")));
  facilitator.leave(3);
  EXPECT_EQ(facilitator.step(now).solved.at(0).answer.code, AnswerCode::lost);
}

TEST_F(Conjunctions, TheRefusalSaysWhichPartFailed) {
  sent(ask(go_to_karen(5)));
  sent(answer({AnswerCode::refused, "no idea"}));
  const auto end = test::only(answer({AnswerCode::refused, "nor I"}).solved);
  EXPECT_EQ(end.service, "b");
  EXPECT_EQ(end.answer,
            (Answer{AnswerCode::refused, "part 1 of 2, place_of person=\"karen\" place=?: nor I"}));

  Request unknown = go_to_karen(6);
  unknown.arguments[2] = text(kAnd, "fly");
  sent(ask(unknown));
  sent(answer(at("library")));  // b may know a place to which it can fly
  const auto none = test::only(answer({AnswerCode::refused, "no idea"}).solved);
  EXPECT_EQ(none.answer, (Answer{AnswerCode::nobody,
                                 "part 2 of 2, fly place=\"library\": no agent can do \"fly\""}));

  Request malformed = go_to_karen(7);
  malformed.arguments[2] = number(kAnd, 1.0);
  EXPECT_EQ(ask(malformed).solved.at(0).answer.code, AnswerCode::bad_argument);
  Request long_one = go_to_karen(8);
  for (int i = 0; i < 7; ++i)
    long_one.arguments.push_back(text(kAnd, "go"));
  EXPECT_EQ(ask(long_one).solved.at(0).answer.text, "a conjunction has 8 parts at most");
}

TEST_F(Conjunctions, OnlyTheLastPartMayBeAnAction) {
  Request first = place_of(5);
  first.functor = "go";
  first.arguments = {text("place", "library"), text(kAnd, "place_of"), text("person", "karen")};
  const auto out = ask(first);
  EXPECT_TRUE(out.requests.empty());
  EXPECT_EQ(out.solved.at(0).answer.code, AnswerCode::bad_argument);
  EXPECT_NE(out.solved.at(0).answer.text.find("go is an action"), std::string::npos);
  sent(ask(wanting(go_to_karen(6), 0.0)));
  sent(answer(at("library")));
  const auto end = answer({AnswerCode::refused, "no idea"});
  EXPECT_TRUE(end.requests.empty()) << "all answers are wanted of facts alone";
  EXPECT_EQ(end.solved.at(0).answer.code, AnswerCode::bad_argument);
}

TEST_F(Conjunctions, AllAnswersOfAllPartsAreCollectedInAStableOrder) {
  Request request = go_to_karen(5);
  request.arguments[2] = text(kAnd, "near");
  request.arguments.push_back(variable("other", "O"));
  sent(ask(wanting(request, 0.0)));
  std::vector<std::string> found;
  const auto take = [&](const Facilitator::Outputs& out) {
    for (const Solved& solved : out.solved)
      found.push_back(solved.service + ": " + solved.answer.text + describe(solved.answer.results));
    return out;
  };
  const auto beside = [](const std::string& other) {
    return Answer{AnswerCode::done, "", {text("other", other)}};
  };
  EXPECT_EQ(sent(take(answer(at("library")))), "robot: near place=\"library\" other=?");
  EXPECT_EQ(sent(take(answer(beside("stairs")))), "b: place_of person=\"karen\" place=?");
  EXPECT_EQ(sent(take(answer(at("kitchen")))), "robot: near place=\"kitchen\" other=?");
  take(answer(beside("lift")));
  EXPECT_EQ(found, (std::vector<std::string>{"robot: P=\"library\" O=\"stairs\"",
                                             "robot: P=\"kitchen\" O=\"lift\"",
                                             "facilitator: 2 answers"}));
}

TEST_F(Conjunctions, TheDeadlineIsOfTheWhole) {
  Request request = go_to_karen(5);
  request.deadline = 3.0;
  sent(ask(request));
  now += 2.0;
  EXPECT_EQ(sent(answer(at("library"))), "robot: go place=\"library\"");
  EXPECT_EQ(newest.deadline, 1.0) << "the rest of it";
  answer({AnswerCode::underway, ""});
  now += 1.0;
  EXPECT_EQ(facilitator.due(), now);
  const auto end = test::only(facilitator.step(now).solved);
  EXPECT_EQ(end.answer,
            (Answer{AnswerCode::too_late,
                    "part 2 of 2, go place=\"library\": robot did not answer in time"}));
}

TEST_F(Conjunctions, AWithdrawalReachesThePartAtWork) {
  sent(ask(go_to_karen(5)));
  sent(answer(at("library")));
  answer({AnswerCode::underway, ""});
  Request withdrawal = place_of(5);
  withdrawal.functor = kWithdraw;
  EXPECT_EQ(sent(ask(withdrawal)), "robot: withdraw");
  const auto stopped = test::only(answer({AnswerCode::given_up, "stopped"}).solved);
  EXPECT_EQ(stopped.answer.code, AnswerCode::given_up);
  sent(ask(go_to_karen(6)));
  withdrawal.number = 6;
  EXPECT_EQ(ask(withdrawal).solved.at(0).answer,
            (Answer{AnswerCode::refused, "withdrawn; nothing was done"}));
  EXPECT_EQ(facilitator.open(), 0u);
}

TEST_F(Conjunctions, AnActionIsNotBegunAgainAfterARestart) {
  sent(ask(go_to_karen(5)));
  const auto asked = answer(at("library"));
  EXPECT_TRUE(asked.changed) << "it is kept before the request is sent";
  Facilitator next(kSelf + 1, now + 2.0);
  restore(saved(facilitator), next);
  next.announce(agent(1, "a"));
  next.ask(go_to_karen(5), now);
  EXPECT_TRUE(next.step(now).requests.empty());
  const auto end = next.step(now + 2.0);
  EXPECT_TRUE(end.requests.empty());
  EXPECT_EQ(end.solved.at(0).answer.code, AnswerCode::lost);
  sent(asked);
  answer({AnswerCode::refused, "no such place"});
  EXPECT_EQ(saved(facilitator), saved(Facilitator(kSelf)))
      << "nothing was done: it may be asked anew";
}

TEST(FacilitationAtRandom, EveryRequestHasOneEnd) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const auto pick = [&](std::uint64_t n) {
      return static_cast<std::uint64_t>(random.uniform() * static_cast<double>(n)) % n;
    };
    Facilitator facilitator(kSelf);
    std::vector<Request> sent;
    std::map<std::uint64_t, int> ends;
    double now = 0.0;
    std::uint64_t made = 0;
    const auto take = [&](const Facilitator::Outputs& out) {
      for (const Request& request : out.requests) {
        sent.push_back(request);
      }
      for (const Solved& solved : out.solved)
        ends[solved.number] += ended(solved.answer.code) ? 1 : 0;
    };
    for (int step = 0; step < 300; ++step) {
      now += 0.1;
      switch (pick(6)) {
        case 0:
          facilitator.announce(agent(1 + pick(5), "a" + std::to_string(pick(5)), pick(2) == 0));
          break;
        case 1:
          facilitator.leave(1 + pick(5));
          break;
        case 2:
          facilitator.ask(wanting(place_of(++made), static_cast<double>(pick(4))), now);
          break;
        case 3: {
          Request both = go_to_karen(++made);
          both.arguments[2] = text(kAnd, "place_of");
          both.arguments[3] = variable("person", "P");
          facilitator.ask(wanting(both, static_cast<double>(pick(4))), now);
          break;
        }
        default:
          if (!sent.empty()) {
            const Request& request = sent[pick(sent.size())];
            facilitator.hear(request.service, request.asker, request.number,
                             {static_cast<AnswerCode>(pick(10)), "", {text("place", "library")}},
                             now);
          }
      }
      take(facilitator.step(now));
    }
    for (int i = 0; i < 40; ++i)  // each silent part has 10 s
      take(facilitator.step(now += 10.0));
    EXPECT_EQ(facilitator.open(), 0u);
    for (std::uint64_t request = 1; request <= made; ++request)
      EXPECT_EQ(ends[request], 1) << "seed " << seed << ", request " << request;
  }
}

// Where the bus checks who asks.
TEST_F(Facilitation, ARequestIsWithdrawnByItsAskerAndByOperators) {
  facilitator.announce(agent(1, "a", true));
  Request request = place_of(5);
  request.person = Identity{"anna", "agent"};
  const auto asked = ask(request);
  EXPECT_EQ(asked.requests.at(0).person, request.person);
  EXPECT_EQ(test::only(asked.audit).act, v1::AUDIT_ASKED);
  Request other = withdrawal(5);
  other.person = Identity{"planner", "agent"};
  const auto refused = ask(other);
  EXPECT_TRUE(refused.requests.empty() && refused.solved.empty());
  EXPECT_EQ(refused.warnings.size(), 1U);
  EXPECT_EQ(test::only(refused.audit).act, v1::AUDIT_REFUSED);
  other.person = Identity{"karen", "operator"};
  EXPECT_EQ(ask(other).requests.at(0).functor, kWithdraw);
}

TEST_F(Facilitation, AnActionIsItsAskersOverARestart) {
  facilitator.announce(agent(2, "sweeper", true));
  Request request = place_of(5);
  request.person = Identity{"anna at flakey", "agent"};
  ask(request);
  const std::string kept = saved(facilitator);
  const auto back = [&] {
    facilitator = Facilitator(kSelf + 1, now + 2.0);
    restore(kept, facilitator);
    facilitator.announce(agent(2, "sweeper", true));
    EXPECT_EQ(saved(facilitator), kept);
  };
  const Identity planner{"planner", "agent"};
  for (Request other : {withdrawal(5), request}) {
    back();
    other.person = planner;
    const auto refused = ask(other);
    EXPECT_TRUE(refused.requests.empty() && refused.solved.empty()) << other.functor;
    EXPECT_EQ(test::only(refused.audit).act, v1::AUDIT_REFUSED);
    EXPECT_EQ(facilitator.open(), 0U);
  }
  for (const Identity& who : {*request.person, Identity{"karen", "operator"}}) {
    back();
    Request ends = withdrawal(5);
    ends.person = who;
    const auto told = test::only(ask(ends).requests);
    EXPECT_EQ(told.functor, kWithdraw);
  }
}

TEST_F(Facilitation, ATriggerIsItsRequestersAndActsForThem) {
  const Identity anna{"anna", "agent"};
  facilitator.announce(agent(1, "a", true));
  Trigger trigger{{1, 1}, "ann", TriggerKind::time, 5.0, "", {}, "place_of", {}, 1};
  trigger.action_arguments = {text("person", "karen")};
  trigger.person = anna;
  facilitator.set(trigger, now);
  EXPECT_FALSE(facilitator.may_change({1, 1}, Identity{"planner", "agent"}));
  EXPECT_TRUE(facilitator.may_change({1, 1}, anna));
  EXPECT_TRUE(facilitator.may_change({1, 1}, Identity{"karen", "operator"}));
  EXPECT_TRUE(facilitator.may_change({1, 2}, Identity{"planner", "agent"})) << "it is not known";
  now += 5.0;
  const auto fired = facilitator.step(now);
  EXPECT_EQ(fired.warnings.size(), 1U);
  EXPECT_EQ(test::only(fired.requests).person, anna);
}

}  // namespace
}  // namespace saphira::agent_interface

#include "agent_interface/shell/dialogue_shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "agent_interface/shell/facilitator_shell.hpp"
#include "node_options.hpp"
#include "only.hpp"
#include "process.hpp"

namespace saphira::agent_interface {
namespace {

/// The dialogue and its partners, on a bus in memory.
class DialogueOnTheBus : public testing::Test {
 protected:
  DialogueOnTheBus() {
    options.grammar = test::source("config/grammars/flakey.grammar");
    options.memory = folder.path("memory");
    start();
  }
  void start() {
    dialogue.reset();
    service.emplace(test::memory_options("dialogue"), memory);
    dialogue = std::make_unique<DialogueShell>(*service, options);
  }
  /// The robot's answer, in one line.
  std::string say(const std::string& text, const std::string& speaker = "Alice") {
    heard.write({.id = {5, ++number}, .speaker = speaker, .text = text, .confidence = 1.0});
    dialogue->step();
    return answers();
  }
  std::string answers() {
    std::string all;
    for (const auto& sample : said.take()) {
      all += (all.empty() ? "" : " / ") + sample.data.text;
      refused = sample.data.refused;
    }
    return all;
  }
  /// The newest status of a goal; the robot's words then.
  std::string tell(const v1::GoalId& goal, v1::GoalState state, const std::string& reason = {}) {
    statuses.write({.id = goal, .state = state, .reason = reason});
    dialogue->step();
    return answers();
  }
  std::string message(std::uint64_t cycle, const std::string& text) {
    messages.write({.stamp = {3, cycle}, .source = "intentions: ask", .text = text});
    dialogue->step();
    return answers();
  }

  test::TempDir folder;
  DialogueOptions options;
  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node person{test::memory_options("person"), memory};
  bus::Writer<v1::Utterance> heard = person.writer(bus::topics::kHeard);
  bus::Reader<v1::Utterance> said = person.reader(bus::topics::kSaid);
  bus::Reader<v1::Goal> goals = person.reader(bus::topics::kGoals);
  bus::Reader<v1::BeliefClaim> claims = person.reader(bus::topics::kBeliefClaims);
  bus::Reader<v1::Knowledge> knows = person.reader(bus::topics::kKnows);
  bus::Writer<v1::GoalStatus> statuses = person.writer(bus::topics::kGoalStatus);
  bus::Writer<v1::Message> messages = person.writer(bus::topics::kMessages);
  bus::Writer<v1::BeliefSet> beliefs = person.writer(bus::topics::kBeliefs);
  std::optional<bus::Node> service;
  std::unique_ptr<DialogueShell> dialogue;
  std::uint64_t number = 0;
  bool refused = false;  ///< the newest answer
};

TEST_F(DialogueOnTheBus, ALongNameOfASpeakerIsCutBehindALetter) {
  const std::string letters = "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaa";  // 30 bytes
  say("Flakey, turn left", letters + "\u00fc");
  const auto asked = test::only(goals.take());
  EXPECT_EQ(asked.data.requester, letters + " (by words)");
}

TEST_F(DialogueOnTheBus, AnArmOfTheLastTwoSecondsPointsAtAnOffice) {
  auto maps = person.writer(bus::topics::kMap);
  auto registrations = person.writer(bus::topics::kRegistration);
  auto visions = person.writer(bus::topics::kVision);
  v1::FloorMap map;
  for (const auto& [id, name, y] : {std::tuple(1U, "north", 1.0), {2U, "south", -1.2}}) {
    map.artifacts.push_back({.id = id,
                             .type = v1::ARTIFACT_DOOR,
                             .pose_in_map = {.x = 2.0, .y = y},
                             .width = 0.9,
                             .name = name});
  }
  maps.write(map);
  v1::Registration registration{
      .stamp = {.cycle = 100}, .state = v1::REGISTRATION_TRACKING, .odom_in_map = {.x = -3.0}};
  registrations.write(registration);
  v1::SeenThing alice{
      .kind = v1::SEEN_PERSON, .pose_in_odom = {.x = 5.0}, .points = -1.5, .pointed = 90};
  visions.write({.stamp = {.cycle = 100}, .things = {alice}});
  EXPECT_EQ(say("Flakey, this is Karen's office"), "I know now that south is karen's office");
  registration.stamp.cycle = 111;
  registrations.write(registration);
  EXPECT_EQ(say("Flakey, this is Bob's office"), "I know now that north is bob's office");
}

TEST_F(DialogueOnTheBus, NoTaskIsTakenWhileABridgeHoldsTheEmergencyStop) {
  bus::Node bridge(test::memory_options("bridge"), memory);
  {
    auto grants = bridge.writer(bus::topics::kGrant);
    grants.write({.estopped = true});
    EXPECT_EQ(say("Flakey, turn left"),
              "the emergency stop is pressed, by a program without a name: saphira estop reset "
              "releases it");
    EXPECT_TRUE(refused);
    EXPECT_TRUE(goals.take().empty());
  }
  EXPECT_EQ(say("Flakey, turn left"), "I turn 90 degrees to the left") << "the bridge is gone";
}

TEST_F(DialogueOnTheBus, ACommandBecomesAGoalAndItsEndIsSaid) {
  EXPECT_EQ(say("Flakey, turn left"), "I turn 90 degrees to the left");
  const auto asked = test::only(goals.take());
  EXPECT_EQ(asked.data.functor, "turn_to");
  EXPECT_EQ(asked.data.requester, "Alice (by words)");
  tell(asked.data.id, v1::GOAL_SUSPENDED, "a more important goal");
  EXPECT_EQ(say("Flakey, why are you standing?"),
            "the turn for Alice is suspended: a more important goal");
  EXPECT_EQ(tell(asked.data.id, v1::GOAL_SUCCEEDED, "turned"), "done: turned");
}

TEST_F(DialogueOnTheBus, TheGrammarIsReadAgainWhenItChangesAndAMistakeChangesNothing) {
  const std::string file = folder.path("own.grammar");
  const auto write = [&](const std::string& text) { std::ofstream(file) << text; };
  write("keyword: robot\nstop() \"I stop\"\n  stop\n");
  options.grammar = file;
  start();
  EXPECT_EQ(say("robot, stop"), "I stop");
  EXPECT_EQ(say("robot, cease"), "what?");
  write("keyword: robot\nstop() \"I stop at once\"\n  stop | cease\n");
  ASSERT_TRUE(test::wait_until([&] {
    dialogue->reload();
    return say("robot, cease") == "I stop at once";
  }));
  auto logs = person.reader(bus::topics::kLog);
  write("keyword: robot\nstop( \"no end\"\n");
  std::string told;
  ASSERT_TRUE(test::wait_until([&] {
    dialogue->reload();
    for (const auto& record : logs.take())
      told += record.data.text;
    return told.find("own.grammar:2:") != std::string::npos;
  })) << told;
  EXPECT_EQ(say("robot, cease"), "I stop at once");
}

TEST_F(DialogueOnTheBus, AQuestionIsPutToAnAgentWhileItIsThere) {
  bus::Node badges(test::memory_options("badges"), memory);
  auto agents = badges.writer(bus::topics::kAgents);
  auto asked = badges.reader<v1::Request>(bus::topics::kSolve);
  auto solved = badges.writer(bus::topics::kSolved);
  const v1::Agent agent{
      .id = 5, .name = "badges", .capabilities = {bus::capability("place_of", "", {})}};
  agents.write(agent);
  EXPECT_EQ(say("Flakey, where is Karen?"),
            "nobody has told me where karen is; I ask badges, for 5 s at most");
  dialogue->step();
  const auto request = test::only(asked.take());
  EXPECT_EQ(request.data.functor, "place_of");
  EXPECT_EQ(request.data.deadline, kAgentsPatience);
  solved.write({.asker = request.data.asker,
                .number = request.data.number,
                .service = "badges",
                .code = v1::ANSWER_DONE,
                .results = {bus::text("place", "EJ-231")}});
  dialogue->step();
  EXPECT_EQ(answers(), "badges says: karen is at EJ-231");
  agents.dispose(agent);
  EXPECT_EQ(say("Flakey, where is Karen?"), "nobody has told me where karen is");
}

TEST_F(DialogueOnTheBus, AMessageOfAnotherProgramThanAnActivityIsNotSaid) {
  say("Flakey, take the mail from EJ-231 to EJ-233");
  messages.write({.stamp = {3, 50}, .source = "console", .text = "my file is full"});
  dialogue->step();
  EXPECT_EQ(answers(), "");
  EXPECT_EQ(message(51, "Is John here?"), "Is John here?");
}

TEST_F(DialogueOnTheBus, WhatIsToldIsClaimedKnownAndOutlivesARestart) {
  say("Flakey, John usually knows where Karen is");
  const auto claimed = test::only(claims.take());
  EXPECT_EQ(claimed.data.name, "knows-where-karen");
  EXPECT_EQ(claimed.data.value, "(\"john\")");
  EXPECT_EQ(claimed.data.source, "Alice said \"Flakey, John usually knows where Karen is\"");
  start();
  dialogue->step();
  const auto known = knows.take_newest();
  ASSERT_TRUE(known);
  ASSERT_EQ(known->known.size(), 1u);
  EXPECT_EQ(known->known[0].words, "john knows where karen is");
  EXPECT_FALSE(claims.take().empty());
}

TEST_F(DialogueOnTheBus, ATaskGoesOnOverARestartAndItsEndIsSaid) {
  say("Flakey, take the mail from EJ-231 to EJ-233");
  const auto asked = test::only(goals.take());
  EXPECT_EQ(asked.data.writer_lost, v1::WRITER_LOST_KEEP);
  tell(asked.data.id, v1::GOAL_UNDERWAY);
  EXPECT_EQ(message(40, "Is anybody here?"), "Is anybody here?");
  // The writer keeps earlier sentences.
  start();
  EXPECT_EQ(message(52, "Please give me the mail"), "Please give me the mail");
  statuses.write({.id = asked.data.id, .state = v1::GOAL_SUCCEEDED, .reason = "brought"});
  dialogue->step();
  const auto told = test::only(said.take());
  EXPECT_EQ(told.data.text, "done: brought");
  EXPECT_EQ(told.data.listener, "Alice");
  EXPECT_EQ(told.data.answers.number, number);
  // Its end is not reported again.
  start();
  dialogue->step();
  EXPECT_TRUE(answers().empty());
}

// Otherwise nobody would hold the goal, and a restart of the intentions would lose it.
TEST_F(DialogueOnTheBus, ATaskOfBeforeARestartIsAskedForAgainWhileItIsUnderway) {
  say("Flakey, take the mail from EJ-231 to EJ-233");
  const auto first = test::only(goals.take());
  start();
  dialogue->step();
  const auto unknown = goals.take();
  EXPECT_TRUE(std::all_of(unknown.begin(), unknown.end(), [](const auto& sample) {
    return sample.info.disposed;
  })) << "a goal that nobody knows may be from yesterday";
  tell(first.data.id, v1::GOAL_UNDERWAY);
  const auto again = test::only(goals.take());
  EXPECT_EQ(again.data, first.data);
  tell(first.data.id, v1::GOAL_UNDERWAY);
  EXPECT_TRUE(goals.take().empty());
  say("Flakey, turn left", "Bob");
  EXPECT_EQ(test::only(goals.take()).data.priority, 1);
}

TEST_F(DialogueOnTheBus, ATaskEndsWithTheProgramThatWantsItAndNotWithAPersonsProgram) {
  const auto says = [&](v1::UtteranceMeans means, const std::string& text) {
    v1::Utterance utterance{
        .id = {6, ++number}, .speaker = "model", .text = text, .means = means, .confidence = 1.0};
    auto writer = std::make_unique<bus::Writer<v1::Utterance>>(person.writer(bus::topics::kHeard));
    writer->write(utterance);
    dialogue->step();
    answers();
    return writer;
  };
  auto writer = says(v1::UTTERANCE_TYPED, "Flakey, take the mail from EJ-231 to EJ-233");
  auto asked = goals.take();
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].data.writer_lost, v1::WRITER_LOST_KEEP);
  writer.reset();
  dialogue->step();
  EXPECT_TRUE(goals.take().empty());

  writer = says(v1::UTTERANCE_PROGRAM, "Flakey, take the mail from EJ-233 to EJ-231");
  asked = goals.take();
  ASSERT_EQ(asked.size(), 2u) << "the task before is dropped";
  EXPECT_EQ(asked[1].data.writer_lost, v1::WRITER_LOST_CANCEL);
  writer.reset();
  dialogue->step();
  EXPECT_EQ(
      answers(),
      "I drop the delivery of the mail: the program that wanted it has left or taken it back");
  const auto ended = test::only(goals.take());
  EXPECT_EQ(ended.data.withdrawn, "the program that wanted it has left or taken it back");
  EXPECT_EQ(ended.data.id, asked[1].data.id);
}

// The words of a program may come in the same moment as the news of its end.
TEST_F(DialogueOnTheBus, WordsOfAProgramThatHasEndedBeginNothingThatStays) {
  {
    person.writer(bus::topics::kHeard)
        .write({.id = {6, 1},
                .text = "Flakey, go forward",
                .means = v1::UTTERANCE_PROGRAM,
                .confidence = 1.0});
  }
  dialogue->step();
  const auto seen = goals.take();
  EXPECT_TRUE(seen.empty() || !seen.back().data.withdrawn.empty());
}

TEST_F(DialogueOnTheBus, WhatAnActivityFindsIsKnownAndWhatPeopleTakeBackCoversIt) {
  v1::BeliefSet found;
  found.beliefs.resize(3);
  found.beliefs[0].name = "asking-about";
  found.beliefs[0].value = "\"answer\"";
  found.beliefs[1].name = "asking-for";
  found.beliefs[1].value = "\"john\"";
  found.beliefs[2].name = "place-of-karen";
  found.beliefs[2].value = "\"EJ-231\"";
  found.beliefs[2].said_by = "find-person";
  found.beliefs[2].since = 70;
  found.stamp.cycle = 170;
  beliefs.write(found);
  dialogue->step();
  beliefs.write(found);
  claims.take();
  EXPECT_EQ(say("Flakey, where is Karen?"), "I found karen at EJ-231");
  EXPECT_TRUE(claims.take().empty());
  EXPECT_EQ(say("ask Karen"), "thank you");
  std::vector<std::string> told;
  for (const auto& sample : claims.take())
    told.push_back(sample.data.name + " " + sample.data.value);
  EXPECT_EQ(told, (std::vector<std::string>{"answer \"karen\"", "knows-where-john (\"karen\")"}));
  EXPECT_EQ(say("Flakey, Karen left"), "I no longer believe that karen is at EJ-231");
  std::vector<std::string> values;
  for (const auto& sample : claims.take())
    values.push_back(sample.info.disposed ? "disposed" : sample.data.value);
  EXPECT_EQ(values, std::vector<std::string>{"nil"});
  // Beliefs from before a restart are older than that.
  start();
  dialogue->step();
  answers();
  EXPECT_EQ(say("Flakey, where is Karen?"), "nobody has told me where karen is");
}

TEST_F(DialogueOnTheBus, APersonWhosePlaceAnotherProgramBelievesIsLookedFor) {
  auto maps = person.writer(bus::topics::kMap);
  v1::MapArtifact door{.id = 1, .type = v1::ARTIFACT_DOOR, .width = 0.9, .name = "north"};
  maps.write({.artifacts = {door}});
  v1::BeliefSet believed;
  believed.beliefs.resize(3);
  believed.beliefs[0].name = "place-of-karen";
  believed.beliefs[0].value = "\"north\"";
  believed.beliefs[1].name = "knows-where-john";
  believed.beliefs[1].value = "(\"karen\")";
  believed.beliefs[2].name = "place-of-bob";
  believed.beliefs[2].value = "nil";
  beliefs.write(believed);
  EXPECT_EQ(say("Flakey, go to Bob"),
            "I know no place or person called bob, but north. Which one, or where is bob?");
  EXPECT_TRUE(goals.take().empty());
  EXPECT_EQ(say("Flakey, go to Karen"), "I go to karen");
  EXPECT_EQ(say("Flakey, find John"), "I drop the way to karen / I look for john");
}

TEST_F(DialogueOnTheBus, AdviceIsTakenBackByARequest) {
  say("Flakey, John usually knows where Karen is");
  bus::Node hub(test::memory_options("facilitator"), memory);
  FacilitatorShell facilitator(hub, 0.0);
  bus::RequestClient client(person, bus::topics::kSolve, "a person");
  v1::Request request{.functor = "forget", .arguments = {bus::number("number", 1.0)}};
  double now = 0.0;
  const auto others = [&] {
    facilitator.step(now += 0.01);
    dialogue->step();
  };
  EXPECT_EQ(client.ask(request, 30.0, nullptr, others).text, "forgotten");
  EXPECT_EQ(client.ask(request, 30.0, nullptr, others).text,
            "nothing is known under 1 (saphira knows lists the facts)");
}

// A goal is asked for by its activity's name, as anything else that an agent can do.
TEST_F(DialogueOnTheBus, AnActivityIsRequestedOfTheRobot) {
  bus::Node hub(test::memory_options("facilitator"), memory);
  FacilitatorShell facilitator(hub, 0.0);
  v1::ActivitySchema schema{.name = "go-to-place"};
  schema.parameters.resize(1);
  schema.parameters[0].name = "place";
  schema.parameters[0].kind = v1::PARAMETER_TEXT;
  schema.parameters[0].required = true;
  person.writer(bus::topics::kActivitySchemas).write({.schemas = {schema}});
  auto client = std::make_unique<bus::RequestClient>(person, bus::topics::kSolve, "a person");
  v1::Request request{.functor = "go-to-place"};
  double now = 3.0;
  std::optional<v1::Goal> goal;
  v1::GoalState state = v1::GOAL_SUCCEEDED;
  const auto others = [&] {
    facilitator.step(now += 0.01);
    for (const auto& sample : goals.take())
      if (!sample.info.disposed) {
        goal = sample.data;
        statuses.write({.id = goal->id, .state = state, .reason = "as the intentions say"});
      }
  };
  others();  // the robot announces what it can do
  EXPECT_EQ(client->ask(request, 30.0, nullptr, others).code, v1::ANSWER_BAD_ARGUMENT);
  request.arguments = {bus::text("place", "library")};
  EXPECT_EQ(client->ask(request, 30.0, nullptr, others).code, v1::ANSWER_DONE);
  ASSERT_TRUE(goal);
  EXPECT_EQ(goal->functor, "go-to-place");
  EXPECT_EQ(goal->requester, "a person");
  EXPECT_EQ(bus::text_of(goal->arguments, "place"), "library");
  state = v1::GOAL_FAILED;
  const v1::Answer failed = client->ask(request, 30.0, nullptr, others);
  EXPECT_EQ(failed.code, v1::ANSWER_GIVEN_UP);
  EXPECT_EQ(failed.text, "as the intentions say");
}

/// The words of a stop go to the bridge itself, whatever other programs do.
TEST_F(DialogueOnTheBus, AGoalOfAnotherProgramIsNamedWhenItHasEnded) {
  bus::Writer<v1::Goal> others = person.writer(bus::topics::kGoals);
  const v1::Goal goal{.id = {person.instance(), 1},
                      .requester = "bob",
                      .functor = "go-to-place",
                      .arguments = {bus::text("place", "EJ-231")}};
  const auto become = [&](v1::GoalState state, const std::string& reason) {
    statuses.write({.id = goal.id,
                    .requester = goal.requester,
                    .functor = goal.functor,
                    .state = state,
                    .reason = reason});
    dialogue->step();
  };
  others.write(goal);
  become(v1::GOAL_UNDERWAY, "");
  others.dispose(goal);
  become(v1::GOAL_FAILED, "no way");
  EXPECT_EQ(say("Flakey, why?"), "the way to EJ-231 for bob failed: no way");
}

TEST_F(DialogueOnTheBus, AStopIsTheBridges) {
  bus::Node bridge{test::memory_options("bridge"), memory};
  auto stops = bridge.reader(bus::topics::kDriveStop);
  auto done = bridge.writer(bus::topics::kRobotAnswers);
  const auto answer = [&](const v1::Request& request, v1::AnswerCode code) {
    done.write({.asker = request.asker,
                .number = request.number,
                .code = code,
                .text = "stopped: a program (direct)"});
    dialogue->step();
    return answers();
  };
  EXPECT_EQ(say("Flakey, stop"), "I stop");
  auto request = stops.take_newest();
  ASSERT_TRUE(request);
  EXPECT_EQ(bus::text_of(request->arguments, "by"), "Alice (by words)");
  EXPECT_EQ(answer(*request, v1::ANSWER_UNDERWAY), "");
  EXPECT_EQ(answer(*request, v1::ANSWER_DONE), "done: stopped: a program (direct)");

  say("Flakey, stop");
  request = stops.take_newest();
  ASSERT_TRUE(request);
  EXPECT_EQ(answer(*request, v1::ANSWER_GIVEN_UP), "I could not: stopped: a program (direct)");

  say("Flakey, stop");
  dialogue->step(100.0);
  EXPECT_EQ(answers(), "");
  dialogue->step(103.0);
  EXPECT_TRUE(answers().starts_with("I could not: no bridge has confirmed the stop"));

  say("Flakey, stop");
  request = stops.take_newest();
  ASSERT_TRUE(request);
  EXPECT_EQ(answer(*request, v1::ANSWER_UNDERWAY), "");
  dialogue->step(1000.0);
  EXPECT_EQ(answers(),
            "I could not: the bridge has confirmed the stop (stopped: a program (direct)), but the "
            "robot was not seen at rest: press the robot's own switch");
}

// The bus says who speaks; what speakers call themselves is not checked.
TEST_F(DialogueOnTheBus, AGoalByWordsNamesTheMemberWhoseProgramSaidThem) {
  heard.set_sender({"flakey", "operator"});
  say("Flakey, turn left", "Bob");
  const auto asked = test::only(goals.take());
  EXPECT_EQ(asked.data.person.name, "flakey");
  EXPECT_EQ(asked.data.person.role, "operator");
  EXPECT_EQ(asked.data.requester, "Bob (by words)");
  heard.set_sender({"planner", "agent"});
  say("Flakey, turn right", "Bob");
  EXPECT_TRUE(refused);
  EXPECT_TRUE(goals.take().empty()) << "it would replace the operator's";
}

TEST_F(DialogueOnTheBus, AGoalByWordsNamesThePersonAtADoor) {
  heard.set_sender({"flakey", "operator"});
  v1::Utterance utterance;
  utterance.id.writer = 5;
  utterance.id.number = ++number;
  utterance.speaker = "Karen";
  utterance.text = "Flakey, turn left";
  utterance.confidence = 1.0;
  utterance.person = {"anna", "agent"};
  heard.write(utterance);
  dialogue->step();
  const auto asked = test::only(goals.take());
  EXPECT_EQ(asked.data.person.name, "anna at flakey");
  EXPECT_EQ(asked.data.person.role, "agent");
}

TEST_F(DialogueOnTheBus, ASpeakerWithoutANameHasThatOfTheMember) {
  heard.set_sender({"karen", "operator"});
  say("Flakey, turn left", "");
  EXPECT_EQ(test::only(goals.take()).data.requester, "karen (by words)");
}

TEST_F(DialogueOnTheBus, ARequestOfTheRobotBecomesAGoalOfItsAsker) {
  bus::Node hub(test::memory_options("facilitator"), memory);
  FacilitatorShell facilitator(hub, 0.0);
  v1::ActivitySchemas schemas;
  schemas.schemas.resize(1);
  schemas.schemas[0].name = "go-home";
  person.writer(bus::topics::kActivitySchemas).write(schemas);
  auto writer = person.writer<v1::Request>(bus::topics::kSolve);
  writer.set_sender({"planner", "agent"});
  double now = 3.0;
  facilitator.step(now += 0.01);
  v1::Request request = bus::request("go-home");
  request.asker = 9;
  request.number = 1;
  request.source = "karen";
  writer.write(request);
  facilitator.step(now += 0.01);
  facilitator.step(now += 0.01);
  const auto asked = test::only(goals.take());
  EXPECT_EQ(asked.data.person.name, "planner");
  EXPECT_EQ(asked.data.person.role, "agent");
  EXPECT_EQ(asked.data.requester, "planner (agent), karen");
}

}  // namespace
}  // namespace saphira::agent_interface

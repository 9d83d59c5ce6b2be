// A person watches the running system from the command line, asks for reasons, and interrupts its
// micro-tasks.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "saphira/base/text.hpp"
#include "system.hpp"

namespace saphira::test {
namespace {

class LookingTest : public testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& words) {
    return saphira(words, {{"SAPHIRA_ROBOT", system.robot()}});
  }
  /// Drives to a point far down the corridor.
  void drive() {
    system.start_all();
    goal = system.go_to(6.0, 0.0);
    ASSERT_TRUE(system.wait_moving()) << system.output();
  }

  System system;
  v1::GoalId goal;
};

TEST_F(LookingTest, SaysWhyFromTheWheelsToTheGoal) {
  ASSERT_NO_FATAL_FAILURE(drive());
  const Outcome said = run({"why", "--json"});
  ASSERT_EQ(said.code, 0) << said.text;
  const auto json = nlohmann::json::parse(said.text);
  const std::string sentence = json.at("sentence");
  EXPECT_TRUE(sentence.starts_with("The robot is told to drive ahead at ")) << sentence;
  EXPECT_TRUE(has(sentence, "for go_to(position=(6, 0) in odom) of test")) << sentence;
  EXPECT_TRUE(has(said.text, "\"kind\":\"rule\"")) << said.text;
  EXPECT_TRUE(has(said.text, "\"kind\":\"intention\"")) << said.text;
  const Outcome no = run({"why", "not", "turn", "right"});
  EXPECT_EQ(no.code, 0) << no.text;
  EXPECT_TRUE(no.text.starts_with("It does ")) << no.text;
  EXPECT_EQ(run({"why", "not", "fly"}).code, 2);

  // The same cycle, some time later, has the same reason. (The place on the map is told of the
  // present alone.)
  const std::string cycle = std::to_string(json.at("cycle").get<std::uint64_t>());
  const Outcome once = run({"why", "--json", "--cycle", cycle});
  ASSERT_EQ(once.code, 0) << once.text;
  const std::string reason = nlohmann::json::parse(once.text).at("sentence");
  EXPECT_TRUE(has(reason, "for go_to(position=(6, 0) in odom) of test")) << reason;
  const Outcome again = run({"why", "--json", "--cycle", cycle});
  ASSERT_EQ(again.code, 0) << again.text;
  EXPECT_EQ(nlohmann::json::parse(again.text).at("sentence"), reason);
  const Outcome before = run({"why", "--cycle", "-10"});
  EXPECT_EQ(before.code, 0) << before.text;
  const Outcome never = run({"why", "--cycle", "999999"});
  EXPECT_EQ(never.code, 1) << never.text;
  EXPECT_TRUE(has(never.text, "cycle 999999 is not known; recalled are ")) << never.text;

  system.goals().cancel(goal);
  ASSERT_TRUE(system.wait_still()) << system.output();
  const Outcome stands = run({"why"});
  EXPECT_EQ(stands.code, 0) << stands.text;
  EXPECT_TRUE(stands.text.starts_with("The robot stands: no goal is underway")) << stands.text;
  EXPECT_TRUE(
      has(stands.text, "go_to of test: canceled, withdrawn by the program that asked for it"))
      << stands.text;
}

TEST_F(LookingTest, ListsInterruptsAndResumesProcesses) {
  ASSERT_NO_FATAL_FAILURE(drive());
  const Outcome list = run({"processes"});
  EXPECT_EQ(list.code, 0) << list.text;
  for (const char* name : {"occgrid", "side-segment", "test-wall", "test-match",
                           "execute-current-behaviors", "execute-intentions"})
    EXPECT_TRUE(has(list.text, name)) << list.text;

  // Each of the two processes that drive is suspended: the robot stands until it is resumed.
  for (const auto& [service, process] : {std::pair{"behaviors", "execute-current-behaviors"},
                                         {"intentions", "execute-intentions"}}) {
    const Outcome asked = run({"processes", "interrupt", service, process});
    EXPECT_EQ(asked.code, 0) << asked.text;
    EXPECT_TRUE(has(asked.text, "SUSP")) << asked.text;
    EXPECT_TRUE(system.wait_still()) << system.output();
    const Outcome why = run({"why"});
    EXPECT_TRUE(why.text.starts_with(std::string("The robot stands: ") + process + " of " +
                                     service + " is suspended"))
        << why.text;
    EXPECT_EQ(run({"processes", "resume", service, process}).code, 0);
    EXPECT_TRUE(system.wait_moving()) << system.output();
  }
  const Outcome wrong = run({"processes", "suspend", "behaviors", "sleep"});
  EXPECT_EQ(wrong.code, 1);
  EXPECT_TRUE(has(wrong.text, "no process \"sleep\"; there are execute-current-behaviors"))
      << wrong.text;
  EXPECT_EQ(run({"processes", "stop", "behaviors", "x"}).code, 2);
}

// As docs/robots-of-others.md compares a robot with its file.
TEST_F(LookingTest, MovesAndTurnsAsThePageSays) {
  system.start_all();
  const std::string page = read_file(source("docs/robots-of-others.md"));
  ASSERT_TRUE(wait_until([&] { return system.truth().cycle > 0; })) << system.output();
  const Pose begin = system.truth().pose_in_world;
  for (const auto& [command, number] : {std::pair{"move", "1"}, {"turn", "90"}}) {
    EXPECT_TRUE(has(page, std::string("`saphira ") + command + " " + number + "`"));
    Outcome done;
    EXPECT_TRUE(wait_until([&] {
      done = run({command, number});
      return done.code == 0 || !has(done.text, "no bridge is heard");
    }));
    EXPECT_EQ(done.code, 0) << done.text << system.output();
  }
  ASSERT_TRUE(system.wait_still());
  const Pose moved = relative(begin, system.truth().pose_in_world);
  EXPECT_NEAR(moved.position().norm(), 1.0, 0.1);
  EXPECT_NEAR(norm2_angle(moved.th), kPi / 2.0, 0.1);
}

TEST_F(LookingTest, SaysThatNobodyIsThere) {
  std::vector<std::pair<std::string, Process>> asked;  // each listens for a while: at the same time
  for (const char* const command : {"intentions", "why", "processes"})
    asked.emplace_back(command, Process({"saphira", command}, system.folder().path(command),
                                        {{"SAPHIRA_ROBOT", system.robot()}}));
  for (auto& [command, process] : asked) {
    EXPECT_EQ(process.wait(), 1) << command;
    EXPECT_TRUE(has(process.output(), "no program is on the bus")) << process.output();
  }
}

}  // namespace
}  // namespace saphira::test

// A person asks the running system for reasons, and moves it, from the command line.
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

  System system;
};

TEST_F(LookingTest, SaysWhyFromTheWheelsToTheGoal) {
  system.start_all();
  const v1::GoalId goal = system.go_to(6.0, 0.0);
  ASSERT_TRUE(system.wait_moving()) << system.output();
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

  // Without the process that drives the robot stands, until it is resumed.
  const std::string process = "execute-current-behaviors";
  EXPECT_EQ(run({"processes", "interrupt", "behaviors", process}).code, 0);
  EXPECT_TRUE(system.wait_still()) << system.output();
  const Outcome why = run({"why"});
  EXPECT_TRUE(why.text.starts_with("The robot stands: " + process + " of behaviors is suspended"))
      << why.text;
  EXPECT_EQ(run({"processes", "resume", "behaviors", process}).code, 0);
  EXPECT_TRUE(system.wait_moving()) << system.output();

  system.goals().cancel(goal);
  ASSERT_TRUE(system.wait_still()) << system.output();
  const Outcome stands = run({"why"});
  EXPECT_EQ(stands.code, 0) << stands.text;
  EXPECT_TRUE(stands.text.starts_with("The robot stands: no goal is underway")) << stands.text;
  EXPECT_TRUE(
      has(stands.text, "go_to of test: canceled, withdrawn by the program that asked for it"))
      << stands.text;
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

}  // namespace
}  // namespace saphira::test

#include "saphira/situation/situation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "office.hpp"

namespace saphira::situation {
namespace {

using test::driving;
using test::program;

TEST(Condition, OfTwoInstancesTheOneThatIsHeardCounts) {
  Situation s = driving();
  s.behaviors_known.newest = s.now - 80;
  Program dead = program("behaviors");
  dead.age = 8.0;
  s.programs.push_back(dead);
  EXPECT_EQ(condition(s, "behaviors").health, Health::hung);
  test::find(s, "behaviors").age = 9.0;
  EXPECT_EQ(condition(s, "behaviors").health, Health::lost);
  EXPECT_NE(condition(s, "behaviors").words.find("8.0 s"), std::string::npos);
}

TEST(Condition, AMachineWithAnotherTimeIsNamedOnce) {
  Situation s = driving();
  EXPECT_EQ(clocks_apart(s.programs), "");
  for (Program& each : s.programs) {
    each.status.host = "board";
    each.clock_behind = 3.04;
  }
  s.programs.back().status.host = "laptop";
  s.programs.back().clock_behind = -1.4;
  const std::string text = clocks_apart(s.programs);
  EXPECT_TRUE(text.starts_with("clock: that of board is 3.0 s behind this machine's")) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  s.programs.back().clock_behind = -60.0;
  EXPECT_NE(clocks_apart(s.programs).find("laptop is 60 s ahead of"), std::string::npos)
      << clocks_apart(s.programs);
}

TEST(Condition, TheWaitingCopyOfASecondDeploymentDoesNotCount) {
  Situation s = driving();
  Program copy = test::program("bridge");
  copy.status.uptime = 1.0;
  copy.status.state = v1::SERVICE_WAITING;
  copy.namesake = true;
  s.programs.push_back(copy);
  EXPECT_EQ(condition(s, "bridge").health, Health::running);
  EXPECT_EQ(trouble(s), "");
  test::find(s, "bridge").age = 9.0;
  EXPECT_EQ(condition(s, "bridge").health, Health::waiting);
}

TEST(Condition, InTheJsonEachInstanceHasItsOwn) {
  Situation s = driving();
  s.behaviors_known.newest = s.now - 10;  // hung
  Program waiting = test::program("behaviors");
  waiting.status.state = v1::SERVICE_WAITING;
  waiting.status.reason = "another behaviors has this robot";
  waiting.namesake = true;
  Program silent = test::program("behaviors");
  silent.age = 9.0;
  Program second = test::program("behaviors");
  second.namesake = true;
  s.programs.insert(s.programs.end(), {waiting, silent, second});
  std::vector<std::string> conditions;
  const auto json = nlohmann::json::parse(to_json(s));
  for (const auto& one : json.at("programs"))
    if (one.at("name") == "behaviors")
      conditions.push_back(one.at("condition"));
  EXPECT_EQ(conditions,
            (std::vector<std::string>{
                "has said nothing for 1.0 s (it hangs, or is cut off)",
                "is waiting: another behaviors has this robot",
                "has not been heard for 9.0 s (it is dead, hangs, or is cut off)", ""}));
}

TEST(Condition, SamplesCountBeforeTheStatusComes) {
  Situation s = driving();
  for (const char* const name : {"behaviors", "intentions"}) {
    test::remove(s, name);
    EXPECT_EQ(condition(s, name).health, Health::running);
  }
  EXPECT_EQ(unheard(s), std::vector<std::string>{});
  s.behaviors_known.newest = s.now - 10;
  EXPECT_EQ(condition(s, "behaviors").health, Health::absent);
  s.behaviors_known.newest = s.now;
  s.silence = 1.5;  // nothing newer can be expected
  EXPECT_EQ(unheard(s), (std::vector<std::string>{"behaviors", "intentions"}));
}

TEST(Condition, WhoIsMissedByOthersIsNamed) {
  Situation s = driving();
  test::remove(s, "registration");
  EXPECT_EQ(unheard(s), std::vector<std::string>{}) << "a deployment without it";
  EXPECT_FALSE(misses(s));
  v1::ServiceStatus& intentions = test::find(s, "intentions").status;
  intentions.state = v1::SERVICE_DEGRADED;
  for (const char* const runs : {"runs on an old sample of", "runs without"}) {
    intentions.reason = std::string(runs) + " registration";
    EXPECT_EQ(trouble(s), "registration is not heard (not running, hung, or cut off; intentions " +
                              intentions.reason + ")");
    EXPECT_EQ(unheard(s), std::vector<std::string>{"registration"});
    EXPECT_TRUE(misses(s));
    EXPECT_EQ(nlohmann::json::parse(to_json(s)).at("missing"), "registration");
  }
}

TEST(Condition, LateIsHeardAndHungIsNot) {
  Situation s = driving();
  s.behaviors_known.newest = s.now - 2;
  EXPECT_EQ(condition(s, "behaviors").health, Health::running);
  s.behaviors_known.newest = s.now - 3;
  EXPECT_EQ(condition(s, "behaviors").health, Health::late);
  EXPECT_TRUE(condition(s, "behaviors").heard());
  s.behaviors_known.newest = s.now - 10;
  EXPECT_EQ(condition(s, "behaviors").health, Health::hung);
  EXPECT_FALSE(condition(s, "behaviors").heard());
}

TEST(IsHeard, WhileTheStatusComes) {
  Program lost = test::program("dialogue");
  EXPECT_TRUE(is_heard({lost}, "dialogue"));
  EXPECT_FALSE(is_heard({lost}, "facilitator"));
  lost.age = 9.0;
  EXPECT_FALSE(is_heard({lost}, "dialogue"));
}

TEST(Json, HoldsProgramsDriveGoalsAndTrouble) {
  Situation s = driving();
  test::find(s, "intentions").age = 4.0;
  s.intentions_known.newest = s.now - 40;
  const auto json = nlohmann::json::parse(to_json(s));
  EXPECT_EQ(json.at("programs").size(), 5U);
  EXPECT_EQ(json.at("programs").at(0).at("name"), "behaviors");
  EXPECT_EQ(json.at("programs").at(2).at("state"), "lost");
  EXPECT_EQ(json.at("drive").at("role"), "behaviors");
  EXPECT_EQ(json.at("goals").at(0).at("functor"), "go_to");
  EXPECT_EQ(json.at("goals").at(0).at("state"), "underway");
  EXPECT_EQ(json.at("missing"), "intentions");
  EXPECT_EQ(json.at("trouble"), trouble(s));
}

}  // namespace
}  // namespace saphira::situation

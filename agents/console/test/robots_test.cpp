#include "saphira/console/robots.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace saphira::console {
namespace {

using security::DoorRight;
using Names = std::vector<std::string>;

TEST(Robots, TheOwnOneIsFirstAndAWildcardIsNone) {
  EXPECT_EQ(robots_of({"b", "c", "a", "*", "b,c", ""}, "b"), (Names{"b", "a", "c"}));
  EXPECT_EQ(robots_of({}, "b"), Names{"b"});
  std::set<std::string> many;
  for (int i = 0; i < 100; ++i)
    many.insert("r" + std::to_string(i));
  EXPECT_EQ(robots_of(many, "b").size(), 32U);
}

class RobotsHeard : public testing::Test {
 protected:
  RobotSeen seen(const std::string& name, double age = 0.1) {
    return {.name = name, .age = age, .robot = &robot_, .grant = &grant_};
  }
  v1::RobotState robot_{.velocity = 0.2, .battery = 12.34};
  v1::Grant grant_{.role = v1::ROLE_TELEOP, .source = "ann"};
};

TEST_F(RobotsHeard, AnOldStateIsSilenceAndALatchComesBeforeMotion) {
  EXPECT_EQ(does(seen("a", 1.0)), RobotDoes::drives);
  EXPECT_EQ(does(seen("a", 1.01)), RobotDoes::silent);
  EXPECT_EQ(does({.name = "a"}), RobotDoes::silent);
  robot_.velocity = -0.005;
  EXPECT_EQ(does(seen("a")), RobotDoes::stands);
  robot_.rotation_velocity = -0.2;
  EXPECT_EQ(does(seen("a")), RobotDoes::drives);
  grant_.estopped = true;
  EXPECT_EQ(does(seen("a")), RobotDoes::stopped);
}

TEST_F(RobotsHeard, APageGetsWhoDrivesAndWhy) {
  RobotSeen one = seen("a");
  one.why = "drives to the lobby";
  one.page = {.instance = 1, .host = "h", .address = "http://localhost:8643/"};
  EXPECT_EQ(nlohmann::json::parse(to_json(one)),
            (nlohmann::json{{"name", "a"},
                            {"own", false},
                            {"does", "drives"},
                            {"trouble", ""},
                            {"why", "drives to the lobby"},
                            {"host", "h"},
                            {"address", "http://localhost:8643/"},
                            {"velocity", 0.2},
                            {"battery", 12.3},
                            {"role", "ROLE_TELEOP"},
                            {"who", "ann"}}));
  grant_ = {.role = v1::ROLE_ESTOP, .source = "console", .estopped = true, .estop_source = "ben"};
  EXPECT_EQ(nlohmann::json::parse(to_json(one)).at("who"), "ben");
  EXPECT_FALSE(nlohmann::json::parse(to_json(RobotSeen{.name = "a"})).contains("battery"));
}

TEST_F(RobotsHeard, AStopIsForOneOrAllAndLatchedWithAKeyToDrive) {
  const std::vector<RobotSeen> two{seen("a"), seen("b")};
  const StopOrder all = stop_order(two, "", DoorRight::drive);
  EXPECT_EQ(all.robots, (Names{"a", "b"}));
  EXPECT_TRUE(all.latched && all.well);
  const StopOrder one = stop_order(two, "b", DoorRight::watch);
  EXPECT_EQ(one.robots, Names{"b"});
  EXPECT_TRUE(!one.latched && one.well);
  EXPECT_FALSE(stop_order(two, "b", DoorRight::none).latched);
  const StopOrder none = stop_order(two, "c", DoorRight::operate);
  EXPECT_TRUE(none.robots.empty() && !none.well);
}

TEST_F(RobotsHeard, ASilentRobotIsToldTooAndThePersonHearsOfIt) {
  const StopOrder order = stop_order({seen("a"), seen("b", 3.0)}, "", DoorRight::drive);
  EXPECT_EQ(order.robots, (Names{"a", "b"}));
  EXPECT_FALSE(order.well);
  EXPECT_NE(order.text.find("NOT HEARD: b;"), std::string::npos) << order.text;
}

}  // namespace
}  // namespace saphira::console

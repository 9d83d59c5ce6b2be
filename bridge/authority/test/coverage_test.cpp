#include "saphira/authority/coverage.hpp"

#include <gtest/gtest.h>

#include "saphira/authority/robot.hpp"
#include "saphira/base/places.hpp"

namespace saphira::authority {
namespace {

protocol::RobotParameters robot(const std::string& name) {
  return protocol::load_parameters(find_file(config_folder() + "/robots", name, ".p"));
}

/// One round of silent sonars.
std::vector<Reading> silence(const protocol::RobotParameters& parameters) {
  std::vector<Reading> readings;
  for (const protocol::SonarUnit& sonar : parameters.sonars)
    readings.push_back({sonar.number, sonar.pose_in_robot, std::nullopt});
  return readings;
}

TEST(Coverage, OfAStandingRobotEndsAtItsGap) {
  for (const auto& [name, way] : {std::pair{"pioneer", 1.5}, {"p3dx", 0.35}, {"amigo", 0.35}}) {
    const protocol::RobotParameters parameters = robot(name);
    Coverage coverage(parameters.radius);
    coverage.update(1, {}, silence(parameters));
    EXPECT_NEAR(coverage.way(true), way, 0.051) << name;
  }
}

TEST(Coverage, OfASwingIsWhole) {
  for (const char* const name : {"p3dx", "amigo"}) {
    const protocol::RobotParameters parameters = robot(name);
    const double angle = swing(parameters.sonars, true);
    Coverage coverage(parameters.radius);
    coverage.update(1, {0.0, 0.0, angle}, silence(parameters));
    coverage.update(2, {0.0, 0.0, -angle}, silence(parameters));
    coverage.update(3, {}, silence(parameters));
    EXPECT_GT(coverage.way(true), 1.4) << name;
    coverage.update(44, {}, {});
    EXPECT_LT(coverage.way(true), 0.5) << name << ": others may stand there by now";
  }
}

TEST(Coverage, OfABeamEndsAtItsEcho) {
  Coverage coverage(0.05);
  coverage.update(1, {}, {{0, {0.0, 0.0, 0.0}, 1.0}});
  EXPECT_NEAR(coverage.way(true), 0.95, 0.051);
  EXPECT_LT(coverage.way(false), 0.5) << "nothing looks back";
  coverage.update(2, {0.3, 0.0, 0.0}, {});
  EXPECT_NEAR(coverage.way(true), 0.65, 0.051) << "it stays where it was in odom";
}

TEST(Coverage, ASwingClosesTheGapAhead) {
  const auto degrees_of = [](const char* name, bool forward) {
    return degrees(swing(robot(name).sonars, forward));
  };
  EXPECT_NEAR(degrees_of("p3dx", true), 3.5, 1e-6);
  EXPECT_NEAR(degrees_of("p3dx", false), 3.5, 1e-6);
  EXPECT_NEAR(degrees_of("amigo", true), 8.5, 1e-6);
  EXPECT_EQ(degrees_of("amigo", false), 0.0) << "the gap is too wide";
  EXPECT_NEAR(degrees_of("flakey", true), 8.5, 1e-6) << "to either side of straight ahead";
  EXPECT_EQ(degrees_of("pioneer", true), 0.0) << "a sonar looks straight ahead";
  EXPECT_EQ(degrees_of("pioneer", false), 0.0) << "no sonar looks back";
}

}  // namespace
}  // namespace saphira::authority

#include "saphira/protocol/parameters.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "saphira/base/text.hpp"

namespace saphira::protocol {
namespace {

std::string source(const std::string& path) {
  return std::string(std::getenv("SAPHIRA_SOURCE_DIR")) + "/" + path;
}

// Manual chapter 10 as it is printed.
TEST(Parameters, TheManualsSampleLoads) {
  const auto p = load_parameters(source("bridge/protocol/test/data/manual-sample.p"));
  EXPECT_DOUBLE_EQ(p.angle_unit, 0.0009973);
  EXPECT_DOUBLE_EQ(p.distance_unit, 0.079e-3);
  EXPECT_DOUBLE_EQ(p.velocity_unit, 2.0e-3);
  EXPECT_DOUBLE_EQ(p.radius, 0.220);
  EXPECT_DOUBLE_EQ(p.diagonal, 0.090);
  EXPECT_DOUBLE_EQ(p.range_unit, 0.229e-3);
  ASSERT_EQ(p.sonars.size(), 7U);
  EXPECT_DOUBLE_EQ(p.sonars[1].pose_in_robot.x, 0.100);
  EXPECT_DOUBLE_EQ(p.sonars[1].pose_in_robot.y, 0.100);
  EXPECT_DOUBLE_EQ(p.sonars[1].pose_in_robot.th, radians(20));
  EXPECT_DOUBLE_EQ(p.sonars[6].pose_in_robot.th, radians(-90));
  // Seven sonars are 0 to 6, and the sample describes a number 7.
  ASSERT_EQ(p.warnings.size(), 1U);
  EXPECT_NE(p.warnings[0].find("SonarUnit 7 is left out: SonarNum is 7"), std::string::npos);
}

TEST(Parameters, EveryShippedFileLoads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source("config/robots"))) {
    if (entry.path().extension() != ".p")
      continue;
    const auto p = load_parameters(entry.path().string());
    EXPECT_TRUE(p.warnings.empty()) << entry.path();
    EXPECT_FALSE(p.robot_class.empty()) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(Parameters, ThePioneer) {
  const auto p = load_parameters(source("config/robots/pioneer.p"));
  EXPECT_EQ(p.robot_class, "Pioneer");
  EXPECT_DOUBLE_EQ(p.angle_unit, 0.0061359);
  EXPECT_DOUBLE_EQ(p.distance_unit, 0.05066e-3);
  EXPECT_DOUBLE_EQ(p.velocity_unit, 2.5332e-3);
  EXPECT_DOUBLE_EQ(p.range_unit, 0.1734e-3);
  EXPECT_DOUBLE_EQ(p.radius, 0.220);
  EXPECT_DOUBLE_EQ(p.max_velocity, 0.4);
  EXPECT_DOUBLE_EQ(p.deceleration, 2.0);
  EXPECT_DOUBLE_EQ(p.encode_jitter, 0.01);  // Table 3-1
  EXPECT_DOUBLE_EQ(p.angle_jitter, 0.02);
  EXPECT_DOUBLE_EQ(p.angle_drift, 0.003);
  ASSERT_EQ(p.sonars.size(), 7U);
  EXPECT_DOUBLE_EQ(p.sonars[0].pose_in_robot.th, kPi / 2);
}

TEST(Parameters, KeywordsInAnyCaseAndOrder) {
  const auto p = parse_parameters(
      "sonarunit 0 100 0 0\nSONARNUM 1\nName Erratic ; a comment\r\nMaxRVelocity\n 90\n"
      "Vel2Divisor 20\nFrontBuffer 20\nSideBuffer 60\nFrontMaxRange 2000\nBattery 13\n",
      "a.p");
  EXPECT_EQ(p.name, "Erratic");
  EXPECT_DOUBLE_EQ(p.max_rotation_velocity, radians(90));
  EXPECT_DOUBLE_EQ(p.vel2_unit, 0.020);
  EXPECT_EQ(p.front_buffer, 20);
  EXPECT_EQ(p.side_buffer, 60);
  EXPECT_DOUBLE_EQ(p.front_max_range, 2.0);
  EXPECT_DOUBLE_EQ(p.battery, 13.0);
  EXPECT_EQ(p.sonars.size(), 1U);
}

struct Broken {
  const char* text;
  int line;
  int column;
  const char* expected;
};

class BrokenParameters : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenParameters, SayWhereAndWhatWasExpected) {
  try {
    parse_parameters(GetParam().text, "broken.p");
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_EQ(error.file(), "broken.p");
    EXPECT_EQ(error.line(), GetParam().line) << error.what();
    EXPECT_EQ(error.column(), GetParam().column) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().expected), std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BrokenParameters,
    ::testing::Values(
        Broken{"RobotRadius abc\n", 1, 13, "expected a number (RobotRadius)"},
        Broken{"RobotRadius\nSonarNum 0\n", 1, 12, "expected RobotRadius"},
        Broken{"RobotRadius -5\n", 1, 13, "between"}, Broken{"RobotRadius 1 2\n", 1, 15, "end of"},
        Broken{"RobotRadius nan\n", 1, 13, "expected a number"},
        Broken{"Radius 1\n", 1, 1, "expected a keyword"},
        Broken{"RobotRadius 1\n\nrobotradius 2\n", 3, 1, "line 1"},
        Broken{"SonarNum 2\nSonarUnit 0 1 2 3\n", 1, 10, "SonarUnit 1 is missing"},
        Broken{"SonarNum 1.5\n", 1, 10, "whole number"}, Broken{"SonarNum 65\n", 1, 10, "between"},
        Broken{"SonarUnit 0 1 2 3\n", 1, 1, "SonarNum"},
        Broken{"SonarNum 1\nSonarUnit 0 1 2\n", 2, 16, "bearing"},
        Broken{"SonarNum 1\nSonarUnit 0 1 2 3\nSonarUnit 0 1 2 3\n", 3, 11, "once"},
        Broken{"Class\n", 1, 6, "a word"}, Broken{"DistConvFactor 0\n", 1, 16, "between"},
        Broken{"FrontBuffer 201\n", 1, 13, "between"}));

TEST(Parameters, AMissingFileIsNamed) {
  try {
    load_parameters("/nowhere/x.p");
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/x.p"), std::string::npos);
  }
}

// Manual 5.4.2.
TEST(ParameterFileNames, LowerCaseSubclassElseClass) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(parameter_file_names("Pioneer", "PSOS43M"), (Names{"psos43m.p", "pioneer.p"}));
  EXPECT_EQ(parameter_file_names("B21", ""), (Names{"b21.p"}));
  EXPECT_EQ(parameter_file_names("Pioneer", "pioneer"), (Names{"pioneer.p"}));
  EXPECT_EQ(parameter_file_names("../../etc/passwd", ".."), Names{});
  EXPECT_EQ(parameter_file_names("", ""), Names{});
}

}  // namespace
}  // namespace saphira::protocol

#include "saphira/protocol/parameters.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string_view>

#include "lines.hpp"
#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/protocol/command.hpp"
#include "trouble.hpp"

namespace saphira::protocol {
namespace {

using test::source;

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

std::vector<std::string> shipped() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(source("config/robots")))
    if (entry.path().extension() == ".p")
      files.push_back(entry.path().string());
  EXPECT_FALSE(files.empty());
  return files;
}

// Sonars stand on or in the hull and look away from the middle.
TEST(Parameters, EveryShippedFileLoadsAndItsSonarsLookOutward) {
  for (const std::string& file : shipped()) {
    const auto p = load_parameters(file);
    EXPECT_TRUE(p.warnings.empty()) << file;
    EXPECT_FALSE(p.robot_class.empty()) << file;
    for (const SonarUnit& unit : p.sonars) {
      const Pose& pose = unit.pose_in_robot;
      EXPECT_LE(pose.position().norm(), p.radius + 0.1) << file << " " << int{unit.number};
      EXPECT_GT(pose.position().dot(pose.direction()), 0.0) << file << " " << int{unit.number};
    }
  }
}

TEST(Parameters, EachSubclassHasItsFile) {
  const int subclasses =
      test::each_line("bridge/protocol/test/subclasses.txt", '#', [](const std::string& line) {
        std::istringstream in(line);
        std::string name;
        double angle, distance, velocity, range, difference, vel2, most, most_rotation, radius;
        std::size_t sonars = 0;
        ASSERT_TRUE(in >> name >> angle >> distance >> velocity >> range >> difference >> vel2 >>
                    most >> most_rotation >> sonars >> radius);
        const auto names = parameter_file_names("Pioneer", name);
        const auto p = load_parameters(source("config/robots/" + names.at(0)));
        EXPECT_EQ(p.robot_class, "Pioneer");
        EXPECT_EQ(p.subclass, name);
        EXPECT_NEAR(p.angle_unit, angle, 1e-6);
        EXPECT_DOUBLE_EQ(p.distance_unit, distance * 1e-3);
        EXPECT_DOUBLE_EQ(p.velocity_unit, velocity * 1e-3);
        EXPECT_DOUBLE_EQ(p.range_unit, range * 1e-3);
        EXPECT_NEAR(p.rotation_per_difference, difference * 1e3, 1e-9);
        EXPECT_DOUBLE_EQ(p.vel2_unit, vel2 * 1e-3);
        EXPECT_DOUBLE_EQ(p.max_velocity, most * 1e-3);
        EXPECT_DOUBLE_EQ(p.max_rotation_velocity, radians(most_rotation));
        EXPECT_EQ(p.sonars.size(), sonars);
        EXPECT_DOUBLE_EQ(p.radius, radius * 1e-3);
        EXPECT_EQ(p.protocol, name.ends_with("-sh") ? Protocol::kArcos
                              : name.starts_with("psos") || name.starts_with("pion")
                                  ? Protocol::kPsos
                                  : Protocol::kP2os);
        EXPECT_EQ(p.move_command, p.protocol != Protocol::kPsos);
      });
  EXPECT_EQ(subclasses, 29);
}

// The classes whose servers send no subclass (Table 5-7), and others by their class.
TEST(Parameters, ClassesWithoutSubclass) {
  for (const std::string robot_class : {"B14", "B21", "Khepera", "Erratic", "Flakey"}) {
    const auto names = parameter_file_names(robot_class, "");
    const auto p = load_parameters(source("config/robots/" + names.at(0)));
    EXPECT_EQ(p.robot_class, robot_class);
    EXPECT_GE(p.sonars.size(), 8U);
  }
}

TEST(Parameters, TheLeastRangeOfSonars) {
  EXPECT_EQ(load_parameters(source("config/robots/pioneer.p")).sonar_min_range, 0.05);
  EXPECT_EQ(load_parameters(source("config/robots/khepera.p")).sonar_min_range, 0.005);
}

TEST(Parameters, AHeadTurnsByPulses) {
  const auto p = load_parameters(source("config/robots/flakey.p"));
  EXPECT_EQ(pulse_of_head(p, 0.0), 1500);
  EXPECT_EQ(pulse_of_head(p, radians(165.0)), 2490);
  EXPECT_EQ(pulse_of_head(p, radians(-90.0)), 960);
  EXPECT_EQ(pulse_of_head(p, radians(166.0)), 0) << "beyond its reach";
  EXPECT_NEAR(angle_of_head(p, 960), radians(-90.0), 1e-9);
  EXPECT_EQ(angle_of_head(p, 0), 0.0);
  const auto fixed = load_parameters(source("config/robots/pioneer.p"));
  EXPECT_EQ(pulse_of_head(fixed, 0.0), 0);
  EXPECT_EQ(angle_of_head(fixed, 2000), 0.0);
}

// The Pioneer with a head is the Pioneer otherwise.
TEST(Parameters, ThePioneerWithAHead) {
  auto p = load_parameters(source("config/robots/pioneer-head.p"));
  EXPECT_DOUBLE_EQ(p.head_reach, radians(165.0));
  const auto pioneer = load_parameters(source("config/robots/pioneer.p"));
  p.head_reach = pioneer.head_reach;
  p.file = pioneer.file;
  p.subclass = pioneer.subclass;
  EXPECT_EQ(p, pioneer);
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

// The least content of a file, as in the manual's own.
constexpr const char* kLeast =
    "AngleConvFactor 0.001\nDistConvFactor 0.08\nVelConvFactor 2\nRangeConvFactor 0.2\n"
    "RobotRadius 220\n";

TEST(Parameters, KeywordsInAnyCaseAndOrder) {
  const auto p = parse_parameters(
      kLeast +
          std::string(
              "sonarunit 0 100 0 0\nSONARNUM 1\nName Erratic ; a comment\r\nMaxRVelocity\n 90\n"
              "Vel2Divisor 20\nFrontBuffer 20\nSideBuffer 60\n"
              "FrontMaxRange 2000\nBattery 13\n"),
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

// A file of ARIA's: sections, units of other equipment, columns beyond ours, comments that are
// broken over two lines, and zeros for values that the robot decides.
constexpr const char* kAriaForm =
    "ConfigVersion 2.0\n"
    "Section General settings\n"
    "Class Pioneer            ; general type\n"
    "Subclass p3dx-sh\n"
    "RobotRadius 250.00000\nRobotDiagonal 120.00000\nRobotLengthFront 210.0\n"
    "MaxRVelocity 500\nMaxVelocity 2200\nHolonomic true\n"
    "Section Conversion factors\n"
    "AngleConvFactor 0.00153\nDistConvFactor 1.00000\nVelConvFactor 1.00000\n"
    "RangeConvFactor 1.00000\nDiffConvFactor 0.00560\nVel2Divisor 20.00000\nGyroScaler 1.626\n"
    "Section Movement control parameters\n"
    "SettableAccsDecs true\nTransAccel 0   ; 0: the robot's own\nRotDecel 0\nTransDecel 400\n"
    "Section Sonar parameters\n"
    "SonarNum 2\n"
    ";  SonarUnit <number> <x, mm> <y, mm> <heading of the disc,\n"
    " degrees> <board>\n"
    "SonarUnit 0 69 136 90 1 2 10\n"
    "SonarUnit 1 114 119 50\n"
    "Section SonarBoard_1\n"
    "SonarMaxRange 4335\nSonarBoardPort\n"
    "Section Laser parameters\n"
    "LaserX 21\n"
    "Section Laser 2 parameters\n"
    "LaserX 0\n";

TEST(Parameters, DecelerationsThatTheBridgeSetsStayWithinTheRobotsLimits) {
  const RobotParameters later = load_parameters(source("config/robots/p3dx.p"));
  EXPECT_DOUBLE_EQ(later.stop_deceleration, 0.6);
  EXPECT_NEAR(degrees(later.stop_rotation_deceleration), 200.0, 1e-9);
  EXPECT_DOUBLE_EQ(later.max_acceleration, 2.0);
  const RobotParameters first = load_parameters(source("config/robots/pioneer.p"));
  EXPECT_EQ(first.stop_deceleration, 0.0) << "it cannot be set";
  EXPECT_DOUBLE_EQ(first.max_acceleration, 2.0) << "its own deceleration";
}

TEST(Parameters, AFileInTheFormOfAria) {
  const auto p = parse_parameters(kAriaForm, "aria.p");
  EXPECT_EQ(p.subclass, "p3dx-sh");
  EXPECT_EQ(p.protocol, Protocol::kArcos);
  EXPECT_TRUE(p.move_command);
  EXPECT_DOUBLE_EQ(p.radius, 0.25);
  EXPECT_DOUBLE_EQ(p.max_velocity, 2.2);
  EXPECT_DOUBLE_EQ(p.acceleration, RobotParameters{}.acceleration);
  EXPECT_DOUBLE_EQ(p.deceleration, 0.4);
  EXPECT_DOUBLE_EQ(p.sonar_max_range, RobotParameters{}.sonar_max_range);
  ASSERT_EQ(p.sonars.size(), 2U);
  EXPECT_DOUBLE_EQ(p.sonars[1].pose_in_robot.th, radians(50));
}

// A file that was cut off anywhere is refused with a message that names the place, or has lost
// nothing that counts.
void expect_no_silent_cut(const std::string& text) {
  auto whole = parse_parameters(text, "cut.p");
  whole.warnings.clear();
  int refused = 0;
  for (std::size_t size = 0; size < text.size(); ++size) {
    try {
      auto cut = parse_parameters(std::string_view(text).substr(0, size), "cut.p");
      cut.warnings.clear();
      EXPECT_EQ(cut, whole) << "silently cut to " << size << " of " << text.size() << " bytes";
    } catch (const FileError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what())
                    .find("cut.p:" + std::to_string(error.line()) + ":" +
                          std::to_string(error.column()) + ": expected"),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(CutFiles, OfEveryShippedRobotAreNoticed) {
  for (const std::string& file : shipped()) {
    SCOPED_TRACE(file);
    expect_no_silent_cut(read_file(file));
  }
}

TEST(CutFiles, OfTheManualAndOfAriaAreNoticed) {
  expect_no_silent_cut(read_file(source("bridge/protocol/test/data/manual-sample.p")));
  expect_no_silent_cut(kAriaForm);
}

TEST(Parameters, MistakesSayWhereAndWhatWasExpected) {
  EXPECT_EQ(test::each_mistake("bridge/protocol/test/mistakes.txt",
                               [](const std::string& text) { parse_parameters(text, "broken.p"); }),
            36);
}

TEST(Parameters, AMissingFileIsNamed) {
  EXPECT_TRUE(test::has(test::trouble([] { load_parameters("/nowhere/x.p"); }), "/nowhere/x.p"));
}

TEST(ParametersOf, TheFileOfTheRobotOtherwiseTheNextThatFitsWithAWarning) {
  const std::string robots = source("config/robots");
  const RobotIdentity robot{"erratic", "Pioneer", "p3dx"};
  const RobotParameters own = parameters_of(robot, robots);
  EXPECT_EQ(own.file, robots + "/p3dx.p");
  EXPECT_TRUE(own.warnings.empty());
  const RobotIdentity variant{"erratic", "Pioneer", "p3dx-sh-lms1xx"};
  const RobotParameters similar = parameters_of(variant, robots);
  EXPECT_EQ(similar.file, robots + "/p3dx-sh.p");
  EXPECT_EQ(
      similar.warnings,
      (std::vector<std::string>{"robot \"erratic\" (Pioneer, p3dx-sh-lms1xx) has no parameter "
                                "file of its own: takes " +
                                robots + "/p3dx-sh.p"}));
}

TEST(ParametersOf, AGivenFileIsTakenWhereItIsForTheRobot) {
  const std::string robots = source("config/robots");
  const RobotIdentity robot{"erratic", "Pioneer", "p3dx"};
  EXPECT_EQ(parameters_of(robot, "/nowhere", robots + "/p3dx.p").file, robots + "/p3dx.p");
  const std::string other = robots + "/amigo.p";
  const RobotParameters found = parameters_of(robot, robots, other);
  EXPECT_EQ(found.file, robots + "/p3dx.p");
  EXPECT_EQ(found.warnings,
            (std::vector<std::string>{
                other + " is for a robot (Pioneer, amigo) and not for this one: takes " + robots +
                "/p3dx.p"}));
}

TEST(ParametersOf, WhereNoFileFitsTheErrorSaysWhatWasLookedFor) {
  const auto trouble = [](const RobotIdentity& robot) {
    return test::trouble([&] { parameters_of(robot, source("config/robots")); });
  };
  EXPECT_EQ(
      trouble({"mine", "Pioneer", "wheelchair"}),
      "no parameter file for robot \"mine\" (Pioneer, wheelchair): looked for wheelchair.p in " +
          source("config/robots") +
          ". Copy the file of the most similar robot there, under its subclass");
  EXPECT_NE(trouble({"mine", "", ""}).find("nothing (the robot names no class)"),
            std::string::npos);
  // The units of the two differ.
  EXPECT_EQ(trouble({"mine", "Pioneer", "amigo-v2"}),
            "robot \"mine\" (Pioneer, amigo-v2) may be of either generation, whose units differ: " +
                source("config/robots") +
                "/amigo.p or amigo-sh.p. Copy the right one there as "
                "amigo-v2.p");
  EXPECT_NE(trouble({"mine", "MTLX", "pioneer-lx"}).find("looked for pioneer-lx.p, mtlx.p"),
            std::string::npos)
      << trouble({"mine", "MTLX", "pioneer-lx"});
}

// Manual 5.4.2.
TEST(ParameterFileNames, LowerCaseSubclassElseClass) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(parameter_file_names("Pioneer", "PSOS43M"), (Names{"psos43m.p", "pioneer.p"}));
  EXPECT_EQ(parameter_file_names("B21", ""), (Names{"b21.p"}));
  EXPECT_EQ(parameter_file_names("Pioneer", "pioneer"), (Names{"pioneer.p"}));
  EXPECT_EQ(parameter_file_names("Pioneer", "p3dx-sh-lms1xx"),
            (Names{"p3dx-sh-lms1xx.p", "p3dx-sh.p"}));
  EXPECT_EQ(parameter_file_names("Pioneer", "p3at-sh-laser-2"),
            (Names{"p3at-sh-laser-2.p", "p3at-sh-laser.p", "p3at-sh.p"}));
  EXPECT_EQ(parameter_file_names("Pioneer", "wheelchair"), (Names{"wheelchair.p"}))
      << "not the file of the first generation";
  EXPECT_EQ(parameter_file_names("Pioneer", "pioneer-unknown"), (Names{"pioneer-unknown.p"}))
      << "nor this one";
  EXPECT_EQ(parameter_file_names("Pioneer", ""), (Names{"pioneer.p"}));
  EXPECT_EQ(parameter_file_names("B21", "b21r-laser"), (Names{"b21r-laser.p", "b21r.p", "b21.p"}));
  EXPECT_EQ(parameter_file_names("../../etc/passwd", ".."), Names{});
  EXPECT_EQ(parameter_file_names("", ""), Names{});
}

}  // namespace
}  // namespace saphira::protocol

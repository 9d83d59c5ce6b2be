// Parameter files as owners of other robots have them, and docs/robots-of-others.md, which gives
// the result for each.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "saphira/base/text.hpp"
#include "saphira/protocol/parameters.hpp"
#include "trouble.hpp"

namespace saphira::protocol {
namespace {

/// A file in Saphira's form with these lines in place of those with the same keywords.
std::string saphira_form(const std::string& lines = "") {
  std::string text;
  for (const char* usual :
       {"Class Pioneer", "Subclass mine", "AngleConvFactor 0.001534", "DistConvFactor 1",
        "VelConvFactor 1", "RangeConvFactor 1", "DiffConvFactor 0.0056", "Vel2Divisor 20",
        "RobotRadius 250", "MaxVelocity 1000", "MaxRVelocity 100", "SonarNum 2",
        "SonarUnit 0 100 50 10", "SonarUnit 1 100 -50 -10"}) {
    const std::string line = usual;
    const std::string keyword = line.substr(0, line.find(' ') + 1);
    if (keyword == "SonarUnit " || lines.find(keyword) == std::string::npos)
      text += line + "\n";
  }
  return text + lines;
}

/// In ARIA's form, with unknown equipment.
std::string aria_form(const std::string& subclass, const std::string& more = "") {
  return "ConfigVersion 2.0\nSection General settings\nClass Pioneer\nSubclass " + subclass +
         "\nRobotRadius 250.00000 ; radius in mm\nRobotWidth 425\nSomethingNew true\n"
         "Section Conversion factors\nAngleConvFactor 0.00153 ; radians per angular unit "
         "(2PI/4096)\n"
         "DistConvFactor 1.00000\nVelConvFactor 1.00000\nRangeConvFactor 1.00000\n"
         "DiffConvFactor 0.00560\nVel2Divisor 20.00000\n"
         "Section Movement control parameters\nMaxVelocity 2200\nMaxRVelocity 500\n"
         "TransAccel 0\nTransDecel 0\n"
         "Section Sonar parameters\nSonarNum 1\nSonarUnit 0 69 136 90 0 0\n"
         "Section Laser parameters\nLaserType lms1XX\nLaserX 17\n" +
         more;
}

/// The error message for a text; empty: it is accepted.
std::string trouble(const std::string& text) {
  return test::trouble_of<FileError>([&] { parse_parameters(text, "mine.p"); });
}

std::string page() {
  const char* const source = std::getenv("SAPHIRA_SOURCE_DIR");
  return read_file(std::string(source == nullptr ? "." : source) + "/docs/robots-of-others.md");
}

TEST(RobotsOfOthers, AreTaken) {
  EXPECT_EQ(trouble(saphira_form()), "");
  for (const char* subclass : {"p3dx-sh-lms1xx", "p3at-sh-laser", "mt400"}) {
    const RobotParameters robot = parse_parameters(aria_form(subclass), "mine.p");
    EXPECT_EQ(robot.subclass, subclass);
    EXPECT_EQ(robot.sonars.size(), 1U);
  }
  EXPECT_EQ(parse_parameters(aria_form("p3dx-sh-lms1xx"), "mine.p").protocol, Protocol::kArcos);
  EXPECT_FALSE(parse_parameters(aria_form("p3dx-sh-lms1xx"), "mine.p").protocol_is_assumed);
  EXPECT_EQ(parse_parameters(aria_form("p2at8"), "mine.p").protocol, Protocol::kP2os);
  // Its name shows no generation; its packets do (Reflector::recognize).
  const RobotParameters outdoors = parse_parameters(aria_form("mt400"), "mine.p");
  EXPECT_EQ(outdoors.protocol, Protocol::kP2os);
  EXPECT_TRUE(outdoors.protocol_is_assumed);
  const RobotParameters told =
      parse_parameters(aria_form("mt400", "Section General settings\nProtocol arcos\n"), "mine.p");
  EXPECT_EQ(told.protocol, Protocol::kArcos);
  EXPECT_FALSE(told.protocol_is_assumed);
  // Written on Windows.
  std::string windows;
  for (const char c : saphira_form())
    windows += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(trouble(windows), "");
  // One unit too many.
  const RobotParameters more = parse_parameters(saphira_form("SonarUnit 9 0 0 0\n"), "mine.p");
  ASSERT_EQ(more.warnings.size(), 1U);
  EXPECT_NE(more.warnings[0].find("SonarUnit 9 is left out"), std::string::npos);
}

struct Refused {
  const char* lines;     ///< in place of the usual ones
  const char* says;      ///< part of the message
  const char* page_has;  ///< the same in the page
};
const Refused kRefused[] = {
    {"RobotRadus 250\n", "did you mean RobotRadius?", "did you mean RobotRadius?"},
    {"RobotRadius 250\nRobotRadius 260\n", "expected each keyword once; it stands on line",
     "expected each keyword once"},
    {"AngleConvFactor 0.0879\n", "AngleConvFactor in radians a tick, of which a turn has 256",
     "AngleConvFactor in radians a tick, of which a turn has 256 at least"},
    {"AngleConvFactor 0.0001534\n", "AngleConvFactor in radians a tick, of which a turn has 256",
     "and 32768 at most"},
    {"RobotLength 0.5\n", "RobotLength in mm", "RobotRadius in mm"},
    {"RobotWidth 0.4\n", "RobotWidth in mm", "RobotRadius in mm"},
    {"DiffConvFactor 5.6\n", "DiffConvFactor in radians a mm", "RobotRadius in mm"},
    {"RangeConvFactor 0.001\n", "RangeConvFactor in mm a tick", "DistConvFactor in mm a tick"},
    {"DistConvFactor 485\n", "DistConvFactor in mm a tick", "DistConvFactor in mm a tick"},
    {"MaxVelocity 0.75\n", "MaxVelocity in mm/s", "MaxVelocity in mm/s"},
    {"TransAccel 0.3\n", "TransAccel in mm/s2", "TransAccel in mm/s2"},
    {"RobotRadius 0.25\n", "RobotRadius in mm", "RobotRadius in mm"},
    {"SonarNum 4\nSonarUnit 2 0 0 0\n", "SonarUnit 3 is missing (has the file been cut off?)",
     "SonarUnit 3 is missing (has the file been cut off?)"},
    {"MaxRVelocity 1", "expected a line break", "has the file been cut off?"},
};

TEST(RobotsOfOthers, UnlikelyValuesAreTold) {
  const auto warning = [](const std::string& text) {
    const RobotParameters robot = parse_parameters(text, "mine.p");
    EXPECT_EQ(robot.warnings.size(), 1U) << text;
    return robot.warnings.empty() ? "" : robot.warnings[0];
  };
  EXPECT_EQ(warning(saphira_form("RobotRadius 25\nRobotWidth 425\n")),
            "mine.p:14: RobotRadius of 25 mm is less than half of RobotWidth, 425 mm: the robot "
            "would touch things that it passes");
  EXPECT_EQ(
      warning(saphira_form("Vel2Divisor 0.02\n")),
      "mine.p:14: Vel2Divisor of 0.02 mm/s gives wheels 3 mm/s at the most, where MaxVelocity "
      "is 1000 mm/s: is it 20?");
  std::string metres = aria_form("p3dx");
  metres.replace(metres.find("69 136 90"), 9, "0.069 0.136 1.57");
  EXPECT_NE(warning(metres).find("their places are in mm and their bearings in degrees"),
            std::string::npos);
  std::string misspelt = aria_form("p3dx");
  misspelt.replace(misspelt.find("General"), 7, "Genral");
  const std::string said = trouble(misspelt);
  EXPECT_EQ(said.find("mine.p:2:9: expected a section of ARIA: did you mean general settings? Its "
                      "lines are not read; missing: RobotRadius"),
            0U)
      << said;
}

TEST(RobotsOfOthers, AreRefusedAsThePageSays) {
  const std::string text = page();
  for (const Refused& each : kRefused) {
    const std::string said = trouble(saphira_form(each.lines));
    EXPECT_NE(said.find(each.says), std::string::npos) << each.lines << said;
    EXPECT_NE(text.find(each.page_has), std::string::npos) << each.page_has;
  }
}

}  // namespace
}  // namespace saphira::protocol

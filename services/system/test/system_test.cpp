#include "system/system.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "bridge/shell/shell.hpp"
#include "node_options.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/security/roles.hpp"

namespace saphira::system {
namespace {

using runtime::Line;
using runtime::Unit;

std::string names(const std::vector<Line::End>& ends, const std::vector<Unit>& units) {
  std::string text;
  for (const Line::End& end : ends)
    text += units[end.unit].name + " ";
  return text;
}

// Topics that people and other programs outside the robot write.
const std::set<std::string> kFromOutside{
    "drive/estop",   "drive/estop/reset", "drive/teleop",   "drive/direct",  "lockstep/permit",
    "goals",         "beliefs/said",      "device/gripper", "device/output", "device/analog",
    "device/timer",  "device/sonar",      "device/sound",   "device/server", "device/serial",
    "device/vision", "agents/solved"};

TEST(System, CyclicTopicsHaveOneWriter) {
  EXPECT_EQ(only_writer("robot/state"), "bridge");
  EXPECT_EQ(only_writer("drive/grant"), "bridge");
  EXPECT_EQ(only_writer("behaviors/state"), "behaviors");
  EXPECT_EQ(only_writer("recall/robot"), "bridge");
  EXPECT_EQ(only_writer("robot/description"), "") << "not cyclic";
  EXPECT_EQ(only_writer("drive/direct"), "") << "people write it";
  EXPECT_EQ(only_writer("nothing"), "");
}

TEST(System, EveryTopicThatIsReadIsWrittenByOne) {
  const std::vector<Unit> all = units();
  for (const Line& line : runtime::lines_of(all)) {
    if (kFromOutside.contains(line.topic))
      EXPECT_TRUE(line.writers.empty()) << line.topic;
    else
      EXPECT_EQ(line.writers.size(), 1U) << line.topic << ": " << names(line.writers, all);
  }
}

// Design: no service reads another's output for the cycle that it computes.
TEST(System, TheBridgeAloneIsReadInTheSameCycle) {
  const std::vector<Unit> all = units();
  for (const Line& line : runtime::lines_of(all))
    for (const Line::End& end : line.readers)
      EXPECT_EQ(end.use == runtime::Port::Use::kState, line.topic.starts_with("robot/"))
          << line.topic << " of " << all[end.unit].name;
}

// A service without a role would find the bus of a site with security closed.
TEST(System, EachProgramHasARoleThatMayUseItsTopics) {
  const std::string file = config_folder() + "/security/roles.yaml";
  const security::Roles roles =
      security::parse_roles(read_file(file), file, security::topics_of_contract());
  for (const Unit& unit : units()) {
    const security::Role* const role = roles.of_program(unit.name);
    ASSERT_NE(role, nullptr) << unit.name;
    for (const runtime::Port& port : unit.ports)
      EXPECT_TRUE(port.is_input() ? roles.may_read(role->name, port.topic)
                                  : roles.may_write(role->name, port.topic))
          << unit.name << ", " << port.topic;
  }
}

// docs/architecture.md shows it. `saphira wiring --draw docs/wiring.svg` makes it anew.
TEST(System, TheDrawingInTheDocumentsIsOfToday) {
  const char* const source = std::getenv("SAPHIRA_SOURCE_DIR");
  ASSERT_NE(source, nullptr) << "SAPHIRA_SOURCE_DIR: expected the folder of the sources";
  EXPECT_TRUE(read_file(std::string(source) + "/docs/wiring.svg") ==
              runtime::wiring_drawing(units()))
      << "the picture is of another system: build/release/bin/saphira wiring --draw "
         "docs/wiring.svg";
}

// Programs that run several services have all their options together.
TEST(System, NoTwoServicesHaveAnOptionOfTheSameName) {
  CommandLine app("all", "all");
  for (const runtime::Component& service : services()) {
    if (!service.add_options)
      continue;
    EXPECT_NO_THROW(service.add_options(app)) << service.name;
  }
}

TEST(System, TheTableOfTheBridgeIsTrue) {
  const auto memory = bus::make_memory_bus();
  bridge::BridgeOptions options;
  options.robot_port = "unix:/nowhere";
  options.robots_folder = config_folder() + "/robots";
  options.keeper = false;
  options.vision = {"a"};
  const bridge::Shell shell(test::memory_options("bridge"), options, memory);
  bus::Node watcher(test::memory_options("watcher"), memory);
  bus::Census census(watcher);
  std::set<std::string> live;
  for (const bus::EndpointEntry& entry : census.endpoints())
    if (entry.program == "bridge" && !entry.topic.starts_with("system/"))
      live.insert((entry.writer ? "writes " : "reads ") + entry.topic);
  std::set<std::string> table;
  for (const Unit& unit : units())
    if (unit.name == "bridge")
      for (const runtime::Port& port : unit.ports)
        table.insert((port.is_input() ? "reads " : "writes ") + port.topic);
  EXPECT_EQ(live, table);
}

}  // namespace
}  // namespace saphira::system

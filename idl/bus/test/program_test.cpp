#include "saphira/bus/program.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <stdexcept>

#include "harness.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/cycle.hpp"

namespace saphira::bus::test {
namespace {

int run(const std::function<int(const NodeOptions&, const Stop&)>& body) {
  std::string name = "saphira-test";
  char* argv[] = {name.data(), nullptr};
  return run_program(1, argv, "test", "A test", {}, body);
}

/// Steps once, as a service does.
void step(const NodeOptions& options, const Stop& stop) {
  const auto bus = make_memory_bus();
  Node bridge(options, bus);
  auto robot = bridge.writer(topics::kRobotState);
  Node node(options, bus);
  Cycle cycle(node);
  auto describes = bridge.writer(topics::kRobotDescription);
  describes.write(description(1));
  robot.write(robot_state(1, 1));
  ASSERT_TRUE(cycle.next(stop));
  cycle.done();
}

TEST(Program, AMistakeInWhatAPersonGaveIsAUsageError) {
  EXPECT_EQ(run([](const NodeOptions& options, const Stop&) -> int {
              Node node(options, make_memory_bus());
              throw FileError("a.map", 1, 2, "expected a number");
            }),
            kExitUsage);
  EXPECT_EQ(run([](const NodeOptions&, const Stop&) -> int {
              throw std::invalid_argument("--start: expected a place");
            }),
            kExitUsage);
  EXPECT_EQ(run([](const NodeOptions&, const Stop&) -> int {
              return static_cast<int>(read_file("/nowhere/a.map").size());
            }),
            kExitUsage);
  EXPECT_EQ(run([](const NodeOptions&, const Stop&) -> int { throw std::runtime_error("no bus"); }),
            kExitBroken);
}

// A supervisor starts a service again after kExitBroken, and gives up after kExitUsage.
TEST(Program, TheSameIsOurMistakeWhereTheServiceWasAtWork) {
  EXPECT_EQ(run([](const NodeOptions& options, const Stop& stop) -> int {
              step(options, stop);
              throw std::invalid_argument("a bug");
            }),
            kExitBroken);
  EXPECT_EQ(run([](const NodeOptions&, const Stop&) -> int {
              throw FileError("a.map", 1, 2, "expected a number");
            }),
            kExitUsage)
      << "of another run";
}

TEST(Program, ADryRunFailsForAMistakeThatARunningProgramOnlyReports) {
  std::string name = "saphira-test";
  std::string dry = "--dry-run";
  char* argv[] = {name.data(), dry.data(), nullptr};
  const auto code = [&](int argc, const std::string& mistake) {
    return run_program(argc, argv, "test", "A test", {},
                       [&](const NodeOptions& options, const Stop&) {
                         Node node(options, make_memory_bus());
                         node.warn("an old file");
                         if (!mistake.empty())
                           node.error(mistake);
                         return static_cast<int>(kExitOk);
                       });
  };
  EXPECT_EQ(code(2, ""), kExitOk);
  EXPECT_EQ(code(2, "a.beh:1:1: expected a name"), kExitFailed);
  EXPECT_EQ(code(1, "a.beh:1:1: expected a name"), kExitOk);
}

// An error message begins with the name of the program that people typed.
TEST(Program, AnErrorBeginsWithTheNameOfTheProgram) {
  std::string name = "saphira-test";
  char* argv[] = {name.data(), nullptr};
  testing::internal::CaptureStderr();
  run_program(1, argv, "test", "A test", {}, [](const NodeOptions&, const Stop&) -> int {
    throw std::invalid_argument("expected a place");
  });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "saphira-test: expected a place\n");
}

// A wildcard would be the partition of every robot.
TEST(Program, ARobotIsNamedByOneName) {
  const auto said = [](std::string robot) {
    std::string name = "saphira-test";
    std::string option = "--robot";
    char* argv[] = {name.data(), option.data(), robot.data(), nullptr};
    testing::internal::CaptureStderr();
    const int code =
        run_program(3, argv, "test", "A test", {}, [](const NodeOptions& options, const Stop&) {
          std::fputs(options.robot.c_str(), stderr);
          return static_cast<int>(kExitOk);
        });
    const std::string text = testing::internal::GetCapturedStderr();
    EXPECT_EQ(code == kExitOk, text == robot) << text;
    EXPECT_TRUE(code == kExitOk || code == kExitUsage) << code;
    return text;
  };
  EXPECT_EQ(said("*"),
            "saphira-test: --robot: expected the name of one robot (1 to 64 letters, digits, -, _ "
            "and .), found \"*\"\n");
  for (const std::string& wrong :
       {std::string("m?st"), std::string("a/b"), std::string("../x"), std::string("a b"),
        std::string("[ab]"), std::string(), std::string(65, 'a')})
    EXPECT_NE(said(wrong).find("found \"" + wrong + "\""), std::string::npos) << wrong;
  for (const std::string& right : {std::string("P3-DX_2.b"), std::string(64, 'a')})
    EXPECT_EQ(said(right), right);
}

}  // namespace
}  // namespace saphira::bus::test

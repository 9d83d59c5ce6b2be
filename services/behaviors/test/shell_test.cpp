#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "behaviors/shell/service.hpp"
#include "node_options.hpp"
#include "saphira/bus/goal_client.hpp"

namespace saphira::behaviors {
namespace {

v1::IntendedBehavior behavior(const char* schema, int priority,
                              std::vector<v1::Argument> parameters = {}) {
  return {.name = schema,
          .schema = schema,
          .priority = priority,
          .running = true,
          .parameters = std::move(parameters)};
}

runtime::Shell::Make with(const Options& options) {
  return [options](runtime::Ports& ports) { return std::make_unique<Service>(ports, options); };
}

/// The service between a scripted bridge and scripted intentions, on a bus within the process.
class ShellTest : public testing::TestWithParam<bool> {
 protected:
  void describe() {
    descriptions.write({.stamp = {.epoch = epoch},
                        .radius = 0.22,
                        .max_velocity = 0.4,
                        .max_rotation_velocity = 1.7,
                        .front_buffer = 30,
                        .side_buffer = 40,
                        .front_max_range = 2.5});
  }
  /// RobotState of the next cycle.
  void state() {
    states.write({.stamp = {epoch, ++cycle}, .odom = 1, .pose_in_odom = {.th = heading}});
  }
  void intend(std::vector<v1::IntendedBehavior> set) {
    intentions.write(
        {.stamp = {epoch, cycle}, .behavior_control = true, .behaviors = std::move(set)});
  }
  void step() {
    ASSERT_TRUE(shell.step(stop));
    const std::optional<v1::MotorCommand> newest = commands.take_newest();
    ASSERT_TRUE(newest);
    command = *newest;
    const std::optional<v1::BehaviorSet> told_now = behaviors.take_newest();
    ASSERT_TRUE(told_now);
    told = *told_now;
    EXPECT_EQ(command.stamp.epoch, epoch);
    EXPECT_EQ(command.stamp.cycle, cycle);
    EXPECT_EQ(told.stamp.cycle, cycle);
  }
  void one(std::vector<v1::IntendedBehavior> set) {
    state();
    step();
    intend(std::move(set));
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Stop stop;
  bus::Node bridge{test::memory_options("bridge", GetParam()), memory};
  bus::Node service{test::memory_options("behaviors", GetParam()), memory};
  bus::Writer<v1::RobotState> states{bridge.writer(bus::topics::kRobotState)};
  bus::Writer<v1::RobotDescription> descriptions{bridge.writer(bus::topics::kRobotDescription)};
  bus::Writer<v1::Intentions> intentions{bridge.writer(bus::topics::kIntentions)};
  bus::Reader<v1::MotorCommand> commands{bridge.reader(bus::topics::kDriveBehaviors)};
  bus::Reader<v1::BehaviorSet> behaviors{bridge.reader(bus::topics::kBehaviors)};
  runtime::Shell shell{service, with({})};

  std::uint64_t epoch = 77;
  std::uint64_t cycle = 0;
  double heading = 1.0;
  v1::MotorCommand command;
  v1::BehaviorSet told;
};

INSTANTIATE_TEST_SUITE_P(LiveAndLockstep, ShellTest, testing::Bool());

TEST_P(ShellTest, CommandsWhatIsIntended) {
  describe();
  one({behavior("ConstantVelocity", 2, {bus::number("speed", 0.25)})});
  EXPECT_FALSE(command.active);
  const std::uint64_t first = command.number;
  one({});
  EXPECT_TRUE(command.active);
  EXPECT_EQ(command.velocity, 0.25);
  EXPECT_EQ(command.heading, 1.0);
  EXPECT_EQ(command.source, "behaviors");
  EXPECT_GT(command.number, first);
  ASSERT_EQ(told.behaviors.size(), 1U);
  EXPECT_EQ(told.behaviors[0].speed_weight, 1.0);
  // Nothing is intended any more.
  state();
  step();
  EXPECT_FALSE(command.active);
  EXPECT_TRUE(told.behaviors.empty());
}

// A minute of published samples is kept for late readers.
TEST_P(ShellTest, RecallsWhatItPublished) {
  describe();
  for (int i = 0; i < 20; ++i)
    one({behavior("Stop", 2)});
  bus::Reader<v1::BehaviorSet> late{bridge.reader(bus::topics::kRecallBehaviors)};
  const auto samples = late.take();
  ASSERT_EQ(samples.size(), 20U);
  EXPECT_EQ(samples.front().data.stamp.cycle, 1U);
  EXPECT_EQ(samples.back().data.stamp.cycle, cycle);
}

/// A shell with a user's folder, and the example plug-in.
TEST(ShellFiles, AreTakenWhileItRunsAndTold) {
  namespace fs = std::filesystem;
  const test::TempDir temporary;
  const fs::path folder = temporary.path();
  int time = 1'000'000;
  const auto write = [&](const std::string& text) {
    std::ofstream(folder / "mine.beh") << text;
    fs::last_write_time(folder / "mine.beh", fs::file_time_type(std::chrono::seconds(++time)));
  };
  const std::string head = "BeginBehavior ConstantVelocity\nParams\nRules\n";
  const std::string tail = "\nUpdate\nActivity\nEndBehavior\n";
  const auto memory = bus::make_memory_bus();
  bus::Node bridge(test::memory_options("bridge"), memory);
  bus::Node service(test::memory_options("behaviors"), memory);
  auto states = bridge.writer(bus::topics::kRobotState);
  auto descriptions = bridge.writer(bus::topics::kRobotDescription);
  auto intentions = bridge.writer(bus::topics::kIntentions);
  auto behaviors = bridge.reader(bus::topics::kBehaviors);
  auto schemas = bridge.reader(bus::topics::kBehaviorSchemas);
  runtime::Shell shell(service, with({folder.string(), {SAPHIRA_EXAMPLE_PLUGIN}}));
  const auto find = [](const v1::BehaviorSchemas& all, const std::string& name) {
    for (const v1::BehaviorSchema& schema : all.schemas)
      if (schema.name == name)
        return schema;
    return v1::BehaviorSchema();
  };
  std::optional<v1::BehaviorSchemas> told = schemas.take_newest();
  ASSERT_TRUE(told);
  EXPECT_GE(told->schemas.size(), 12U);
  EXPECT_EQ(told->trouble, "");
  EXPECT_EQ(find(*told, "HoldDistance").source, SAPHIRA_EXAMPLE_PLUGIN);
  EXPECT_EQ(find(*told, "ConstantVelocity").parameters.size(), 2U) << "speed, contact";

  bus::Stop stop;
  std::uint64_t cycle = 0;
  descriptions.write({.stamp = {.epoch = 7}, .max_velocity = 0.4});
  // Twice as many cycles as are between two looks.
  const auto drive = [&] {
    double speed = 0.0;
    for (int i = 0; i < 20; ++i) {
      v1::Intentions intended{.stamp = {7, cycle},
                              .behavior_control = true,
                              .behaviors = {behavior("ConstantVelocity", 2)}};
      states.write({.stamp = {7, ++cycle}});
      intentions.write(intended);
      EXPECT_TRUE(shell.step(stop));
      if (const auto newest = behaviors.take_newest())
        speed = newest->speed;
    }
    return speed;
  };
  EXPECT_DOUBLE_EQ(drive(), 0.2);
  write(head + "If 1.0 Then Speed 50" + tail);
  EXPECT_DOUBLE_EQ(drive(), 0.05);
  told = schemas.take_newest();
  ASSERT_TRUE(told);
  EXPECT_EQ(find(*told, "ConstantVelocity").source, (folder / "mine.beh").string());
  ASSERT_EQ(find(*told, "ConstantVelocity").rules.size(), 1U);
  EXPECT_EQ(find(*told, "ConstantVelocity").rules[0].action, "Speed 50");
  write(head + "If 1.0 Then Speed" + tail);
  EXPECT_DOUBLE_EQ(drive(), 0.05);
  told = schemas.take_newest();
  ASSERT_TRUE(told);
  EXPECT_NE(told->trouble.find("mine.beh:5:1: expected a variable or a number"), std::string::npos)
      << told->trouble;
}

TEST(ShellFiles, APluginThatIsNoneEndsItAtItsStart) {
  const auto memory = bus::make_memory_bus();
  bus::Node service(test::memory_options("behaviors"), memory);
  EXPECT_THROW(runtime::Shell(service, with({"", {"/nowhere.so"}})), std::runtime_error);
}

}  // namespace
}  // namespace saphira::behaviors

#include "saphira/sim/scene.hpp"

#include <gtest/gtest.h>

#include <string>

#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/sim/simulation.hpp"
#include "saphira/sim/sonar.hpp"
#include "world_scene.hpp"

namespace saphira::sim {
namespace {

using protocol::encode;
using protocol::RobotParameters;

TEST(Things, DiscsAreSeenAndTouched) {
  Things things;
  things.discs.push_back({{3.0, 0.0}, 0.5});
  EXPECT_DOUBLE_EQ(distance(things, {0.0, 0.0}), 2.5);
  EXPECT_EQ(*nearest_point(things, {0.0, 0.0}), Vec2(2.5, 0.0));
  EXPECT_DOUBLE_EQ(distance(things, {3.0, 0.25}), -0.25);
  EXPECT_NEAR((*nearest_point(things, {3.0, 0.25}) - Vec2(3.0, 0.5)).norm(), 0.0, 1e-12);
  const auto hit = cast_ray(things, {0.0, 0.0}, {1.0, 0.0}, 5.0);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(*hit, 2.5);
  const auto aside = cast_ray(things, {0.0, 0.3}, {1.0, 0.0}, 5.0);
  ASSERT_TRUE(aside);
  EXPECT_NEAR(*aside, 2.6, 1e-12);
  EXPECT_FALSE(cast_ray(things, {0.0, 0.6}, {1.0, 0.0}, 5.0));
  EXPECT_FALSE(cast_ray(things, {0.0, 0.0}, {-1.0, 0.0}, 5.0));
  EXPECT_FALSE(cast_ray(things, {0.0, 0.0}, {1.0, 0.0}, 2.0));
  things.segments.push_back({{2.0, -1.0}, {2.0, 1.0}});
  EXPECT_DOUBLE_EQ(cast_ray(things, {0.0, 0.0}, {1.0, 0.0}, 5.0).value(), 2.0);
  EXPECT_DOUBLE_EQ(distance(things, {0.0, 0.0}), 2.0);
}

TEST(Scene, RobotsSeeEachOther) {
  WorldScene scene(room());
  scene.add_robot(one_sonar(), {2.0, 5.0, 0.0}, 1);
  scene.add_robot(one_sonar(), {4.0, 5.0, kPi}, 2);
  SonarModel model;
  model.noise = model.relative_noise = model.dropout = 0.0;
  for (RobotNumber i = 0; i < 2; ++i) {
    Sonars sonars(scene, i, one_sonar(), model, 1);
    for (int tick = 0; tick < 10; ++tick)
      scene.tick();  // or the second would hear the first one's sound
    const auto echo = sonars.fire(0, scene.robot(i).pose_in_world());
    ASSERT_TRUE(echo.range);
    EXPECT_NEAR(*echo.range, 2.0 - 0.22, 0.001) << i;  // round, so a little late
  }
  EXPECT_NEAR(scene.robot(0).clearance(), 2.0 - 0.44, 1e-12);
}

// Two sonars that face each other: one hears the other's sound, once, and directly.
TEST(Scene, SonarsHearEachOther) {
  const World world = room();
  SonarModel model;
  model.noise = model.relative_noise = model.dropout = model.crosstalk = 0.0;
  const auto hears = [&](double th, int ticks_between, const Pose& other) {
    Scene scene(world);
    scene.add_robot(one_sonar(), {2.0, 5.0, 0.0}, 1);
    scene.add_robot(one_sonar(), other, 2);
    Sonars one(scene, 0, one_sonar(), model, 1);
    Sonars two(scene, 1, one_sonar(), model, 1);
    one.fire(0, {2.0, 5.0, th});
    for (int i = 0; i < ticks_between; ++i)
      scene.tick();
    return two.fire(0, other).range.value_or(0.0);
  };
  const Pose facing{6.0, 5.0, kPi};
  EXPECT_NEAR(hears(0.0, 0, facing), 2.0, 1e-9);                          // half of 4 m
  EXPECT_NEAR(hears(0.0, 1, facing), (4.0 - 0.01 * kSound) / 2.0, 1e-9);  // late
  EXPECT_NEAR(hears(0.0, 2, facing), 4.0 - 0.22, 0.002);                  // too late: an echo
  EXPECT_NEAR(hears(kPi / 2.0, 0, facing), 4.0 - 0.22, 0.002);            // looks elsewhere
}

class SimulationTest : public ::testing::Test {
 protected:
  SimulationTest() : world_(room()) {}

  static void send(Simulation& simulation, RobotNumber number, const protocol::Command& command) {
    simulation.receive(number, encode(command));
  }
  static void open(Simulation& simulation, RobotNumber number) {
    for (int i = 0; i < 3; ++i)
      simulation.receive(number, protocol::encode_sync(i));
    send(simulation, number, protocol::Open{});
    simulation.server(number).take_output();
  }
  static std::string trace(Simulation& simulation, RobotNumber number) {
    std::string text;
    for (const TraceRow& row : simulation.server(number).take_trace())
      text += to_csv(row);
    return text;
  }

  World world_;
};

TEST_F(SimulationTest, OneRobotIsAServerAlone) {
  ServerOptions options;
  options.trace = true;
  Simulation simulation(world_);
  simulation.add(one_sonar(), {2.0, 5.0, 0.0}, options);
  Scene scene(world_);
  Server server(scene, one_sonar(), {2.0, 5.0, 0.0}, options);
  open(simulation, 0);
  for (int i = 0; i < 3; ++i)
    server.receive(protocol::encode_sync(i));
  server.receive(encode(protocol::Open{}));
  server.take_output();
  for (int i = 0; i < 200; ++i) {
    protocol::Bytes bytes = encode(protocol::Velocity{0.1 * (i % 5)});
    if (i % 20 < 10) {
      const protocol::Bytes more = encode(protocol::Step{});
      bytes.insert(bytes.end(), more.begin(), more.end());
    }
    simulation.receive(0, bytes);
    server.receive(bytes);
    simulation.advance(7);
    server.advance(7);
    ASSERT_EQ(simulation.server(0).take_output(), server.take_output()) << i;
  }
  simulation.disconnect(0);
  server.disconnect();
  std::string expected;
  for (const TraceRow& row : server.take_trace())
    expected += to_csv(row);
  EXPECT_EQ(trace(simulation, 0), expected);
}

TEST_F(SimulationTest, AStepIsMadeWhenAllHaveAskedForIt) {
  ServerOptions options;
  options.single_step = true;
  options.trace = true;
  Simulation simulation(world_);
  simulation.add(one_sonar(), {2.0, 5.0, 0.0}, options);
  simulation.add(one_sonar(), {2.0, 7.0, 0.0}, options);
  open(simulation, 0);
  send(simulation, 0, protocol::Step{});
  EXPECT_EQ(simulation.scene().ticks(), 0U) << "before the second robot is open";
  open(simulation, 1);
  EXPECT_EQ(simulation.scene().ticks(), 0U);
  // Messages behind a STEP wait for it.
  send(simulation, 0, protocol::Velocity{0.4});
  EXPECT_EQ(simulation.server(0).robot().target_velocity(), 0.0);
  send(simulation, 1, protocol::Step{});
  EXPECT_EQ(simulation.scene().ticks(), 10U);
  EXPECT_EQ(simulation.server(0).robot().target_velocity(), 0.4);
  send(simulation, 1, protocol::Step{});
  send(simulation, 1, protocol::Step{});
  EXPECT_EQ(simulation.scene().ticks(), 10U);
  send(simulation, 0, protocol::Step{});
  send(simulation, 0, protocol::Step{});
  EXPECT_EQ(simulation.scene().ticks(), 30U);
  EXPECT_GT(simulation.server(0).robot().velocity(), 0.0);
  // A client that has gone is not waited for, and its robot comes to rest in the others' steps.
  simulation.disconnect(0);
  EXPECT_GT(simulation.server(0).robot().velocity(), 0.0);
  for (int i = 0; i < 5; ++i)
    send(simulation, 1, protocol::Step{});
  EXPECT_EQ(simulation.scene().ticks(), 80U);
  EXPECT_EQ(simulation.server(0).robot().velocity(), 0.0);
  // The last one's robot comes to rest at once.
  send(simulation, 1, protocol::Velocity{0.4});
  send(simulation, 1, protocol::Step{});
  simulation.disconnect(1);
  EXPECT_EQ(simulation.server(1).robot().velocity(), 0.0);
}

// The result is the same, whichever client connects and sends first.
TEST_F(SimulationTest, TheOrderOfTheClientsDoesNotMatter) {
  const auto run = [&](bool turned) {
    ServerOptions options;
    options.single_step = true;
    options.trace = true;
    Simulation simulation(world_);
    for (int i = 0; i < 2; ++i) {
      options.seed = static_cast<std::uint64_t>(i + 1);
      RobotParameters parameters = one_sonar();
      parameters.encode_jitter = parameters.angle_jitter = 0.02;
      simulation.add(parameters, {4.0 + i, 5.0 + 0.1 * i, 0.0}, options);
    }
    for (const RobotNumber i : {0U, 1U})
      open(simulation, turned ? 1 - i : i);
    for (int cycle = 0; cycle < 300; ++cycle)
      for (const RobotNumber i : {0U, 1U}) {
        const RobotNumber number = turned ? 1 - i : i;
        send(simulation, number, protocol::Velocity{number == 0 ? 0.4 : -0.2});
        send(simulation, number, protocol::RotationVelocity{0.1});
        send(simulation, number, protocol::Step{});
      }
    return trace(simulation, 0) + trace(simulation, 1);
  };
  const std::string one = run(false);
  EXPECT_EQ(one, run(true));
  EXPECT_GT(one.size(), 60000U);
}

}  // namespace
}  // namespace saphira::sim

// The library and its robot on a bus in memory, without processes.

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "../shell/bus_robot.hpp"
#include "../src/os.hpp"
#include "node_options.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::c {
namespace {

TEST(View, ASonarWithoutAnEchoIsOnItsAxisAtItsRange) {
  protocol::RobotParameters robot;
  robot.file = "test";
  reflector::State state;
  state.buckets = {{{2, 5.0, false}, 1, Pose{}, Vec2(0.13 + 3.0, 4.0)}};
  Os::get().reflect(state, robot);
  EXPECT_EQ(sfSonarRange(2), 5000);
  EXPECT_NEAR(sfSonarXCoord(2), 3130.0F, 0.5F);
  EXPECT_NEAR(sfSonarYCoord(2), 4000.0F, 0.5F);
}

TEST(Angles, AreRadiansAndForProgramsOfSaphira6Degrees) {
  EXPECT_NEAR(sfNormAngle(-1.0F), 2.0 * kPi - 1.0, 1e-5);
  point* const p = sfCreateGlobalPoint(1000.0F, 0.0F, 1.0F);
  EXPECT_NEAR(p->ath, 1.0F, 1e-6);
  Os::get().angle_unit = radians(1.0);
  EXPECT_NEAR(sfNormAngle(-90.0F), 270.0F, 1e-3);
  EXPECT_NEAR(sfSub2Angle(10.0F, 30.0F), -20.0F, 1e-3);
  point* const q = sfCreateGlobalPoint(1000.0F, 1000.0F, 90.0F);
  EXPECT_NEAR(q->ath, 90.0F, 1e-3);
  EXPECT_NEAR(sfPointPhi(q), 45.0F, 1e-3);
  Os::get().angle_unit = 1.0;
  std::free(p);
  std::free(q);
}

/// A program's robot, and the other side of the bus.
class OnMemory : public testing::Test {
 protected:
  OnMemory() {
    stamp_.epoch = 7;
    v1::RobotDescription description{.stamp = stamp_};
    descriptions_.write(description);
    EXPECT_TRUE(test::wait_until([this] {
      v1::RobotState state;
      ++stamp_.cycle;
      state.stamp = stamp_;
      state.odom = 1;
      states_.write(state);
      return robot_->session() != 0;
    }));
  }
  void drive(double velocity) {
    reflector::Motion motion{.translation = reflector::Translation::velocity, .velocity = velocity};
    robot_->drive(motion, stamp_.cycle);
  }
  /// The speeds of the commands until this one comes, which are not releases.
  std::vector<double> until(double velocity) {
    std::vector<double> told;
    EXPECT_TRUE(test::wait_until([&] {
      for (const auto& sample : commands_.take())
        if (sample.data.active)
          told.push_back(sample.data.velocity);
      return !told.empty() && told.back() == velocity;
    }));
    return told;
  }
  /// Registration's pose, until the robot has taken it or one later sample.
  void registers(double x) {
    v1::Registration sample{.stamp = stamp_, .state = v1::REGISTRATION_TRACKING, .odom = 1};
    sample.odom_in_map.x = x;
    registrations_.write(sample);
    v1::Registration next = sample;
    next.environment = ++environment_;
    registrations_.write(next);
    EXPECT_TRUE(test::wait_until([&] { return robot_->found()->environment == environment_; }));
  }

  std::shared_ptr<bus::MemoryBus> memory_ = bus::make_memory_bus();
  bus::Node bridge_{test::memory_options("bridge"), memory_};
  bus::Writer<v1::RobotDescription> descriptions_ = bridge_.writer(bus::topics::kRobotDescription);
  bus::Writer<v1::RobotState> states_ = bridge_.writer(bus::topics::kRobotState);
  bus::Writer<v1::Grant> grants_ = bridge_.writer(bus::topics::kGrant);
  bus::Writer<v1::Registration> registrations_ = bridge_.writer(bus::topics::kRegistration);
  bus::Writer<v1::Answer> answers_ = bridge_.writer(bus::topics::kRegistrationRequest.answers);
  bus::Reader<v1::Request> placed_ = bridge_.reader(bus::topics::kRegistrationRequest);
  bus::Reader<v1::Request> stops_ = bridge_.reader(bus::topics::kDriveStop);
  bus::Reader<v1::MotorCommand> commands_ = bridge_.reader(bus::topics::kDriveDirect);
  v1::Stamp stamp_;
  std::uint32_t environment_ = 0;
  std::unique_ptr<Robot> robot_ = robot_on_bus(
      test::memory_options("program"), [](const std::string&, bool) {}, memory_);
};

TEST_F(OnMemory, SfStopRobotAsksTheBridgeForAStop) {
  robot_->stop();  // of Os::stop_robot, which is sfStopRobot
  std::optional<v1::Request> asked;
  EXPECT_TRUE(test::wait_until([&] { return (asked = stops_.take_newest()).has_value(); }));
  EXPECT_EQ(asked->functor, "stop");
  EXPECT_EQ(asked->source, "program");
}

TEST_F(OnMemory, AfterAStopCommandsAreDroppedUntilItIsTaken) {
  v1::Grant grant{.stamp = stamp_};
  grants_.write(grant);
  drive(0.3);
  EXPECT_EQ(until(0.3), std::vector<double>{0.3});
  grant.stop.number = 1;
  grant.stop_source = "somebody";
  grants_.write(grant);
  EXPECT_TRUE(test::wait_until([&] {
    const auto command = commands_.take_newest();
    return command && !command->active;
  })) << "it lets go";
  drive(0.3);
  EXPECT_TRUE(robot_->take_stop());
  drive(0.2);
  EXPECT_EQ(until(0.2), std::vector<double>{0.2});
}

TEST_F(OnMemory, APersonWhoTakesTheWheelsIsTold) {
  v1::Grant grant{.stamp = stamp_, .role = v1::ROLE_TELEOP, .source = "ann"};
  grants_.write(grant);  // the program has not driven
  grant = {.stamp = stamp_, .role = v1::ROLE_DIRECT, .source = "program"};
  grants_.write(grant);
  // Grants are read as the newest: each has to be seen before the next.
  grant.estopped = true;
  EXPECT_TRUE(test::wait_until([&] {
    grants_.write(grant);
    grant.estopped = !grant.estopped;
    return commands_.take_newest().has_value();
  }));
  EXPECT_EQ(robot_->take_driver(), "");
  grant = {.stamp = stamp_, .role = v1::ROLE_TELEOP, .source = "ann"};
  grants_.write(grant);
  std::string driver;
  EXPECT_TRUE(test::wait_until([&] { return !(driver = robot_->take_driver()).empty(); }));
  EXPECT_EQ(driver, "ann");
  EXPECT_EQ(robot_->take_driver(), "");
}

TEST(Tasks, AWordOfAnotherThreadOutlastsTheTurn) {
  static std::atomic<bool> runs;
  runs = false;
  process* const task = sfInitProcess(
      [] {
        if (process_state != sfINIT)
          return;
        runs = true;
        while (runs)
          std::this_thread::yield();
        process_state = 20;
      },
      "busy");
  std::thread turn([] { Os::get().run_tasks(); });
  EXPECT_TRUE(test::wait_until([] { return runs.load(); }));
  sfSuspendProcess(task, 5);
  runs = false;
  turn.join();
  EXPECT_EQ(task->state, -5);
  task->state = sfREMOVE;
}

TEST_F(OnMemory, SfMoveRobotHoldsUntilRegistrationHasAnswered) {
  registers(1.0);
  EXPECT_EQ(robot_->found()->odom_in_map->x, 1.0);
  robot_->place({5.0, 0.0, 0.0});
  std::optional<v1::Request> asked;
  EXPECT_TRUE(test::wait_until([&] { return (asked = placed_.take_newest()).has_value(); }));
  EXPECT_EQ(asked->functor, "place");
  registers(1.0);
  EXPECT_FALSE(robot_->found()->odom_in_map) << "its pose is the one before";
  v1::Answer answer{.asker = asked->asker, .number = asked->number, .code = v1::ANSWER_DONE};
  answers_.write(answer);
  EXPECT_TRUE(test::wait_until([&] {
    registers(5.0);
    return robot_->found()->odom_in_map.has_value();
  }));
  EXPECT_EQ(robot_->found()->odom_in_map->x, 5.0);
}

}  // namespace
}  // namespace saphira::c

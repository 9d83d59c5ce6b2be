#include "saphira/situation/occasions.hpp"

#include <gtest/gtest.h>

#include "office.hpp"

namespace saphira::situation {
namespace {

using test::driving;

/// The kind of the occasion that a change makes, half a second after the situation without it.
class OccasionsTest : public testing::Test {
 protected:
  std::string look(double seconds = 0.5) {
    now += seconds;
    const auto found = occasions.look(s, now);
    return found ? found->kind : "";
  }
  Situation s = driving();
  Occasions occasions;
  double now = 100.0;
};

TEST_F(OccasionsTest, TheBeginningAndAQuietDriveAreNone) {
  s.grant->estopped = true;
  s.grant->stop = {1, 1};
  EXPECT_EQ(look(), "");
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(look(), "");
}

TEST_F(OccasionsTest, StopsAreToldOnceEach) {
  look();
  s.grant->stop = {7, 1};
  s.grant->stop_source = "karen";
  now += 0.5;
  const auto found = occasions.look(s, now);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, "stopped");
  EXPECT_EQ(found->text, "stopped by karen");
  EXPECT_EQ(look(), "");
  s.grant->stop = {7, 2};
  EXPECT_EQ(look(), "") << "within ten seconds";
  s.grant->stop = {7, 3};
  EXPECT_EQ(look(10.0), "stopped");
  s.grant->estopped = true;
  EXPECT_EQ(look(), "estop");
  EXPECT_EQ(look(20.0), "") << "it is latched";
}

TEST_F(OccasionsTest, AGoalThatFails) {
  look();
  v1::GoalStatus status;
  status.id = {5, 1};
  status.functor = "go-to-place";
  status.state = v1::GOAL_UNDERWAY;
  s.statuses = {status};
  EXPECT_EQ(look(), "");
  s.statuses[0].state = v1::GOAL_FAILED;
  s.statuses[0].reason = "no way to N3";
  now += 0.5;
  const auto found = occasions.look(s, now);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, "goal-failed");
  EXPECT_EQ(found->text, "go-to-place has failed: no way to N3");
  EXPECT_EQ(look(20.0), "");
  status.id = {5, 2};
  status.state = v1::GOAL_SUCCEEDED;
  s.statuses.push_back(status);
  EXPECT_EQ(look(20.0), "") << "a success";
}

TEST_F(OccasionsTest, AGuardThatHoldsTheRobotForASecond) {
  look();
  s.grant->guard = v1::GUARD_STOP;
  EXPECT_EQ(look(), "");
  EXPECT_EQ(look(), "");
  EXPECT_EQ(look(), "guard");
  EXPECT_EQ(look(20.0), "") << "it still holds it";
  s.grant->guard = v1::GUARD_NONE;
  EXPECT_EQ(look(), "");
  s.grant->guard = v1::GUARD_STOP;
  EXPECT_EQ(look(), "");
  EXPECT_EQ(look(1.0), "guard");
}

TEST_F(OccasionsTest, AStallAndTheTroubleThatTheBridgeTells) {
  ASSERT_EQ(s.programs.front().status.name, "bridge");
  look();
  s.robot->left_stalled = true;
  EXPECT_EQ(look(), "stalled");
  EXPECT_EQ(look(20.0), "");
  v1::ServiceStatus& bridge = s.programs.front().status;
  bridge.state = v1::SERVICE_DEGRADED;
  bridge.reason = "the battery is nearly empty";
  now += 0.5;
  const auto found = occasions.look(s, now);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, "robot-trouble");
  EXPECT_EQ(found->text, "the battery is nearly empty");
  EXPECT_EQ(look(20.0), "");
  bridge.state = v1::SERVICE_RUNNING;
  look();
  s.grant->estopped = true;
  bridge.state = v1::SERVICE_DEGRADED;
  EXPECT_EQ(look(20.0), "estop");
  EXPECT_EQ(look(20.0), "") << "its own trouble is the same event";
}

TEST_F(OccasionsTest, LossesOfProgramRobotAndPlace) {
  look();
  s.programs.front().age = 3.5;
  EXPECT_EQ(look(), "program-lost");
  EXPECT_EQ(look(20.0), "");
  s.silence = 1.2;
  EXPECT_EQ(look(), "silent");
  s.silence = 0.0;
  v1::Registration registration;
  registration.state = v1::REGISTRATION_TRACKING;
  s.registration = registration;
  EXPECT_EQ(look(20.0), "");
  s.registration->state = v1::REGISTRATION_LOST;
  EXPECT_EQ(look(), "robot-lost");
  EXPECT_EQ(look(20.0), "");
}

}  // namespace
}  // namespace saphira::situation

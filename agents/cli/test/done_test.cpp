#include "saphira/cli/done.hpp"

#include <gtest/gtest.h>

#include "saphira/geometry/pose.hpp"

namespace saphira::cli {
namespace {

TEST(Done, AMoveWhenNothingIsLeftOfItAndTheRobotRests) {
  const Move move{Move::Kind::move, "move", -0.5, 0.2};
  const v1::MotorCommand command = command_of(move);
  EXPECT_TRUE(command.active);
  EXPECT_EQ(command.translation, v1::TRANSLATION_POSITION);
  EXPECT_EQ(command.distance, -0.5);
  EXPECT_EQ(command.velocity, 0.2);
  EXPECT_EQ(command.rotation, v1::ROTATION_NONE);
  v1::Grant grant;
  v1::RobotState robot;
  grant.distance_left = -0.35;
  EXPECT_FALSE(done(move, grant, robot));
  EXPECT_EQ(rest_of(move, grant, robot), ", 0.35 m left");
  grant.distance_left = 0.0;
  robot.velocity = -0.1;
  EXPECT_FALSE(done(move, grant, robot));
  robot.velocity = 0.0;
  EXPECT_TRUE(done(move, grant, robot));
  EXPECT_EQ(rest_of(move, grant, robot), "");
}

TEST(Done, ATurnWhenTheRobotPointsThereAndRests) {
  const Move turn{Move::Kind::turn, "turn", radians(90.0), 0.0};
  v1::Grant grant{.rotation = v1::ROTATION_HEADING, .heading = radians(-179.0)};
  v1::RobotState robot{.pose_in_odom = {.th = radians(150.0)}};
  EXPECT_FALSE(done(turn, grant, robot));
  EXPECT_EQ(rest_of(turn, grant, robot), ", 31 degrees left");
  robot.pose_in_odom.th = radians(180.0);
  robot.rotation_velocity = 0.5;
  EXPECT_FALSE(done(turn, grant, robot));
  robot.rotation_velocity = 0.0;
  EXPECT_TRUE(done(turn, grant, robot));
}

TEST(Done, ASpeedNever) {
  EXPECT_FALSE(done({Move::Kind::speed, "speed", 0.0, 0.0}, {}, {}));
}

TEST(Move, IsCheckedBeforeAnythingMoves) {
  EXPECT_EQ(trouble_of({Move::Kind::move, "move", 1.0, 0.0}), "");
  EXPECT_EQ(trouble_of({Move::Kind::turn, "turn", radians(-180.0), 0.0}), "");
  EXPECT_EQ(trouble_of({Move::Kind::move, "move", 0.0, 0.0}),
            "move: expected meters from -100 to 100 and not 0, found 0");
  EXPECT_EQ(trouble_of({Move::Kind::turn, "turn", radians(400.0), 0.0}),
            "turn: expected degrees from -180 to 180 and not 0, found 400");
  EXPECT_EQ(trouble_of({Move::Kind::speed, "speed", 9.0, 0.0}),
            "speed: expected meters a second from -5 to 5, found 9");
}

}  // namespace
}  // namespace saphira::cli

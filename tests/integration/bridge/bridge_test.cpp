// The bridge over the real bus, with a simulated robot in its own process: the choice of the
// driver, and no motion without one.
#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::test {
namespace {

using std::chrono::milliseconds;

TEST(Bridge, DescribesTheRobotAndDrivesIt) {
  Scene scene;
  scene.start();
  ASSERT_TRUE(scene.until([&] { return scene.connected() && scene.description; }))
      << scene.bridge_log();
  EXPECT_EQ(scene.description->robot_class, "Pioneer");
  EXPECT_EQ(scene.description->sonars.size(), 7U);
  EXPECT_NEAR(scene.description->radius, 0.22, 1e-9);
  EXPECT_NEAR(scene.description->max_velocity, 0.4, 1e-9);
  EXPECT_EQ(scene.description->stamp.epoch, scene.state.stamp.epoch);
  EXPECT_EQ(scene.state.pose_in_odom.x, 0.0);

  forward(scene.command, 0.2, 0.3);
  scene.drives = true;
  ASSERT_TRUE(scene.until([&] {
    return scene.state.velocity > 0.18 && scene.state.rotation_velocity > 0.2;
  })) << scene.bridge_log();
  EXPECT_EQ(scene.grant.role, v1::ROLE_DIRECT);
  EXPECT_EQ(scene.grant.source, "test");
  EXPECT_NEAR(scene.grant.velocity, 0.2, 1e-9);
  EXPECT_GT(scene.grant.expires_in, 0.0);
  ASSERT_TRUE(scene.until([&] { return scene.status.state == v1::SERVICE_RUNNING; }));

  // Release is a stop at once: only the robot's own braking remains (0.2 m/s at 2 m/s2).
  scene.drives = false;
  scene.command.active = false;
  const std::uint64_t released = scene.state.stamp.cycle;
  scene.publish();
  // The trace, not the robot's own state: its packets round a last tremble away.
  ASSERT_TRUE(scene.until([&] { return stood_still(scene.trace(), released) != 0; }));
  const std::uint64_t still = stood_still(scene.trace(), released);
  EXPECT_GT(still, 0U);
  EXPECT_LE(still, released + 4);
  EXPECT_EQ(scene.grant.role, v1::ROLE_NONE);
}

TEST(BridgeInLockstep, TheGuardStopsBeforeAWall) {
  Scene scene(true);
  scene.world += "11500 8000 11500 12000\n";
  scene.start();
  forward(scene.command, 0.4);
  scene.permit(150);
  ASSERT_TRUE(scene.until([&] { return scene.state.stamp.cycle == 150; })) << scene.bridge_log();
  EXPECT_EQ(scene.grant.guard, v1::GUARD_STOP);
  EXPECT_NE(scene.grant.guard_reason.find("ahead"), std::string::npos);
  EXPECT_TRUE(scene.rests());
  // Turning away is free.
  forward(scene.command, 0.4, 0.8);
  scene.permit(200);
  ASSERT_TRUE(scene.until([&] { return scene.state.velocity > 0.3; }));
  std::vector<sim::TraceRow> rows = scene.end();
  ASSERT_GE(rows.size(), 150U);
  rows.resize(150);
  EXPECT_EQ(rows.back().contacts, 0);
  // Room for a person, who reaches farther than the shin's echo.
  EXPECT_GT(rows.back().clearance, 0.2);
  EXPECT_LT(rows.back().clearance, 0.35) << "stopped needlessly early";
}

}  // namespace
}  // namespace saphira::test

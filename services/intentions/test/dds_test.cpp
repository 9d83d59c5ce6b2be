#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "node_options.hpp"
#include "process.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/bus/goal_client.hpp"
#include "scripted_bus.hpp"

namespace saphira::intentions {
namespace {

using std::chrono::milliseconds;

/// A robot in its own thread: as fast as the service answers, or without an answer at 10 Hz.
class Robot10Hz {
 public:
  explicit Robot10Hz(const std::string& robot)
      : node_(test::node_options("robot", robot)), thread_([this] { run(); }) {}
  ~Robot10Hz() {
    stop_.request();
    thread_.join();
  }

 private:
  void run() {
    ScriptedBus world(node_);
    while (!stop_.requested()) {
      world.publish_state();
      for (int i = 0; i < 10 && !world.act(); ++i)
        node_.wait(milliseconds(10), &stop_);
    }
  }

  bus::Node node_;
  bus::Stop stop_;
  std::thread thread_;
};

/// The service's program, and a requester here.
class IntentionsProgram : public testing::Test {
 protected:
  std::vector<std::string> command() const {
    return {"saphira-intentions", "--robot",         robot, "--domain", test::domain(),
            "--memory",           dir.path("memory")};
  }
  bool reaches(const v1::GoalId& id, v1::GoalState state) {
    return test::wait_until([&] {
      requester.wait(milliseconds(20));
      goals.poll();
      const auto status = goals.status(id);
      return status && status->state == state;
    });
  }
  std::string told(const v1::GoalId& id) {
    const auto status = goals.status(id);
    return status ? bus::describe(*status) : "no status";
  }

  const std::string robot = test::unique_robot();
  const test::TempDir dir;
  bus::Node requester{test::node_options("requester", robot)};
  bus::GoalClient goals{requester, "a test"};
};

// Killed at 90 degrees of a half turn, it turns the other 90, not another 180.
TEST_F(IntentionsProgram, AHalfTurnIsAHalfTurnOverAKill) {
  bus::Node node(test::node_options("robot", robot));
  ScriptedBus site(node);
  std::optional<test::Process> service(std::in_place, command(), dir.path("log"));
  const v1::GoalId id = goals.ask(test::goal("about-turn"));
  double turned = 0.0;
  bool killed = false;
  EXPECT_TRUE(test::wait_until([&] {
    const double before = site.world.robot.pose_in_odom.th;
    site.publish_state();
    bool acted = false;
    for (int i = 0; i < 10 && !(acted = site.act()); ++i)
      node.wait(milliseconds(10));
    if (!acted)
      site.world.move({});  // no driver: it stands
    turned += norm2_angle(site.world.robot.pose_in_odom.th - before);
    if (!killed && turned > kPi / 2.0) {
      killed = true;
      service->signal(SIGKILL);
      service->wait();
      service.emplace(command(), dir.path("log2"));
    }
    goals.poll();
    const auto status = goals.status(id);
    return status && bus::ended(status->state);
  })) << told(id);
  EXPECT_TRUE(killed);
  EXPECT_EQ(goals.status(id)->state, v1::GOAL_SUCCEEDED) << told(id);
  EXPECT_EQ(goals.status(id)->note, "");
  EXPECT_NEAR(turned, kPi, 0.15);
}

TEST_F(IntentionsProgram, StartsWithADamagedMemoryAndSaysSo) {
  std::ofstream(dir.path("memory")) << sealed("ended 1f 2 succeeded none fine") << "placed \x81\n";
  std::ofstream(dir.path("memory.work")) << sealed("nonsense\n");
  test::Process service(command(), dir.path("log"));
  Robot10Hz world(robot);
  const v1::GoalId id = goals.ask(go_to(0.3, 0.0));
  EXPECT_TRUE(reaches(id, v1::GOAL_SUCCEEDED)) << told(id) << service.output();
  EXPECT_NE(service.output().find("memory.damaged"), std::string::npos) << service.output();
  EXPECT_NE(service.output().find("memory.work.damaged"), std::string::npos);
}

}  // namespace
}  // namespace saphira::intentions

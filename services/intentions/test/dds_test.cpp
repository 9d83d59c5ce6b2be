#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "node_options.hpp"
#include "process.hpp"
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
  bool reaches(bus::GoalClient& client, const v1::GoalId& id, v1::GoalState state) {
    return test::wait_until([&] {
      requester.wait(milliseconds(20));
      client.poll();
      const auto status = client.status(id);
      return status && status->state() == state;
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

v1::Goal drive() {
  v1::Goal goal;
  goal.functor("drive");
  goal.arguments().push_back(bus::number("speed", 0.2));
  return goal;
}

TEST_F(IntentionsProgram, TakesGoalsToTheirEnd) {
  test::Process service(command(), dir.path("log"));
  v1::Goal wrong;
  wrong.functor("fly");
  const v1::GoalId refused = goals.ask(wrong);
  EXPECT_TRUE(goals.delivered(10000));
  EXPECT_TRUE(reaches(goals, refused, v1::GOAL_REFUSED)) << told(refused);
  const v1::GoalId id = goals.ask(go_to(1.0, 0.0));
  EXPECT_TRUE(reaches(goals, id, v1::GOAL_WAITING)) << told(id);
  Robot10Hz world(robot);
  EXPECT_TRUE(reaches(goals, id, v1::GOAL_SUCCEEDED)) << told(id) << service.output();
}

TEST_F(IntentionsProgram, CancelsAlsoForAnother) {
  test::Process service(command(), dir.path("log"));
  Robot10Hz world(robot);
  const v1::GoalId own = goals.ask(drive());
  EXPECT_TRUE(reaches(goals, own, v1::GOAL_UNDERWAY)) << told(own);
  goals.cancel(own);
  EXPECT_TRUE(reaches(goals, own, v1::GOAL_CANCELED)) << told(own);
  const v1::GoalId foreign = goals.ask(drive());
  EXPECT_TRUE(reaches(goals, foreign, v1::GOAL_UNDERWAY)) << told(foreign);
  bus::GoalClient another(requester, "another");
  EXPECT_TRUE(reaches(another, foreign, v1::GOAL_UNDERWAY));
  another.cancel(foreign);
  EXPECT_TRUE(reaches(goals, foreign, v1::GOAL_CANCELED)) << told(foreign);
}

TEST_F(IntentionsProgram, HearsThatAWriterIsGone) {
  test::Process service(command(), dir.path("log"));
  Robot10Hz world(robot);
  v1::GoalId canceled;
  v1::GoalId kept;
  {
    bus::Node node(test::node_options("another", robot));
    bus::GoalClient another(node, "another");
    canceled = another.ask(drive());
    v1::Goal goal = go_to(0.5, 0.0);
    goal.writer_lost(v1::WRITER_LOST_KEEP);
    kept = another.ask(goal);
    EXPECT_TRUE(reaches(goals, canceled, v1::GOAL_UNDERWAY)) << told(canceled);
    EXPECT_TRUE(reaches(goals, kept, v1::GOAL_WAITING)) << told(kept);
  }
  EXPECT_TRUE(reaches(goals, canceled, v1::GOAL_CANCELED)) << told(canceled);
  EXPECT_EQ(goals.status(canceled)->code(), v1::CODE_WRITER_LOST);
  EXPECT_TRUE(reaches(goals, kept, v1::GOAL_SUCCEEDED)) << told(kept);
}

TEST_F(IntentionsProgram, GoesOnAfterAKill) {
  Robot10Hz world(robot);
  v1::GoalId done;
  v1::GoalId underway;
  {
    test::Process service(command(), dir.path("log"));
    done = goals.ask(go_to(0.3, 0.0));
    EXPECT_TRUE(reaches(goals, done, v1::GOAL_SUCCEEDED)) << told(done);
    underway = goals.ask(drive());
    EXPECT_TRUE(reaches(goals, underway, v1::GOAL_UNDERWAY)) << told(underway);
    service.signal(SIGKILL);
    service.wait();
  }
  test::Process service(command(), dir.path("log2"));
  bus::Node node(test::node_options("watcher", robot));
  bus::GoalClient watcher(node, "watcher");
  EXPECT_TRUE(test::wait_until([&] {
    node.wait(milliseconds(20));
    watcher.poll();
    return watcher.status(done) && watcher.status(underway) &&
           watcher.status(underway)->state() == v1::GOAL_UNDERWAY;
  }));
  ASSERT_TRUE(watcher.status(done)) << service.output();
  EXPECT_EQ(watcher.status(done)->state(), v1::GOAL_SUCCEEDED);
}

// Killed at 90 degrees of a half turn, it turns the other 90, not another 180.
TEST_F(IntentionsProgram, AHalfTurnIsAHalfTurnOverAKill) {
  bus::Node node(test::node_options("robot", robot));
  ScriptedBus site(node);
  std::optional<test::Process> service(std::in_place, command(), dir.path("log"));
  v1::Goal goal;
  goal.functor("about-turn");
  const v1::GoalId id = goals.ask(goal);
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
    return status && bus::ended(status->state());
  })) << told(id);
  EXPECT_TRUE(killed);
  EXPECT_EQ(goals.status(id)->state(), v1::GOAL_SUCCEEDED) << told(id);
  EXPECT_EQ(goals.status(id)->note(), "");
  EXPECT_NEAR(turned, kPi, 0.15);
}

TEST_F(IntentionsProgram, StartsWithADamagedMemoryAndSaysSo) {
  std::ofstream(dir.path("memory")) << "ended 1f 2 succeeded none fine\nplaced \x81\n";
  std::ofstream(dir.path("memory.work")) << "nonsense\n";
  test::Process service(command(), dir.path("log"));
  Robot10Hz world(robot);
  const v1::GoalId id = goals.ask(go_to(0.3, 0.0));
  EXPECT_TRUE(reaches(goals, id, v1::GOAL_SUCCEEDED)) << told(id) << service.output();
  EXPECT_NE(service.output().find("memory.damaged"), std::string::npos) << service.output();
  EXPECT_NE(service.output().find("memory.work.damaged"), std::string::npos);
}

TEST_F(IntentionsProgram, SaysWhatIsWrongWithItsMemory) {
  test::Process service({"saphira-intentions", "--memory", "/no/such/folder/memory"},
                        dir.path("log"));
  EXPECT_EQ(service.wait(), std::optional<int>(2)) << service.output();
  EXPECT_NE(service.output().find("/no/such/folder/memory"), std::string::npos);
}

}  // namespace
}  // namespace saphira::intentions

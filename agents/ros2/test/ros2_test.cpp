#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "bytes.hpp"
#include "saphira/ros2/inward.hpp"
#include "saphira/ros2/navigate.hpp"
#include "saphira/ros2/outward.hpp"

namespace saphira::ros2 {
namespace {

constexpr std::int64_t kNow = 1'700'000'000'250'000'000;
constexpr double kHalfTurn = 3.14159265358979323846;

v1::RobotState robot_at(const v1::Pose2& pose) {
  return {
      .odom = 3, .pose_in_odom = pose, .velocity = 0.2, .rotation_velocity = -0.1, .battery = 12.5};
}

v1::Registration tracking(const v1::Pose2& odom_in_map) {
  return {.state = v1::REGISTRATION_TRACKING,
          .odom = 3,
          .pose_in_map = {11.0, 20.0, 0.5},
          .odom_in_map = odom_in_map,
          .covariance = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}};
}

TEST(Outward, OdometryAndItsFrames) {
  Outward outward(true);
  const Messages messages = outward.take(robot_at({1.0, 2.0, kHalfTurn / 2}), kNow);
  EXPECT_EQ(messages.odom->header, (Header{{1'700'000'000, 250'000'000}, "odom"}));
  EXPECT_EQ(messages.odom->child_frame_id, "base_link");
  EXPECT_EQ(messages.odom->pose.pose.position, (Point{1.0, 2.0, 0.0}));
  EXPECT_NEAR(messages.odom->pose.pose.orientation.z, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(messages.odom->twist.twist.linear.x, 0.2);
  EXPECT_EQ(messages.odom->twist.twist.angular.z, -0.1);
  ASSERT_EQ(messages.tf->transforms.size(), 1U);
  EXPECT_EQ(messages.tf->transforms[0].child_frame_id, "base_link");
  EXPECT_FLOAT_EQ(messages.battery->voltage, 12.5F);
  EXPECT_TRUE(std::isnan(messages.battery->percentage));
}

TEST(Outward, OdomIsOnTheMapWhileItsPlaceIsKnown) {
  for (const bool with_map : {true, false}) {
    Outward outward(with_map);
    const Messages placed = outward.take(tracking({10.0, 20.0, 0.0}), kNow);
    const Messages messages = outward.take(robot_at({1.0, 0.0, 0.0}), kNow);
    EXPECT_EQ(messages.tf->transforms.size(), with_map ? 2U : 1U);
    EXPECT_EQ(messages.tf->transforms[0].header.frame_id, with_map ? "map" : "odom");
    EXPECT_EQ(placed.pose.has_value(), with_map);
    EXPECT_EQ(outward.place()->pose.x, 11.0);
    if (!with_map)
      continue;
    const auto& covariance = placed.pose->pose.covariance;
    EXPECT_EQ(covariance[0], 1.0);
    EXPECT_EQ(covariance[6], 2.0);
    EXPECT_EQ(covariance[7], 3.0);
    EXPECT_EQ(covariance[30], 4.0);
    EXPECT_EQ(covariance[31], 5.0);
    EXPECT_EQ(covariance[35], 6.0);
  }
}

TEST(Outward, EachReadingIsARangeInTheFrameOfItsSonar) {
  Outward outward(true);
  v1::RobotState state = robot_at({});
  state.sonars = {{4, 1.25F, true}, {5, 0.0F, false}};
  const Messages messages = outward.take(state, kNow);
  ASSERT_EQ(messages.sonar.size(), 2U);
  EXPECT_EQ(messages.sonar[0].header.frame_id, "sonar_4");
  EXPECT_EQ(messages.sonar[0].range, 1.25F);
  EXPECT_EQ(messages.sonar[1].range, std::numeric_limits<float>::infinity());
  v1::RobotDescription description{.sonars = {{4, {0.1, 0.2, 0.3}}}};
  const Messages frames = outward.take(description, kNow);
  EXPECT_EQ(frames.tf_static->transforms.at(0).child_frame_id, "sonar_4");
  EXPECT_EQ(frames.tf_static->transforms.at(0).transform.translation.y, 0.2);
}

TEST(Outward, EchoesAreACloud) {
  v1::SonarBuckets sonars;
  sonars.buckets.resize(2);
  sonars.buckets[0].reading = {0, 1.0F, true};
  sonars.buckets[0].x = 1.0;
  sonars.buckets[0].pose_in_odom = {2.0, 0.0, 0.0};
  const PointCloud2 cloud = *Outward::take(sonars, kNow).echoes;
  EXPECT_EQ(cloud.width, 1U);
  EXPECT_EQ(cloud.data.size(), cloud.point_step);
  float x = 0.0F;
  std::memcpy(&x, cloud.data.data() + cloud.fields.at(0).offset, sizeof x);
  EXPECT_EQ(x, 3.0F);
}

TEST(Outward, MapHasItsFloorsAndWalls) {
  v1::FloorMap map;
  map.artifacts.resize(2);
  map.artifacts[0] = {.id = 1,
                      .type = v1::ARTIFACT_CORRIDOR,
                      .pose_in_map = {5.0, 0.0, 0.0},
                      .length = 4.0,
                      .width = 2.0};
  map.artifacts[1] = {.id = 2, .type = v1::ARTIFACT_POSITION, .name = "N2"};
  const Messages messages = Outward(true).take(map, kNow);
  const OccupancyGrid& grid = *messages.map;
  ASSERT_EQ(grid.data.size(), std::size_t{grid.info.width} * grid.info.height);
  const auto cell = [&](double x, double y) {
    const auto column = std::lround((x - grid.info.origin.position.x) / grid.info.resolution - 0.5);
    const auto row = std::lround((y - grid.info.origin.position.y) / grid.info.resolution - 0.5);
    return grid.data.at(static_cast<std::size_t>(row * grid.info.width + column));
  };
  EXPECT_EQ(cell(5.0, 0.0), 0);
  EXPECT_EQ(std::max(cell(5.0, 0.98), cell(5.0, 1.02)), 100);
  EXPECT_EQ(cell(5.0, 1.3), -1);
  ASSERT_EQ(messages.map_markers->markers.size(), 3U);
  EXPECT_EQ(messages.map_markers->markers[2].text, "N2");
  EXPECT_FALSE(Outward(false).take(map, kNow).map);
}

TEST(Outward, CellsAreInPercent) {
  Outward outward(true);
  v1::GridTile tile{.column = 1, .resolution = 0.1, .side = 2, .cells = {0, 200, 255, 51}};
  const OccupancyGrid grid = *outward.take(tile, false, kNow).local_map;
  EXPECT_EQ(grid.data, (std::vector<std::int8_t>{0, 100, -1, 25}));
  EXPECT_EQ(grid.info.origin.position.x, 0.2);
}

TEST(Outward, DiagnosticsHaveALevelForEachProgram) {
  situation::Situation situation;
  situation.programs.resize(3);
  situation.programs[0].status.state = v1::SERVICE_RUNNING;
  situation.programs[1].status.state = v1::SERVICE_WAITING;
  situation.programs[2].status.state = v1::SERVICE_RUNNING;
  situation.programs[2].age = 10.0;
  situation.grant.emplace().estopped = true;
  const DiagnosticArray all = *Outward::diagnostics(situation, kNow).diagnostics;
  std::vector<int> levels;
  for (const DiagnosticStatus& status : all.status)
    levels.push_back(status.level);
  EXPECT_EQ(levels, (std::vector<int>{0, 1, 3, 2}));
}

Twist twist(double velocity, double rotation) {
  Twist made;
  made.linear.x = velocity;
  made.angular.z = rotation;
  return made;
}

TEST(Wheels, DriveWhileMessagesCome) {
  Wheels wheels;
  EXPECT_FALSE(wheels.next(0.0));
  EXPECT_TRUE(wheels.heard(twist(0.3, -0.5), 1.0));
  const v1::MotorCommand command = *wheels.next(1.4);
  EXPECT_TRUE(command.active);
  EXPECT_EQ(command.translation, v1::TRANSLATION_VELOCITY);
  EXPECT_EQ(command.velocity, 0.3);
  EXPECT_EQ(command.rotation, v1::ROTATION_VELOCITY);
  EXPECT_EQ(command.rotation_velocity, -0.5);
  for (int i = 0; i < 4; ++i)
    EXPECT_FALSE(wheels.next(1.6)->active);
  EXPECT_FALSE(wheels.next(1.6));
}

TEST(Wheels, NumbersThatCannotBeStopIt) {
  Wheels wheels;
  EXPECT_FALSE(wheels.heard(twist(std::numeric_limits<double>::quiet_NaN(), 0.0), 1.0));
  EXPECT_FALSE(wheels.heard(twist(0.0, std::numeric_limits<double>::infinity()), 1.0));
  EXPECT_FALSE(wheels.next(1.0));
}

TEST(Wheels, AfterAStopItBeginsAnew) {
  v1::Grant stop;
  stop.stop = {1, 1};
  v1::Grant emergency;
  emergency.estopped = true;
  for (const auto& [grant, by_rest] :
       {std::pair(stop, true), std::pair(stop, false), std::pair(emergency, true)}) {
    Wheels wheels;
    wheels.heard(v1::Grant());
    wheels.heard(twist(0.3, 0.0), 1.0);
    EXPECT_TRUE(wheels.next(1.0)->active);
    wheels.heard(grant);
    EXPECT_FALSE(wheels.next(1.1)->active);
    wheels.heard(twist(0.3, 0.0), 1.2);
    EXPECT_FALSE(wheels.next(1.2)->active);
    if (by_rest)
      wheels.heard(twist(0.0, 0.0), 1.3);
    else
      wheels.next(2.0);
    wheels.heard(twist(0.3, 0.0), 2.1);
    EXPECT_TRUE(wheels.next(2.1)->active);
  }
}

PoseStamped pose_in(const std::string& frame, const v1::Pose2& pose) {
  return {{{}, frame}, pose_of(pose)};
}

TEST(Inward, APoseIsAGoal) {
  const v1::Goal goal = *goal_of(pose_in("map", {1.0, 2.0, -0.5}));
  EXPECT_EQ(goal.functor, "go_to");
  EXPECT_EQ(goal.arguments.at(0).frame, v1::FRAME_MAP);
  EXPECT_EQ(goal.arguments.at(0).point.x, 1.0);
  EXPECT_NEAR(goal.arguments.at(0).point.th, -0.5, 1e-12);
  EXPECT_EQ(goal.arguments.at(1).name, "facing");
  EXPECT_NEAR(goal.arguments.at(1).number, -0.5, 1e-12);
  EXPECT_EQ(goal_of(pose_in("odom", {}))->arguments.at(0).frame, v1::FRAME_ODOM);
  EXPECT_EQ(goal_of(pose_in("base_link", {}))->arguments.at(0).frame, v1::FRAME_ROBOT);
  EXPECT_EQ(goal_of(pose_in("base_link", {}))->arguments.size(), 1U);
  const v1::Pose2 robot{2.0, 3.0, kHalfTurn / 2};
  const v1::Goal placed = *goal_of(in_odom(pose_in("base_link", {1.0, 0.0, 1.0}), robot));
  EXPECT_EQ(placed.arguments.at(0).frame, v1::FRAME_ODOM);
  EXPECT_NEAR(placed.arguments.at(0).point.x, 2.0, 1e-12);
  EXPECT_NEAR(placed.arguments.at(0).point.y, 4.0, 1e-12);
  EXPECT_NEAR(placed.arguments.at(1).number, kHalfTurn / 2 + 1.0, 1e-12);
  EXPECT_EQ(in_odom(pose_in("map", {1.0, 0.0, 1.0}), robot), pose_in("map", {1.0, 0.0, 1.0}));
  EXPECT_FALSE(goal_of(pose_in("camera", {})));
  EXPECT_FALSE(goal_of(pose_in("map", {std::nan(""), 0.0, 0.0})));
}

SendRequest request(std::uint8_t number) {
  SendRequest made;
  made.goal_id.uuid[0] = number;
  made.goal.pose = pose_in("odom", {3.0, 4.0, 0.0});
  return made;
}

v1::GoalStatus status_of(const v1::GoalId& id, v1::GoalState state) {
  return {.id = id, .state = state};
}

/// The states of all goals, the oldest first.
std::vector<int> states(const Navigate& navigate) {
  std::vector<int> all;
  for (const ActionStatus& status : navigate.statuses().status_list)
    all.push_back(status.status);
  return all;
}

constexpr v1::GoalId kFirst{7, 1};
constexpr v1::GoalId kSecond{7, 2};

class NavigateTest : public ::testing::Test {
 protected:
  NavigateTest() {
    EXPECT_TRUE(navigate.send(request(1), kNow).goal);
    navigate.asked(kFirst);
  }
  Navigate navigate;
  const Uuid first = request(1).goal_id;
};

TEST_F(NavigateTest, Succeeds) {
  EXPECT_EQ(states(navigate), std::vector<int>{Navigate::kAccepted});
  EXPECT_FALSE(navigate.take(status_of(kSecond, v1::GOAL_UNDERWAY)));
  EXPECT_TRUE(navigate.take(status_of(kFirst, v1::GOAL_UNDERWAY)));
  EXPECT_FALSE(navigate.take(status_of(kFirst, v1::GOAL_SUSPENDED)));
  EXPECT_FALSE(navigate.result(first));
  EXPECT_TRUE(navigate.take(status_of(kFirst, v1::GOAL_SUCCEEDED)));
  EXPECT_EQ(navigate.result(first)->status, Navigate::kSucceeded);
  EXPECT_EQ(navigate.result(first)->result.error_code, 0);
  EXPECT_EQ(navigate.result(request(9).goal_id)->status, 0);
}

TEST_F(NavigateTest, FailsWithCodeAndReason) {
  v1::GoalStatus status = status_of(kFirst, v1::GOAL_FAILED);
  status.code = v1::CODE_BLOCKED;
  status.reason = "a chair";
  navigate.take(status);
  EXPECT_EQ(navigate.result(first)->status, Navigate::kAborted);
  EXPECT_EQ(navigate.result(first)->result.error_code, v1::CODE_BLOCKED);
  EXPECT_EQ(navigate.result(first)->result.error_msg, "a chair");
}

TEST_F(NavigateTest, IsCanceledByItsClient) {
  CancelRequest cancel;
  cancel.goal_info.goal_id = first;
  const Navigate::Canceled canceled = navigate.cancel(cancel);
  EXPECT_EQ(canceled.goals, std::vector<v1::GoalId>{kFirst});
  EXPECT_EQ(canceled.response.return_code, 0);
  EXPECT_EQ(canceled.response.goals_canceling.size(), 1U);
  navigate.take(status_of(kFirst, v1::GOAL_UNDERWAY));
  EXPECT_EQ(states(navigate), std::vector<int>{Navigate::kCanceling});
  navigate.take(status_of(kFirst, v1::GOAL_CANCELED));
  EXPECT_EQ(states(navigate), std::vector<int>{Navigate::kCanceled});
  EXPECT_EQ(navigate.cancel(cancel).response.return_code, 3);
  cancel.goal_info.goal_id = request(9).goal_id;
  EXPECT_EQ(navigate.cancel(cancel).response.return_code, 2);
}

TEST_F(NavigateTest, IsAbortedByAnybodyElse) {
  navigate.take(status_of(kFirst, v1::GOAL_CANCELED));
  EXPECT_EQ(states(navigate), std::vector<int>{Navigate::kAborted});
}

TEST_F(NavigateTest, ANewGoalReplacesIt) {
  const Navigate::Sent sent = navigate.send(request(2), kNow + 1);
  navigate.asked(kSecond);
  EXPECT_EQ(sent.replaced, std::vector<v1::GoalId>{kFirst});
  EXPECT_EQ(states(navigate), (std::vector<int>{Navigate::kAborted, Navigate::kAccepted}));
  EXPECT_FALSE(navigate.send(request(2), kNow).response.accepted);
  EXPECT_FALSE(navigate.send(request(0), kNow).response.accepted);
  SendRequest elsewhere = request(3);
  elsewhere.goal.pose.header.frame_id = "camera";
  EXPECT_FALSE(navigate.send(elsewhere, kNow).response.accepted);
  EXPECT_EQ(navigate.cancel({}).goals, std::vector<v1::GoalId>{kSecond});  // all
}

TEST_F(NavigateTest, CancelsAllUpToATime) {
  CancelRequest cancel;
  cancel.goal_info.stamp = time_of(kNow - 1);
  EXPECT_TRUE(navigate.cancel(cancel).goals.empty());
  cancel.goal_info.stamp = time_of(kNow);
  EXPECT_EQ(navigate.cancel(cancel).goals.size(), 1U);
}

TEST_F(NavigateTest, FeedbackHasDistanceAndTime) {
  const viewer::Place here{{}, {0.0, 0.0, 0.0}};
  EXPECT_FALSE(navigate.feedback(here, kNow));
  v1::GoalStatus status = status_of(kFirst, v1::GOAL_UNDERWAY);
  status.elapsed = 2.5;
  status.progress = 0.5;
  navigate.take(status);
  EXPECT_FALSE(navigate.feedback(std::nullopt, kNow));
  const auto feedback = navigate.feedback(here, kNow)->feedback;
  EXPECT_EQ(feedback.distance_remaining, 5.0F);
  EXPECT_EQ(feedback.navigation_time, (Duration{2, 500'000'000}));
  EXPECT_EQ(feedback.estimated_time_remaining, (Duration{2, 500'000'000}));
}

TEST(Bytes, EarlierDistributionsLackTheLastMembers) {
  const std::string range = bytes_of(Range{});
  EXPECT_EQ(bytes_of(Range{}, Distribution::humble).size(), range.size() - 4);
  EXPECT_EQ(bytes_of(Range{}, Distribution::iron), range);
  ResultResponse response{.status = 6, .result = {204, "no way"}};
  EXPECT_EQ(bytes_of(response, Distribution::humble), std::string("\0\1\0\0\6\0", 6));
  EXPECT_EQ(bytes_of(response, Distribution::iron).size(), 8U);
  EXPECT_EQ(read<ResultResponse>(bytes_of(response, Distribution::jazzy)), response);
}

TEST(Bytes, WhatIsNoSuchMessageIsNotRead) {
  std::string bytes = bytes_of(Path{{}, {PoseStamped{}}});
  EXPECT_TRUE(read<Path>(bytes));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(read<Path>(bytes.substr(0, size))) << size;
  bytes[21] = bytes[22] = '\x7F';  // in the count of poses
  EXPECT_FALSE(read<Path>(bytes));
}

TEST(Bytes, RequestsOfBothMiddlewares) {
  const std::string bare = bytes_of(ResultRequest{request(1).goal_id});
  bus::ForeignSample sample{bare, {{1, 15}, 5}, {}};
  Ticket ticket = *ticket_of(sample);
  EXPECT_EQ(plain(sample, ticket), bare);
  EXPECT_EQ(answer(bare, ticket), bare);
  EXPECT_EQ(ticket.request.writer, sample.id.writer);
  EXPECT_EQ(ticket.request.number, 5U);
  sample.related.writer = {1, 15, 4};  // the reader of answers
  EXPECT_EQ(ticket_of(sample)->request.writer, sample.related.writer);

  const std::string head = "client..request.";
  sample.bytes.insert(4, head);
  sample.id.writer = {1, 16};
  ticket = *ticket_of(sample);
  EXPECT_EQ(plain(sample, ticket), bare);
  EXPECT_EQ(answer(bare, ticket), sample.bytes);
  sample.bytes[1] = 0;  // big-endian
  EXPECT_EQ(ticket_of(sample)->head, "..tneilc.tseuqer");
  sample.bytes.resize(10);
  EXPECT_FALSE(ticket_of(sample));
}

}  // namespace
}  // namespace saphira::ros2

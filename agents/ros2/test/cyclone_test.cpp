// A client of ROS 2, on Cyclone DDS and the same IDL, drives a simulated robot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "cyclone_client.hpp"
#include "ros2_cyclone.h"
#include "saphira/situation/words.hpp"

namespace saphira::ros2 {
namespace {

/// A service: requests have the client's and their own number in front, as rmw_cyclonedds has it.
template <class Request, class Response>
struct Asker {
  Asker(const Client& client, const std::string& name, const dds_topic_descriptor_t& request,
        const dds_topic_descriptor_t& response)
      : requests(client.writer("rq/navigate_to_pose/_action/" + name + "Request", request)),
        responses(client.reader("rr/navigate_to_pose/_action/" + name + "Reply", response)) {}
  bool matched() const {
    dds_publication_matched_status_t out;
    dds_subscription_matched_status_t in;
    dds_get_publication_matched_status(requests, &out);
    dds_get_subscription_matched_status(responses, &in);
    return out.current_count > 0 && in.current_count > 0;
  }
  void ask(Request request) {
    request.client = 0x1122334455667788;
    request.number = ++number;
    dds_write(requests, &request);
  }
  /// The answer to the newest request.
  bool answered(const std::function<void(const Response&)>& each) {
    return comes<Response>(responses, [&](const Response& response) {
      if (response.client != 0x1122334455667788 || response.number != number)
        return false;
      each(response);
      return true;
    });
  }

  dds_entity_t requests;
  dds_entity_t responses;
  std::int64_t number = 0;
};

/// A simulated robot with its services in an office, and the program for ROS 2.
class CycloneTest : public ::testing::Test {
 protected:
  explicit CycloneTest(const std::string& distribution = "jazzy", bool stamps = false)
      : stamped(stamps),
        ros({"saphira-ros2", "--ros-interface", "127.0.0.1", "--distribution", distribution,
             "--cmd-vel", stamps ? "stamped" : "twist"},
            folder.path("ros2.log"), environment) {
    EXPECT_TRUE(comes<Odometry>(odom, [&](const Odometry& message) { return seen(message); }));
  }

  using Odometry = nav_msgs_msg_dds__Odometry_;

  bool seen(const Odometry& message) {
    x = message.pose.pose.position.x;
    velocity = message.twist.twist.linear.x;
    return true;
  }
  bool drives_at(const std::function<bool()>& as_wanted) {
    return comes<Odometry>(odom,
                           [&](const Odometry& message) { return seen(message) && as_wanted(); });
  }
  /// Writes this velocity until it is as wanted.
  bool drive(double wish, const std::function<bool()>& as_wanted) {
    std::string frame = "base_link";
    geometry_msgs_msg_dds__TwistStamped_ command{};
    command.header.frame_id = frame.data();
    command.twist.linear.x = wish;
    return test::wait_until(
        [&] {
          dds_write(cmd_vel, stamped ? static_cast<const void*>(&command) : &command.twist);
          return take<Odometry>(odom, [&](const Odometry& message) { return seen(message); }) &&
                 as_wanted();
        },
        kLong);
  }

  const test::TempDir folder;
  const std::map<std::string, std::string> environment{{"SAPHIRA_ROBOT", test::unique_robot()},
                                                       {"SAPHIRA_DOMAIN", test::domain()},
                                                       {"ROS_DOMAIN_ID", test::domain()}};
  test::Process robot{{"saphira-all", "--world", "small-office", "--map", "small-office",
                       "--socket", folder.path("robot")},
                      folder.path("robot.log"),
                      environment};
  const bool stamped;  // cmd_vel
  test::Process ros;
  const Client client;
  const dds_entity_t odom = client.reader("rt/odom", nav_msgs_msg_dds__Odometry__desc);
  const dds_entity_t cmd_vel =
      client.writer("rt/cmd_vel", stamped ? geometry_msgs_msg_dds__TwistStamped__desc
                                          : geometry_msgs_msg_dds__Twist__desc);
  double x = 0.0;
  double velocity = 0.0;
};

TEST_F(CycloneTest, EachTopicIsRead) {
  EXPECT_TRUE(comes<tf2_msgs_msg_dds__TFMessage_>(
      client.reader("rt/tf", tf2_msgs_msg_dds__TFMessage__desc), [](const auto& message) {
        return message.transforms._length == 2 &&
               message.transforms._buffer[0].header.frame_id == std::string("map");
      }));
  EXPECT_TRUE(comes<tf2_msgs_msg_dds__TFMessage_>(
      client.reader("rt/tf_static", tf2_msgs_msg_dds__TFMessage__desc, true),
      [](const auto& message) {
        return message.transforms._length > 6 &&
               message.transforms._buffer[1].child_frame_id == std::string("sonar_1");
      }));
  EXPECT_TRUE(comes<geometry_msgs_msg_dds__PoseWithCovarianceStamped_>(
      client.reader("rt/amcl_pose", geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, true),
      [](const auto& message) { return message.pose.covariance[35] > 0.0; }));
  for (const std::string name : {"rt/map", "rt/local_map"})
    EXPECT_TRUE(comes<nav_msgs_msg_dds__OccupancyGrid_>(
        client.reader(name, nav_msgs_msg_dds__OccupancyGrid__desc, true), [](const auto& message) {
          const auto is_free = [](std::int8_t cell) { return cell >= 0 && cell < 50; };
          const std::int8_t* const begin = message.data._buffer;
          const std::int8_t* const end = begin + message.data._length;
          return message.data._length == message.info.width * message.info.height &&
                 std::any_of(begin, end, is_free) && !std::all_of(begin, end, is_free);
        }));
  EXPECT_TRUE(comes<sensor_msgs_msg_dds__Range_>(
      client.reader("rt/sonar", sensor_msgs_msg_dds__Range__desc),
      [](const auto& message) { return message.range > 0.1F && message.range < 5.0F; }));
  EXPECT_TRUE(comes<sensor_msgs_msg_dds__PointCloud2_>(
      client.reader("rt/sonar_points", sensor_msgs_msg_dds__PointCloud2__desc),
      [](const auto& message) {
        return message.fields._length == 3 && message.data._length == message.row_step &&
               message.width > 0;
      }));
  EXPECT_TRUE(comes<sensor_msgs_msg_dds__BatteryState_>(
      client.reader("rt/battery_state", sensor_msgs_msg_dds__BatteryState__desc),
      [](const auto& message) { return message.voltage > 5.0F && message.present; }));
  EXPECT_TRUE(comes<nav_msgs_msg_dds__Path_>(
      client.reader("rt/path", nav_msgs_msg_dds__Path__desc),
      [](const auto& message) { return message.poses._length > 0; }));
  std::map<std::string, int> spaces;
  const auto markers = [&](const visualization_msgs_msg_dds__MarkerArray_& message) {
    for (std::uint32_t i = 0; i < message.markers._length; ++i)
      ++spaces[message.markers._buffer[i].ns];
    return spaces.contains("why") && spaces.contains("percepts") && spaces.contains("walls") &&
           spaces.contains("places");
  };
  const dds_entity_t of_now =
      client.reader("rt/markers", visualization_msgs_msg_dds__MarkerArray__desc);
  const dds_entity_t of_map =
      client.reader("rt/map_markers", visualization_msgs_msg_dds__MarkerArray__desc, true);
  EXPECT_TRUE(test::wait_until(
      [&] {
        return take<visualization_msgs_msg_dds__MarkerArray_>(of_now, markers) ||
               take<visualization_msgs_msg_dds__MarkerArray_>(of_map, markers);
      },
      kLong));
  EXPECT_TRUE(comes<diagnostic_msgs_msg_dds__DiagnosticArray_>(
      client.reader("rt/diagnostics", diagnostic_msgs_msg_dds__DiagnosticArray__desc),
      [](const auto& message) {
        for (std::uint32_t i = 0; i < message.status._length; ++i)
          if (message.status._buffer[i].name == std::string("saphira: bridge"))
            return true;
        return false;
      }));
  EXPECT_TRUE(comes<rmw_dds_common_msg_dds__ParticipantEntitiesInfo_>(
      client.reader("ros_discovery_info", rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc,
                    true),
      [](const auto& message) {
        return message.node_entities_info_seq._length == 1 &&
               message.node_entities_info_seq._buffer[0].writer_gid_seq._length > 13;
      }));
}

TEST_F(CycloneTest, CmdVelIsObeyedAndGuarded) {
  EXPECT_TRUE(drive(0.3, [&] { return velocity > 0.2; })) << ros.output();
  // No more messages.
  EXPECT_TRUE(drives_at([&] { return velocity == 0.0; }));
  EXPECT_TRUE(drive(0.3, [&] { return velocity > 0.2; }));
  // The guard holds it before the wall, though messages go on.
  const dds_entity_t diagnostics =
      client.reader("rt/diagnostics", diagnostic_msgs_msg_dds__DiagnosticArray__desc);
  std::string guard;
  EXPECT_TRUE(drive(0.3, [&] {
    take<diagnostic_msgs_msg_dds__DiagnosticArray_>(diagnostics, [&](const auto& message) {
      for (std::uint32_t i = 0; i < message.status._length; ++i)
        if (message.status._buffer[i].name == std::string("saphira: drive"))
          guard = message.status._buffer[i].values._buffer[2].value;
      return true;
    });
    return velocity < 0.1 && (guard == situation::name_of(v1::GUARD_SLOW) ||
                              guard == situation::name_of(v1::GUARD_STOP));
  })) << guard;
}

struct CycloneStampedTest : CycloneTest {
  CycloneStampedTest() : CycloneTest("humble", true) {}
};

TEST_F(CycloneStampedTest, CmdVelIsObeyed) {
  EXPECT_TRUE(drive(0.3, [&] { return velocity > 0.2; })) << ros.output();
  EXPECT_TRUE(drives_at([&] { return velocity == 0.0; }));
}

TEST_F(CycloneTest, AnActionIsAcceptedFedBackCanceledAndSucceeds) {
  Asker<nav2_msgs_action_dds__NavigateToPose_SendGoal_Request_,
        nav2_msgs_action_dds__NavigateToPose_SendGoal_Response_>
      send(client, "send_goal", nav2_msgs_action_dds__NavigateToPose_SendGoal_Request__desc,
           nav2_msgs_action_dds__NavigateToPose_SendGoal_Response__desc);
  Asker<action_msgs_srv_dds__CancelGoal_Request_, action_msgs_srv_dds__CancelGoal_Response_> cancel(
      client, "cancel_goal", action_msgs_srv_dds__CancelGoal_Request__desc,
      action_msgs_srv_dds__CancelGoal_Response__desc);
  Asker<nav2_msgs_action_dds__NavigateToPose_GetResult_Request_,
        nav2_msgs_action_dds__NavigateToPose_GetResult_Response_>
      result(client, "get_result", nav2_msgs_action_dds__NavigateToPose_GetResult_Request__desc,
             nav2_msgs_action_dds__NavigateToPose_GetResult_Response__desc);
  const dds_entity_t feedback =
      client.reader("rt/navigate_to_pose/_action/feedback",
                    nav2_msgs_action_dds__NavigateToPose_FeedbackMessage__desc);
  const dds_entity_t status = client.reader("rt/navigate_to_pose/_action/status",
                                            action_msgs_msg_dds__GoalStatusArray__desc, true);
  ASSERT_TRUE(test::wait_until(
      [&] { return send.matched() && cancel.matched() && result.matched(); }, kLong));
  const auto go = [&](std::uint8_t number, double ahead) {
    nav2_msgs_action_dds__NavigateToPose_SendGoal_Request_ request{};
    std::string frame = "odom";
    std::string tree;
    request.goal_id.uuid[0] = number;
    request.goal.pose.header.frame_id = frame.data();
    request.goal.behavior_tree = tree.data();
    request.goal.pose.pose.position.x = ahead;
    request.goal.pose.pose.orientation.w = 1.0;
    send.ask(request);
    bool accepted = false;
    EXPECT_TRUE(send.answered([&](const auto& response) { accepted = response.accepted; }));
    EXPECT_TRUE(accepted);
    nav2_msgs_action_dds__NavigateToPose_GetResult_Request_ wait{};
    wait.goal_id.uuid[0] = number;
    result.ask(wait);
  };
  const auto state = [&](std::uint8_t number, int wanted) {
    return comes<action_msgs_msg_dds__GoalStatusArray_>(status, [&](const auto& message) {
      for (std::uint32_t i = 0; i < message.status_list._length; ++i)
        if (message.status_list._buffer[i].goal_info.goal_id.uuid[0] == number &&
            message.status_list._buffer[i].status == wanted)
          return true;
      return false;
    });
  };

  go(1, 3.0);
  EXPECT_TRUE(state(1, 2));
  EXPECT_TRUE(comes<nav2_msgs_action_dds__NavigateToPose_FeedbackMessage_>(
      feedback, [](const auto& message) {
        return message.goal_id.uuid[0] == 1 && message.feedback.distance_remaining > 0.0F &&
               message.feedback.navigation_time.sec + message.feedback.navigation_time.nanosec > 0;
      }));
  action_msgs_srv_dds__CancelGoal_Request_ request{};
  request.goal_info.goal_id.uuid[0] = 1;
  cancel.ask(request);
  EXPECT_TRUE(cancel.answered([](const auto& response) {
    EXPECT_EQ(response.return_code, 0);
    EXPECT_EQ(response.goals_canceling._length, 1U);
  }));
  EXPECT_TRUE(result.answered([](const auto& response) { EXPECT_EQ(response.status, 5); }));
  EXPECT_TRUE(state(1, 5));

  take<Odometry>(odom, [&](const Odometry& message) { return seen(message); });
  go(2, x + 0.5);
  EXPECT_TRUE(result.answered([](const auto& response) {
    EXPECT_EQ(response.status, 4);
    EXPECT_EQ(response.result.error_code, 0);
  }));
  EXPECT_TRUE(state(2, 4));
}

TEST_F(CycloneTest, ARequestOfFastRtpsIsAnsweredInItsWay) {
  bus::Foreign client_of_fast({.domain = static_cast<std::uint32_t>(std::stoul(test::domain())),
                               .name = "client",
                               .interface = "127.0.0.1"},
                              [] {});
  const std::string prefix = "navigate_to_pose/_action/cancel_goal";
  const auto requests =
      client_of_fast.writer({"rq/" + prefix + "Request", kCancelGoal.request_type});
  const auto answers = client_of_fast.reader({"rr/" + prefix + "Reply", kCancelGoal.response_type});
  ASSERT_TRUE(
      test::wait_until([&] { return requests->matched() > 0 && answers->matched() > 0; }, kLong));
  const bus::SampleId reader_of_answers{answers->id(), 0};
  CancelRequest request;
  request.goal_info.goal_id.uuid[0] = 9;
  requests->write(bytes_of(request), &reader_of_answers);
  std::vector<bus::ForeignSample> came;
  ASSERT_TRUE(test::wait_until([&] { return !(came = answers->take()).empty(); }, kLong));
  EXPECT_EQ(came[0].related.writer, answers->id());
  EXPECT_EQ(came[0].related.number, 1U);
  EXPECT_EQ(read<CancelResponse>(came[0].bytes)->return_code, 2);
}

}  // namespace
}  // namespace saphira::ros2

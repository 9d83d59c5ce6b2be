#pragma once

#include "saphira/ros2_idl/types.hpp"

/// ROS 2 as it is on the wire: topics, with the types of idl/.
namespace saphira::ros2 {

using Time = builtin_interfaces::msg::dds_::Time_;
using Duration = builtin_interfaces::msg::dds_::Duration_;
using Header = std_msgs::msg::dds_::Header_;
using Color = std_msgs::msg::dds_::ColorRGBA_;
using Point = geometry_msgs::msg::dds_::Point_;
using Pose3 = geometry_msgs::msg::dds_::Pose_;
using PoseStamped = geometry_msgs::msg::dds_::PoseStamped_;
using PoseWithCovarianceStamped = geometry_msgs::msg::dds_::PoseWithCovarianceStamped_;
using Quaternion = geometry_msgs::msg::dds_::Quaternion_;
using Transform = geometry_msgs::msg::dds_::TransformStamped_;
using Twist = geometry_msgs::msg::dds_::Twist_;
using TwistStamped = geometry_msgs::msg::dds_::TwistStamped_;
using TFMessage = tf2_msgs::msg::dds_::TFMessage_;
using Odometry = nav_msgs::msg::dds_::Odometry_;
using Path = nav_msgs::msg::dds_::Path_;
using OccupancyGrid = nav_msgs::msg::dds_::OccupancyGrid_;
using LaserScan = sensor_msgs::msg::dds_::LaserScan_;
using Range = sensor_msgs::msg::dds_::Range_;
using BatteryState = sensor_msgs::msg::dds_::BatteryState_;
using PointCloud2 = sensor_msgs::msg::dds_::PointCloud2_;
using Marker = visualization_msgs::msg::dds_::Marker_;
using MarkerArray = visualization_msgs::msg::dds_::MarkerArray_;
using DiagnosticStatus = diagnostic_msgs::msg::dds_::DiagnosticStatus_;
using DiagnosticArray = diagnostic_msgs::msg::dds_::DiagnosticArray_;
using Uuid = unique_identifier_msgs::msg::dds_::UUID_;
using GoalInfo = action_msgs::msg::dds_::GoalInfo_;
using ActionStatus = action_msgs::msg::dds_::GoalStatus_;
using GoalStatusArray = action_msgs::msg::dds_::GoalStatusArray_;
using CancelRequest = action_msgs::srv::dds_::CancelGoal_Request_;
using CancelResponse = action_msgs::srv::dds_::CancelGoal_Response_;
using SendRequest = nav2_msgs::action::dds_::NavigateToPose_SendGoal_Request_;
using SendResponse = nav2_msgs::action::dds_::NavigateToPose_SendGoal_Response_;
using ResultRequest = nav2_msgs::action::dds_::NavigateToPose_GetResult_Request_;
using ResultResponse = nav2_msgs::action::dds_::NavigateToPose_GetResult_Response_;
using FeedbackMessage = nav2_msgs::action::dds_::NavigateToPose_FeedbackMessage_;

/// Distributions with different messages.
enum class Distribution { humble, iron, jazzy };

enum class Kind {
  usual,    ///< reliable, volatile, keep last 10
  many,     ///< the same with 100: several in one cycle
  latched,  ///< reliable, transient local, keep last 1
  wish      ///< that others write: best effort and volatile, which fits every writer
};

template <class T>
struct Topic {
  const char* name;
  const char* type;
  const char* hash;  ///< of Jazzy's type (RIHS01); since Iron ROS 2 logs where there is none
  Kind kind = Kind::usual;
};

inline constexpr Topic<Odometry> kOdom{
    "rt/odom", "nav_msgs::msg::dds_::Odometry_",
    "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"};
inline constexpr Topic<TFMessage> kTf{
    "rt/tf", "tf2_msgs::msg::dds_::TFMessage_",
    "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087", Kind::many};
inline constexpr Topic<TFMessage> kTfStatic{
    "rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_",
    "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087", Kind::latched};
inline constexpr Topic<PoseWithCovarianceStamped> kPose{
    "rt/amcl_pose", "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_",
    "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e", Kind::latched};
inline constexpr Topic<OccupancyGrid> kMap{
    "rt/map", "nav_msgs::msg::dds_::OccupancyGrid_",
    "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7", Kind::latched};
inline constexpr Topic<OccupancyGrid> kLocalMap{
    "rt/local_map", "nav_msgs::msg::dds_::OccupancyGrid_",
    "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7", Kind::latched};
inline constexpr Topic<Range> kSonar{
    "rt/sonar", "sensor_msgs::msg::dds_::Range_",
    "b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a", Kind::many};
inline constexpr Topic<LaserScan> kScan{
    "rt/scan", "sensor_msgs::msg::dds_::LaserScan_",
    "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828", Kind::wish};
inline constexpr Topic<PointCloud2> kEchoes{
    "rt/sonar_points", "sensor_msgs::msg::dds_::PointCloud2_",
    "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"};
inline constexpr Topic<BatteryState> kBattery{
    "rt/battery_state", "sensor_msgs::msg::dds_::BatteryState_",
    "4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741"};
inline constexpr Topic<Path> kPath{
    "rt/path", "nav_msgs::msg::dds_::Path_",
    "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b"};
inline constexpr Topic<MarkerArray> kMarkers{
    "rt/markers", "visualization_msgs::msg::dds_::MarkerArray_",
    "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"};
inline constexpr Topic<MarkerArray> kMapMarkers{
    "rt/map_markers", "visualization_msgs::msg::dds_::MarkerArray_",
    "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf", Kind::latched};
inline constexpr Topic<DiagnosticArray> kDiagnostics{
    "rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_",
    "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"};
inline constexpr Topic<Twist> kCmdVel{
    "rt/cmd_vel", "geometry_msgs::msg::dds_::Twist_",
    "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a", Kind::wish};
inline constexpr Topic<TwistStamped> kCmdVelStamped{
    "rt/cmd_vel", "geometry_msgs::msg::dds_::TwistStamped_",
    "5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64", Kind::wish};
inline constexpr Topic<PoseStamped> kGoalPose{
    "rt/goal_pose", "geometry_msgs::msg::dds_::PoseStamped_",
    "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8", Kind::wish};
inline constexpr Topic<PoseWithCovarianceStamped> kInitialPose{
    "rt/initialpose", "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_",
    "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e", Kind::wish};
inline constexpr Topic<FeedbackMessage> kFeedback{
    "rt/navigate_to_pose/_action/feedback",
    "nav2_msgs::action::dds_::NavigateToPose_FeedbackMessage_",
    "9d1f6fa2eb975ce733b419ac2e97b134d8ff92b6478b6559feed9a50bdfd82b3"};
inline constexpr Topic<GoalStatusArray> kStatus{
    "rt/navigate_to_pose/_action/status", "action_msgs::msg::dds_::GoalStatusArray_",
    "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e", Kind::latched};

/// A service: its name without prefix and suffix, and its types.
template <class Request, class Response>
struct Service {
  const char* name;
  const char* request_type;
  const char* response_type;
};

inline constexpr Service<SendRequest, SendResponse> kSendGoal{
    "navigate_to_pose/_action/send_goal",
    "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Request_",
    "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Response_"};
inline constexpr Service<CancelRequest, CancelResponse> kCancelGoal{
    "navigate_to_pose/_action/cancel_goal", "action_msgs::srv::dds_::CancelGoal_Request_",
    "action_msgs::srv::dds_::CancelGoal_Response_"};
inline constexpr Service<ResultRequest, ResultResponse> kGetResult{
    "navigate_to_pose/_action/get_result",
    "nav2_msgs::action::dds_::NavigateToPose_GetResult_Request_",
    "nav2_msgs::action::dds_::NavigateToPose_GetResult_Response_"};

}  // namespace saphira::ros2

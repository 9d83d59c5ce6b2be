#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bytes.hpp"
#include "direct.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/ros2/inward.hpp"
#include "saphira/ros2/navigate.hpp"
#include "saphira/ros2/outward.hpp"
#include "saphira/watch/mind.hpp"

namespace saphira::ros2 {

struct Options {
  bus::Foreign::Options ros;
  std::optional<Distribution> distribution;  ///< none: as Jazzy, and no node for `ros2 node list`
  bool stamped = false;                      ///< cmd_vel is a TwistStamped
  bool teleop = false;                       ///< cmd_vel drives as a person does
  bool reads_only = false;                   ///< nothing that ROS 2 says reaches the robot
  bool with_map = true;
};

/// A robot of the bus as one of ROS 2's. For the thread that waits on the node.
class RosRobot {
 public:
  RosRobot(bus::Node& node, const Options& options);

  /// After each wait, and every 50 ms.
  void poll();

 private:
  template <class T>
  class Out {
   public:
    Out(RosRobot& robot, const Topic<T>& topic);
    void put(const T& message) { writer_->write(bytes_of(message, distribution_)); }

   private:
    std::unique_ptr<bus::Foreign::Writer> writer_;
    Distribution distribution_;
  };
  template <class Request, class Response>
  class Served {
   public:
    Served(RosRobot& robot, const Service<Request, Response>& service);
    /// Calls each(request, ticket).
    template <class Each>
    void take(Each&& each) {
      for (const bus::ForeignSample& sample : requests_->take())
        if (const auto ticket = ticket_of(sample))
          if (const auto request = read<Request>(plain(sample, *ticket)))
            each(*request, *ticket);
    }
    void answer(const Response& response, const Ticket& ticket) {
      due_.push_back({ros2::answer(bytes_of(response, distribution_), ticket), ticket,
                      watch::Clock::now() + kLongestMatch});
    }
    /// Writes the answers, as soon as each client that asks is there to hear them: discovery may
    /// find its request's writer before its answer's reader.
    void flush() {
      while (!due_.empty() && (answers_->matched() >= requests_->matched() ||
                               watch::Clock::now() > due_.front().latest)) {
        answers_->write(due_.front().bytes,
                        due_.front().ticket.head.empty() ? &due_.front().ticket.request : nullptr);
        due_.pop_front();
      }
    }

   private:
    static constexpr std::chrono::seconds kLongestMatch{1};
    struct Due {
      std::string bytes;
      Ticket ticket;
      watch::Clock::time_point latest;
    };
    std::unique_ptr<bus::Foreign::Reader> requests_;
    std::unique_ptr<bus::Foreign::Writer> answers_;
    Distribution distribution_;
    std::deque<Due> due_;
  };
  /// The readers of all that ROS 2 may say to the robot, and its actions.
  struct Inward {
    explicit Inward(RosRobot& robot);
    cli::DirectDriver driver;
    bus::GoalClient goals;
    bus::RequestClient registration;
    std::unique_ptr<bus::Foreign::Reader> cmd_vel;
    std::unique_ptr<bus::Foreign::Reader> goal_pose;
    std::unique_ptr<bus::Foreign::Reader> initial_pose;
    Served<SendRequest, SendResponse> send_goal;
    Served<CancelRequest, CancelResponse> cancel_goal;
    Served<ResultRequest, ResultResponse> get_result;
    Out<FeedbackMessage> feedback;
    Out<GoalStatusArray> status;
    Wheels wheels;
    Navigate navigate;
    std::vector<std::pair<Uuid, Ticket>> asked;  ///< for results that are not there yet
  };

  template <class T>
  std::unique_ptr<bus::Foreign::Reader> reader(const Topic<T>& topic);
  Distribution distribution() const { return options_.distribution.value_or(Distribution::jazzy); }
  void put(const Messages& messages);
  void take_robot();
  void drive(double now);
  /// A pose of base_link in odom, if the robot's place there is known.
  PoseStamped placed(const PoseStamped& pose) const;
  void take_wishes(double now);
  void serve();
  void tell_slowly();
  void show_node();

  bus::Node& node_;
  const Options options_;
  bus::Foreign foreign_;
  std::vector<bus::WriterId> writer_ids_;
  std::vector<bus::WriterId> reader_ids_;
  Outward outward_;
  watch::Mind mind_;
  bus::Reader<v1::RobotState> states_;
  bus::Reader<v1::RobotDescription> descriptions_;
  bus::Reader<v1::Registration> registrations_;
  bus::Reader<v1::FloorMap> maps_;
  bus::Reader<v1::GridTile> tiles_;
  bus::Reader<v1::SonarBuckets> sonars_;
  bus::Reader<v1::Perception> perceptions_;
  Out<Odometry> odom_;
  Out<TFMessage> tf_;
  Out<TFMessage> tf_static_;
  Out<PoseWithCovarianceStamped> pose_;
  Out<OccupancyGrid> map_;
  Out<OccupancyGrid> local_map_;
  Out<Range> sonar_;
  Out<PointCloud2> echoes_;
  Out<BatteryState> battery_;
  Out<Path> path_;
  Out<MarkerArray> markers_;
  Out<MarkerArray> map_markers_;
  Out<DiagnosticArray> diagnostics_;
  std::optional<Inward> inward_;
  std::unique_ptr<bus::Foreign::Writer> node_info_;
  watch::Clock::time_point told_;
  watch::Clock::time_point drove_;
};

}  // namespace saphira::ros2

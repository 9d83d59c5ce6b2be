#include "ros_robot.hpp"

#include <algorithm>

#include "foreign_topic.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/situation/why.hpp"

namespace saphira::ros2 {

namespace {

using namespace std::chrono_literals;

constexpr auto kDrivePeriod = cli::kDrivePeriod;
constexpr auto kSlow = 1s;
constexpr std::size_t kMostWaiting = 64;  // requests for results
constexpr const char* kSource = "cmd_vel of ROS 2";

/// A part of a service. ROS 2 complains about an endpoint without any user data.
bus::ForeignTopic part(const std::string& name, const char* type) {
  bus::ForeignTopic topic{.name = name, .type = type};
  topic.user_data = "saphira=1;";
  return topic;
}

bus::Foreign::Options with_enclave(const Options& options) {
  bus::Foreign::Options ros = options.ros;
  if (options.distribution)
    ros.user_data = "enclave=/;";
  return ros;
}

std::int64_t written_ns(const bus::SampleInfo& info) {
  return unix_nanoseconds() - static_cast<std::int64_t>(info.age * 1e9);
}

template <class Info, class Gid>
std::string node_info(const bus::WriterId& participant, const std::string& name,
                      const std::vector<bus::WriterId>& readers,
                      const std::vector<bus::WriterId>& writers) {
  const auto gid = [](const bus::WriterId& id) {
    Gid made;
    std::ranges::copy(id, made.data.begin());
    return made;
  };
  Info info;
  info.gid = gid(participant);
  info.node_entities_info_seq.emplace_back();
  auto& node = info.node_entities_info_seq.back();
  node.node_namespace = "/";
  node.node_name = name;
  for (const bus::WriterId& id : readers)
    node.reader_gid_seq.push_back(gid(id));
  for (const bus::WriterId& id : writers)
    node.writer_gid_seq.push_back(gid(id));
  return bytes_of(info);
}

}  // namespace

template <class T>
RosRobot::Out<T>::Out(RosRobot& robot, const Topic<T>& topic)
    : writer_(robot.foreign_.writer(foreign(topic))), distribution_(robot.distribution()) {
  robot.writer_ids_.push_back(writer_->id());
}

template <class Request, class Response>
RosRobot::Served<Request, Response>::Served(RosRobot& robot,
                                            const Service<Request, Response>& service)
    : requests_(robot.foreign_.reader(
          part("rq/" + std::string(service.name) + "Request", service.request_type))),
      answers_(robot.foreign_.writer(
          part("rr/" + std::string(service.name) + "Reply", service.response_type))),
      distribution_(robot.distribution()) {
  robot.reader_ids_.push_back(requests_->id());
  robot.writer_ids_.push_back(answers_->id());
}

template <class T>
std::unique_ptr<bus::Foreign::Reader> RosRobot::reader(const Topic<T>& topic) {
  auto made = foreign_.reader(foreign(topic));
  reader_ids_.push_back(made->id());
  return made;
}

RosRobot::Inward::Inward(RosRobot& robot)
    : driver(robot.node_,
             robot.options_.teleop ? bus::topics::kDriveTeleop : bus::topics::kDriveDirect,
             kSource),
      goals(robot.node_, "ROS 2"),
      registration(robot.node_, bus::topics::kRegistrationRequest, "ROS 2"),
      cmd_vel(robot.options_.stamped ? robot.reader(kCmdVelStamped) : robot.reader(kCmdVel)),
      goal_pose(robot.reader(kGoalPose)),
      initial_pose(robot.reader(kInitialPose)),
      send_goal(robot, kSendGoal),
      cancel_goal(robot, kCancelGoal),
      get_result(robot, kGetResult),
      feedback(robot, kFeedback),
      status(robot, kStatus) {}

RosRobot::RosRobot(bus::Node& node, const Options& options)
    : node_(node),
      options_(options),
      foreign_(with_enclave(options), [&node] { node.wake(); }),
      outward_(options.with_map),
      mind_(node, false),
      states_(node.reader(bus::topics::kRobotState)),
      descriptions_(node.reader(bus::topics::kRobotDescription)),
      registrations_(node.reader(bus::topics::kRegistration)),
      maps_(node.reader(bus::topics::kMap)),
      tiles_(node.reader(bus::topics::kGrid)),
      sonars_(node.reader(bus::topics::kSonarBuckets)),
      perceptions_(node.reader(bus::topics::kPerception)),
      odom_(*this, kOdom),
      tf_(*this, kTf),
      tf_static_(*this, kTfStatic),
      pose_(*this, kPose),
      map_(*this, kMap),
      local_map_(*this, kLocalMap),
      sonar_(*this, kSonar),
      echoes_(*this, kEchoes),
      battery_(*this, kBattery),
      path_(*this, kPath),
      markers_(*this, kMarkers),
      map_markers_(*this, kMapMarkers),
      diagnostics_(*this, kDiagnostics) {
  if (!options.reads_only)
    inward_.emplace(*this);
  if (options.distribution)
    show_node();
}

void RosRobot::show_node() {
  bus::ForeignTopic topic =
      part("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_");
  topic.transient_local = true;
  topic.depth = 1;
  node_info_ = foreign_.writer(topic);
  namespace msg = rmw_dds_common::msg::dds_;
  namespace humble = rmw_dds_common::humble::dds_;
  const std::string& name = options_.ros.name;
  node_info_->write(options_.distribution == Distribution::humble
                        ? node_info<humble::ParticipantEntitiesInfo_, humble::Gid_>(
                              foreign_.id(), name, reader_ids_, writer_ids_)
                        : node_info<msg::ParticipantEntitiesInfo_, msg::Gid_>(
                              foreign_.id(), name, reader_ids_, writer_ids_));
}

void RosRobot::put(const Messages& messages) {
  const auto put_if = [](auto& out, const auto& message) {
    if (message)
      out.put(*message);
  };
  put_if(odom_, messages.odom);
  put_if(tf_, messages.tf);
  put_if(tf_static_, messages.tf_static);
  put_if(pose_, messages.pose);
  put_if(map_, messages.map);
  put_if(local_map_, messages.local_map);
  for (const Range& range : messages.sonar)
    sonar_.put(range);
  put_if(echoes_, messages.echoes);
  put_if(battery_, messages.battery);
  put_if(path_, messages.path);
  put_if(markers_, messages.markers);
  put_if(map_markers_, messages.map_markers);
  put_if(diagnostics_, messages.diagnostics);
}

void RosRobot::take_robot() {
  const auto each = [this](auto& reader) {
    reader.visit([this](const auto& sample, const bus::SampleInfo& info) {
      if (!info.disposed)
        put(outward_.take(sample, written_ns(info)));
    });
  };
  each(registrations_);
  each(descriptions_);
  each(states_);
  each(maps_);
  each(sonars_);
  each(perceptions_);
  tiles_.visit([this](const v1::GridTile& tile, const bus::SampleInfo& info) {
    put(outward_.take(tile, info.disposed, unix_nanoseconds()));
  });
}

void RosRobot::poll() {
  mind_.poll();
  take_robot();
  if (inward_) {
    const double now =
        std::chrono::duration<double>(watch::Clock::now().time_since_epoch()).count();
    take_wishes(now);
    drive(now);
    serve();
  }
  if (watch::Clock::now() - told_ >= kSlow) {
    told_ = watch::Clock::now();
    tell_slowly();
  }
  node_.publish_status();
}

void RosRobot::drive(double now) {
  Inward& in = *inward_;
  for (const bus::ForeignSample& sample : in.cmd_vel->take()) {
    std::optional<Twist> twist;
    if (options_.stamped) {
      if (const auto stamped = read<TwistStamped>(sample.bytes))
        twist = stamped->twist;
    } else {
      twist = read<Twist>(sample.bytes);
    }
    if (!twist || !in.wheels.heard(*twist, now))
      node_.warn("a message on cmd_vel has numbers that cannot be");
  }
  in.driver.poll();
  if (in.driver.grant())
    in.wheels.heard(*in.driver.grant());
  if (watch::Clock::now() - drove_ < kDrivePeriod)
    return;
  drove_ = watch::Clock::now();
  if (const std::optional<v1::MotorCommand> command = in.wheels.next(now)) {
    in.driver.drive(*command);
    if (const auto news = in.driver.news(); news && !news->empty())
      node_.info("cmd_vel: " + *news);
  }
}

PoseStamped RosRobot::placed(const PoseStamped& pose) const {
  const v1::RobotState* const robot = inward_->driver.robot();
  return robot != nullptr ? in_odom(pose, robot->pose_in_odom) : pose;
}

void RosRobot::take_wishes(double now) {
  Inward& in = *inward_;
  for (const bus::ForeignSample& sample : in.goal_pose->take()) {
    const auto pose = read<PoseStamped>(sample.bytes);
    if (std::optional<v1::Goal> goal = pose ? goal_of(placed(*pose)) : std::nullopt)
      in.goals.ask(std::move(*goal));
    else
      node_.warn("a pose on goal_pose is not of map, odom or base_link");
  }
  for (const bus::ForeignSample& sample : in.initial_pose->take()) {
    const auto pose = read<PoseWithCovarianceStamped>(sample.bytes);
    if (const auto position =
            pose ? argument_of("position", pose->header, pose->pose.pose) : std::nullopt)
      in.registration.send(bus::request("place", {*position}), [this](const v1::Answer& answer) {
        if (!bus::well(answer.code))
          node_.warn("initialpose: " + answer.text);
      });
    else
      node_.warn("a pose on initialpose is not of map, odom or base_link");
  }
  in.registration.poll(now);
}

void RosRobot::serve() {
  Inward& in = *inward_;
  in.goals.poll();
  bool changed = false;
  in.send_goal.take([&](const SendRequest& request, const Ticket& ticket) {
    SendRequest asked = request;
    asked.goal.pose = placed(request.goal.pose);
    Navigate::Sent sent = in.navigate.send(asked, unix_nanoseconds());
    if (sent.goal)
      in.navigate.asked(in.goals.ask(std::move(*sent.goal)));
    for (const v1::GoalId& id : sent.replaced)
      in.goals.cancel(id);
    in.send_goal.answer(sent.response, ticket);
    changed = changed || sent.response.accepted;
  });
  in.cancel_goal.take([&](const CancelRequest& request, const Ticket& ticket) {
    const Navigate::Canceled canceled = in.navigate.cancel(request);
    for (const v1::GoalId& id : canceled.goals)
      in.goals.cancel(id);
    in.cancel_goal.answer(canceled.response, ticket);
    changed = changed || !canceled.goals.empty();
  });
  in.get_result.take([&](const ResultRequest& request, const Ticket& ticket) {
    if (in.asked.size() >= kMostWaiting)
      in.asked.erase(in.asked.begin());
    in.asked.emplace_back(request.goal_id, ticket);
  });
  for (const v1::GoalStatus& status : in.goals.statuses())
    changed = in.navigate.take(status) || changed;
  if (changed)
    in.status.put(in.navigate.statuses());
  std::erase_if(in.asked, [&](const auto& asked) {
    const std::optional<ResultResponse> result = in.navigate.result(asked.first);
    if (result)
      in.get_result.answer(*result, asked.second);
    return result.has_value();
  });
  in.send_goal.flush();
  in.cancel_goal.flush();
  in.get_result.flush();
}

void RosRobot::tell_slowly() {
  const std::int64_t now = unix_nanoseconds();
  const situation::Situation situation = mind_.situation();
  put(Outward::diagnostics(situation, now));
  if (situation.robot)
    put(Outward::why(situation::why(situation).sentence, now));
  if (inward_)
    if (const auto message = inward_->navigate.feedback(outward_.place(), now))
      inward_->feedback.put(*message);
}

}  // namespace saphira::ros2

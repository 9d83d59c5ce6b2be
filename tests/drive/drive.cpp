#include "drive/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "saphira/authority/robot.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {
namespace {

protocol::RobotParameters parameters_of(const DriveOptions& options) {
  auto parameters =
      protocol::load_parameters(find_file(config_folder() + "/robots", options.robot, ".p"));
  // As set by the bridge at the connection.
  parameters.deceleration = std::max(parameters.deceleration, parameters.stop_deceleration);
  parameters.encode_jitter *= options.errors;
  parameters.angle_jitter *= options.errors;
  parameters.angle_drift *= options.errors;
  return parameters;
}

system::Cores::Settings services_of(const DriveOptions& options,
                                    const protocol::RobotParameters& parameters,
                                    const Pose& start) {
  system::Cores::Settings settings;
  settings.robot = behaviors::model_of(parameters);
  settings.behaviors = options.behaviors.value_or(behaviors::predefined());
  settings.head_reach = parameters.head_reach;
  settings.interpretation = options.interpretation;
  settings.registration = options.registration;
  if (settings.registration && options.knows_pose)
    settings.registration->start = start;
  settings.intentions = options.intentions;
  return settings;
}

/// Of this process alone: tests run side by side.
struct Folder {
  Folder() {
    if (mkdtemp(path.data()) == nullptr)
      throw std::runtime_error(path + " cannot be made");
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path = std::filesystem::temp_directory_path() / "saphira-worlds-XXXXXX";
};

}  // namespace

std::string world_with(const std::string& world, const std::string& name, const std::string& more) {
  static const Folder folder;
  const std::string path = folder.path + "/" + name + ".wld";
  std::ofstream(path) << read_file(config_folder() + "/worlds/" + world + ".wld") << "\n"
                      << more << "\n";
  return path;
}

DriveOptions registered_on(maps::Map map, DriveOptions options, bool knows_pose) {
  options.interpretation = true;
  options.registration.emplace();
  options.registration->map = std::move(map);
  options.registration->add_features = false;
  options.knows_pose = knows_pose;
  return options;
}

Drive::Drive(const DriveOptions& options)
    : parameters_(parameters_of(options)),
      world_(options.made_world
                 ? *options.made_world
                 : sim::load_world(find_file(config_folder() + "/worlds", options.world, ".wld"))),
      scene_(world_),
      robot_(&scene_.add_robot(parameters_,
                               options.start_in_world.value_or(world_.start.value_or(Pose{})),
                               options.seed)),
      sonars_(scene_, robot_->number(), parameters_, options.sonar, options.seed),
      start_(robot_->pose_in_world()),
      cores_(services_of(options, parameters_, start_)),
      bend_(options.bend),
      robot_in_odom_(robot_->pose_in_odom()),
      has_guard_(options.guard),
      knows_walls_(options.knows_walls),
      body_(authority::body_of(parameters_)),
      echoes_(body_.sonar_range),
      coverage_(body_.radius, body_.sonar_range) {
  seen_.pose_in_odom = robot_in_odom_;
  seen_.true_pose_in_world = start_;
}

const Seen& Drive::advance() {
  ++seen_.cycle;
  seen_.readings.clear();
  for (int tick = 0; tick < 10; ++tick) {
    scene_.tick();
    if (const auto echo = sonars_.tick(robot_->pose_in_world()))
      seen_.readings.push_back({echo->number, echo->range.value_or(5.0), echo->range.has_value()});
  }
  reckon();
  seen_.velocity = robot_->velocity();
  seen_.rotation_velocity = robot_->rotation_velocity();
  seen_.true_pose_in_world = robot_->pose_in_world();
  const double turn = 0.1 * parameters_.head_speed;
  seen_.head += std::clamp(look_ - seen_.head, -turn, turn);
  seen_.left_stalled = robot_->left_stalled();
  seen_.right_stalled = robot_->right_stalled();
  robot_->clear_stalls();

  system::RobotCycle now;
  now.cycle = seen_.cycle;
  now.pose_in_odom = seen_.pose_in_odom;
  now.velocity = seen_.velocity;
  now.rotation_velocity = seen_.rotation_velocity;
  now.head = seen_.head;
  now.left_stalled = seen_.left_stalled;
  now.right_stalled = seen_.right_stalled;
  now.readings = seen_.readings;
  const system::Cores::Said& said = cores_.step(now);
  obey(said.behaviors.output);
  if (said.intentions.look)
    look_ = *said.intentions.look;
  return seen_;
}

void Drive::reckon() {
  Pose moved = relative(robot_in_odom_, robot_->pose_in_odom());
  robot_in_odom_ = robot_->pose_in_odom();
  moved.th += bend_ * moved.x;
  seen_.pose_in_odom = bend_ == 0.0 ? robot_in_odom_ : compose(seen_.pose_in_odom, moved);
}

void Drive::obey(const behaviors::Output& output) {
  const double speed = by_hand_ ? speed_ : output.active ? output.speed : 0.0;
  const double heading = by_hand_        ? heading_
                         : output.active ? output.heading_in_odom
                                         : seen_.pose_in_odom.th;
  // Whole millimetres and degrees, as in the robot's commands.
  reflector::Setpoints wanted{speed, true, heading, 0.0};
  guard(wanted);
  robot_->set_velocity(std::round(wanted.velocity * 1000.0) / 1000.0);
  const double bent = norm2_angle(seen_.pose_in_odom.th - robot_in_odom_.th);
  robot_->set_heading(radians(std::round(degrees(norm2_angle(wanted.heading_in_odom - bent)))));
}

/// The walls near the robot, in odom, as its driver knows them.
std::vector<Edge> Drive::edges() const {
  if (by_hand_ || !knows_walls_)
    return cores_.said().intentions.edges;
  std::vector<Edge> edges;
  const ToFrame to_robot(compose(seen_.true_pose_in_world, *knows_walls_));
  const auto in_odom = [&](const Vec2& in_world) {
    return transform(seen_.pose_in_odom, to_robot(in_world));
  };
  for (const sim::Segment& wall : world_.segments)
    if ((sim::nearest_point(wall, seen_.true_pose_in_world.position()) -
         seen_.true_pose_in_world.position())
            .norm() < 3.0)
      edges.push_back({in_odom(wall.from), in_odom(wall.to)});
  return edges;
}

void Drive::guard(reflector::Setpoints& wanted) {
  const double speed = wanted.velocity;
  std::vector<protocol::Sonar> sonars;
  for (const lps::SonarReading& reading : seen_.readings)
    sonars.push_back({static_cast<std::uint8_t>(reading.sonar), reading.range, reading.echo});
  const std::vector<Edge> edges = this->edges();
  const std::vector<authority::Reading> readings = authority::readings_of(sonars, parameters_);
  authority::GuardSettings settings;
  settings.enabled = has_guard_;
  echoes_.update(seen_.cycle, seen_.pose_in_odom, readings, edges);
  body_.knows_edges = !edges.empty();
  body_.sees_ahead = echoes_.sees(seen_.cycle, true);
  body_.sees_behind = echoes_.sees(seen_.cycle, false);
  coverage_.update(seen_.cycle, seen_.pose_in_odom, readings);
  body_.covered = coverage_.way(speed >= 0.0);
  guarded_ = authority::guard(settings, body_, echoes_.spots(), speed, 0.0, seen_.rotation_velocity,
                              by_hand_ ? 0.0 : output().contact_speed, echoes_.edges());
  wanted.velocity = guarded_.velocity;
  sweep_.step(seen_.cycle, guarded_.sweep,
              wanted.velocity < 0.0 ? body_.sweep_behind : body_.sweep_ahead, wanted);
}

void Drive::intend(std::vector<behaviors::Intended> intended, bool control) {
  by_hand_ = false;
  cores_.intend(std::move(intended), control);
}

void Drive::go_to(const Vec2& goal_in_odom, double speed, double radius) {
  const saphira::PlacedPoint goal{{goal_in_odom.x(), goal_in_odom.y(), 0.0}, saphira::Frame::odom};
  intend({{"avoid", "AvoidCollision", 0, true, {}},
          {"keep off", "KeepOff", 1, true, {}},
          {"go", "GoToPos", 2, true, {{"goal", goal}, {"speed", speed}, {"radius", radius}}},
          {"stop", "Stop", 3, true, {}}});
}

void Drive::turn_to(double heading_in_odom) {
  drive(0.0, heading_in_odom);
}

void Drive::stop() {
  intend({{"stop", "Stop", 0, true, {}}});
}

void Drive::drive(double speed, double heading_in_odom) {
  by_hand_ = true;
  cores_.set_control(false);
  speed_ = speed;
  heading_ = heading_in_odom;
}

int Drive::contacts() const {
  return robot_->contacts();
}

bool Tour::act(Drive& drive, const Pose& pose_in_map) {
  if (at_ < points_.size() && (points_[at_] - pose_in_map.position()).norm() < radius_) {
    ++at_;
    ++reached_;
  }
  if (at_ >= points_.size() && loop_)
    at_ = 0;
  if (at_ >= points_.size()) {
    drive.stop();
    return false;
  }
  drive.go_to(transform(drive.seen().pose_in_odom, to_frame(pose_in_map, points_[at_])), speed_);
  return true;
}

}  // namespace saphira::test

#include "drive/drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "behaviors/test/robot_model.hpp"
#include "saphira/authority/robot.hpp"
#include "saphira/base/places.hpp"

namespace saphira::test {
namespace {

protocol::RobotParameters parameters_of(const DriveOptions& options) {
  auto parameters =
      protocol::load_parameters(find_file(config_folder() + "/robots", options.robot, ".p"));
  // As the bridge sets the robot at the connection.
  parameters.deceleration = std::max(parameters.deceleration, parameters.stop_deceleration);
  parameters.encode_jitter *= options.errors;
  parameters.angle_jitter *= options.errors;
  parameters.angle_drift *= options.errors;
  return parameters;
}

}  // namespace

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
      executive_(options.behaviors.value_or(behaviors::predefined()),
                 behaviors::model_of(parameters_)),
      has_guard_(options.guard),
      body_(authority::body_of(parameters_)) {
  seen_.pose_in_odom = robot_->pose_in_odom();
  seen_.true_pose_in_world = robot_->pose_in_world();
}

const Seen& Drive::advance() {
  ++seen_.cycle;
  seen_.readings.clear();
  for (int tick = 0; tick < 10; ++tick) {
    scene_.tick();
    if (const auto echo = sonars_.tick(robot_->pose_in_world()))
      seen_.readings.push_back({echo->number, echo->range.value_or(5.0), echo->range.has_value()});
  }
  seen_.pose_in_odom = robot_->pose_in_odom();
  seen_.velocity = robot_->velocity();
  seen_.rotation_velocity = robot_->rotation_velocity();
  seen_.true_pose_in_world = robot_->pose_in_world();
  seen_.left_stalled = robot_->left_stalled();
  seen_.right_stalled = robot_->right_stalled();
  robot_->clear_stalls();

  intent_ = {seen_.cycle - 1, !by_hand_ && control_, intended_};
  const behaviors::Inputs inputs{seen_.cycle,
                                 {seen_.pose_in_odom, seen_.velocity, seen_.rotation_velocity, 0.0,
                                  seen_.left_stalled, seen_.right_stalled},
                                 seen_.readings,
                                 &intent_};
  output_ = executive_.step(inputs);
  const double speed = by_hand_ ? speed_ : output_.active ? output_.speed : 0.0;
  const double heading = by_hand_         ? heading_
                         : output_.active ? output_.heading_in_odom
                                          : seen_.pose_in_odom.th;
  // Whole millimetres and degrees, as the robot's commands have them.
  robot_->set_velocity(std::round(guard(speed) * 1000.0) / 1000.0);
  robot_->set_heading(radians(std::round(degrees(heading))));
  return seen_;
}

double Drive::guard(double speed) {
  std::vector<protocol::Sonar> sonars;
  for (const lps::SonarReading& reading : seen_.readings)
    sonars.push_back({static_cast<std::uint8_t>(reading.sonar), reading.range, reading.echo});
  echoes_.update(seen_.cycle, seen_.pose_in_odom, authority::readings_of(sonars, parameters_));
  body_.sees_ahead = echoes_.sees(seen_.cycle, true);
  body_.sees_behind = echoes_.sees(seen_.cycle, false);
  authority::GuardSettings settings;
  settings.enabled = has_guard_;
  guarded_ = authority::guard(settings, body_, echoes_.spots(), speed, 0.0, seen_.rotation_velocity,
                              by_hand_ ? 0.0 : output_.contact_speed);
  return guarded_.velocity;
}

void Drive::intend(std::vector<behaviors::Intended> intended, bool control) {
  by_hand_ = false;
  control_ = control;
  intended_ = std::move(intended);
}

void Drive::go_to(const Vec2& goal_in_odom, double speed, double radius) {
  by_hand_ = false;
  control_ = true;
  intended_ = {{"avoid", "AvoidCollision", 0, true, {}},
               {"keep off", "KeepOff", 1, true, {}},
               {"go",
                "GoToPos",
                2,
                true,
                {{"goal", behaviors::PlacedPoint{{goal_in_odom.x(), goal_in_odom.y(), 0.0},
                                                 behaviors::Frame::odom}},
                 {"speed", speed},
                 {"radius", radius}}},
               {"stop", "Stop", 3, true, {}}};
}

void Drive::turn_to(double heading_in_odom) {
  drive(0.0, heading_in_odom);
}

void Drive::stop() {
  by_hand_ = false;
  control_ = true;
  intended_ = {{"stop", "Stop", 0, true, {}}};
}

void Drive::drive(double speed, double heading_in_odom) {
  by_hand_ = true;
  speed_ = speed;
  heading_ = heading_in_odom;
}

std::vector<lps::SonarMount> Drive::mounts() const {
  return executive_.model().lps.sonars;
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

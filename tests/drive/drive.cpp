#include "drive/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "behaviors/shell/service.hpp"
#include "bridge/shell/convert.hpp"
#include "intentions/shell/service.hpp"
#include "interpretation/shell/service.hpp"
#include "lps/shell/convert.hpp"
#include "registration/shell/service.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/authority/robot.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {
namespace {

constexpr std::uint64_t kEpoch = 1;

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

bus::NodeOptions named(const char* name) {
  bus::NodeOptions options;
  options.name = name;
  options.lockstep = true;
  return options;
}

v1::IntendedBehavior behavior(const char* schema, int priority, const Arguments& parameters = {}) {
  return {.name = schema,
          .schema = schema,
          .priority = priority,
          .running = true,
          .parameters = to_bus(parameters)};
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
  Folder& operator=(Folder&&) = delete;

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
      mounts_(behaviors::model_of(parameters_).lps.sonars),
      bend_(options.bend),
      robot_in_odom_(robot_->pose_in_odom()),
      has_guard_(options.guard),
      knows_walls_(options.knows_walls),
      body_(authority::body_of(parameters_)),
      echoes_(body_.sonar_range),
      coverage_(body_.radius, body_.sonar_range),
      node_(named("bridge"), memory_),
      services_(named(""), memory_) {
  seen_.pose_in_odom = robot_in_odom_;
  seen_.true_pose_in_world = start_;
  begin(options);
}

void Drive::begin(const DriveOptions& options) {
  v1::RobotDescription description = bridge::to_bus(parameters_, {}, {.epoch = kEpoch}, "", true);
  description.instance = node_.instance();
  descriptions_.write(description);
  services_.add("behaviors", behaviors::component().make);
  if (options.interpretation)
    services_.add("interpretation", interpretation::component().make);
  if (options.registration)
    services_.add("registration", [&](runtime::Ports& ports) {
      registration::Core::Settings settings = *options.registration;
      if (options.knows_pose)
        settings.start = start_;
      auto service = std::make_unique<registration::Service>(ports, settings);
      registration_ = &service->core();
      return service;
    });
  if (options.vision)
    sees_.emplace(node_.writer(bus::topics::kVision));
  if (!options.intentions) {
    intends_.emplace(node_.writer(bus::topics::kIntentions));
    return;
  }
  services_.add("intentions", [&](runtime::Ports& ports) {
    intentions::Options with;
    with.registration = options.registration.has_value();
    with.interpretation = options.interpretation;
    with.vision = options.vision;
    return std::make_unique<intentions::Service>(ports, with);
  });
}

const sim::ContactWatch& Drive::watch() {
  if (!watch_)
    watch_.emplace(scene_, robot_->number(), parameters_);
  return *watch_;
}

const Seen& Drive::advance() {
  ++seen_.cycle;
  seen_.readings.clear();
  for (int tick = 0; tick < 10; ++tick) {
    scene_.tick();
    if (watch_)
      watch_->tick();
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

  step_services();
  obey();
  return seen_;
}

void Drive::step_services() {
  if (intends_) {
    intended_.stamp = {kEpoch, seen_.cycle - 1};
    intends_->write(intended_);
  }
  // Commands take effect at once here: the heading setpoint is not needed.
  v1::RobotState state{.stamp = {kEpoch, seen_.cycle},
                       .odom = kOdom,
                       .pose_in_odom = to_bus(seen_.pose_in_odom),
                       .velocity = seen_.velocity,
                       .rotation_velocity = seen_.rotation_velocity,
                       .target_heading_in_odom = seen_.pose_in_odom.th,
                       .status = v1::MOTORS_MOVING,
                       .left_stalled = seen_.left_stalled,
                       .right_stalled = seen_.right_stalled,
                       .head = seen_.head};
  state.sonars.reserve(seen_.readings.size());
  for (const lps::SonarReading& reading : seen_.readings)
    state.sonars.push_back({.sonar = static_cast<std::uint8_t>(reading.sonar),
                            .range = static_cast<float>(reading.range),
                            .echo = reading.echo});
  states_.write(state);
  services_.advance();
  commanded_ = commands_.take_newest().value();
  const auto keep = [](auto& newest) {
    return [&](const auto& sample, const bus::SampleInfo& /*info*/) { newest = sample; };
  };
  perceptions_.visit([&](const v1::Perception& perception, const bus::SampleInfo& /*info*/) {
    percepts_ = converted(perception.percepts, [](const auto& one) { return lps::from_bus(one); });
  });
  registrations_.visit(keep(registered_));
  intentions_.visit(keep(intended_));
  if (const auto look = looks_.take_newest())
    look_ = number_of(from_bus(look->arguments), "angle");
}

void Drive::reckon() {
  Pose moved = relative(robot_in_odom_, robot_->pose_in_odom());
  robot_in_odom_ = robot_->pose_in_odom();
  moved.th += bend_ * moved.x;
  seen_.pose_in_odom = bend_ == 0.0 ? robot_in_odom_ : compose(seen_.pose_in_odom, moved);
}

void Drive::obey() {
  const double speed = by_hand_ ? speed_ : commanded_.active ? commanded_.velocity : 0.0;
  const double heading = by_hand_            ? heading_
                         : commanded_.active ? commanded_.heading
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
    return converted(intended_.edges, [](const v1::Edge& edge) {
      return Edge{{edge.x1, edge.y1}, {edge.x2, edge.y2}};
    });
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
  sonars.reserve(seen_.readings.size());
  for (const lps::SonarReading& reading : seen_.readings)
    sonars.push_back({static_cast<std::uint8_t>(reading.sonar), reading.range, reading.echo});
  const std::vector<Edge> edges = this->edges();
  const std::vector<authority::Reading> readings = authority::readings_of(sonars, parameters_);
  authority::GuardSettings settings{.enabled = has_guard_};
  echoes_.update(seen_.cycle, seen_.pose_in_odom, readings, edges);
  body_.knows_edges = !edges.empty();
  body_.sees_ahead = echoes_.sees(seen_.cycle, true);
  body_.sees_behind = echoes_.sees(seen_.cycle, false);
  coverage_.update(seen_.cycle, seen_.pose_in_odom, readings);
  if (speed != 0.0)
    body_.covered = coverage_.way(speed > 0.0);
  guarded_ = authority::guard(settings, body_, echoes_.spots(), speed, 0.0, seen_.rotation_velocity,
                              by_hand_ ? 0.0 : commanded_.contact_speed, echoes_.edges());
  wanted.velocity = guarded_.velocity;
  sweep_.step(seen_.cycle, guarded_.sweep,
              wanted.velocity < 0.0 ? body_.sweep_behind : body_.sweep_ahead, wanted);
}

void Drive::intend(std::vector<v1::IntendedBehavior> intended) {
  by_hand_ = false;
  intended_.behavior_control = true;
  intended_.behaviors = std::move(intended);
}

void Drive::see(std::vector<lps::SeenThing> things) {
  things_ = std::move(things);
  sees_->write({.stamp = {kEpoch, seen_.cycle},
                .odom = kOdom,
                .sees_people = true,
                .sees_colors = true,
                .things = converted(things_, [](const auto& one) { return lps::to_bus(one); })});
}

void Drive::ask(const Request& request) {
  requests_.write(to_bus(request));
}

Pose Drive::believed() const {
  return from_bus(registered_.pose_in_map);
}

void Drive::go_to(const Vec2& goal_in_odom, double speed, double radius) {
  const saphira::PlacedPoint goal{{goal_in_odom.x(), goal_in_odom.y(), 0.0}, saphira::Frame::odom};
  intend({behavior("AvoidCollision", 0), behavior("KeepOff", 1),
          behavior("GoToPos", 2, {{"goal", goal}, {"speed", speed}, {"radius", radius}}),
          behavior("Stop", 3)});
}

void Drive::turn_to(double heading_in_odom) {
  drive(0.0, heading_in_odom);
}

void Drive::stop() {
  intend({behavior("Stop", 0)});
}

void Drive::drive(double speed, double heading_in_odom) {
  by_hand_ = true;
  intended_.behavior_control = false;
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

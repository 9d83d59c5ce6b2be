#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/authority/coverage.hpp"
#include "saphira/authority/echo_map.hpp"
#include "saphira/authority/guard.hpp"
#include "saphira/behaviors/behavior.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/reflector/sweep.hpp"
#include "saphira/registration/core.hpp"
#include "saphira/runtime/composition.hpp"
#include "saphira/sim/contacts.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/sonar.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::test {

/// A world of config/worlds with additions, as a file of that name.
std::string world_with(const std::string& world, const std::string& name, const std::string& more);
inline std::string office_with(const std::string& name, const std::string& more) {
  return world_with("office-floor", name, more);
}

struct DriveOptions {
  std::string world = "office-floor";                 ///< a name of config/worlds
  std::shared_ptr<const sim::World> made_world = {};  ///< instead of it
  std::string robot = "pioneer";                      ///< a name of config/robots
  std::uint64_t seed = 1;
  double errors = 1.0;  ///< factor on the robot's dead-reckoning errors (manual Table 3-1)
  std::optional<Pose> start_in_world = {};  ///< else the world's own
  sim::SonarModel sonar = {};
  bool guard = false;  ///< beside the robot, as in the bridge: it slows drives
  /// With the guard, and without intentions: the driver knows the world's walls, with this error of
  /// its place.
  std::optional<Pose> knows_walls = {};
  double bend = 0.0;  ///< [rad/m] additional turn of dead reckoning

  // The services beside behaviors.
  bool interpretation = false;
  std::optional<registration::Core::Settings> registration = {};
  bool knows_pose = false;  ///< registration gets the robot's start
  bool intentions = false;
  bool vision = false;  ///< the caller sees instead of it, after each cycle
};

/// With interpretation and with registration on that map. `knows_pose`: as in DriveOptions.
DriveOptions registered_on(maps::Map map, DriveOptions options = {}, bool knows_pose = true);

/// The measurements of one cycle, and the true pose beside them.
struct Seen {
  std::uint64_t cycle = 0;
  Pose pose_in_odom;  ///< (0, 0, 0) at the start
  double velocity = 0.0;
  double rotation_velocity = 0.0;
  std::vector<lps::SonarReading> readings;  ///< new ones, in firing order
  Pose true_pose_in_world;
  double head = 0.0;  ///< [rad] direction of the cameras in the robot
  bool left_stalled = false;
  bool right_stalled = false;
};

/// A simulated robot, without packets, and the services on a bus in memory, in lockstep in one
/// thread; repeatable to the last bit. Without intentions it drives towards points with
/// AvoidCollision, KeepOff and GoToPos, as the functor go_to does.
class Drive {
 public:
  /// The number of the odom frame; the bridge makes it from the time.
  static constexpr std::uint64_t kOdom = 1795260425632;

  explicit Drive(const DriveOptions& options);
  Drive& operator=(Drive&&) = delete;

  /// Moves the world by one cycle under the newest commands.
  const Seen& advance();

  /// The task from the next cycle on.
  void go_to(const Vec2& goal_in_odom, double speed = 0.3, double radius = 0.15);
  void turn_to(double heading_in_odom);
  void stop();
  /// Manual driving, without behaviors: [m/s], and the heading in odom [rad].
  void drive(double speed, double heading_in_odom);
  /// These behaviors, as intentions would intend them.
  void intend(std::vector<v1::IntendedBehavior> intended);
  /// The vision service's output for the newest cycle.
  void see(std::vector<lps::SeenThing> things);
  /// A request to registration: carried out in the next cycle.
  void ask(const Request& request);

  // The outputs of the services in the newest cycle; empty without the service.
  const v1::MotorCommand& commanded() const { return commanded_; }
  const std::vector<lps::Percept>& percepts() const { return percepts_; }
  const std::vector<lps::SeenThing>& things() const { return things_; }
  const v1::Intentions& intended() const { return intended_; }
  const v1::Registration& registered() const { return registered_; }
  Pose believed() const;
  const registration::Core& registration() const { return *registration_; }
  runtime::Composition& services() { return services_; }
  /// Another program on their bus.
  bus::Node& node() { return node_; }
  const std::shared_ptr<bus::MemoryBus>& bus() const { return memory_; }
  Pose truth() const { return seen_.true_pose_in_world; }
  /// By dead reckoning alone, from the true start.
  Pose reckoned() const { return compose(start_, seen_.pose_in_odom); }

  const Seen& seen() const { return seen_; }
  const sim::World& world() const { return world_; }
  const protocol::RobotParameters& parameters() const { return parameters_; }
  const std::vector<lps::SonarMount>& mounts() const { return mounts_; }
  /// The result of the guard in the newest cycle.
  const authority::Guarded& guarded() const { return guarded_; }
  sim::Scene& scene() { return scene_; }
  sim::Robot& robot() { return *robot_; }
  /// Of the contacts of the robot, from the first call on.
  const sim::ContactWatch& watch();
  int contacts() const;

 private:
  void begin(const DriveOptions& options);
  void reckon();
  void step_services();
  void obey();
  void guard(reflector::Setpoints& wanted);
  std::vector<Edge> edges() const;

  protocol::RobotParameters parameters_;
  sim::World world_;
  sim::Scene scene_;
  sim::Robot* robot_;
  std::optional<sim::ContactWatch> watch_;
  sim::Sonars sonars_;
  Pose start_;
  std::vector<lps::SonarMount> mounts_;
  double bend_;
  Pose robot_in_odom_;  ///< by the robot's own odometry, without the bend
  bool has_guard_;
  std::optional<Pose> knows_walls_;
  authority::Body body_;
  authority::EchoMap echoes_;
  authority::Coverage coverage_;
  reflector::Sweep sweep_;
  authority::Guarded guarded_;
  bool by_hand_ = false;
  double speed_ = 0.0;
  double heading_ = 0.0;
  double look_ = 0.0;  ///< [rad] the direction that the cameras turn to
  Seen seen_;

  std::shared_ptr<bus::MemoryBus> memory_ = bus::make_memory_bus();
  bus::Node node_;  ///< as the bridge
  bus::Writer<v1::RobotDescription> descriptions_{node_.writer(bus::topics::kRobotDescription)};
  bus::Writer<v1::RobotState> states_{node_.writer(bus::topics::kRobotState)};
  bus::Writer<v1::Request> requests_{node_.writer<v1::Request>(bus::topics::kRegistrationRequest)};
  std::optional<bus::Writer<v1::Intentions>> intends_;  ///< instead of the services
  std::optional<bus::Writer<v1::Vision>> sees_;
  bus::Reader<v1::MotorCommand> commands_{node_.reader(bus::topics::kDriveBehaviors)};
  bus::Reader<v1::Request> looks_{node_.reader<v1::Request>(bus::topics::kServo)};
  bus::Reader<v1::Intentions> intentions_{node_.reader(bus::topics::kIntentions)};
  bus::Reader<v1::Perception> perceptions_{node_.reader(bus::topics::kPerception)};
  bus::Reader<v1::Registration> registrations_{node_.reader(bus::topics::kRegistration)};
  v1::MotorCommand commanded_;
  std::vector<lps::Percept> percepts_;
  std::vector<lps::SeenThing> things_;
  v1::Intentions intended_;
  v1::Registration registered_{.state = v1::REGISTRATION_UNPLACED};
  const registration::Core* registration_ = nullptr;
  runtime::Composition services_;
};

/// Drives through points one after the other, repeatedly if `loop` is set: go_to each, the next one
/// at a distance below `radius`. The points are in the map; the caller passes the robot's estimated
/// or true pose in each cycle.
class Tour {
 public:
  Tour(std::vector<Vec2> points_in_map, bool loop, double radius = 0.5, double speed = 0.3)
      : points_(std::move(points_in_map)), loop_(loop), radius_(radius), speed_(speed) {}

  /// False when the last point is reached; then the robot stops.
  bool act(Drive& drive, const Pose& pose_in_map);
  std::size_t reached() const { return reached_; }
  /// Gives up the present point for the next one.
  void skip() { ++at_; }

 private:
  std::vector<Vec2> points_;
  bool loop_;
  double radius_;
  double speed_;
  std::size_t at_ = 0;
  std::size_t reached_ = 0;
};

}  // namespace saphira::test

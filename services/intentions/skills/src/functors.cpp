#include "saphira/intentions/functors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "driving.hpp"
#include "following.hpp"
#include "mapping.hpp"
#include "saphira/base/archived.hpp"
#include "zones.hpp"

namespace saphira::intentions {
namespace {

/// Cycles until a motion command shows in the robot's state.
constexpr Ticks kOnTheWay = 3;

/// [s] without progress before a goal fails.
constexpr double kPatience = 20.0;
constexpr double kGround = 0.1;           ///< [m] least progress within the patience
constexpr double kDetour = 3.0;           ///< patiences that a robot has which gets on
constexpr double kFar = 1000.0;           ///< [m] distance of the point that stands for a heading
constexpr double kFacing = radians(5.0);  ///< tolerance of the heading at the end of a way

/// Where the readings do not confirm the place, the robot moves about: the number of times, the
/// duration of each [s], and the speed [m/s].
constexpr int kChecks = 3;
constexpr double kCheckTime = 15.0;
constexpr double kCheckSpeed = 0.2;

double value_of(const Arguments& arguments, std::string_view name) {
  const Argument* const argument = find(arguments, name);
  return argument == nullptr ? 0.0 : argument->number;
}

std::string format(const char* pattern, double a, double b = 0.0) {
  char text[96];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

double distance(const Pose& a, const Pose& b) {
  return (a.position() - b.position()).norm();
}

/// The point in odom now: a point on the map by registration; none without a registered pose.
std::optional<Pose> in_odom(const Argument& point, const Robot& robot) {
  if (point.frame != Frame::map)
    return point.point;
  if (!robot.odom_in_map)
    return std::nullopt;
  return relative(*robot.odom_in_map, point.point);
}

/// Detects that a shrinking measure does not shrink any more.
class Watchdog {
 public:
  /// step: the least progress, in the measure's unit.
  Watchdog(double step, double patience) : step_(step), patience_(patience) {}

  void restart(double measure, Ticks now) {
    best_ = measure;
    since_ = now;
  }
  /// True when there has been no progress for too long.
  bool check(double measure, Ticks now) {
    if (measure <= best_ - step_)
      restart(measure, now);
    return waited(now) >= patience_;
  }
  /// [s] since the last progress.
  double waited(Ticks now) const { return static_cast<double>(now - since_) * kTick; }
  double patience() const { return patience_; }
  void patience(double seconds) { patience_ = seconds; }

  SAPHIRA_ARCHIVE(step_, patience_, best_, since_)

 private:
  double step_;
  double patience_;
  double best_ = std::numeric_limits<double>::infinity();
  Ticks since_ = 0;
};

bool begins(const Self& self) {
  return self.state() == IntentionState::kInit || self.state() == IntentionState::kResumed;
}

/// Notes whether a robot is told to move, and whether it ever does.
class Motion {
 public:
  void note(const Robot& robot) {
    const Pose& pose = robot.pose_in_odom;
    if (!first_)
      first_ = pose;
    moved_ = moved_ || distance(*first_, pose) > kMoved ||
             std::abs(norm2_angle(pose.th - first_->th)) > kTurned;
    told_ = told_ || std::abs(robot.target_velocity) > kRestVelocity ||
            std::abs(norm2_angle(robot.target_heading_in_odom - pose.th)) > kToldTurn;
    stalled_ = stalled_ || robot.left_stalled || robot.right_stalled;
  }
  /// Some robots do not report that their motors are off.
  bool none_though_told() const { return told_ && !moved_ && !stalled_; }

  SAPHIRA_ARCHIVE(first_, moved_, told_, stalled_)

 private:
  static constexpr double kMoved = 0.01;              // [m]
  static constexpr double kTurned = radians(1.0);     // [rad]
  static constexpr double kToldTurn = radians(10.0);  // [rad]

  std::optional<Pose> first_;
  bool moved_ = false;
  bool told_ = false;
  bool stalled_ = false;
};

/// Finds that the robot stands before a keep-out, and does not turn away from it.
class KeepOut {
 public:
  bool stops(const Self& self, bool backwards) {
    const std::string zone = keep_out_ahead(self.world(), backwards);
    if (zone.empty() || !at_rest(self.robot()) || zone != zone_) {
      zone_ = zone;
      since_ = self.now();
    }
    return !zone.empty() && static_cast<double>(self.now() - since_) * kTick >= kStands;
  }
  std::string reason() const { return "it must not go on: " + zone_; }
  /// After a pause, or towards another target.
  void restart() { zone_.clear(); }

  SAPHIRA_ARCHIVE(zone_, since_)

 private:
  static constexpr double kStands = 2.0;  // [s]

  std::string zone_;
  Ticks since_ = 0;
};

std::string why_not_moving(const Robot& robot, const Motion& motion) {
  if (!robot.has_power)
    return "; the motors have no power (saphira device motors on)";
  return motion.none_though_told()
             ? "; it has not moved at all: are its motors on? (saphira device motors on)"
             : "";
}

/// The robot stands while its place on the map is unknown, and fails after its patience.
void wait_for_position(Self& self, std::optional<Ticks>& since, double patience) {
  for (const char* label : {"AvoidCollision", "KeepOff", "GoToPos", "ConstantVelocity", "TurnTo"})
    self.drop_behavior(label);
  self.intend_behavior("Stop", "Stop", kRest, {});
  self.say("waits to know where it is on the map");
  if (!since || begins(self))
    since = self.now();
  if (static_cast<double>(self.now() - *since) * kTick >= patience)
    self.fail(v1::CODE_NO_POSITION,
              format("the robot has not known where it is on the map for %.0f s", patience));
}

// A turn counts as made to a tenth of itself, within these limits. The robot is told whole degrees,
// and its servo has a tolerance of up to 0.6 degrees.
constexpr double kShareOfTurn = 0.1;
constexpr double kLeastAngle = radians(1.1);
constexpr double kWidestAngle = radians(5.0);

/// Turns on the spot. No behavior watches obstacles: the robot is round and stays in its place.
class TurnTo : public Activity {
 public:
  TurnTo() = default;  ///< to be restored
  explicit TurnTo(const Arguments& arguments) { take(arguments); }

  bool change(const Arguments& arguments) override {
    take(arguments);
    return true;
  }

  void step(Self& self) override {
    motion_.note(self.robot());
    if (self.state() == IntentionState::kInterrupted)
      return;
    const Pose& pose = self.robot().pose_in_odom;
    // A heading is a point far away in that direction; it keeps its first place, so that the
    // behavior does not change every cycle.
    if (new_target_ && heading_)
      target_ = point("heading", {pose.x + kFar * std::cos(*heading_),
                                  pose.y + kFar * std::sin(*heading_), 0.0});
    const std::optional<Pose> target = in_odom(target_, self.robot());
    if (!target) {
      wait_for_position(self, waiting_since_, watchdog_.patience());
      return;
    }
    const bool waited = std::exchange(waiting_since_, std::nullopt).has_value();
    const double toward = std::atan2(target->y - pose.y, target->x - pose.x);
    const double left = std::abs(norm2_angle(toward - pose.th));
    if (new_target_) {
      whole_turn_ = left;
      near_ = angle_ > 0.0 ? angle_ : std::clamp(kShareOfTurn * left, kLeastAngle, kWidestAngle);
    }
    if (std::exchange(new_target_, false) || begins(self) || waited)
      watchdog_.restart(left, self.now());
    self.intend_behavior("TurnTo", "TurnTo", kTask,
                         {point("goal", *target), number("success_angle", near_),
                          number("turn_speed", turn_speed_)});
    self.intend_behavior("Stop", "Stop", kRest, {});
    self.say(heading_ ? format("turning to %.0f degrees", degrees(*heading_))
                      : "turning to " + format_point(target_));
    if (whole_turn_ > 0.0)
      self.progress(1.0 - left / whole_turn_);
    const bool satisfied =
        left <= near_ || (self.level("TurnTo") >= kSatisfied && left <= 2.0 * near_);
    const bool late = watchdog_.check(left, self.now());
    // A robot whose own servo is coarser ends where that stands.
    const bool coarse = late && angle_ == 0.0 && left <= std::min(kWidestAngle, whole_turn_ / 2.0);
    if ((satisfied || coarse) && at_rest(self.robot()))
      self.succeed(format("turned, %.1f degrees off", degrees(left)));
    else if (late)
      self.fail(v1::CODE_BLOCKED, format("no nearer for %.0f s, %.0f degrees off",
                                         watchdog_.patience(), degrees(left)) +
                                      why_not_moving(self.robot(), motion_));
  }

  void archive(Archive& a) override {
    a("heading", heading_)("target", target_)("waiting_since", waiting_since_)("angle", angle_)(
        "near", near_)("turn_speed", turn_speed_)("watchdog", watchdog_)("motion", motion_)(
        "whole_turn", whole_turn_)("new_target", new_target_);
  }

 private:
  void take(const Arguments& arguments) {
    heading_.reset();
    if (const Argument* const heading = find(arguments, "heading"))
      heading_ = heading->number;
    else
      target_ = *find(arguments, "position");
    angle_ = value_of(arguments, "angle");
    turn_speed_ = value_of(arguments, "turn_speed");
    watchdog_.patience(value_of(arguments, "patience"));
    new_target_ = true;
  }

  std::optional<double> heading_;  ///< [rad] in odom
  Argument target_;
  std::optional<Ticks> waiting_since_;
  double angle_ = 0.0;          ///< [rad] as asked for; 0: a share of the turn
  double near_ = kWidestAngle;  ///< [rad] counts as there
  double turn_speed_ = 0.0;
  Watchdog watchdog_{radians(2.0), kPatience};
  Motion motion_;
  double whole_turn_ = 0.0;
  bool new_target_ = true;
};

// A way counts as driven to a tenth of itself, within these limits.
constexpr double kShareOfWay = 0.1;
constexpr double kLeastRadius = 0.02;   // [m]
constexpr double kWidestRadius = 0.15;  // [m]

/// Drives to a point: AvoidCollision over KeepOff over GoToPos, and Stop where none of them is
/// active. At the point, Stop alone until the robot stands; then it turns where it is to face.
class GoTo : public Activity {
 public:
  explicit GoTo(const Arguments& arguments) : watchdog_(0.05, kPatience) { take(arguments); }

  bool change(const Arguments& arguments) override {
    take(arguments);
    return true;
  }

  void step(Self& self) override {
    motion_.note(self.robot());
    if (self.state() == IntentionState::kInterrupted)
      return;
    if (begins(self))
      turn_.reset();  // the robot may be elsewhere by now
    if (turn_)
      return turn_->step(self);
    self.drop_behavior("TurnTo");
    const std::optional<Pose> target = in_odom(target_, self.robot());
    if (!target) {
      wait_for_position(self, waiting_since_, watchdog_.patience());
      return;
    }
    if (const std::string why = why_no_goal(self.world(), target_.point, target_.frame);
        !why.empty()) {
      self.fail(v1::CODE_NO_ROUTE, format_point(target_) + " " + why);
      return;
    }
    const bool waited = std::exchange(waiting_since_, std::nullopt).has_value();
    const double left = distance(self.robot().pose_in_odom, *target);
    const bool begun = new_target_ || begins(self);
    if (begun) {
      if (new_target_) {
        whole_way_ = left;
        near_ =
            radius_ > 0.0 ? radius_ : std::clamp(kShareOfWay * left, kLeastRadius, kWidestRadius);
      }
      new_target_ = false;
      there_ = false;
      checking_since_.reset();
    }
    const bool checked = checking_since_.has_value();
    if (checked && move_about(self))
      return;
    if (begun || waited || checked) {
      watchdog_.restart(left, self.now());
      keep_out_.restart();
    }
    // The behavior's own report, within limits: it may be satisfied a little before the radius.
    if (left <= near_ || (self.level("GoToPos") >= kSatisfied && left <= 2.0 * near_))
      there_ = true;
    if (there_) {
      self.drop_behavior("AvoidCollision");
      self.drop_behavior("KeepOff");
      self.drop_behavior("GoToPos");
      self.intend_behavior("Stop", "Stop", kRest, {});
      self.say("stopping at " + format_point(target_));
      if (!at_rest(self.robot()))
        return;
      if (!unsure(self) && facing_)
        turn_.emplace(Arguments{facing(), number("angle", kFacing), number("turn_speed", 1.0),
                                number("patience", watchdog_.patience())});
      else if (!unsure(self))
        self.succeed(format("arrived, %.2f m from the point", left));
      else if (checks_ < kChecks)
        checking_since_ = self.now();
      else
        self.fail(v1::CODE_NO_POSITION,
                  format("it may stand %.2f m from the point, but what it hears does not confirm "
                         "where it is on the map",
                         left));
      return;
    }
    self.intend_behavior("AvoidCollision", "AvoidCollision", kAvoid, {});
    self.intend_behavior("KeepOff", "KeepOff", kKeepOff, {});
    self.intend_behavior(
        "GoToPos", "GoToPos", kTask,
        {point("goal", *target), number("speed", speed_), number("radius", near_)});
    self.intend_behavior("Stop", "Stop", kRest, {});
    self.say("driving to " + format_point(target_));
    if (whole_way_ > 0.0)
      self.progress(1.0 - left / whole_way_);
    if (keep_out_.stops(self, false)) {
      self.fail(v1::CODE_NO_ROUTE, keep_out_.reason());
      return;
    }
    const bool late = watchdog_.check(left, self.now());
    path_ = watchdog_.waited(self.now()) > 0.0 ? path_ + distance(last_, self.robot().pose_in_odom)
                                               : 0.0;
    last_ = self.robot().pose_in_odom;
    if (late && !makes_a_detour(self))
      self.fail(v1::CODE_BLOCKED, format("no nearer for %.0f s, %.2f m from the point",
                                         watchdog_.waited(self.now()), left) +
                                      why_not_moving(self.robot(), motion_));
  }

  void archive(Archive& a) override {
    a("target", target_)("facing", facing_)("turn", turn_)("waiting_since", waiting_since_)(
        "keep_out", keep_out_)("speed", speed_)("radius", radius_)("near", near_)(
        "watchdog", watchdog_)("motion", motion_)("last", last_)("path", path_)(
        "whole_way", whole_way_)("new_target", new_target_)("there", there_)(
        "checking_since", checking_since_)("checks", checks_);
  }

 private:
  /// The way around an obstacle may lead away from the point, and take a slow robot long: it gets
  /// on if it drives its radius each second on average.
  bool makes_a_detour(Self& self) const {
    const double waited = watchdog_.waited(self.now());
    return self.world().around.robot_radius > 0.0 &&
           path_ >= waited * self.world().around.robot_radius &&
           waited < kDetour * watchdog_.patience();
  }

  bool unsure(Self& self) const {
    return target_.frame == Frame::map && self.world().unsure_of_position();
  }

  /// A given pose, or one that fits badly, is not enough for an arrival: motion gives more
  /// readings. False when that is over, and the robot has to drive to the point again.
  bool move_about(Self& self) {
    if (!unsure(self) || static_cast<double>(self.now() - *checking_since_) * kTick >= kCheckTime) {
      ++checks_;
      checking_since_.reset();
      self.drop_behavior("ConstantVelocity");
      there_ = false;
      return false;
    }
    self.intend_behavior("AvoidCollision", "AvoidCollision", kAvoid, {});
    self.intend_behavior("KeepOff", "KeepOff", kKeepOff, {});
    self.intend_behavior("ConstantVelocity", "ConstantVelocity", kTask,
                         {number("speed", std::min(speed_, kCheckSpeed))});
    self.intend_behavior("Stop", "Stop", kRest, {});
    self.say("moving about to confirm where it is");
    return true;
  }

  /// A point far away in the direction to face.
  Argument facing() const {
    Argument ahead = target_;
    ahead.name = "position";
    ahead.point = {target_.point.x + kFar * std::cos(*facing_),
                   target_.point.y + kFar * std::sin(*facing_), 0.0};
    return ahead;
  }

  void take(const Arguments& arguments) {
    target_ = *find(arguments, "position");
    const Argument* const facing = find(arguments, "facing");
    facing_ = facing == nullptr ? std::nullopt : std::optional(facing->number);
    turn_.reset();
    speed_ = value_of(arguments, "speed");
    radius_ = value_of(arguments, "radius");
    watchdog_.patience(value_of(arguments, "patience"));
    new_target_ = true;
  }

  Argument target_;
  std::optional<double> facing_;  ///< [rad] in the frame of the target
  std::optional<TurnTo> turn_;    ///< at the target
  std::optional<Ticks> waiting_since_;
  KeepOut keep_out_;
  double speed_ = 0.0;
  double radius_ = 0.0;          ///< [m] as asked for; 0: a share of the way
  double near_ = kWidestRadius;  ///< [m] counts as there
  Watchdog watchdog_;
  Motion motion_;
  Pose last_;
  double path_ = 0.0;  ///< [m] since the last progress
  double whole_way_ = 0.0;
  bool new_target_ = true;
  bool there_ = false;
  std::optional<Ticks> checking_since_;
  int checks_ = 0;
};

/// Drives at a speed around obstacles, for a distance. Without one its deadline is its success.
class Drive : public Activity {
 public:
  explicit Drive(const Arguments& arguments) { take(arguments); }

  bool change(const Arguments& arguments) override {
    take(arguments);
    return true;
  }

  void step(Self& self) override {
    motion_.note(self.robot());
    if (self.state() == IntentionState::kInterrupted)
      return;
    const Pose& pose = self.robot().pose_in_odom;
    const bool same_odom = std::exchange(odom_, self.robot().odom) == self.robot().odom;
    if (begins(self) || restart_ || !same_odom) {
      restart_ = false;
      keep_out_.restart();
      anchor_ = pose;
      anchored_ = self.now();
    } else {
      path_ += distance(last_, pose);
    }
    last_ = pose;
    self.intend_behavior("AvoidCollision", "AvoidCollision", kAvoid, {});
    const double left = distance_ - path_;
    if (distance_ > 0.0 && left <= kRollOut * std::abs(self.robot().velocity))
      return self.succeed(format("drove %.2f m", path_));
    const double speed =
        distance_ > 0.0
            ? std::copysign(std::min(std::abs(speed_), std::max(kSlowest, kSlowing * left)), speed_)
            : speed_;
    self.intend_behavior("ConstantVelocity", "ConstantVelocity", kTask, {number("speed", speed)});
    self.intend_behavior("Stop", "Stop", kRest, {});
    self.say(distance_ > 0.0 ? format("driving %.2f m on", left)
                             : format("driving at %.2f m/s", speed_));
    if (distance(anchor_, pose) >= kGround) {
      anchor_ = pose;
      anchored_ = self.now();
    }
    const double still = static_cast<double>(self.now() - anchored_) * kTick;
    if (keep_out_.stops(self, speed_ < 0.0))
      self.fail(v1::CODE_NO_ROUTE, keep_out_.reason());
    else if (std::abs(speed_) > kRestVelocity && still >= patience_)
      self.fail(v1::CODE_BLOCKED, format("has not moved for %.0f s", patience_) +
                                      why_not_moving(self.robot(), motion_));
  }

  std::string at_deadline(const Robot& robot) override {
    static_cast<void>(robot);
    return distance_ > 0.0 || path_ < kLeastRadius
               ? std::string()
               : format("drove %.2f m until the deadline", path_);
  }

  void archive(Archive& a) override {
    a("speed", speed_)("distance", distance_)("patience", patience_)("restart", restart_)(
        "keep_out", keep_out_)("motion", motion_)("anchor", anchor_)("anchored", anchored_)(
        "last", last_)("path", path_)("odom", odom_);
  }

 private:
  void take(const Arguments& arguments) {
    speed_ = value_of(arguments, "speed");
    distance_ = value_of(arguments, "distance");
    patience_ = value_of(arguments, "patience");
    restart_ = true;
    path_ = 0.0;
  }

  static constexpr double kSlowest = 0.05;  // [m/s] at the end of a distance...
  static constexpr double kSlowing = 1.0;   // [1/s] ...and for each meter that is left
  static constexpr double kRollOut = 0.2;   // [s] from the end of the task to the robot's brakes

  double speed_ = 0.0;
  double distance_ = 0.0;  ///< [m] 0: until the deadline
  double patience_ = kPatience;
  bool restart_ = true;
  KeepOut keep_out_;
  Motion motion_;
  Pose anchor_;
  Ticks anchored_ = 0;
  Pose last_;
  double path_ = 0.0;       ///< [m]
  std::uint64_t odom_ = 0;  ///< of `last_`
};

class Halt : public Activity {
 public:
  void step(Self& self) override {
    if (self.state() == IntentionState::kInterrupted)
      return;
    const double velocity = std::abs(self.robot().velocity);
    if (begins(self)) {
      first_ = velocity;
      begun_ = self.now();
    }
    self.intend_behavior("Stop", "Stop", kAvoid, {});
    self.say("stopping");
    if (first_ > 0.0)
      self.progress(1.0 - velocity / first_);
    const Ticks passed = self.now() - begun_;
    const Surroundings& around = self.world().around;
    const bool over = static_cast<double>(passed) * kTick >= kPatience;
    if (!around.stop_confirmed)
      return over ? self.fail(v1::CODE_BLOCKED,
                              "the bridge has not confirmed the stop: the "
                              "emergency stop is saphira estop")
                  : self.say("asks the bridge to stop the robot");
    if (passed < kOnTheWay)
      return;
    if (!around.other_driver.empty())
      self.succeed("stopped; " + around.other_driver + " has begun to drive since");
    else if (at_rest(self.robot()))
      self.succeed("the robot is at rest");
    else if (over)
      self.fail(v1::CODE_BLOCKED,
                format("still moving after %.0f s, at %.2f m/s", kPatience, self.robot().velocity));
  }

  void archive(Archive& a) override { a("first", first_)("begun", begun_); }

 private:
  double first_ = 0.0;
  Ticks begun_ = 0;
};

Parameter patience() {
  return quantity("patience", "s", 1.0, 3600.0, kPatience);
}

Parameter place(std::string name, bool required) {
  Parameter parameter;
  parameter.name = std::move(name);
  parameter.kind = ArgumentKind::point;
  parameter.required = required;
  return parameter;
}

template <class T>
std::unique_ptr<Activity> make(const Arguments& arguments) {
  return std::make_unique<T>(arguments);
}

}  // namespace

std::string format_point(const Argument& point) {
  return format("(%.2f, %.2f)", point.point.x, point.point.y) +
         (point.frame == Frame::map ? " on the map" : "");
}

Registry built_in() {
  Registry registry;

  Schema go_to;
  go_to.name = "go_to";
  go_to.summary = "drives to a position, around obstacles";
  Parameter facing =
      quantity("facing", "rad in the frame of the position", -2.0 * kPi, 2.0 * kPi, 0.0);
  facing.usual.reset();
  go_to.parameters = {place("position", true), quantity("speed", "m/s", 0.02, 2.0, 0.3),
                      quantity("radius", "m", 0.0, 10.0, 0.0), facing, patience()};
  go_to.make = make<GoTo>;
  registry.add(std::move(go_to));

  Schema drive;
  drive.name = "drive";
  drive.summary = "drives on at a speed, for a distance or until the deadline, around obstacles";
  // Backwards, where few robots have sonars, at a walking pace.
  Parameter speed = quantity("speed", "m/s", -0.2, 2.0, 0.0);
  speed.usual.reset();
  speed.required = true;
  drive.parameters = {speed, quantity("distance", "m", 0.0, 100.0, 0.0), patience()};
  drive.make = make<Drive>;
  registry.add(std::move(drive));

  registry.add(follow_trail());

  Schema turn_to;
  turn_to.name = "turn_to";
  turn_to.summary = "turns on the spot to a heading in odom, or towards a position";
  Parameter heading = quantity("heading", "rad in odom", -2.0 * kPi, 2.0 * kPi, 0.0);
  heading.usual.reset();
  heading.in_odom = true;
  turn_to.parameters = {heading, place("position", false), quantity("angle", "rad", 0.0, kPi, 0.0),
                        // Manual Table 7-11: 0.5 is slow, 2.0 is fast.
                        quantity("turn_speed", "", 0.1, 5.0, 1.0), patience()};
  turn_to.check = [](const Arguments& arguments) -> std::string {
    const bool has_heading = find(arguments, "heading") != nullptr;
    const bool has_position = find(arguments, "position") != nullptr;
    if (has_heading == has_position)
      return std::string(
                 "turn_to: expected either \"heading\" (a number) or \"position\" (a "
                 "point), got ") +
             (has_heading ? "both" : "neither");
    return {};
  };
  turn_to.make = make<TurnTo>;
  registry.add(std::move(turn_to));

  Schema stop;
  stop.name = "stop";
  stop.summary = "halts the robot, and ends every earlier goal that drives";
  stop.replaces = true;
  stop.make = [](const Arguments&) -> std::unique_ptr<Activity> {
    return std::make_unique<Halt>();
  };
  registry.add(std::move(stop));
  registry.add(explore_unknown());

  return registry;
}

}  // namespace saphira::intentions

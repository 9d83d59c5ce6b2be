#include <algorithm>
#include <cmath>
#include <optional>

#include "predefined.hpp"
#include "saphira/lps/point.hpp"

namespace saphira::behaviors {
namespace {

/// [rad] Further than this off its course the robot slows down, and at the second it turns on the
/// spot.
constexpr double kOnCourse = radians(15.0);
constexpr double kOffCourse = radians(60.0);
constexpr double kMostTurn = radians(40.0);
/// [m] The robot aims at the middle of its lane so far ahead.
constexpr double kAhead = 0.6;
/// [1/s], [m/s] as GoToPos approaches its goal.
constexpr double kApproach = 1.0;
constexpr double kCreep = 0.05;
/// [m] A goal so far behind makes the robot turn round: less is overshoot.
constexpr double kBehind = 0.3;
/// [rad] Off its course by this, the robot says to which side it would rather turn.
constexpr double kMisaligned = radians(15.0);

/// What following a lane comes to in one cycle.
struct Course {
  double turn = 0.0;   ///< [rad] to the left
  double speed = 0.0;  ///< [m/s] when on course
  Fuzzy at_goal = 0.0;
  double to_go = 1e9;  ///< [m] along the lane
};

Evaluation follow(const Course& course, const Context& context) {
  if (course.at_goal < 1.0) {
    context.shared.goal_bearing = course.turn;
    context.shared.goal_distance = std::max(course.to_go, 0.0);
    if (std::abs(course.turn) > kMisaligned)
      context.shared.preferred_turn = course.turn > 0.0 ? Side::left : Side::right;
  }
  const Fuzzy off_course = straight_up(std::abs(course.turn), kOnCourse, kOffCourse);
  const double turn = std::min(std::abs(course.turn), kMostTurn);
  Evaluation evaluation;
  evaluation.rules = {
      {"too right", course.turn > 0.0 ? 1.0 : 0.0, Action::turn_left, turn},
      {"too left", course.turn > 0.0 ? 0.0 : 1.0, Action::turn_right, turn},
      {"on course", f_not(off_course), Action::speed, course.speed},
      {"off course", off_course, Action::speed, 0.0},
  };
  evaluation.activity.turn = f_not(course.at_goal);
  evaluation.activity.speed = f_not(course.at_goal);
  evaluation.activity.goal = course.at_goal;
  return evaluation;
}

/// The lane's edges, and how the robot takes it.
struct LaneLimits {
  double left = 0.25;   ///< [m]
  double right = 0.25;  ///< [m]
  double speed_off_lane = 0.15;
  double speed_in_lane = 0.3;
  double turn_ratio = 0.5;
};

class LaneFollower {
 public:
  Evaluation update(const Pose& lane_in_odom, const std::optional<Pose>& goal_in_odom,
                    const LaneLimits& limits, const Context& context) {
    Pose lane = relative(context.robot.pose_in_odom, lane_in_odom);
    std::optional<Pose> goal;
    if (goal_in_odom) {
      goal = relative(context.robot.pose_in_odom, *goal_in_odom);
      const double ahead = lps::xo(lane, *goal) - lps::xo(lane);
      if (!direction_)
        direction_ = ahead >= 0.0 ? 1 : -1;
      else if (*direction_ * ahead < -kBehind)
        direction_ = -*direction_;
      if (*direction_ < 0)
        lane.th = norm2_angle(lane.th + kPi);
    }
    const double off = lps::yo(lane);  // of the robot, to the left of the lane's middle
    const Fuzzy out = straight_up(off, limits.left, 1.5 * limits.left + 0.05) +
                      straight_up(-off, limits.right, 1.5 * limits.right + 0.05);
    const double to_middle = f_or(limits.turn_ratio, out) * std::atan2(-off, kAhead);
    Course course;
    course.turn = norm2_angle(lane.th + to_middle);
    if (goal)
      course.to_go = lps::xo(lane, *goal) - lps::xo(lane);
    course.at_goal = goal ? down_straight(course.to_go, 0.1, 0.2) : 0.0;
    course.speed = limits.speed_in_lane + out * (limits.speed_off_lane - limits.speed_in_lane);
    course.speed = std::min(course.speed, kCreep + kApproach * std::max(0.0, course.to_go - 0.1));
    Evaluation evaluation = follow(course, context);
    if (goal) {
      if (!whole_way_ || !(goal_ == *goal_in_odom)) {
        goal_ = *goal_in_odom;
        whole_way_ = std::max(course.to_go, 0.01);
      }
      evaluation.activity.progress = std::clamp(1.0 - course.to_go / *whole_way_, 0.0, 1.0);
    }
    return evaluation;
  }

 private:
  std::optional<int> direction_;  ///< 1: along the lane; -1: against it
  Pose goal_;
  std::optional<double> whole_way_;  ///< [m]
};

class Follow : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    return follower_.update(*parameters.point("lane"), parameters.point("goal"),
                            {.left = parameters.number("left"),
                             .right = parameters.number("right"),
                             .speed_off_lane = parameters.number("speed_off_lane"),
                             .speed_in_lane = parameters.number("speed"),
                             .turn_ratio = parameters.number("turn_ratio")},
                            context);
  }

 private:
  LaneFollower follower_;
};

class FollowCorridor : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    // Set in from the walls: the hull, and as much again as KeepOff wants beside it.
    const double edge =
        std::max(0.1, parameters.number("width") / 2.0 - context.model.radius - 0.2);
    const double speed = parameters.number("speed");
    return follower_.update(*parameters.point("corridor"), parameters.point("goal"),
                            {.left = edge,
                             .right = edge,
                             .speed_off_lane = 0.7 * speed,
                             .speed_in_lane = speed,
                             .turn_ratio = 0.5},
                            context);
  }

 private:
  LaneFollower follower_;
};

/// [m] before the door, where the robot gets onto its line first.
constexpr double kBeforeDoor = 0.6;

class FollowDoor : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    Pose lane = relative(context.robot.pose_in_odom, *parameters.point("door"));
    if (parameters.text("direction") == "in")
      lane.th = norm2_angle(lane.th + kPi);
    const double along = lps::xo(lane);  // of the robot; 0 in the doorway
    const double off = lps::yo(lane);
    const double room =
        std::max(0.05, parameters.number("width") / 2.0 - context.model.radius - 0.05);
    // Who is not on the line gets onto it before the door, and does not cut the corner.
    const Fuzzy beside = along < -0.05 ? straight_up(std::abs(off), 0.5 * room, 2.0 * room) : 0.0;
    const double aim = beside * -kBeforeDoor + (1.0 - beside) * (along + kAhead);
    Course course;
    course.turn = norm2_angle(lane.th + std::atan2(-off, aim - along));
    const double depth = parameters.number("depth");
    course.to_go = depth - along;
    course.at_goal = straight_up(along, depth - 0.1, depth);
    course.speed = parameters.number("speed") * (1.0 - 0.3 * beside);
    Evaluation evaluation = follow(course, context);
    if (!from_)
      from_ = std::min(along, depth - 0.01);
    evaluation.activity.progress = std::clamp((along - *from_) / (depth - *from_), 0.0, 1.0);
    return evaluation;
  }

 private:
  std::optional<double> from_;  ///< [m] where it began
};

class AttendAtPos : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    const Pose goal = relative(context.robot.pose_in_odom, *parameters.point("goal"));
    const double radius = parameters.number("radius");
    const double distance = lps::distance(goal);
    const double phi = lps::phi(goal);
    const Fuzzy near = down_straight(distance, 0.8 * radius, radius);
    if (!whole_way_)
      whole_way_ = distance;
    if (near < 1.0) {
      context.shared.goal_bearing = phi;
      context.shared.goal_distance = std::max(0.0, distance - 0.8 * radius);
    }
    const Fuzzy off_course = straight_up(std::abs(phi), kOnCourse, kOffCourse);
    const double turn = std::min(std::abs(phi), kMostTurn);
    const double speed = std::min(parameters.number("speed"),
                                  kCreep + kApproach * std::max(0.0, distance - 0.8 * radius));
    Evaluation evaluation;
    evaluation.rules = {
        {"too right", phi > 0.0 ? 1.0 : 0.0, Action::turn_left, turn},
        {"too left", phi > 0.0 ? 0.0 : 1.0, Action::turn_right, turn},
        {"on course", f_and(f_not(off_course), f_not(near)), Action::speed, speed},
        {"there", f_or(off_course, near), Action::speed, 0.0},
    };
    evaluation.activity = {
        .turn = 1.0,
        .speed = 1.0,
        .goal = f_and(down_straight(distance, radius, 1.2 * radius),
                      down_straight(std::abs(phi), 0.1, 0.2)),
        .progress = *whole_way_ > radius
                        ? std::clamp((*whole_way_ - distance) / (*whole_way_ - radius), 0.0, 1.0)
                        : 1.0};
    return evaluation;
  }

 private:
  std::optional<double> whole_way_;  ///< [m]
};

ParameterSpec optional_point(std::string name, std::string meaning) {
  ParameterSpec spec = point_parameter(std::move(name), std::move(meaning));
  spec.required = false;
  return spec;
}

}  // namespace

Schema follow() {
  return {
      "Follow",
      "follows a lane",
      {point_parameter("lane", "a point on the lane's middle, directed along it"),
       optional_point("goal", "how far; without one, on and on along the lane's direction"),
       number_parameter("right", "m, the lane's edge to the right of the line", 0.0, 5.0, 0.25),
       number_parameter("left", "m, the lane's edge to the left of the line", 0.0, 5.0, 0.25),
       number_parameter("speed_off_lane", "m/s, outside the lane", 0.0, 2.0, 0.15),
       number_parameter("speed", "m/s, in the lane", 0.0, 2.0, 0.3),
       number_parameter("turn_ratio", "0: being aligned matters, 1: being in the middle matters",
                        0.0, 1.0, 0.5)},
      [] { return std::make_unique<Follow>(); }};
}

Schema follow_corridor() {
  return {"FollowCorridor",
          "follows a corridor, along its middle",
          {point_parameter("corridor", "a point on the corridor's middle, directed along it"),
           number_parameter("width", "m, between the walls", 0.3, 20.0, 2.0),
           optional_point("goal", "how far; without one, on and on along the point's direction"),
           number_parameter("speed", "m/s, in the lane", 0.0, 2.0, 0.3)},
          [] { return std::make_unique<FollowCorridor>(); }};
}

Schema follow_door() {
  return {"FollowDoor",
          "goes through a door",
          {point_parameter("door", "the middle of the doorway, directed out of the room"),
           number_parameter("width", "m, of the doorway", 0.3, 5.0, 0.9),
           choice_parameter("direction", "into the room, or out into the corridor", {"in", "out"}),
           number_parameter("speed", "m/s", 0.0, 2.0, 0.2),
           number_parameter("depth", "m, how far behind the doorway is through", 0.0, 5.0, 0.6)},
          [] { return std::make_unique<FollowDoor>(); }};
}

Schema attend_at_pos() {
  return {"AttendAtPos",
          "drives near a point and faces it",
          {point_parameter("goal", "what to attend to"),
           number_parameter("speed", "m/s", 0.0, 2.0, 0.3),
           number_parameter("radius", "m, how near is near", 0.02, 10.0, 1.0)},
          [] { return std::make_unique<AttendAtPos>(); }};
}

}  // namespace saphira::behaviors

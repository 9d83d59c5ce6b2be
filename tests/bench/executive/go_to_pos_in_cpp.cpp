#include <algorithm>
#include <optional>

#include "behaviors_in_cpp.hpp"
#include "saphira/lps/point.hpp"

namespace saphira::bench {

using namespace behaviors;

namespace {

/// [rad] Beyond the first deviation from its course the robot slows down, and beyond the second it
/// turns on the spot. It turns several times as fast as it could orbit the goal.
constexpr double kOnCourse = radians(15.0);
constexpr double kOffCourse = radians(60.0);
constexpr double kMostTurn = radians(40.0);
/// [1/s] The robot arrives with at most this times the remaining distance, and not slower than
/// kCreep [m/s].
constexpr double kApproach = 1.0;
constexpr double kCreep = 0.05;

class GoToPos : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context& context) override {
    const Pose goal_in_odom = *parameters.point("goal");
    const Pose goal = relative(context.robot.pose_in_odom, goal_in_odom);
    const double radius = parameters.number("radius");
    const double distance = lps::distance(goal);
    const double phi = lps::phi(goal);
    if (!whole_way_ || !(goal_in_odom.position() == goal_)) {
      whole_way_ = distance;
      goal_ = goal_in_odom.position();
    }
    // Over the middle half of the success radius: at its rim the behavior is at full strength, so
    // that the robot does arrive within it.
    const Fuzzy at_goal = down_straight(distance, 0.5 * radius, radius);
    const Fuzzy off_course = straight_up(std::abs(phi), kOnCourse, kOffCourse);
    const double speed = std::min(parameters.number("speed"),
                                  kCreep + kApproach * std::max(0.0, distance - 0.5 * radius));
    if (at_goal < 1.0) {
      context.shared.goal_bearing = phi;
      context.shared.goal_distance = distance;
    }
    Evaluation evaluation;
    const double turn = std::min(std::abs(phi), kMostTurn);
    evaluation.rules = {
        {"too right", phi > 0.0 ? 1.0 : 0.0, Action::turn_left, turn},
        {"too left", phi > 0.0 ? 0.0 : 1.0, Action::turn_right, turn},
        {"on course", f_not(off_course), Action::speed, speed},
        {"off course", off_course, Action::speed, 0.0},
    };
    evaluation.activity = {
        .turn = f_not(at_goal),
        .speed = f_not(at_goal),
        .goal = down_straight(distance, radius, 2.0 * radius),
        .progress = *whole_way_ > 0.0 ? std::clamp(1.0 - distance / *whole_way_, 0.0, 1.0) : 1.0};
    return evaluation;
  }

 private:
  Vec2 goal_{0.0, 0.0};
  std::optional<double> whole_way_;  ///< [m]
};

}  // namespace

Schema go_to_pos_in_cpp() {
  return {"GoToPos",
          "drives straight to a point",
          {point_parameter("goal", "where to"), number_parameter("speed", "m/s", 0.0, 2.0, 0.3),
           number_parameter("radius", "m, how near is there", 0.02, 10.0, 0.15)},
          [] { return std::make_unique<GoToPos>(); }};
}

}  // namespace saphira::bench

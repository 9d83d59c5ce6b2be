#include "localization/patrol.hpp"

#include <cmath>
#include <utility>

namespace saphira::test {
Localizer::Localizer(const DriveOptions& drive, maps::Map map, std::optional<Pose> pose_in_map)
    : drive_(drive),
      start_(drive_.seen().true_pose_in_world),
      last_in_odom_(drive_.seen().pose_in_odom),
      bent_in_odom_(last_in_odom_),
      interpretation_(with_sonars<interpretation::Settings>(drive_)),
      registration_(with_sonars<registration::Settings>(drive_), std::move(map), pose_in_map) {}

const registration::Output& Localizer::advance() {
  const Seen& seen = drive_.advance();
  Pose in_odom = seen.pose_in_odom;
  if (bent_ != 0.0) {
    Pose moved = relative(last_in_odom_, seen.pose_in_odom);
    moved.th += bent_ * moved.x;
    bent_in_odom_ = compose(bent_in_odom_, moved);
    in_odom = bent_in_odom_;
  }
  last_in_odom_ = seen.pose_in_odom;
  const double before = clock_ ? clock_() : 0.0;
  percepts_ = interpretation_.step({seen.cycle, in_odom, seen.readings}).percepts;
  const registration::Output& output =
      registration_.step({seen.cycle, 1, in_odom, percepts_, seen.readings, finds_objects_});
  took_ = clock_ ? clock_() - before : 0.0;
  return output;
}

void Offs::add(const Pose& believed, const Pose& truth) {
  position.push_back((believed.position() - truth.position()).norm());
  heading.push_back(std::abs(norm2_angle(believed.th - truth.th)));
}

std::vector<Vec2> office_tour(bool library) {
  std::vector<Vec2> points{{17.5, 8.0},  {19.0, 7.0},  {24.6, 7.0},  {25.6, 8.5},
                           {25.6, 24.0}, {24.0, 25.0}, {17.5, 25.0}, {12.0, 25.0}};
  if (library)
    points.insert(points.end(), {{8.0, 25.0}, {6.25, 22.0}, {6.25, 10.0}, {6.25, 7.2}});
  else
    points.insert(points.end(), {{16.0, 25.0}, {17.5, 23.5}, {17.5, 9.0}, {16.0, 7.0}, {3.0, 6.8}});
  points.insert(points.end(),
                {{17.0, 7.0}, {35.0, 7.0}, {27.0, 7.0}, {19.0, 7.0}, {17.5, 9.0}, {17.5, 23.0}});
  return points;
}

PatrolResult patrol(Localizer& robot, const std::vector<Vec2>& points, int cycles) {
  PatrolResult result;
  Tour tour(points, true);
  Vec2 last = robot.truth().position();
  for (int i = 0; i < cycles; ++i) {
    tour.act(robot.drive(), i == 0 ? robot.truth() : robot.believed());
    const registration::Output& output = robot.advance();
    result.way += (robot.truth().position() - last).norm();
    last = robot.truth().position();
    result.reckoned.add(robot.reckoned(), robot.truth());
    if (output.state == registration::State::tracking)
      result.registered.add(output.pose_in_map, robot.truth());
    else
      ++result.not_tracking;
    result.took.push_back(robot.took());
  }
  result.reached = tour.reached();
  return result;
}

}  // namespace saphira::test

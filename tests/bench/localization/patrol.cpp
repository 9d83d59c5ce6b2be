#include "localization/patrol.hpp"

#include <cmath>

namespace saphira::test {

void Offs::add(const Pose& believed, const Pose& truth) {
  position.push_back((believed.position() - truth.position()).norm());
  heading.push_back(std::abs(norm2_angle(believed.th - truth.th)));
}

std::vector<Vec2> office_tour() {
  return {{17.5, 8.0},  {19.0, 7.0},  {24.6, 7.0},  {25.6, 8.5},  {25.6, 24.0},
          {24.0, 25.0}, {17.5, 25.0}, {12.0, 25.0}, {16.0, 25.0}, {17.5, 23.5},
          {17.5, 9.0},  {16.0, 7.0},  {3.0, 6.8},   {17.0, 7.0},  {35.0, 7.0},
          {27.0, 7.0},  {19.0, 7.0},  {17.5, 9.0},  {17.5, 23.0}};
}

PatrolResult patrol(Drive& robot, const std::vector<Vec2>& points, int cycles) {
  PatrolResult result;
  Tour tour(points, true);
  Vec2 last = robot.truth().position();
  for (int i = 0; i < cycles; ++i) {
    tour.act(robot, i == 0 ? robot.truth() : robot.believed());
    robot.advance();
    result.way += (robot.truth().position() - last).norm();
    last = robot.truth().position();
    result.reckoned.add(robot.reckoned(), robot.truth());
    if (robot.registered().state == v1::REGISTRATION_TRACKING)
      result.registered.add(robot.believed(), robot.truth());
    else
      ++result.not_tracking;
  }
  result.reached = tour.reached();
  return result;
}

}  // namespace saphira::test

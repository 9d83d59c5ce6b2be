#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"

namespace saphira::test {

class Ways;

/// A drive across a world with standing and walking people.
struct Crossing {
  sim::World world;  ///< with the people in it
  Pose start_in_world;
  std::vector<Vec2> way;  ///< [m] in the world, a point each 0.1 m; the last one is the goal
  double length = 0.0;    ///< [m]
  std::shared_ptr<const Ways> ways;  ///< to the goal, from any place of the robot
};

struct CrossingOptions {
  std::string world;
  std::string robot;
  std::uint64_t seed = 1;
  int standing = 2;
  int walking = 2;
  double most = 12.0;  ///< [m] greatest length of the way
};

/// Plans a crossing: from the world's start, or the nearest place with room for the robot, to the
/// farthest place within `most`. Standing people leave the robot a way; walking people have room to
/// pass the robot. None without a way of 2 m in this world.
std::optional<Crossing> plan_crossing(const CrossingOptions& options,
                                      const protocol::RobotParameters& robot);

struct CrossingResult {
  bool arrived = false;
  double seconds = 0.0;
  double closest = 0.0;  ///< [m] hull to person, the least of the run
  // Contacts with people (sim::Blame).
  int caused = 0;       ///< by the robot
  int walked_into = 0;  ///< the robot stood, or crept
  int unseen = 0;       ///< no sonar could have heard the person in time
  int things = 0;       ///< with walls and objects, caused by the robot
  int other_things = 0;
  Vec2 end_in_world{0.0, 0.0};
};

/// Drives the crossing, with the guard of the bridge. `trace`: prints each contact.
CrossingResult drive_crossing(const Crossing& crossing, const CrossingOptions& options,
                              const sim::SonarModel& sonar, bool trace = false);

}  // namespace saphira::test

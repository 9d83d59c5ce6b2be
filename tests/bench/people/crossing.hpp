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
  bool has_way = true;    ///< past the people who stand
  std::vector<Vec2> way;  ///< [m] in the world, a point each 0.1 m; the last one is the goal
  double length = 0.0;    ///< [m]
  std::shared_ptr<const Ways> ways;  ///< to the goal, from any place of the robot
};

/// The people of a crossing.
enum class Crowd {
  kNobody,
  kUsual,     ///< two who stand on the way or beside it, two who walk along it
  kCorridor,  ///< one who stands in the middle of a corridor
  kDoorway,   ///< one who stands in a doorway of the way
  kInside,    ///< one who stands just behind it
  kBeside,    ///< one who stands before it, at the wall
};
inline constexpr const char* kCrowdNames[] = {"nobody",  "usual",  "corridor",
                                              "doorway", "inside", "beside"};

struct CrossingOptions {
  std::string world;
  std::string robot;
  std::uint64_t seed = 1;
  Crowd crowd = Crowd::kUsual;
  double body = 0.25;  ///< [m] radius of a person
  double most = 12.0;  ///< [m] greatest length of the way
};

/// Plans a crossing: from the world's start, or the nearest place with room for the robot, to the
/// farthest place within `most`. The usual standing people leave the robot a way; walking people
/// have room to pass the robot. None without a way of 2 m in this world, or where it has no such
/// place.
std::optional<Crossing> plan_crossing(const CrossingOptions& options,
                                      const protocol::RobotParameters& robot);

struct CrossingResult {
  bool arrived = false;
  double seconds = 0.0;
  double closest = 0.0;  ///< [m] hull to person, the least of the run
  // Contacts in which the robot moved towards the other one:
  int standing = 0;     ///< with people who stood
  int walking = 0;      ///< with people who walked
  int unheard = 0;      ///< of these two, those that no sonar could have heard in time
  int things = 0;       ///< with walls and objects
  int walked_into = 0;  ///< by people, where it did not
  Vec2 end_in_world{0.0, 0.0};
};

/// Drives the crossing, with the guard of the bridge. `trace`: prints each contact.
CrossingResult drive_crossing(const Crossing& crossing, const CrossingOptions& options,
                              const sim::SonarModel& sonar, bool trace = false);

}  // namespace saphira::test

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::test {

/// A journey through the office floor: from any place in a room to a place by its name.
struct Journey {
  std::string from;
  Pose start_in_world;
  std::string to;
};

/// That number of journeys, drawn by the seed: starts are anywhere in the room with space for the
/// robot and a hand's width more, in any direction.
std::vector<Journey> random_journeys(const maps::Map& map, const sim::World& world, int count,
                                     std::uint64_t seed);

/// The result of a journey.
struct Arrival {
  bool succeeded = false;  ///< by the goal's status
  bool there = false;      ///< by the robot's true pose
  bool at_rest = false;
  bool ended = false;
  int contacts = 0;
  std::uint64_t cycles = 0;
  int passages = 0;  ///< from a corridor through a door
  int stopped = 0;   ///< of them, with a stop on the way
  std::string reason;
  std::string trouble;  ///< of behaviors; empty: none
  std::vector<std::string> talk;
};

/// One journey with one seed for noise and errors, at most `cycles` long. `world`: a name or file.
Arrival travel(const Journey& journey, std::uint64_t seed, int cycles = 6000,
               const std::string& world = "office-floor", bool talk = false);

}  // namespace saphira::test

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/logs/data_set.hpp"
#include "saphira/sim/world.hpp"

/// Drives with an exact truth, on floors, with lasers and wheels unlike those of the available
/// logs.
namespace saphira::bench {

struct Floor {
  std::vector<sim::Segment> walls;
  std::vector<Vec2> route;  ///< of the robot, from point to point [m]
};

/// A ring of corridors with furnished rooms on both sides, all different; the robot goes around and
/// into many of them.
Floor office_floor(std::uint64_t seed);
/// Two corridors between rows of identical rooms.
Floor rows_of_rooms(std::uint64_t seed);
/// A grid of long corridors with niches: loops of 100 to 300 m. `rounds`: length of the drive.
Floor blocks(std::uint64_t seed, int rounds);
/// One loop of 240 m of bare corridors.
Floor bare_loop();
/// A hall of 60 by 40 m with pillars, and a corridor behind it.
Floor hall();

struct LaserKind {
  int beams = 181;
  double step = radians(1.0);
  double reach = 80.0;  ///< [m] also the range without a hit
  double noise = 0.01;  ///< [m] one sigma
  Pose in_robot;        ///< its middle beam looks along x
  double every = 0.0;   ///< [m] of way from scan to scan; 0: at every `period`
  double period = 0.2;  ///< [s]
};

struct Wheels {
  double errors = 1.0;      ///< times those of manual Table 3-1
  double bias = 0.0;        ///< [rad/m]
  double slip_every = 0.0;  ///< [m] of way between heading jumps; 0: none
  double slip = 0.0;        ///< [rad] the largest
};

/// The log of a robot that drives along the route at 0.5 m/s among `people` who walk near it.
logs::DataSet drive_synthetic(const std::string& name, const Floor& floor, const LaserKind& laser,
                              const Wheels& wheels, int people, std::uint64_t seed);

std::vector<std::string> synthetic_names();
logs::DataSet synthetic_data_set(const std::string& name, std::uint64_t seed);

}  // namespace saphira::bench

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"

/// Logs of robots as CARMEN wrote them, and the relations of the SLAM benchmark.
namespace saphira::logs {

/// A message's two stamps [s]: of the sender, and of the logger (since the log began, in some).
struct Stamps {
  double ipc = 0.0;
  double logger = 0.0;
};

/// The message that a scan was in.
enum class Laser { flaser, robot1, raw1, rlaser, robot2, raw2, laser3, laser4, raw3, raw4 };

struct LaserScan {
  Stamps time;
  Pose pose;  ///< of the robot, as the log says it: dead reckoning in raw logs
  Pose laser_in_robot;
  double first_angle = -kPi / 2;
  double step = radians(1.0);
  double no_return = 50.0;  ///< [m] as long as this: nothing was hit
  std::vector<double> ranges;
  std::string host;
  Laser laser = Laser::flaser;
};

struct OdomRecord {
  Stamps time;
  Pose pose;
  std::size_t scans_before = 0;  ///< how many scans stand before it in the file
};

struct CarmenLog {
  std::string file;
  std::vector<LaserScan> scans;  ///< of one laser
  std::vector<OdomRecord> odometry;
  std::vector<OdomRecord> truth;     ///< TRUEPOS, of simulators
  std::vector<std::string> damaged;  ///< lines that could not be read, as FileError says it
  std::vector<std::string> notes;    ///< what a person should know of how it was read
};

/// Reads the lines FLASER, RLASER, LASER3 and 4, ROBOTLASER1 and 2, RAWLASER1 to 4, ODOM, TRUEPOS
/// and the PARAM of lasers; others are passed over. Of several lasers the front one is kept, of
/// several messages the one with the robot's pose. Where the log does not say them, the beams'
/// angles are those of usual lasers with so many, the laser's place is what its poses say, and the
/// range that means no return is the one at which ranges pile up. A damaged line is passed over and
/// told; FileError where no scan is left.
CarmenLog parse_carmen(std::string_view text, const std::string& file);

/// The range [m] from which on ranges are no returns: the shortest of the long ones at which they
/// pile up. Nothing where they do not.
std::optional<double> find_no_return(const std::vector<LaserScan>& scans);

/// Where the pose at `to` was, seen from that at `from`.
struct Relation {
  double from = 0.0;
  double to = 0.0;
  Pose to_in_from;
};

/// Lines `t1 t2 dx dy dz roll pitch yaw`. FileError where it is wrong.
std::vector<Relation> parse_relations(std::string_view text, const std::string& file);

/// The content of a file, unpacked where it is a .gz. Of a .gz that is damaged or ends too early
/// what could be read, and what is wrong in `trouble`. std::runtime_error where nothing could be
/// read.
std::string read_log(const std::string& path, std::string* trouble = nullptr);

}  // namespace saphira::logs

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"

/// Robot logs in CARMEN's format.
namespace saphira::logs {

/// A message's two stamps [s]: of the sender, and of the logger (since the beginning of the log, in
/// some).
struct Stamps {
  double ipc = 0.0;
  double logger = 0.0;
};

/// The message of a scan.
enum class Laser { flaser, robot1, raw1, rlaser, robot2, raw2, laser3, laser4, raw3, raw4 };

struct LaserScan {
  Stamps time;
  Pose pose;  ///< of the robot, from the log: dead reckoning in raw logs
  Pose laser_in_robot;
  double first_angle = -kPi / 2;
  double step = radians(1.0);
  double no_return = 50.0;  ///< [m] this range and longer ones: no return
  std::vector<double> ranges;
  Laser laser = Laser::flaser;
};

struct OdomRecord {
  Stamps time;
  Pose pose;
  std::size_t scans_before = 0;  ///< number of earlier scans in the file
};

struct CarmenLog {
  std::string file;
  std::vector<LaserScan> scans;  ///< of one laser
  std::vector<OdomRecord> odometry;
  std::vector<std::string> damaged;  ///< unreadable lines, with their FileError
  std::vector<std::string> notes;    ///< remarks for people about the reading
};

/// Reads the lines FLASER, RLASER, LASER3 and 4, ROBOTLASER1 and 2, RAWLASER1 to 4, ODOM
/// and the PARAM of lasers; others are skipped. Of several lasers the front one is kept, of several
/// messages the one with the robot's pose. Without them in the log, the beams' angles are those of
/// usual lasers with that number of beams, the laser's place follows from its poses, and the range
/// that means no return is the one at which ranges pile up. A damaged line is skipped and reported;
/// FileError where no scan is left.
CarmenLog parse_carmen(std::string_view text, const std::string& file);

/// The range [m] from which ranges are no returns: the shortest of the long ranges at which they
/// pile up. Nothing if they do not.
std::optional<double> find_no_return(const std::vector<LaserScan>& scans);

/// The content of a file, unpacked if it is a .gz. Of a damaged or truncated .gz the readable part,
/// with the error in `trouble`. std::runtime_error where nothing is readable.
std::string read_log(const std::string& path, std::string* trouble = nullptr);

}  // namespace saphira::logs

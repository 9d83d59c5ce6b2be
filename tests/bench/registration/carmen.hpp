#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"

/// Logs of robots as CARMEN wrote them, and the relations of the SLAM benchmark.
namespace saphira::bench {

/// A message's two stamps [s]: of the sender, and of the logger (since the log began, in some).
struct Stamps {
  double ipc = 0.0;
  double logger = 0.0;
};

struct LaserScan {
  Stamps time;
  Pose pose;  ///< of the robot, as the log says it: dead reckoning in raw logs
  Pose laser_in_robot;
  double first_angle = -kPi / 2;
  double step = radians(1.0);
  double no_return = 50.0;  ///< [m] as long as this: nothing was hit
  std::vector<double> ranges;
  std::string host;
};

struct OdomRecord {
  Stamps time;
  Pose pose;
  std::size_t scans_before = 0;  ///< how many scans stand before it in the file
};

struct CarmenLog {
  std::string file;
  std::vector<LaserScan> scans;
  std::vector<OdomRecord> odometry;
  std::vector<std::string> damaged;  ///< lines that could not be read, as FileError says it
};

/// Lines FLASER, ROBOTLASER1 and ODOM; others are passed over. A damaged line is passed over too
/// and told; FileError where no scan is left.
CarmenLog parse_carmen(std::string_view text, const std::string& file);

/// Where the pose at `to` was, seen from that at `from`.
struct Relation {
  double from = 0.0;
  double to = 0.0;
  Pose to_in_from;
};

/// Lines `t1 t2 dx dy dz roll pitch yaw`. FileError where it is wrong.
std::vector<Relation> parse_relations(std::string_view text, const std::string& file);

/// The content of a file, unpacked where it is a .gz. std::runtime_error where it cannot be read.
std::string read_log(const std::string& path);

}  // namespace saphira::bench

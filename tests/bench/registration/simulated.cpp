#include "simulated.hpp"

#include <cmath>

#include "drive/drive.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/random.hpp"

namespace saphira::bench {

using namespace logs;

namespace {

constexpr double kLaserReach = 20.0;  // [m]

std::vector<Vec2> round_of(const std::string& world) {
  if (world == "loop")
    return {{2.0, 2.0}, {24.0, 2.0}, {24.0, 16.0}, {2.0, 16.0}};
  return {{17.5, 24.6}, {25.0, 25.0}, {25.6, 7.0}, {34.0, 7.0}, {10.0, 7.0}, {17.5, 7.2}};
}

}  // namespace

DataSet simulate_data_set(const std::string& world, double errors, std::uint64_t seed, int cycles) {
  test::DriveOptions options;
  options.world = world;
  options.errors = errors;
  options.seed = seed;
  test::Drive drive(options);
  test::Tour tour(round_of(world), true);
  Random random(seed, 11);
  DataSet set;
  set.name = "simulated " + world;
  set.map = maps::load_map(find_file(config_folder() + "/maps", world, ".map"));
  set.sonars.emplace();
  set.sonars->ring.mounts = drive.mounts();
  std::vector<StampedPose> odometry;
  std::vector<StampedPose> truth;
  Beams beams;
  beams.step = radians(1.0);
  for (int cycle = 1; cycle <= cycles; ++cycle) {
    const test::Seen& seen = drive.advance();
    const double time = 0.1 * cycle;
    tour.act(drive, seen.true_pose_in_world);
    odometry.push_back({time, seen.pose_in_odom});
    truth.push_back({time, seen.true_pose_in_world});
    set.sonars->times.push_back(time);
    set.sonars->poses_in_odom.push_back(seen.pose_in_odom);
    set.sonars->readings.push_back(seen.readings);
    if (cycle % 3 != 0)
      continue;
    std::vector<double> ranges;
    for (int i = 0; i <= 180; ++i) {
      const double at = seen.true_pose_in_world.th + beams.first_angle + i * beams.step;
      const auto hit = sim::cast_ray(drive.world().segments, seen.true_pose_in_world.position(),
                                     {std::cos(at), std::sin(at)}, kLaserReach);
      ranges.push_back(hit ? hit->range + random.normal(0.0, 0.01) : 80.0);
    }
    set.times.push_back(time);
    set.poses_in_odom.push_back(seen.pose_in_odom);
    set.scans.push_back(make_scan(ranges, beams));
  }
  set.odometry = Trajectory(std::move(odometry));
  set.reference.emplace(std::move(truth));
  return set;
}

}  // namespace saphira::bench

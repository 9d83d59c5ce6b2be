#include "saphira/logs/virtual_sonar.hpp"

#include <cmath>

#include "saphira/base/places.hpp"
#include "saphira/protocol/parameters.hpp"

namespace saphira::logs {

std::vector<lps::SonarMount> pioneer_sonars() {
  const auto robot =
      protocol::load_parameters(find_file(config_folder() + "/robots", "pioneer", ".p"));
  std::vector<lps::SonarMount> mounts;
  for (const protocol::SonarUnit& unit : robot.sonars)
    mounts.push_back({unit.number, unit.pose_in_robot});
  return mounts;
}

std::vector<lps::SonarMount> front_of_b21() {
  constexpr double kRadius = 0.25;  // [m]
  std::vector<lps::SonarMount> mounts;
  for (int i = 0; i < 13; ++i) {
    const double bearing = kPi / 2 - radians(15.0) * i;
    mounts.push_back({i, {kRadius * std::cos(bearing), kRadius * std::sin(bearing), bearing}});
  }
  return mounts;
}

std::vector<lps::SonarReading> hear(const Scan& scan, const SonarRing& ring) {
  std::vector<lps::SonarReading> out;
  for (const lps::SonarMount& mount : ring.mounts) {
    lps::SonarReading reading{mount.sonar, ring.max_range, false};
    const ToFrame to_sonar(mount.in_robot);
    const double axis = mount.in_robot.th;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Vec2 at = to_sonar(scan.points[i]);
      const double range = at.norm();
      if (range >= reading.range || std::abs(std::atan2(at.y(), at.x())) > ring.half_cone)
        continue;
      const Vec2& normal = scan.normals[i];
      if (!normal.isZero()) {
        const Vec2 back(-(std::cos(axis) * at.x() - std::sin(axis) * at.y()) / range,
                        -(std::sin(axis) * at.x() + std::cos(axis) * at.y()) / range);
        if (std::abs(normal.dot(back)) < std::cos(ring.incidence))
          continue;
      }
      reading.range = range;
      reading.echo = true;
    }
    out.push_back(reading);
  }
  return out;
}

}  // namespace saphira::logs

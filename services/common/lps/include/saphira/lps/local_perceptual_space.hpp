#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/obstacle_memory.hpp"
#include "saphira/lps/occupancy.hpp"
#include "saphira/lps/sonar_buffer.hpp"

namespace saphira::lps {

struct SonarReading {
  int sonar = 0;
  double range = 0.0;  ///< [m] along the axis; meaningless without an echo
  bool echo = false;
};

struct SonarMount {
  int sonar = 0;
  Pose in_robot;

  bool operator==(const SonarMount&) const = default;
};

/// The LPS's view of a robot; from its description.
struct LpsSettings {
  std::vector<SonarMount> sonars;
  std::size_t front_buffer = 30;  ///< readings
  std::size_t side_buffer = 20;   ///< readings, each side
  double front_max_range = 2.5;   ///< [m] sfFrontMaxRange
  MemorySettings memory;
};

/// The buffer that a sonar feeds (manual 6.6.1), by its direction: within 60 degrees of ahead, the
/// front one; within 30 degrees of straight left or right, that side's. Sonars that look backwards
/// feed none; the obstacle memory takes them too.
enum class Feeds { none, front, left, right };
Feeds feeds(const Pose& sonar_in_robot);

/// The readings that an occupancy function uses.
enum class Source {
  front,      ///< sfFRONT
  sides,      ///< sfSIDES: both side buffers
  all,        ///< sfALL: the three buffers
  remembered  ///< the obstacle memory
};

/// The Local Perceptual Space (manual 6.6): the geometry around the robot, in its own frame.
/// Everything in it stays registered as the robot moves by dead reckoning.
class LocalPerceptualSpace {
 public:
  explicit LocalPerceptualSpace(LpsSettings settings = {});

  /// One cycle: the robot is at `robot_in_odom`, and these readings came since the last update, in
  /// firing order. They are placed along the way between the two poses: at 100 degrees a second the
  /// robot turns by ten in a cycle, half a sonar's cone.
  void update(const Pose& robot_in_odom, const std::vector<SonarReading>& readings,
              std::uint64_t cycle);
  /// The robot has hit an obstacle, here from its middle: it counts as an echo.
  void touch(const Vec2& at_in_robot);
  /// The LPS as seen from `robot_in_odom`.
  LocalPerceptualSpace seen_from(const Pose& robot_in_odom) const;
  /// Forgets everything but the settings.
  void reset();

  const LpsSettings& settings() const { return settings_; }
  std::uint64_t cycle() const { return cycle_; }

  const SonarBuffer& front() const { return front_; }
  const SonarBuffer& left() const { return left_; }
  const SonarBuffer& right() const { return right_; }
  void set_front_buffer(std::size_t limit);
  void set_side_buffer(std::size_t limit);
  void set_front_max_range(double range) { settings_.front_max_range = range; }

  /// The valid readings of a source, in the robot's frame.
  std::vector<Vec2> points(Source source) const;
  const std::vector<Vec2>& obstacles() const { return memory_.points(); }

  /// sfOccBox and sfOccBoxRet. The manual gives the box functions no source: they look at all
  /// buffers.
  Occupancy box(Axis axis, double cx, double cy, double h, double w,
                Source source = Source::all) const;
  /// sfOccPlane and sfOccPlaneRet.
  Occupancy plane(Direction direction, Source source, double d, double s1, double s2) const;

  template <class Archive>
  void archive(Archive& a) {
    a("settings", settings_);
    if (a.restores())
      reset();
    a("placed", placed_)("robot_in_odom", robot_in_odom_)("cycle", cycle_)("front", front_)(
        "left", left_)("right", right_)("memory", memory_);
  }

 private:
  void take(const SonarReading& reading, const Pose& robot_in_odom);
  /// The remembered obstacles, in the present frame of the robot.
  void register_readings();

  LpsSettings settings_;
  bool placed_ = false;  ///< an odometry pose has come
  Pose robot_in_odom_;
  std::uint64_t cycle_ = 0;
  SonarBuffer front_;
  SonarBuffer left_;
  SonarBuffer right_;
  ObstacleMemory memory_;
};

}  // namespace saphira::lps

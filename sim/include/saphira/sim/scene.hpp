#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "saphira/protocol/parameters.hpp"
#include "saphira/sim/robot.hpp"
#include "saphira/sim/world.hpp"

namespace saphira::sim {

/// Who looks or moves, among the robots of a scene, so that nobody meets himself.
using RobotNumber = std::size_t;
inline constexpr RobotNumber kNobody = std::numeric_limits<RobotNumber>::max();

/// A world and what moves in it. One tick() moves everything by one tick of time, always in the
/// same order, so that a scene is the same to the last bit in every run.
class Scene {
 public:
  /// The world outlives the scene.
  explicit Scene(const World& world) : world_(&world) {}
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Puts a robot into it, which stays at its address. std::invalid_argument where it would touch
  /// something.
  Robot& add_robot(const protocol::RobotParameters& parameters, const Pose& start_in_world,
                   std::uint64_t seed);

  void tick();
  std::uint64_t ticks() const { return ticks_; }  ///< since the beginning

  const World& world() const { return *world_; }
  std::size_t robots() const { return robots_.size(); }
  const Robot& robot(RobotNumber number) const { return *robots_[number]; }
  Robot& robot(RobotNumber number) { return *robots_[number]; }

  /// Adds the movable things within `reach` of `point`, and some that are not, to `things`; not the
  /// robot `but`.
  void add_movable(const Vec2& point, double reach, RobotNumber but, Things& things) const;
  /// Whether there is anything movable but the robot `but`.
  bool has_movable(RobotNumber but) const { return robots_.size() > (but == kNobody ? 0U : 1U); }
  /// No point of anything movable moves faster [m/s].
  double fastest() const { return fastest_; }

  /// From `point` to the nearest thing [m], whatever it is; not the robot `but`.
  double distance(const Vec2& point, RobotNumber but = kNobody) const;

 private:
  friend class Robot;
  void moved(RobotNumber number);

  const World* world_;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<Disc> hulls_;  // of the robots, by number
  double fastest_ = 0.0;
  std::uint64_t ticks_ = 0;
};

}  // namespace saphira::sim

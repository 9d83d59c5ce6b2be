#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/vision/sight.hpp"

namespace saphira::vision {

struct TrackerSettings {
  double acceleration = 1.0;       ///< [m/s2] one sigma: a person's changes of velocity
  double blob_acceleration = 0.5;  ///< [m/s2] a coloured object may be carried
  /// [m/s2] An object seen in directions alone counts as standing, or it would have no place.
  double direction_acceleration = 0.01;
  double fastest = 2.0;  ///< [m/s]
  double gate = 9.2;     ///< squared distance in sigmas up to which a sight may be the same object
  int confirm = 3;       ///< sights that make a published track,
  double sure = 0.45;    ///< with this confidence
  double forget_in_view = 2.0;       ///< [s] without a sight in view
  double forget_out_of_view = 15.0;  ///< [s] without a sight out of view
  double coast = 1.5;  ///< [s] of constant velocity out of sight, before it slows down
  /// [m] From a person's middle to the robot's: nobody walks through the robot.
  double body = 0.45;
  int hold = 4;                     ///< sights that make a pointing arm
  double same_arm = radians(40.0);  ///< [rad] between the directions of one arm
};

/// Assigns sights to tracks, and estimates the places of tracks between and after sights (paper
/// 3.2.3): a constant velocity for each, with random changes. Everything is in odom.
class Tracker {
 public:
  explicit Tracker(const TrackerSettings& settings = {}) : settings_(settings) {}

  /// Sightings of `cycle` from that pose; of one kind alone, so that one camera's picture does not
  /// count against the other's objects. `in_view`: true where an object at a place in the robot's
  /// frame would have been seen. Cycles never go back.
  void see(lps::SeenThing::Kind kind, std::uint64_t cycle, const Pose& robot_in_odom,
           const std::vector<Sight>& sights, const std::function<bool(const Vec2&)>& in_view);

  /// All tracks, at their estimated places in a cycle, by id.
  std::vector<lps::SeenThing> things(std::uint64_t cycle, const Pose& robot_in_odom) const;

  /// Another origin of odom: all places are void. Ids continue.
  void reset() { tracks_.clear(); }

  SAPHIRA_ARCHIVE(tracks_, next_id_)

 private:
  using State = Eigen::Vector4d;  // x, y [m], velocity [m/s]
  using Covariance = Eigen::Matrix4d;
  struct Track {
    lps::SeenThing thing;
    State state = State::Zero();
    Covariance covariance = Covariance::Identity();
    std::uint64_t at = 0;  // cycle of the state
    bool ranged = true;    // of its newest sight
    bool told = false;
    int sights = 0;
    Vec2 arm{0.0, 0.0};   // direction of an outstretched arm, smooth
    int arms = 0;         // sights of it, less those without it
    double missed = 0.0;  // [s] in view without a sight
  };

  void predict(Track& track, std::uint64_t cycle, const Pose& robot) const;
  void update(Track& track, const Sight& sight, const Pose& robot) const;
  void watch_arm(Track& track, const Sight& sight, std::uint64_t cycle, const Pose& robot) const;
  void begin(const Sight& sight, std::uint64_t cycle, const Pose& robot);

  TrackerSettings settings_;
  std::vector<Track> tracks_;
  std::uint32_t next_id_ = 1;
};

}  // namespace saphira::vision

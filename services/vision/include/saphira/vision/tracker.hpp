#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/vision/sight.hpp"

namespace saphira::vision {

struct TrackerSettings {
  double acceleration = 1.0;       ///< [m/s2] one sigma: how people change their way
  double blob_acceleration = 0.5;  ///< [m/s2] what has a colour may be carried
  /// [m/s2] What is seen in directions alone is taken to stand, or no place would come of them.
  double direction_acceleration = 0.01;
  double fastest = 2.0;  ///< [m/s]
  double gate = 9.2;   ///< squared distance in sigmas from where a sight may still be the same one
  int confirm = 3;     ///< so many sights make one that is told of,
  double sure = 0.45;  ///< if they are so sure
  double forget_in_view = 2.0;       ///< [s] without a sight where it should be seen
  double forget_out_of_view = 15.0;  ///< [s] without a sight where it cannot be
  double coast = 1.5;  ///< [s] out of sight it goes on so long as it went, and slows down then
};

/// Decides which sights are of the same thing and where things are between and after sights (paper
/// 3.2.3): a constant velocity for each, which changes at random. Everything is in odom.
class Tracker {
 public:
  explicit Tracker(const TrackerSettings& settings = {}) : settings_(settings) {}

  /// Sightings of `cycle` from there; of one kind alone, so that a picture of one camera does
  /// not count against what the other sees. `in_view`: whether something at a place of the robot's
  /// frame would have been seen. Cycles never go back.
  void see(lps::SeenThing::Kind kind, std::uint64_t cycle, const Pose& robot_in_odom,
           const std::vector<Sight>& sights, const std::function<bool(const Vec2&)>& in_view);

  /// All tracks, at their estimated places in a cycle, by id.
  std::vector<lps::SeenThing> things(std::uint64_t cycle, const Pose& robot_in_odom) const;

  /// Another origin of odom: places mean nothing any more. Ids go on.
  void reset() { tracks_.clear(); }

 private:
  using State = Eigen::Vector4d;  // x, y [m], velocity [m/s]
  using Covariance = Eigen::Matrix4d;
  struct Track {
    lps::SeenThing thing;
    State state = State::Zero();
    Covariance covariance = Covariance::Identity();
    std::uint64_t at = 0;  // cycle of the state
    bool ranged = true;    // its newest sight
    bool told = false;
    int sights = 0;
    double missed = 0.0;  // [s] where it should have been seen
  };

  void predict(Track& track, std::uint64_t cycle) const;
  void update(Track& track, const Sight& sight, const Pose& robot) const;
  void begin(const Sight& sight, std::uint64_t cycle, const Pose& robot);

  TrackerSettings settings_;
  std::vector<Track> tracks_;
  std::uint32_t next_id_ = 1;
};

}  // namespace saphira::vision

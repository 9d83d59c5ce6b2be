#pragma once

#include <cstdint>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/vision/arms.hpp"
#include "saphira/vision/blobs.hpp"
#include "saphira/vision/people.hpp"
#include "saphira/vision/picture.hpp"
#include "saphira/vision/tracker.hpp"

namespace saphira::vision {

/// From camera results to the people and colours around the robot. Each camera is optional, and
/// takes pictures at its own times; the cycle and the robot's pose of each picture must be known.
class Vision {
 public:
  explicit Vision(const ColorCamera& camera = {}) : camera_(camera) {}

  void see(const StereoPicture& picture, const Pose& robot_in_odom);
  /// The result of a stereo system, if there is one. It shows no arms.
  void see(const Bands& bands, std::uint64_t cycle, const Pose& robot_in_odom);
  void see(const Channels& channels, std::uint64_t cycle, const Pose& robot_in_odom);

  /// All tracks, at their estimated places in that cycle, by id.
  std::vector<lps::SeenThing> things(std::uint64_t cycle, const Pose& robot_in_odom) const {
    return tracker_.things(cycle, robot_in_odom);
  }

  /// Another origin of odom: all places are void. Ids continue.
  void reset() { tracker_.reset(); }

  SAPHIRA_ARCHIVE(tracker_)

 private:
  void see_people(const Bands& bands, const std::vector<Sight>& people, std::uint64_t cycle,
                  const Pose& robot_in_odom);

  ColorCamera camera_;
  Census census_;
  Tracker tracker_;
};

}  // namespace saphira::vision

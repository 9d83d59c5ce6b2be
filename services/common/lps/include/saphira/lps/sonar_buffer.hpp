#pragma once

#include <cstddef>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::lps {

/// One slot of a sonar buffer.
struct SonarEntry {
  Vec2 in_odom{0.0, 0.0};   ///< [m] origin of the echo; meaningless when not valid
  Vec2 in_robot{0.0, 0.0};  ///< [m] the same, registered with the robot
  bool valid = false;
};

/// A circular buffer of sonar readings, the cbuf of manual 6.6.1: a new reading replaces the
/// oldest, and the entries stay registered as the robot moves. They are kept in odom and carried
/// over to the robot's frame, so that no rounding error builds up with every cycle.
class SonarBuffer {
 public:
  explicit SonarBuffer(std::size_t limit = 30) : limit_(limit == 0 ? 1 : limit) {}

  /// sfSetFrontBuffer, sfSetSideBuffer: a size greater than zero becomes the limit (the newest
  /// entries stay); zero clears the buffer and leaves its limit.
  void set_limit(std::size_t limit);
  std::size_t limit() const { return limit_; }

  void add(const Vec2& in_odom, const Pose& robot_in_odom);
  /// The sonar fired without an echo: takes a slot, with the valid flag off.
  void add_miss();
  /// The robot has moved to this pose.
  void move_to(const Pose& robot_in_odom);

  /// In the order of the slots, which is not that of time once the buffer has wrapped.
  const std::vector<SonarEntry>& entries() const { return entries_; }
  /// From the oldest to the newest.
  std::vector<SonarEntry> in_order() const;

  SAPHIRA_ARCHIVE(limit_, next_, entries_)

 private:
  void put(const SonarEntry& entry);

  std::size_t limit_;
  std::size_t next_ = 0;  ///< the slot that is replaced next
  std::vector<SonarEntry> entries_;
};

}  // namespace saphira::lps

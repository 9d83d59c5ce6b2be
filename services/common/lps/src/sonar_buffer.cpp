#include "saphira/lps/sonar_buffer.hpp"

#include <algorithm>

namespace saphira::lps {

void SonarBuffer::set_limit(std::size_t limit) {
  if (limit == 0) {
    entries_.clear();
    next_ = 0;
    return;
  }
  std::vector<SonarEntry> kept = in_order();
  if (kept.size() > limit)
    kept.erase(kept.begin(), kept.end() - static_cast<std::ptrdiff_t>(limit));
  entries_ = std::move(kept);
  limit_ = limit;
  next_ = entries_.size() == limit_ ? 0 : entries_.size();
}

void SonarBuffer::add(const Vec2& in_odom, const Pose& robot_in_odom) {
  put({in_odom, to_frame(robot_in_odom, in_odom), true});
}

void SonarBuffer::add_miss() {
  put({});
}

void SonarBuffer::put(const SonarEntry& entry) {
  if (entries_.size() < limit_)
    entries_.push_back(entry);
  else
    entries_[next_] = entry;
  next_ = (next_ + 1) % limit_;
}

void SonarBuffer::move_to(const Pose& robot_in_odom) {
  const ToFrame to_robot(robot_in_odom);
  for (SonarEntry& entry : entries_)
    if (entry.valid)
      entry.in_robot = to_robot(entry.in_odom);
}

std::vector<SonarEntry> SonarBuffer::in_order() const {
  std::vector<SonarEntry> ordered = entries_;
  if (entries_.size() == limit_)
    std::rotate(ordered.begin(), ordered.begin() + static_cast<std::ptrdiff_t>(next_),
                ordered.end());
  return ordered;
}

}  // namespace saphira::lps

#include "saphira/console/picture_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace saphira::console {

namespace {

constexpr double kFull = 0.2;       // [s] beyond the quickest answer
constexpr double kPeriod = 0.1;     // [s] between two pictures of a camera
constexpr double kMost = 8.0;       // pictures on their way at a time
constexpr double kMore = 0.5;       // of them with each quick answer
constexpr double kForgets = 1.002;  // the quickest delay grows with each answer: links change
constexpr double kMean = 0.2;       // share of the newest gap in the mean
constexpr double kSlow = 0.15;      // [s] between answers
constexpr double kQuick = 0.115;    // [s] likewise
constexpr std::array<int, 4> kQualities{0, 40, 25, 15};
constexpr int kWorse = -4;   // answers in turn until the quality falls
constexpr int kBetter = 80;  // until it rises

}  // namespace

bool PictureFlow::is_late(double delay) const {
  return delay > quickest_ + kFull;
}

bool PictureFlow::takes(Lane lane, std::uint64_t number, double now) const {
  if (number == last_)
    return false;
  std::size_t all = 0;
  std::size_t least = SIZE_MAX;  // of a lane
  std::size_t late = 0;
  for (const auto& [each, under_way] : lanes_) {
    all += under_way.size();
    if (!under_way.empty() && is_late(now - under_way.front().sent)) {
      if (each == lane || is_full() || 2 * ++late > lanes_.size())
        return false;
      continue;
    }
    least = std::min(least, under_way.size());
  }
  return lanes_.at(lane).size() <= least && (all == 0 || static_cast<double>(all + 1) <= room_);
}

void PictureFlow::sent(Lane lane, std::uint64_t number, double now) {
  last_ = number;
  lanes_.at(lane).push_back({number, now});
}

void PictureFlow::acknowledged(Lane lane, std::uint64_t number, double now) {
  std::deque<UnderWay>& under_way = lanes_.at(lane);
  const auto found = std::ranges::find(under_way, number, &UnderWay::number);
  if (found == under_way.end())
    return;
  const double delay = now - found->sent;
  under_way.erase(under_way.begin(), found + 1);
  quickest_ = std::min(kForgets * quickest_, delay);
  if (answered_ >= 0.0)
    gap_ += kMean * (now - answered_ - gap_);
  answered_ = now;
  late_ = is_late(delay) ? late_ + 1 : 0;
  const bool full = is_full();
  room_ = std::clamp(room_ + (full ? -1.0 : kMore), 1.0,
                     std::min(kMost, 1.0 + std::ceil((quickest_ + kFull) / kPeriod)));
  even_ = full || gap_ > kSlow ? std::min(0, even_) - 1
          : gap_ < kQuick      ? std::max(0, even_) + 1
                               : 0;
  if (even_ <= kWorse && step_ + 1 < kQualities.size()) {
    ++step_;
    even_ = 0;
  } else if (even_ >= kBetter && step_ > 0) {
    --step_;
    even_ = 0;
  }
}

int PictureFlow::quality() const {
  return kQualities[step_];
}

}  // namespace saphira::console

#include "saphira/console/picture_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace saphira::console {

namespace {

constexpr double kFull = 0.2;    // [s] beyond the quickest answer
constexpr double kPeriod = 0.1;  // [s] between two pictures of a camera
constexpr double kMostUnderWay = 8;
constexpr double kForgets = 1.002;  // the quickest delay grows with each answer: links change
constexpr std::array<int, 4> kQualities{0, 40, 25, 15};
constexpr int kWorse = -2;   // full answers in turn until the quality falls
constexpr int kBetter = 50;  // other answers in turn until it rises

}  // namespace

bool PictureFlow::is_full(double delay) const {
  return delay > quickest_ + kFull;
}

bool PictureFlow::takes(std::uint64_t number, double now) const {
  if (number == last_)
    return false;
  const double delay =
      under_way_.empty() ? delay_ : std::max(delay_, now - under_way_.front().sent);
  const double room = is_full(delay) || quickest_ > 1e8
                          ? 1.0
                          : std::min(kMostUnderWay, 1.0 + std::ceil(quickest_ / kPeriod));
  return static_cast<double>(under_way_.size()) < room;
}

void PictureFlow::sent(std::uint64_t number, double now) {
  last_ = number;
  under_way_.push_back({number, now});
}

void PictureFlow::acknowledged(std::uint64_t number, double now) {
  const auto found = std::find_if(under_way_.begin(), under_way_.end(),
                                  [&](const UnderWay& each) { return each.number == number; });
  if (found == under_way_.end())
    return;
  delay_ = now - found->sent;
  under_way_.erase(under_way_.begin(), found + 1);
  quickest_ = std::min(kForgets * quickest_, delay_);
  even_ = is_full(delay_) ? std::min(0, even_) - 1 : std::max(0, even_) + 1;
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

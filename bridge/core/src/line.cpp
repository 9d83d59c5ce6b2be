#include "saphira/bridge/line.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/base/numbers.hpp"

namespace saphira::bridge {

namespace {

constexpr std::size_t kEnough = 20;  // packets needed to judge a line
constexpr double kUnheard =
    0.35;                   // [s] without a whole packet: longer than the lease of a driver, 0.3 s
constexpr int kBegins = 5;  // whole packets in motion, after which it is heard
constexpr int kForgiven = 2;      // times
constexpr double kStands = 20.0;  // [s] at the first time not forgiven; then doubled...
constexpr double kMostStands = 300.0;
constexpr double kShown = 2.0;   // [s] of a doubt in the status
constexpr double kPause = 10.0;  // [s] between two doubts in the log

}  // namespace

void Line::add(bool damaged) {
  newest_[next_] = damaged;
  next_ = (next_ + 1) % kWindow;
  count_ = std::min(count_ + 1, kWindow);
}

void Line::damage(std::uint64_t damaged) {
  for (std::uint64_t i = damaged_; i < damaged && i < damaged_ + kWindow; ++i)
    add(true);
  damaged_ = damaged;
}

bool Line::packet(std::uint64_t damaged, double gap, bool moved, double now) {
  damage(damaged);
  add(false);
  return listen(gap, moved, now);
}

bool Line::listen(double gap, bool moved, double now) {
  if (!moved || gap <= kUnheard) {
    heard_moving_ = moved ? heard_moving_ + 1 : 0;
    if (heard_moving_ >= kBegins)
      unheard_ = 0;
    return false;
  }
  if (std::exchange(heard_moving_, 0) >= kBegins || ++unheard_ <= kForgiven)
    return false;
  stands_until_ = now + std::min(kStands * std::pow(2.0, unheard_ - kForgiven - 1), kMostStands);
  return true;
}

std::size_t Line::damaged_in_window() const {
  return static_cast<std::size_t>(std::ranges::count(newest_, true));
}

bool Line::bad() const {
  return count_ >= kEnough && damaged_in_window() * 10 >= count_;
}

std::string Line::damaged_words() const {
  return std::to_string(damaged_in_window()) + " of its last " + std::to_string(count_) +
         " packets were damaged";
}

std::string Line::words() const {
  return "the line to the robot is bad: " + damaged_words() +
         " (is a plug loose, the cable long, the radio weak?)";
}

std::string Line::why_it_stands(double now) const {
  return "the robot is not heard while it moves (" + std::to_string(unheard_) + " times now" +
         (bad() ? ", " + damaged_words() : "") + "): it stands for another " +
         plain(std::ceil(stands_until_ - now)) + " s";
}

void Doubts::add(const protocol::Impossible& impossible, double now) {
  ++count_;
  at_ = now;
  news_ = true;
  newest_ = impossible.what;
}

std::string Doubts::newest(double now) const {
  return count_ > 0 && now - at_ <= kShown ? newest_ : "";
}

std::optional<std::string> Doubts::take_words(double now) {
  if (!news_ || now - told_ < kPause)
    return std::nullopt;
  news_ = false;
  told_ = now;
  return newest_;
}

}  // namespace saphira::bridge

#include "saphira/watch/inquiry.hpp"

namespace saphira::watch {

namespace {

constexpr double kPaced = 1.0;     // [s] by then a robot that moves on has shown its pace
constexpr double kRecalled = 0.7;  // [s] without older samples: the past is complete

}  // namespace

bool Inquiry::poll() {
  mind_.poll();
  const auto known = mind_.known();
  if (known.first != oldest_)
    grown_ = Clock::now();
  oldest_ = known.first;
  const double waited = seconds_since(began_);
  if (asked_ == 0) {
    cycle_ = mind_.newest_cycle();
    if (waited <= kMindPatience && !(mind_.whole(cycle_) && (mind_.knows_goals() || waited > 1.0)))
      return false;
    if (!mind_.knows_pace() && waited < kPaced)
      return false;
    if (!mind_.held() && !misses(mind_.situation()))
      return true;
    // Since when is in the past.
    if (mind_.recall())
      grown_ = Clock::now();
    return waited > 1.0 && seconds_since(grown_) > kRecalled;
  }
  if (asked_ > 0)
    cycle_ = static_cast<std::uint64_t>(asked_);
  else if (cycle_ == 0 && known.second > static_cast<std::uint64_t>(-asked_) && waited > 0.5)
    // Relative to the time of the question, not of the answer.
    cycle_ = known.second - static_cast<std::uint64_t>(-asked_);
  return (cycle_ != 0 && mind_.whole(cycle_) && (mind_.knows_goals() || waited > 1.0)) ||
         (waited > kMindPatience && seconds_since(grown_) > 1.0);
}

std::string Inquiry::missing() const {
  const auto known = mind_.known();
  const bool past = asked_ != 0;
  if (past ? known.second == 0 : !mind_.heard())
    return std::string("nothing is said about ") + (past ? "what has been" : "the robot") + "; " +
           who_is_there(mind_.processes());
  if (!past || mind_.some(cycle_))
    return {};
  return "cycle " + (asked_ > 0 ? std::to_string(asked_) : std::to_string(-asked_) + " ago") +
         " is not known; recalled are " + std::to_string(known.first) + " to " +
         std::to_string(known.second);
}

}  // namespace saphira::watch

#include "saphira/intentions/stops.hpp"

#include <algorithm>
#include <utility>

namespace saphira::intentions {
namespace {

/// The bridge is asked again for a stop that it does not confirm.
constexpr Ticks kAskAgain = 5;
constexpr std::size_t kMostOwn = 16;

}  // namespace

void Stops::ask(std::string requester, Ticks now) {
  requester_ = std::move(requester);
  asked_ = now;
}

void Stops::heed(const v1::StopId& own) {
  heeds_ = own;
  own_.push_back(own);
  if (own_.size() > kMostOwn)
    own_.pop_front();
}

bool Stops::take(const v1::StopId& newest) {
  if (!heeds_) {
    heeds_ = seen_ = newest;
    return false;
  }
  if (newest == v1::StopId{} || newest == seen_)
    return false;
  const auto found = std::find(own_.begin(), own_.end(), newest);
  const bool own = found != own_.end();
  // The bridge comes to a later one of our own by itself.
  const bool overtaken = std::find(found, own_.end(), *heeds_) != own_.end();
  const bool old = !own && newest == heeds_;
  seen_ = newest;
  if (!overtaken)
    heeds_ = newest;
  if (!old)
    requester_.reset();
  return !own && !old;
}

void Stops::give_up(bool confirms) {
  if (!std::exchange(requester_, std::nullopt))
    return;
  if (confirms && seen_ != v1::StopId{})
    heeds_ = seen_;
}

std::optional<std::string> Stops::asks(Ticks now, bool confirms) const {
  const Ticks since = now - asked_;
  return since == 0 || (confirms && since % kAskAgain == 0) ? requester_ : std::nullopt;
}

bool Stops::take_changed() {
  return std::exchange(saved_, heeds_) != heeds_;
}

}  // namespace saphira::intentions

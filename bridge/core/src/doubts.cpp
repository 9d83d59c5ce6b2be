#include "saphira/bridge/doubts.hpp"

namespace saphira::bridge {

namespace {

constexpr double kShown = 2.0;   // [s] in the status
constexpr double kPause = 10.0;  // [s] between two words of the log

}  // namespace

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

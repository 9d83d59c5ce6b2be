#include "epochs.hpp"

#include <algorithm>

namespace saphira::bus::internal {

void Epochs::describe(const Program& program, std::uint64_t epoch) {
  // Programs come and go for months; of those that are gone nothing is kept that matters.
  if (described_.size() >= kMostPrograms && !described_.contains(program))
    std::erase_if(described_, [&](const auto& known) { return known.first != bridge_; });
  described_[program] = epoch;
}

void Epochs::lose(const Program& program) {
  // Its description stays: after a nap it is matched as before, and not told again.
  if (bridge_ == program)
    bridge_.reset();
}

Epochs::Verdict Epochs::judge(const Program& writer, std::uint64_t epoch) {
  const auto described = described_.find(writer);
  if (described == described_.end() || described->second != epoch)
    return left_.contains(epoch) ? Verdict::left : Verdict::wait;
  if (bridge_ && *bridge_ != writer)
    return Verdict::foreign;
  bridge_ = writer;
  if (epoch == epoch_)
    return Verdict::take;
  if (left_.size() >= kMostLeft)
    left_.erase(left_.begin());
  if (epoch_ != 0)
    left_.insert(epoch_);
  left_.erase(epoch);
  epoch_ = epoch;
  return Verdict::adopt;
}

bool Epochs::useful(std::uint64_t epoch) const {
  if (epoch == epoch_)
    return true;
  if (left_.contains(epoch))
    return false;
  // One that nobody has described yet may be our bridge's next.
  return !bridge_ || std::none_of(described_.begin(), described_.end(), [&](const auto& known) {
    return known.second == epoch && known.first != *bridge_;
  });
}

}  // namespace saphira::bus::internal

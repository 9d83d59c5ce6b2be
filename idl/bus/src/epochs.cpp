#include "epochs.hpp"

#include <algorithm>

namespace saphira::bus::internal {

bool Epochs::followed(const Program& program, const Known& known) const {
  return bridge_ && (*bridge_ == program || (instance_ != 0 && known.instance == instance_));
}

void Epochs::describe(const Program& program, std::uint64_t instance, std::uint64_t epoch) {
  // Programs come and go for months; a program that is gone need not be remembered.
  if (described_.size() >= kMostPrograms && !described_.contains(program))
    std::erase_if(described_,
                  [&](const auto& known) { return !followed(known.first, known.second); });
  described_[program] = {instance, epoch};
}

void Epochs::lose(const Program& program) {
  // Its description stays: after a pause the program is matched as before, without a new
  // description.
  const auto lost = described_.find(program);
  if (lost != described_.end())
    lost->second.present = false;
  if (std::none_of(described_.begin(), described_.end(), [&](const auto& known) {
        return known.second.present && followed(known.first, known.second);
      }))
    bridge_.reset();
}

Epochs::Verdict Epochs::judge(const Program& writer, std::uint64_t epoch) {
  const auto described = described_.find(writer);
  if (described == described_.end() || described->second.epoch != epoch)
    return left_.contains(epoch) ? Verdict::left : Verdict::wait;
  if (bridge_ && !followed(writer, described->second))
    return Verdict::foreign;
  bridge_ = writer;
  instance_ = described->second.instance;
  described->second.present = true;
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
  // An epoch without a description may be our bridge's next one.
  return !bridge_ || std::none_of(described_.begin(), described_.end(), [&](const auto& known) {
    return known.second.epoch == epoch && !followed(known.first, known.second);
  });
}

}  // namespace saphira::bus::internal

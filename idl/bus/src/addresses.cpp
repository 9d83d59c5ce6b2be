#include "addresses.hpp"

#include <algorithm>
#include <ranges>
#include <vector>

#include "saphira/base/text.hpp"

namespace saphira::bus::internal {

bool Addresses::due(const Devices& seen, Time now) {
  seen_ = seen;
  Devices usable = seen;
  if (!only_.empty())
    std::erase_if(usable, [&](const auto& one) { return one.first != only_; });
  if (usable != usable_ || !looked_) {
    // At the start of the program no address has to settle.
    changed_ = looked_ ? now : now - kSettled;
    looked_ = true;
    usable_ = std::move(usable);
  }
  // A socket that is bound to one address ends with that address.
  if (!only_.empty() && usable_.empty())
    made_with_.clear();
  const bool has_new =
      !std::includes(made_with_.begin(), made_with_.end(), usable_.begin(), usable_.end());
  return has_new && now - changed_ >= kSettled && now >= not_before_;
}

std::string Addresses::wait() const {
  if (!usable_.empty())
    return {};
  if (only_.empty())
    return "this machine has no network address yet: only its own programs are reached";
  const auto names = std::views::keys(seen_);
  const std::string all = joined(std::vector<std::string>(names.begin(), names.end()));
  return "interface " + only_ + " is no address of this machine" +
         (all.empty() ? ", which has none yet" : ", which has " + all) +
         ": only its own programs are reached";
}

}  // namespace saphira::bus::internal

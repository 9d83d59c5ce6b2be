#include "saphira/intentions/endings.hpp"

#include <utility>

#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

constexpr Ticks kSaveAgain = 10;

/// To the saved length.
std::string shortened(const std::string& reason) {
  return reason.size() <= kLongestReason
             ? reason
             : std::string(first_letters(reason, kLongestReason - 3)) + "...";
}

}  // namespace

void Endings::recall(const Ending& ending) {
  if (remembered_.insert_or_assign(ending.id, ending).second)
    order_.push_back(ending.id);
  while (order_.size() > most_) {
    remembered_.erase(order_.front());
    order_.pop_front();
  }
}

void Endings::add(Ending ending) {
  ending.reason = shortened(ending.reason);
  recall(ending);
  unsaved_.push_back(std::move(ending));
  due_ = true;
}

const Ending* Endings::find(const GoalId& id) const {
  const auto found = remembered_.find(id);
  return found == remembered_.end() ? nullptr : &found->second;
}

std::optional<GoalId> Endings::newest() const {
  return order_.empty() ? std::nullopt : std::optional(order_.back());
}

void Endings::not_saved(const std::vector<Ending>& endings, Ticks now) {
  unsaved_.insert(unsaved_.begin(), endings.begin(), endings.end());
  if (unsaved_.size() > most_)
    unsaved_.erase(unsaved_.begin(), unsaved_.end() - static_cast<std::ptrdiff_t>(most_));
  failed_ = now;
}

bool Endings::due(Ticks now) const {
  return due_ || (failed_ && now - *failed_ >= kSaveAgain);
}

std::vector<Ending> Endings::take() {
  due_ = false;
  failed_.reset();
  return std::exchange(unsaved_, {});
}

}  // namespace saphira::intentions

#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/intentions/work.hpp"

namespace saphira::intentions {

/// The ends of goals: they are remembered, since no goal is done twice, and are to be saved with
/// the work.
class Endings {
 public:
  explicit Endings(std::size_t most = kMostEndings) : most_(most) {}

  /// It is saved already.
  void recall(const Ending& ending);
  /// It is to be saved.
  void add(Ending ending);
  const Ending* find(const GoalId& id) const;
  std::optional<GoalId> newest() const;

  /// The work is another, and is to be saved.
  void change_work() { due_ = true; }
  /// The disk took neither these endings nor the work: a full one is tried again with the next
  /// change, and after a second.
  void not_saved(const std::vector<Ending>& endings, Ticks now);
  /// The work is to be saved now, with the endings of take().
  bool due(Ticks now) const;
  std::vector<Ending> take();

  SAPHIRA_ARCHIVE(remembered_, order_, unsaved_, due_, failed_)

 private:
  std::size_t most_;
  std::map<GoalId, Ending> remembered_;
  std::deque<GoalId> order_;
  std::vector<Ending> unsaved_;
  bool due_ = false;
  std::optional<Ticks> failed_;  ///< the disk did not take the newest
};

}  // namespace saphira::intentions

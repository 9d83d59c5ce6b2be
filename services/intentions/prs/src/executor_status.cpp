#include <utility>

#include "saphira/intentions/executor.hpp"

// The statuses of the goals: their content, and how long they are told.
namespace saphira::intentions {
namespace {

/// The publishing period of the status of an open goal.
constexpr Ticks kStatusPeriod = 10;
/// Cycles for the trend of a level, and the least difference.
constexpr std::size_t kTrend = 20;
constexpr double kTrendStep = 0.02;

/// True where an observer needs to know at once.
bool differs(const GoalStatus& a, const GoalStatus& b) {
  return a.state != b.state || a.code != b.code || a.reason != b.reason || a.step != b.step ||
         a.requester != b.requester || a.functor != b.functor || a.note != b.note ||
         a.waits_for != b.waits_for;
}

}  // namespace

/// The present work of an intention, for people: an activity of the language uses the words of its
/// schema.
std::string Executor::step_of(const IntentionNode& node) const {
  const Schema* const schema = registry_->find(node.schema);
  if (schema == nullptr || schema->program == nullptr)
    return node.step;
  if (!schema->summary.empty())
    return schema->name + ": " + schema->summary;
  // Its step is an awaited condition, or a goal in code, which is not for people.
  return node.step.empty() || node.step.front() == '(' ? schema->name : node.step;
}

/// Updates the goal's satisfaction.
void Executor::measure(Entry& entry) {
  GoalStatus& status = entry.status;
  if (status.state != v1::GOAL_UNDERWAY || entry.node == 0) {
    if (status.state == v1::GOAL_SUCCEEDED && entry.goal.level <= 0.0)
      status.level = 1.0;
    status.trend = v1::TREND_STEADY;
    entry.levels.clear();
    return;
  }
  status.level = forest_.level_of(entry.node);
  entry.levels.push_back(status.level);
  if (entry.levels.size() > kTrend)
    entry.levels.pop_front();
  const double change = status.level - entry.levels.front();
  status.trend = change > kTrendStep    ? v1::TREND_RISING
                 : change < -kTrendStep ? v1::TREND_FALLING
                                        : v1::TREND_STEADY;
}

/// The status with the refusal of the newest change; nothing: it was not refused.
std::optional<GoalStatus> Executor::refused_change(const Entry& entry) {
  if (entry.refusal.empty())
    return std::nullopt;
  GoalStatus status = entry.status;
  status.reason += (status.reason.empty() ? "goes on unchanged, " : "; ");
  status.reason += "the change was refused: " + entry.refusal;
  // Only where the state has no reason of its own: what it waits for has its member.
  if (status.code == v1::CODE_NONE || status.waits_for != GoalId{})
    status.code = entry.refusal_code;
  return status;
}

GoalUpdates Executor::take_updates() {
  GoalUpdates updates;
  for (auto& [id, entry] : entries_) {
    const std::optional<GoalStatus> refused = refused_change(entry);
    const GoalStatus& status = refused ? *refused : entry.status;
    if (entry.open() && entry.requester.is_meeting(awake_))
      continue;
    const bool due = entry.open() && now_ - entry.published_at >= kStatusPeriod;
    if (entry.published && !due && !differs(*entry.published, status))
      continue;
    entry.published = status;
    entry.published_at = now_;
    updates.changed.push_back(status);
  }
  updates.withdrawn = std::exchange(withdrawn_, {});
  const bool grown = forest_.take_changed();
  const bool set =
      std::exchange(set_revision_, beliefs_->set_revision()) != beliefs_->set_revision();
  const bool stopped = stops_.take_changed();
  if (grown || set || stopped || !updates.changed.empty())
    endings_.change_work();
  if (endings_.due(now_)) {
    updates.endings = endings_.take();
    updates.work = work();
  }
  return updates;
}

/// Withdraws goals that ended long ago, and the oldest where there are too many: without a robot no
/// time passes. Published goals only.
void Executor::forget_ended() {
  while (!ended_order_.empty()) {
    const auto oldest = entries_.find(ended_order_.front());
    const std::optional<GoalStatus>& told = oldest->second.published;
    const bool many = ended_order_.size() > options_.max_shown && told && ended(told->state);
    if (!many && in_seconds(now_ - oldest->second.ended) < options_.keep_ended)
      return;
    withdrawn_.push_back(oldest->first);
    entries_.erase(oldest);
    ended_order_.pop_front();
  }
}

}  // namespace saphira::intentions

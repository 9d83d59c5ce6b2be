#include "saphira/ros2/navigate.hpp"

#include <algorithm>
#include <utility>

#include "geometry/shell/convert.hpp"
#include "saphira/ros2/inward.hpp"
#include "saphira/ros2/outward.hpp"

namespace saphira::ros2 {

namespace {

constexpr std::size_t kMost = 32;  // goals that are remembered
// Results of a request to cancel.
constexpr std::int8_t kUnknownGoal = 2;
constexpr std::int8_t kTerminated = 3;

constexpr std::int64_t nanoseconds(const Time& time) {
  return time.sec * std::int64_t{1'000'000'000} + time.nanosec;
}

/// The state of an action's goal, from that of the robot's.
Navigate::State state_of(v1::GoalState state, Navigate::State before) {
  switch (state) {
    case v1::GOAL_WAITING:
      return before;
    case v1::GOAL_UNDERWAY:
    case v1::GOAL_SUSPENDED:
      return before == Navigate::kCanceling ? before : Navigate::kExecuting;
    case v1::GOAL_SUCCEEDED:
      return Navigate::kSucceeded;
    case v1::GOAL_CANCELED:
      return before == Navigate::kCanceling ? Navigate::kCanceled : Navigate::kAborted;
    case v1::GOAL_REFUSED:
    case v1::GOAL_FAILED:
      break;
  }
  return Navigate::kAborted;
}

/// [m] from the robot to a point on the map or in odom [0: not known].
double distance(const viewer::Place& place, const v1::Argument& to) {
  Pose goal = from_bus(to.point);
  if (to.frame == v1::FRAME_ODOM && place.odom_in_map)
    goal = compose(from_bus(*place.odom_in_map), goal);
  else if (to.frame == v1::FRAME_ROBOT || (to.frame == v1::FRAME_MAP && !place.odom_in_map))
    return 0.0;
  return (goal.position() - from_bus(place.pose).position()).norm();
}

Duration duration_of(double seconds) {
  const Time time = time_of(static_cast<std::int64_t>(seconds * 1e9));
  return {time.sec, time.nanosec};
}

}  // namespace

Navigate::Entry* Navigate::find(const Uuid& goal) {
  const auto found = std::ranges::find_if(
      entries_, [&](const Entry& entry) { return entry.info.goal_id == goal; });
  return found == entries_.end() ? nullptr : &*found;
}

Navigate::Sent Navigate::send(const SendRequest& request, std::int64_t time_ns) {
  Sent sent;
  std::optional<v1::Goal> goal = goal_of(request.goal.pose);
  if (!goal || request.goal_id == Uuid{} || find(request.goal_id) != nullptr)
    return sent;
  for (Entry& entry : entries_)
    if (!entry.ended()) {
      entry.state = kAborted;
      entry.status.reason = "replaced by a newer goal";
      entry.status.code = v1::CODE_PREEMPTED;
      sent.replaced.push_back(entry.id);
    }
  while (entries_.size() >= kMost)
    entries_.pop_front();
  sent.response = {true, time_of(time_ns)};
  entries_.push_back(
      {{request.goal_id, sent.response.stamp}, {}, goal->arguments.front(), kAccepted, {}});
  sent.goal = std::move(goal);
  return sent;
}

void Navigate::asked(const v1::GoalId& id) {
  entries_.back().id = id;
}

Navigate::Canceled Navigate::cancel(const CancelRequest& request) {
  const GoalInfo& asked = request.goal_info;
  const bool any = asked.goal_id == Uuid{};
  const std::int64_t until = nanoseconds(asked.stamp);
  Canceled canceled;
  bool known = false;
  for (Entry& entry : entries_) {
    const bool meant = entry.info.goal_id == asked.goal_id || (any && until == 0) ||
                       (until != 0 && nanoseconds(entry.info.stamp) <= until);
    known = known || meant;
    if (!meant || entry.ended())
      continue;
    entry.state = kCanceling;
    canceled.goals.push_back(entry.id);
    canceled.response.goals_canceling.push_back(entry.info);
  }
  if (canceled.goals.empty() && !any)
    canceled.response.return_code = known ? kTerminated : kUnknownGoal;
  return canceled;
}

std::optional<ResultResponse> Navigate::result(const Uuid& goal) const {
  const auto found = std::ranges::find_if(
      entries_, [&](const Entry& entry) { return entry.info.goal_id == goal; });
  if (found == entries_.end())
    return ResultResponse{};
  if (!found->ended())
    return std::nullopt;
  ResultResponse response{.status = found->state};
  if (found->state != kSucceeded) {
    response.result.error_code = static_cast<std::uint16_t>(found->status.code);
    response.result.error_msg = found->status.reason;
  }
  return response;
}

bool Navigate::take(const v1::GoalStatus& status) {
  for (Entry& entry : entries_) {
    if (entry.id != status.id || entry.ended())
      continue;
    const State before = entry.state;
    entry.status = status;
    entry.state = state_of(status.state, before);
    return entry.state != before;
  }
  return false;
}

GoalStatusArray Navigate::statuses() const {
  GoalStatusArray all;
  for (const Entry& entry : entries_)
    all.status_list.push_back({entry.info, entry.state});
  return all;
}

std::optional<FeedbackMessage> Navigate::feedback(const std::optional<viewer::Place>& place,
                                                  std::int64_t time_ns) const {
  const auto found = std::ranges::find(entries_, kExecuting, &Entry::state);
  if (found == entries_.end() || !place)
    return std::nullopt;
  FeedbackMessage message{.goal_id = found->info.goal_id};
  auto& feedback = message.feedback;
  feedback.current_pose.header = {time_of(time_ns), place->odom_in_map ? "map" : "odom"};
  feedback.current_pose.pose = pose_of(place->pose);
  const v1::GoalStatus& status = found->status;
  feedback.navigation_time = duration_of(status.elapsed);
  if (status.progress > 0.0)
    feedback.estimated_time_remaining =
        duration_of(status.elapsed * (1.0 - status.progress) / status.progress);
  feedback.distance_remaining = static_cast<float>(distance(*place, found->position));
  return message;
}

}  // namespace saphira::ros2

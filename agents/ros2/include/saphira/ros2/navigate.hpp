#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "saphira/idl/intention.hpp"
#include "saphira/ros2/messages.hpp"
#include "saphira/viewer/picture.hpp"

namespace saphira::ros2 {

/// The server of the action NavigateToPose: its goals are goals of the robot. A new one replaces
/// the one before, which is aborted. Without clock and bus.
class Navigate {
 public:
  /// States of a goal, as in GoalStatus.
  enum State : std::int8_t {
    kAccepted = 1,
    kExecuting = 2,
    kCanceling = 3,
    kSucceeded = 4,
    kCanceled = 5,
    kAborted = 6
  };

  /// The fate of a request. `goal`: to be asked for, and told to asked().
  struct Sent {
    SendResponse response;
    std::optional<v1::Goal> goal;
    std::vector<v1::GoalId> replaced;  ///< to be canceled
  };
  Sent send(const SendRequest& request, std::int64_t time_ns);
  /// The id of the goal that was sent last.
  void asked(const v1::GoalId& id);

  struct Canceled {
    CancelResponse response;
    std::vector<v1::GoalId> goals;  ///< to be canceled
  };
  Canceled cancel(const CancelRequest& request);

  /// Nothing: the goal has not ended.
  std::optional<ResultResponse> result(const Uuid& goal) const;
  /// The newest state of a goal of the robot. True where the states of the action have changed.
  bool take(const v1::GoalStatus& status);
  GoalStatusArray statuses() const;
  /// For the goal that is executed, if there is one.
  std::optional<FeedbackMessage> feedback(const std::optional<viewer::Place>& place,
                                          std::int64_t time_ns) const;

 private:
  struct Entry {
    GoalInfo info;
    v1::GoalId id;  ///< [0, 0: not asked for yet]
    v1::Argument position;
    State state = kAccepted;
    v1::GoalStatus status;
    bool ended() const { return state >= kSucceeded; }
  };
  Entry* find(const Uuid& goal);

  std::deque<Entry> entries_;  // by the time of acceptance
};

}  // namespace saphira::ros2

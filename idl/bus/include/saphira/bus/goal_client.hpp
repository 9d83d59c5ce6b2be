#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/bus/request_client.hpp"
#include "saphira/idl/goal_end.hpp"

namespace saphira::bus {

/// An agent's side of goals: asks for them, changes and cancels them, and follows their status. For
/// the node's own thread.
///
///   Node node(options);
///   GoalClient goals(node, "my agent");
///   v1::Goal goal;
///   goal.functor = "go_to";
///   goal.arguments = {point("position", 3.0, 1.0, 0.0, v1::FRAME_ODOM)};
///   const v1::GoalId id = goals.ask(goal);
///   while (...) { node.wait(500ms); goals.poll(); auto status = goals.status(id); ... }
///
/// The goals live with the client: when it is destroyed without cancel, or its process dies, the
/// goal's writer_lost decides between cancel and keep. A goal that has ended, or was canceled, is
/// forgotten some minutes later, here and on the bus.
class GoalClient {
 public:
  /// requester: name of the asker, for people. keep: how long the end of one's own goal is
  /// remembered; at least the minute in which everybody knows its status.
  GoalClient(Node& node, std::string requester,
             std::chrono::milliseconds keep = std::chrono::minutes(5));

  /// Asks for a goal; fills in its id and, where it names none, its requester.
  /// std::runtime_error where the bus did not take it.
  v1::GoalId ask(v1::Goal goal);
  /// Takes over a goal that this program asked for before it was started again. Exceptions as
  /// above.
  void adopt(const v1::GoalId& id, v1::Goal goal);
  /// Replaces the goal under the id of one that this client asked for.
  void change(const v1::GoalId& id, v1::Goal goal);
  /// Withdraws a goal: also one of another client, by its id. why: for its status, in words; needed
  /// with `by`, the person who cancels.
  void cancel(const v1::GoalId& id, const std::string& why = {}, const v1::Person& by = {});

  /// Withdraws all that this client asked for and that is not to be kept without its program.
  void leave();

  /// Takes the samples of goals/status, and forgets goals that ended long ago. Call after each
  /// Node::wait.
  void poll();
  /// It was asked for here, or has a status.
  bool knows(const v1::GoalId& id) const;
  /// All that is known of a goal, by anybody; nothing before its first status.
  std::optional<v1::GoalStatus> status(const v1::GoalId& id) const;
  /// Every goal that is known, by the time of its newest status; at the same time by functor and
  /// number, which do not differ between runs.
  std::vector<v1::GoalStatus> statuses() const;

  /// Waits until everything that was asked, changed and canceled has reached a reader of goals.
  /// Acceptance of a goal shows in its status only.
  bool delivered(int timeout_ms);

 private:
  using Key = std::pair<std::uint64_t, std::uint64_t>;
  using Clock = std::chrono::steady_clock;

  /// A goal that this client has on the bus: it asked for it, or withdrew it with a reason.
  struct Own {
    v1::Goal goal;
    std::optional<Clock::time_point> over;       ///< time of its end
    std::optional<Clock::time_point> withdrawn;  ///< withdrawal of its status, without an end
  };

  void forget();
  void miss();

  Node& node_;
  std::string requester_;
  Writer<v1::Goal> writer_;
  Reader<v1::GoalStatus> reader_;
  std::map<Key, v1::GoalStatus> known_;
  std::chrono::milliseconds keep_;
  /// Statuses are kept after the service has withdrawn them.
  std::map<Key, Own> own_;
};

using v1::describe;
using v1::ended;
/// The state in a word, such as "underway".
std::string describe(v1::GoalState state);
/// Reads the id as describe() writes it; nothing: not an id.
std::optional<v1::GoalId> parse_goal_id(const std::string& text);
/// One line: state, step, progress, reason.
std::string describe(const v1::GoalStatus& status);

}  // namespace saphira::bus

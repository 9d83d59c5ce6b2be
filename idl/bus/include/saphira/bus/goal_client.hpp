#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/bus/request_client.hpp"

namespace saphira::bus {

/// An agent's side of goals: asks for them, changes and cancels them, and follows what becomes of
/// them. For the node's own thread.
///
///   Node node(options);
///   GoalClient goals(node, "my agent");
///   v1::Goal goal;
///   goal.functor("go_to");
///   goal.arguments({point("position", 3.0, 1.0, 0.0, v1::FRAME_ODOM)});
///   const v1::GoalId id = goals.ask(goal);
///   while (...) { node.wait(500ms); goals.poll(); auto status = goals.status(id); ... }
///
/// The goals live with the client: when it is destroyed without cancel, or its process dies, each
/// goal's writer_lost says what becomes of it. A goal that has ended, or was canceled, is forgotten
/// some minutes later, here and on the bus.
class GoalClient {
 public:
  /// requester: who asks, for people. keep: how long the end of a goal of one's own is known; not
  /// shorter than the minute in which its status is known to everybody.
  GoalClient(Node& node, std::string requester,
             std::chrono::milliseconds keep = std::chrono::minutes(5));

  /// Asks for a goal; fills in its id and, where it names none, its requester.
  /// std::runtime_error where the bus did not take it.
  v1::GoalId ask(v1::Goal goal);
  /// Asks for something else under the id of a goal that this client asked for.
  void change(const v1::GoalId& id, v1::Goal goal);
  /// Withdraws a goal: also one of another client, by its id.
  void cancel(const v1::GoalId& id);

  /// Takes in what has come on goals/status, and forgets what ended long ago. Call after each
  /// Node::wait.
  void poll();
  /// All that is known of a goal, by anybody; nothing before its first status.
  std::optional<v1::GoalStatus> status(const v1::GoalId& id) const;
  /// Every goal that is known, by id.
  std::vector<v1::GoalStatus> statuses() const;

  /// Waits until everything that was asked, changed and canceled has reached a reader of goals.
  /// That it is understood is said by its status.
  bool delivered(int timeout_ms);

 private:
  using Key = std::pair<std::uint64_t, std::uint64_t>;
  using Clock = std::chrono::steady_clock;

  /// A goal that this client asked for.
  struct Own {
    std::optional<Clock::time_point> over;       ///< since it is
    std::optional<Clock::time_point> withdrawn;  ///< its status, while no end was heard
  };

  void forget();
  void miss();

  Node& node_;
  std::string requester_;
  Writer<v1::Goal> writer_;
  Reader<v1::GoalStatus> reader_;
  std::map<Key, v1::GoalStatus> known_;
  std::chrono::milliseconds keep_;
  /// Their statuses are kept though the service has withdrawn them.
  std::map<Key, Own> own_;
};

/// True where a goal in this state has come to its end.
bool ended(v1::GoalState state);
/// The state in a word, such as "underway".
std::string describe(v1::GoalState state);
/// "1f3a...:2" : the id as people type it. parse_goal_id reads it; nothing where it is not one.
std::string describe(const v1::GoalId& id);
std::optional<v1::GoalId> parse_goal_id(const std::string& text);
/// One line: state, step, progress, reason.
std::string describe(const v1::GoalStatus& status);

}  // namespace saphira::bus

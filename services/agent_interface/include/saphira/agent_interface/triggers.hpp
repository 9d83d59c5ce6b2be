#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::agent_interface {

enum class TriggerKind { time, data, event };

/// An action that is requested when a condition holds (after OAA).
struct Trigger {
  std::pair<std::uint64_t, std::uint64_t> id;
  std::string source;  ///< the requester
  TriggerKind kind = TriggerKind::time;
  double period = 1.0;  ///< [s] of time and data
  std::string condition;
  Arguments condition_arguments;
  std::string action;
  Arguments action_arguments;  ///< unbound ones are filled from the condition's result
  std::uint64_t times = 0;     ///< firings at most; 0: without end
  Checked person{};            ///< the requester, for whom its action is requested

  bool operator==(const Trigger&) const = default;
};

/// A trigger fires: its action with these arguments.
struct Firing {
  const Trigger* trigger = nullptr;
  Arguments arguments{};
};

/// The triggers of all programs, and which of them fire. `now` is seconds of any clock that never
/// goes back. Pointers to triggers hold until the trigger is set anew or taken back.
class Triggers {
 public:
  using Id = std::pair<std::uint64_t, std::uint64_t>;

  /// Returns the error in the trigger, which is then not set; empty: none.
  std::string set(const Trigger& trigger, double now);
  void take_back(const Id& trigger);
  /// Its firings count when it is set again.
  void miss(const Id& trigger) { armed_.erase(trigger); }
  /// It fires no more, until it is taken back.
  void call_off(const Id& trigger);
  /// nullptr: none has that id.
  const Trigger* find(const Id& trigger) const;
  /// Those that may fire yet.
  std::vector<const Trigger*> live() const;

  /// Those of time and data that are due now.
  std::vector<const Trigger*> take_due(double now);
  /// The time of the next one.
  std::optional<double> due() const;
  std::vector<Firing> happened(const std::string& functor, const Arguments& arguments);
  /// The condition of a data trigger was answered.
  std::optional<Firing> looked(const Id& trigger, const Answer& answer);
  /// found: the values of open arguments. None: the trigger fires no more.
  std::optional<Firing> fire(const Id& trigger, const Arguments& found);

  /// True where the memory has changed since the last call.
  bool take_changed() { return std::exchange(changed_, false); }
  /// The memory: the firings.
  SAPHIRA_ARCHIVE(fired_)

 private:
  struct Armed {
    Trigger trigger;
    double next = 0.0;
    bool looked = false;               ///< the condition was answered
    std::optional<Arguments> found{};  ///< by the last answer; none: no value
  };

  bool is_spent(const Trigger& trigger) const;

  std::map<Id, Armed> armed_{};
  std::map<Id, std::uint64_t> fired_{};  ///< how often, of triggers with `times`
  bool changed_ = false;
};

}  // namespace saphira::agent_interface

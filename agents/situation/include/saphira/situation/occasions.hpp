#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "saphira/situation/situation.hpp"

namespace saphira::situation {

/// An event after which people want to see the last minute.
struct Occasion {
  std::string kind;  ///< as part of a file's name: goal-failed, stopped, estop, guard,
                     ///< program-lost, silent, robot-lost, stalled, robot-trouble
  std::string text;  ///< in words, such as "go-to-place has failed: no way to N3"
};

/// Tells such events from one situation to the next. A kind comes once in ten seconds; the first
/// situation is the beginning, and no event.
class Occasions {
 public:
  /// `now`: [s] of a steady clock. The most important event since the last call.
  std::optional<Occasion> next(const Situation& situation, double now);

 private:
  std::optional<Occasion> find(const Situation& situation, double now);

  using Key = std::pair<std::uint64_t, std::uint64_t>;
  /// The part of a situation that the next one is compared with.
  struct Seen {
    std::optional<Key> stop;  ///< asker and number [none: no grant is known]
    bool estopped = false;
    std::optional<bool> lost;  ///< [none: no registration is known]
    bool silent = false;
    bool stalled = false;
    bool has_trouble = false;  ///< by the bridge
    bool knows_goals = false;
    std::set<Key> failed;                                      ///< goals
    std::set<std::pair<std::string, std::uint64_t>> programs;  ///< heard: name and instance
  };
  std::optional<Seen> before_;
  double held_ = -1.0;  ///< [s] since when the guard stops the robot [-1: it does not]
  std::map<std::string, double> told_;  ///< [s] by kind
};

}  // namespace saphira::situation

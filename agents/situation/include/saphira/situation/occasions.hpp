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
                     ///< program-lost, silent, robot-lost
  std::string text;  ///< in words, such as "go-to-place has failed: no way to N3"
};

/// Tells such events from one situation to the next. A kind comes once in ten seconds; the first
/// situation is the beginning, and no event.
class Occasions {
 public:
  /// `now`: [s] of a steady clock. The most important event since the last call.
  std::optional<Occasion> look(const Situation& situation, double now);

 private:
  std::optional<Occasion> find(const Situation& situation, double now);

  struct Before {
    std::pair<std::uint64_t, std::uint64_t> stop;  ///< asker and number
    bool estopped = false;
    bool lost = false;
    bool silent = false;
  };
  std::optional<Before> before_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, v1::GoalState> goals_;
  std::set<std::pair<std::string, std::uint64_t>> programs_;  ///< heard: name and instance
  double held_ = -1.0;  ///< [s] since when the guard stops the robot [-1: it does not]
  std::map<std::string, double> told_;  ///< [s] by kind
};

}  // namespace saphira::situation

#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "saphira/mcp/results.hpp"

namespace saphira::mcp {

/// An action that an agent was asked for, with the status of a goal.
struct Action {
  v1::GoalStatus status;
  Json results = Json::object();  ///< of its end
};

/// The actions that a client has asked of agents. Each has an id and a status as a goal has, so the
/// same tools report and withdraw both.
class Actions {
 public:
  /// A request that was sent under the number of this id.
  void begin(const v1::GoalId& id, const v1::Request& request,
             std::vector<v1::CapabilityParameter> declared);
  void hear(const v1::Answer& answer);
  void withdraw(const v1::GoalId& id);

  /// Null: no action of this id.
  const Action* find(const v1::GoalId& id) const;
  /// Oldest first. The newest ends are remembered.
  std::vector<Action> all() const;

 private:
  struct Asked {
    Action action;
    std::vector<v1::CapabilityParameter> declared;
    bool withdrawn = false;
  };

  std::map<std::uint64_t, Asked> asked_;  ///< by the number
};

/// As a goal, with the results.
Json json_of(const Action& action);
/// State, reason and results, for the model.
std::string words_of(const Action& action);

}  // namespace saphira::mcp

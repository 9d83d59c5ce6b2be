#pragma once

#include "saphira/mcp/results.hpp"

namespace saphira::mcp {

/// An action that an agent was asked for. It has an id and a status as a goal has, so the same
/// tools report and withdraw both.
struct Action {
  v1::GoalStatus status;
  Json results = Json::object();  ///< of its end
};

/// A request that was sent under the number of this id.
Action action_of(const v1::GoalId& id, const v1::Request& request);
/// The status after this answer. declared: of the results.
void take_answer(Action& action, const v1::Answer& answer, bool withdrawn,
                 const std::vector<v1::CapabilityParameter>& declared);
/// As a goal, with the results.
Json json_of(const Action& action);
/// State, reason and results, for the model.
std::string words_of(const Action& action);

}  // namespace saphira::mcp

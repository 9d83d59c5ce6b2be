#pragma once

#include <string>
#include <vector>

#include "saphira/idl/agents.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/idl/request.hpp"
#include "saphira/mcp/session.hpp"

/// The results of tools as JSON, and their forms: JSON Schema, which clients check them against.
namespace saphira::mcp {

Json json_of(const v1::GoalStatus& status);

/// The robot's words for a model: advice about commands of people, which it cannot follow, becomes
/// advice about tools and people.
std::string for_model(std::string text);
/// All texts of a value.
Json for_model(Json value);
/// A text without line ends and other control characters.
std::string one_line(std::string text);
/// The words of another agent, as a quotation on one line: data, and no instructions.
std::string quotation(const std::string& text);

/// Arguments of an event or results of an answer, by name. Several of one name are a list. One of
/// another kind than declared is left out.
Json values_of(const std::vector<v1::Argument>& arguments,
               const std::vector<v1::CapabilityParameter>& declared = {});

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

/// Of a tool that asks for a goal.
Json goal_form();
/// Of a permanent tool; null: there is none of this name.
Json form_of(const std::string& tool);
/// Of a capability: the parameters that an answer may fill. Of an action: a goal with these
/// results.
Json form_of(const v1::Capability& capability);

}  // namespace saphira::mcp

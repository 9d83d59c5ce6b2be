#pragma once

#include <string>
#include <vector>

#include "saphira/idl/behavior.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/idl/system.hpp"

namespace saphira::cli {

/// The name of an intention or a behavior without the number of its instance, which the activities'
/// executor appends: "rest" of "rest#32".
std::string without_instance(const std::string& name);
/// In words: "rest, instance 32".
std::string instance_words(const std::string& name);

/// The intention display (paper, Figure 10): a line for each intention and each behavior, with the
/// marker * (blocking) or o, the schema, the instance, and the next state or B; then the present
/// step. `behaviors` adds the satisfaction of each.
std::string intentions_display(const v1::Intentions& intentions, const v1::BehaviorSet* behaviors);

/// The behaviors window (manual 2.3.6, Figures 2-4 and 2-5): for each behavior on both channels its
/// activity as a bar through the middle line, and its recommendation as a bar to one side; at the
/// bottom their summation.
std::string behaviors_display(const v1::BehaviorSet& behaviors);

/// The window of one behavior (Figure 2-6): parameters, state, rules with their antecedents, fuzzy
/// variables. `intended` and `schema` add their own data.
std::string behavior_display(const v1::BehaviorState& behavior,
                             const v1::IntendedBehavior* intended,
                             const v1::BehaviorSchema* schema);

/// The window of a behavior that is not intended: parameters and rules, from its file.
std::string schema_display(const v1::BehaviorSchema& schema);

/// For a name that no behavior has: the one that is meant, in whatever case, and all the `names`,
/// each once.
std::string unknown_behavior(const std::string& name, std::vector<std::string> names);

/// The beliefs whose name contains `part` (all: empty), with source and age.
std::string beliefs_table(const v1::BeliefSet& beliefs, const std::string& part = {});

/// The processes window (manual 2.3.7), for all services together.
std::string processes_table(std::vector<v1::ProcessSet> services);

/// In the manual's notation: INIT, SUSP, or the number of its own state.
std::string state_text(const v1::Process& process);

/// A parameter's value, such as 0.3, "left" or (1, 2) in odom.
std::string value_text(const v1::Argument& argument);

}  // namespace saphira::cli

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/idl/agents.hpp"
#include "saphira/idl/request.hpp"

/// Agents and utterances in words.
namespace saphira::cli {

/// name=? for a slot that the answer fills, name=?P for one whose value is the variable P's;
/// otherwise as parse_argument. std::invalid_argument gives the expected form.
v1::Argument parse_slot(const std::string& word);

/// The request of a functor and its slots, or of one part such as "place_of(person=karen,
/// place=?P)" a word. std::invalid_argument gives the expected form.
v1::Request parse_question(const std::vector<std::string>& words);

/// The utterance is for a listener that is this instance and has listened for so long [s]: it
/// answers it, or was said since. A living writer repeats its earlier sentences to a new reader.
/// age: [s] of the utterance.
bool is_for(const v1::Utterance& utterance, double age, std::uint64_t instance, double listened);

/// Such as "alice: Flakey, stop"; the robot's own with its name.
std::string line_of(const v1::Utterance& utterance, const std::string& robot = {});

/// Such as "calendar: place="library"", or the code and the reason.
std::string line_of(const v1::Answer& answer);
/// An agent at work says the same as before. Equal values are not a repetition: they may be of
/// several agents of one name.
bool repeats(const v1::Answer& answer, const v1::Answer& before);
/// One JSON object: agent, code, text, and values by name; several values of one name are a list.
/// robot: whose agent it is; empty: is not said.
std::string to_json(const v1::Answer& answer, const std::string& robot = {});

/// The agents, each with a line for each capability. The robot's activities are the last line.
std::string describe(const std::vector<v1::Agent>& agents);
/// Such as "trigger 1f3a:2 of ann: every 5 s: note(door="3")". missing: what it waits for.
std::string describe(const v1::Trigger& trigger, const std::string& id, bool live = true,
                     const std::string& missing = {});
/// ids: separated by blanks, as the facilitator tells its live triggers.
bool is_among(const std::string& id, const std::string& ids);

/// The advice to the robot, each with its number, speaker and time.
std::string knowledge_table(const v1::Knowledge& knowledge);

}  // namespace saphira::cli

#pragma once

#include <string>

#include "agents.h"
#include "request.h"

/// Agents and utterances in words.
namespace saphira::cli {

/// name=? for a slot that the answer fills; otherwise as parse_argument. std::invalid_argument
/// gives the expected form.
v1::Argument parse_slot(const std::string& word);

/// Such as "alice: Flakey, stop"; the robot's own with its name.
std::string line_of(const v1::Utterance& utterance, const std::string& robot = {});

/// Such as "calendar: place="library"", or the code and the reason.
std::string line_of(const v1::Answer& answer);
/// One JSON object: agent, code, text, and values by name; several values of one name are a list.
std::string to_json(const v1::Answer& answer);

/// An agent with a line for each capability.
std::string describe(const v1::Agent& agent);
/// Such as "trigger 1f3a:2 of ann: every 5 s: note".
std::string describe(const v1::Trigger& trigger, const std::string& id);

/// The advice to the robot, each with its number, speaker and time.
std::string knowledge_table(const v1::Knowledge& knowledge);

}  // namespace saphira::cli

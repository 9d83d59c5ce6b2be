#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "saphira/agent_interface/dialogue.hpp"

namespace saphira::agent_interface {

/// The value of a slot; empty: the meaning has no such slot.
std::string slot(const Meaning& meaning, const std::string& name);
double number_of(const Meaning& meaning, const std::string& name);
/// The meaning with another value of a slot.
Meaning with(Meaning meaning, const std::string& name, const std::string& value);

std::string lower(std::string text);

/// "somebody" where the speaker has no name.
std::string speaker_of(const Advice& advice);
std::string speaker_of(const Utterance& utterance);
/// "Alice said that karen is at EJ-231".
std::string as_told(const Advice& advice);
/// The origin of a claim that follows from an utterance.
std::string claim_source(const Utterance& utterance);

bool is_open(const KnownGoal& goal);

/// A text as a field of a line that is kept; fields are separated by tabs. Tabs and line breaks in
/// people's words become blanks.
std::string field(std::string text);
std::vector<std::string> fields(std::string_view line);

/// The way to a place of the map, as the crow flies. Empty: no such place.
std::string way_to(const std::string& place, const Situation& situation);

}  // namespace saphira::agent_interface

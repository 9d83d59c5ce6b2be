#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saphira/agent_interface/dialogue.hpp"

namespace saphira::agent_interface {

/// The functors of answers to a question back: another name for that of the sentence before, and
/// the number of one of several meanings.
inline constexpr std::string_view kInstead = "instead";
inline constexpr std::string_view kChoice = "choice";

/// The kind of all hazards.
inline constexpr const char* kDanger = "danger";

/// The claim about a reply that is no answer to the question of an activity.
inline constexpr const char* kNotUnderstood = "not-understood";

/// The meaning of "wait": a task goes on afterwards.
inline constexpr const char* kHold = "hold";

/// The fact of agents: the place of a person.
inline constexpr const char* kPlaceFact = "place_of";

/// The answer after a no.
inline constexpr const char* kLeft = "then I leave it";

/// The claim that the robot is to go slowly.
inline constexpr const char* kPace = "pace";

/// True for a thing on the robot's back.
bool is_aboard(const std::string& thing, const Situation& situation);
/// True for a question of an activity whether something is handed over.
bool is_handover(std::string_view asked_about);

/// The marks between clauses, as words of their own: a comma, and any other.
inline constexpr const char* kComma = ",";
inline constexpr const char* kMark = ".";
/// The words of a text, with the marks between them.
std::vector<std::string> words_and_marks_of(std::string_view text);

/// True for digits, with a point or without.
bool is_number(const std::string& word);
/// The number in words there, such as "seventeen", "twenty seven" and "one hundred and twenty", and
/// how many words that are; 0: none.
std::pair<int, std::size_t> spoken_number(const std::vector<std::string>& words, std::size_t at);
/// Spoken numbers in a name as digits: "ej two thirty one" is "ej 231".
std::string in_digits(const std::string& name);

/// True for a stretched or repeated word ("stopstop"), one with two letters swapped, and a long one
/// with a letter left out.
bool is_misspelled(const std::string& word, const std::string& right);

/// Of a word: a letter, a digit, a hyphen, or a byte of a letter in UTF-8.
bool is_letter(char c);
/// The value of a slot; empty: the meaning has no such slot.
std::string slot(const Meaning& meaning, const std::string& name);
double number_of(const Meaning& meaning, const std::string& name);
/// An argument of a request that the answer fills.
Argument open_slot(std::string name);
bool is_yes_or_no(const Meaning& meaning);
/// True where a sentence ends with a question mark.
bool is_question(std::string_view text);
/// The meaning with another value of a slot.
Meaning with(Meaning meaning, const std::string& name, const std::string& value);

/// "at 10:02 ", in local time; empty for an unknown time.
std::string time_text(double unix_time);
/// "somebody" for an empty name.
std::string named_person(const std::string& name);
/// The words that were said, also where they corrected a sentence before.
const std::string& words_said(const Utterance& utterance);
/// "the way to EJ-231 for alice"; for the listener's own task without that name.
std::string named_task(const Task& task, const std::string& listener);
bool same_person(const std::string& a, const std::string& b);
/// True where this utterance may answer a question of the robot with yes or no: it is of the
/// speaker whose words raised the question, and comes within 20 s of them.
bool may_answer(const Utterance& utterance, const Utterance& raised_by);

/// "Alice said that karen is at EJ-231".
std::string as_told(const Advice& advice);
/// "Alice said at 10:02 "Flakey, Karen is in EJ-231"", in local time.
std::string source_of(const Advice& advice);
/// The origin of a claim that follows from an utterance.
std::string claim_source(const Utterance& utterance);

inline constexpr const char* kWhichThing = "which thing? Say its name";
inline constexpr const char* kLost = "I do not know where I am on the map";
/// The robot's place in the map's words; empty: unknown, or nameless.
std::string here(const Situation& situation);
/// The nearest doorway within that distance [m] that `fits`; nullptr: none.
const maps::Feature* nearest_door(
    const maps::Map& map, const Vec2& position, double within,
    const std::function<bool(const maps::Feature&)>& fits = [](const maps::Feature&) {
      return true;
    });
/// The nearest feature of the map with that name; nullptr: none. The robot's pose has to be known.
const maps::Feature* nearest_of(const std::string& place, const Situation& situation);
/// The way to a place of the map, as the crow flies. Empty: no such place.
std::string way_to(const std::string& place, const Situation& situation);

}  // namespace saphira::agent_interface

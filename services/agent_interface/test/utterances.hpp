#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "saphira/agent_interface/grammar.hpp"

namespace saphira::agent_interface {

/// Sentences, and the meaning that a person would give them: functors with their slots, `what?`,
/// `nothing` for words that are not meant for the robot, or `ambiguous`.
struct SaidAndMeant {
  std::string text;
  std::string meaning;
  bool reply = false;  ///< the robot has asked a question
};

/// The lines of utterances.txt, "utterance => meaning". std::runtime_error for any other line.
inline std::vector<SaidAndMeant> read_utterances(const std::string& content) {
  std::vector<SaidAndMeant> phrases;
  bool replies = false;
  std::istringstream lines(content);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') {
      replies = line == "# Where the robot has asked";
      continue;
    }
    const std::size_t arrow = line.find(" => ");
    if (arrow == std::string::npos)
      throw std::runtime_error("expected \"utterance => meaning\", found " + line);
    phrases.push_back({line.substr(0, arrow), line.substr(arrow + 4), replies});
  }
  return phrases;
}

/// The grammar's meaning of a phrase, in the words of those lines.
inline std::string meaning_of(const Grammar& grammar, const SaidAndMeant& phrase) {
  const Grammar::Understood understood = grammar.understand(phrase.text, phrase.reply);
  if (understood.meanings.size() == 1) {
    std::string text = describe(understood.meanings.front());
    for (const Meaning& step : understood.then)
      text += "; then " + describe(step);
    for (const Meaning& rule : understood.during)
      text += "; with " + describe(rule);
    return text;
  }
  if (understood.meanings.size() > 1)
    return "ambiguous";
  return understood.addressed ? "what?" : "nothing";
}

}  // namespace saphira::agent_interface

#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "saphira/agent_interface/grammar.hpp"

namespace saphira::agent_interface {

/// Signs for a text, a name and a number at the beginning or end of a pattern.
inline constexpr const char* kAnyText = "...";
inline constexpr const char* kAnyName = "{}";
inline constexpr const char* kAnyNumber = "<number>";

bool is_number(const std::string& word);
std::vector<std::string> without_commas(std::vector<std::string> words);

/// The search for the meanings of one text. It remembers what it has looked for, and counts its
/// work.
class Grammar::Finder {
 public:
  explicit Finder(const Grammar& grammar) : grammar_(grammar) {}

  struct Match {
    std::size_t end = 0;
    std::size_t literal = 0;  ///< words of the pattern itself
    std::map<std::string, std::string> slots{};
  };
  std::vector<Match> match(const Node& node, const std::vector<std::string>& words,
                           const Match& from);
  /// The meanings by the rules for that use; `command`: also the typed ones.
  std::vector<Meaning> look(const std::vector<std::string>& words, bool addressed, bool replies,
                            Use use);
  /// The ways to divide words and commas into sentences with one meaning each, all of them steps.
  /// `before`: the words of the step before them. runs_on: also where no word joins two sentences.
  std::vector<std::vector<Meaning>> divided(const std::vector<std::string>& words,
                                            const std::vector<std::string>& before, bool runs_on);
  /// A meaning of that kind before or behind other words, and these. A rule may also be within
  /// them.
  std::vector<std::pair<Meaning, std::vector<std::string>>> asides(
      const std::vector<std::string>& words, Use use);

  /// It finds nothing any more.
  bool is_spent() const { return work > kMostWork; }

  std::size_t work = 0;  ///< see Understood

 private:
  std::vector<Match> sequence(const std::vector<Node>& parts, const std::vector<std::string>& words,
                              const Match& from);
  std::vector<Match> name(const Node& node, const std::vector<std::string>& words,
                          const Match& from) const;
  std::vector<Match> entry(const Node& node, const std::vector<std::string>& words,
                           const Match& from) const;
  std::optional<std::pair<std::size_t, std::string>> decimal(const std::vector<std::string>& words,
                                                             std::size_t at) const;
  std::vector<Meaning> find(const std::vector<std::string>& words, bool addressed, Use use);
  bool may_be_name(const std::string& word) const;
  /// One step, or the same several times; empty: it is none. sentence: as it was looked for.
  std::vector<Meaning> steps_in(std::vector<std::string>& sentence,
                                const std::vector<std::string>& before);

  const Grammar& grammar_;
  std::map<std::tuple<Use, bool, std::vector<std::string>>, std::vector<Meaning>> looked_;
};

}  // namespace saphira::agent_interface

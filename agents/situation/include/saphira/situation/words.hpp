#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/idl/agents.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/idl/motion.hpp"
#include "saphira/idl/system.hpp"

namespace saphira::situation {

/// Enumerators for people.
const char* name_of(v1::ServiceState state);
const char* name_of(v1::LogLevel level);
const char* name_of(v1::Role role);
const char* name_of(v1::GuardAction action);
const char* name_of(v1::Frame frame);

/// Stops that hold until a person releases them, with the command for that: an emergency stop and
/// its source, or autonomy's wait for a hand-back. Empty without either.
std::string latched(const v1::Grant& grant);
/// One line: the driver and the reason, the latches, and the guard's action.
std::string describe(const v1::Grant& grant);
/// The goal for people: go_to(position=(3, 1) in odom).
std::string describe(const v1::Goal& goal);

/// A typed sentence of a person to the robot. time: [s] since 1970.
v1::Utterance typed(std::uint64_t writer, std::uint64_t number, const std::string& speaker,
                    const std::string& text, double time);

/// True where the node stands for a behavior: a leaf of the tree.
bool is_behavior(const v1::IntentionNode& node, const v1::Intentions& intentions);

/// "0.4 s", "12 s".
std::string seconds_text(double seconds);
/// "bridge, behaviors and intentions".
std::string listed(const std::vector<std::string>& parts, const char* last = " and ");

/// The length limit of an easily read sentence.
inline constexpr std::size_t kLongestSentence = 200;

/// Joins parts, in order. To fit the limit, less important parts are shortened, and then left out.
class Sentence {
 public:
  /// `rank` 0 is never left out; `brief` is a shorter form (empty: none).
  void add(int rank, std::string text, std::string brief = {});
  /// Ends with a period.
  std::string text() const;

 private:
  struct Part {
    int rank;
    std::string text;
    std::string brief;
  };
  std::vector<Part> parts_;
};

/// The text, cut to that many characters at a word, with "..." for the missing part.
std::string cut(const std::string& text, std::size_t most);

}  // namespace saphira::situation

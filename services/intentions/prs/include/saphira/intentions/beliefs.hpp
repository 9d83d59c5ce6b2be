#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/intentions/value.hpp"
#include "saphira/intentions/world.hpp"

namespace saphira::intentions {

class Functions;

/// A belief: a name and its value.
struct Belief {
  std::string name;
  Value value;
  std::string said_by;  ///< an intention, "perception", or the claimant
  Ticks since = 0;      ///< of the newest change of its value

  bool operator==(const Belief&) const = default;
};

/// A claim of a third party on the bus, or its withdrawal.
struct ClaimEvent {
  enum class Kind { kSaid, kWithdrawn };
  Kind kind = Kind::kSaid;
  GoalId id;           ///< unique for ever, as that of a goal
  std::string source;  ///< the writer, for people
  std::string name;
  Value value;
  Ticks age = 0;  ///< since it was made
};

/// The beliefs of the robot (paper 3.4: the LPS and a set of environment variables): the results of
/// conditions of the LPS, the claims of third parties, and the values set by activities. A
/// condition cannot be overruled; among the others the newest counts.
class Beliefs {
 public:
  /// The functions whose conditions are beliefs; they outlive this object. None: no conditions.
  explicit Beliefs(const Functions* functions = nullptr) : functions_(functions) {}

  /// Evaluates the conditions; one with a new value changes at `now`.
  void evaluate_conditions(const World& world);
  void set(std::string_view name, Value value, std::string_view who, Ticks now);
  void unset(std::string_view name);
  void take(const ClaimEvent& event, Ticks now);

  /// nil where unknown.
  Value get(std::string_view name, const World& world) const;
  /// The newest value of a name from activities or claims; nullptr: none.
  const Belief* stored(std::string_view name) const;
  /// By name.
  std::vector<Belief> all() const;
  /// The values that activities have set, by name.
  std::vector<Belief> set_by_activities() const;
  /// Increases with each change of those.
  std::uint64_t set_revision() const { return set_revision_; }
  /// Increases with each change of all().
  std::uint64_t revision() const { return revision_; }

  SAPHIRA_ARCHIVE(set_, claims_, conditions_, claim_count_, revision_, set_revision_, looked_)

 private:
  struct Claim {
    GoalId id;
    Belief belief;
  };
  const Functions* functions_;
  std::map<std::string, Belief, std::less<>> set_;
  std::map<std::string, std::vector<Claim>, std::less<>> claims_;  ///< oldest first
  std::map<std::string, Belief, std::less<>> conditions_;
  std::size_t claim_count_ = 0;
  std::uint64_t revision_ = 0;
  std::uint64_t set_revision_ = 0;
  Ticks looked_ = std::numeric_limits<Ticks>::min();  ///< time of conditions_
};

}  // namespace saphira::intentions

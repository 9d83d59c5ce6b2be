#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/archived.hpp"

namespace saphira::agent_interface {

/// A fact that somebody told the robot (paper 4.5).
struct Advice {
  enum class Kind { office_of, person_at, knows_where, hazard, has };
  std::uint64_t number = 0;
  Kind kind = Kind::office_of;
  std::string about;  ///< the person, the thing, or the kind of hazard or rule of a zone
  std::string value;  ///< a place, or the person that knows or has it
  std::string speaker;
  std::string said;            ///< in the speaker's words
  double time = 0.0;           ///< [s] since 1970; 0: unknown
  std::uint32_t artifact = 0;  ///< of the map; 0: none

  friend bool operator==(const Advice&, const Advice&) = default;
};

/// The speaker of what the robot has found out itself.
inline constexpr const char* kRobot = "the robot";

/// Such as "office_of".
const char* describe(Advice::Kind kind);
/// As a sentence: "EJ-231 is karen's office".
std::string describe(const Advice& advice);

class Knowledge {
 public:
  /// The newest advice of a kind about a subject; of a hazard: at that place; of who knows where
  /// somebody is: by that person. `value` empty: any.
  const Advice* find(Advice::Kind kind, std::string_view about, std::string_view value = {}) const;
  /// Replaces advice of the same kind and subject, of which there may be several hazards and
  /// several persons who know; sets its number.
  const Advice& learn(Advice advice);
  /// Forgets the advice and returns it; nothing for an unknown number.
  std::optional<Advice> forget(std::uint64_t number);
  const std::vector<Advice>& all() const { return all_; }

  /// The probable place of a person: the place of a sighting, otherwise their office. Empty:
  /// unknown.
  std::string place_of(std::string_view person) const;
  /// True where it knows a place of that person, or somebody who knows it.
  bool findable(std::string_view person) const;
  /// True where there is a fact about that person, or that person knows a place of others.
  bool knows(std::string_view person) const;

  SAPHIRA_ARCHIVE(all_, newest_)

 private:
  std::vector<Advice> all_;
  std::uint64_t newest_ = 0;
};

}  // namespace saphira::agent_interface

#pragma once

#include <nlohmann/json.hpp>

#include "saphira/situation/situation.hpp"

/// A robot in an office, for tests: the samples of its programs in normal operation (office.json).
namespace saphira::situation::test {

using Json = nlohmann::json;

/// A situation from its members, and the samples of the contract as JSON; a program by its name, of
/// which a # and more may follow. A program has run for a minute and was heard just now, as far as
/// it does not say otherwise. std::invalid_argument for anything else.
Situation situation_of(const Json& json);

/// Cycle 1000 of a drive to (3, 1) past an obstacle on the right: KeepOff (1) steers left, GoToPos
/// (3) drives on.
Json driving_json();
inline Situation driving() {
  return situation_of(driving_json());
}
/// The texts "num 0.3", "deg 20" and "ago 1.5" in a JSON become numbers: as it stands, in radians,
/// and the cycle so many seconds before `now`. "big done" becomes DONE.
Json evaluated(const Json& json, std::uint64_t now);

}  // namespace saphira::situation::test

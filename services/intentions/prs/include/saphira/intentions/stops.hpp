#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "saphira/base/archived.hpp"
#include "saphira/idl/common.hpp"
#include "saphira/intentions/world.hpp"

namespace saphira::intentions {

/// The stop that the goals come after: a stop of the bridge ends every goal that drives, and a goal
/// "stop" asks the bridge for one.
class Stops {
 public:
  Stops() = default;
  /// `heeds`: from before a restart.
  explicit Stops(const std::optional<v1::StopId>& heeds) : heeds_(heeds), saved_(heeds) {}

  /// A goal "stop" has begun for that requester.
  void ask(std::string requester, Ticks now);
  /// The id of the stop that the bridge was asked for: goals of afterwards may drive.
  void heed(const v1::StopId& own);
  /// Takes the newest stop of the bridge. One from before heeds() is known says nothing about the
  /// goals. True: it ends the goals that drive.
  bool take(const v1::StopId& newest);
  /// No goal "stop" is open any more: a stop that was not confirmed is not asked for again.
  /// `confirms`: the bridge tells its stops.
  void give_up(bool confirms);

  /// The requester for whom the bridge is to be asked in this cycle; none: it is not.
  std::optional<std::string> asks(Ticks now, bool confirms) const;
  /// No stop is asked for that the bridge has not confirmed.
  bool confirmed() const { return !requester_; }
  /// Goals that drive come after it; none: no bridge was heard yet.
  const std::optional<v1::StopId>& heeds() const { return heeds_; }
  /// True once after a change of heeds().
  bool take_changed();

  SAPHIRA_ARCHIVE(heeds_, saved_, seen_, own_, requester_, asked_)

 private:
  std::optional<v1::StopId> heeds_;
  std::optional<v1::StopId> saved_;
  v1::StopId seen_;             ///< the bridge's newest
  std::deque<v1::StopId> own_;  ///< that may be on their way
  std::optional<std::string> requester_;
  Ticks asked_ = 0;
};

}  // namespace saphira::intentions

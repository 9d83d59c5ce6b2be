#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/bus/introspect.hpp"

namespace saphira::watch {

/// The bridges that an order to all of them has to reach, by the announcements of programs. A
/// bridge is announced before it is heard. A robot whose behaviors are there without its bridge
/// counts as well: its bridge hangs, or is cut off. Pure.
class Roll {
 public:
  /// quiet: [s] without a new program after which all are known.
  explicit Roll(double quiet) : quiet_(quiet) {}

  /// announced: of this moment; writers: of topics that bridges alone write, and that are there,
  /// for bridges that do not announce their program. now: [s] of a clock that never goes back.
  void update(const std::vector<bus::ProgramEntry>& announced,
              const std::set<bus::WriterId>& writers, double now);
  bool complete(double now) const {
    return changed_ && (now - *changed_ >= quiet_ || now - *began_ >= kMost);
  }

  std::size_t count() const { return bridges_.size() + bridgeless_.size(); }
  /// The robots of all bridges, and of those that none of these writers is of. Sorted.
  std::vector<std::string> robots() const;
  std::vector<std::string> without(const std::set<bus::WriterId>& writers) const;

  static constexpr double kMost = 10.0;  ///< [s] where programs come and go all the time

 private:
  using Id = decltype(bus::ProgramEntry::id);
  static Id id_of(const bus::WriterId& writer);

  const double quiet_;
  std::map<Id, std::string> bridges_;  ///< their robots
  std::set<std::string> bridgeless_;   ///< robots
  std::set<Id> programs_;
  std::optional<double> began_;
  std::optional<double> changed_;  ///< [s] then the newest program came
};

}  // namespace saphira::watch

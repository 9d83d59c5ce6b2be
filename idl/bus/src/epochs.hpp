#pragma once

// The choice of the bridge whose epochs a service follows. Pure.

#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "peers.hpp"

namespace saphira::bus::internal {

/// An epoch belongs to the bridge that has described its robot for it. A service follows one bridge
/// until that bridge is gone; samples of other bridges of the same robot name are refused.
///
/// A bridge is known by the instance in its description, not by its participant: it has one
/// participant on each side of its machine, and makes them anew after a pause or for another
/// address.
class Epochs {
 public:
  using Program = Peers::Program;  ///< a participant
  enum class Verdict {
    take,     ///< of the epoch that is followed
    adopt,    ///< the first one of an epoch that is followed from now on
    wait,     ///< its writer's description may still be on the way
    foreign,  ///< of another bridge than the one that is followed
    left      ///< of an epoch that was left
  };

  /// The bridge `instance` [0: unknown, each participant is one] has described its robot for an
  /// epoch by this participant.
  void describe(const Program& program, std::uint64_t instance, std::uint64_t epoch);
  /// A participant is gone. Another bridge may be followed when the followed one has none left.
  void lose(const Program& program);
  /// The verdict on a state of the robot. Follows its bridge where none is followed yet.
  Verdict judge(const Program& writer, std::uint64_t epoch);
  /// True where other services' samples of this epoch are of use, now or soon.
  bool useful(std::uint64_t epoch) const;
  /// The epoch that is followed; 0 before the first.
  std::uint64_t epoch() const { return epoch_; }

 private:
  static constexpr std::size_t kMostPrograms = 64;
  static constexpr std::size_t kMostLeft = 1000;

  struct Known {
    std::uint64_t instance = 0;
    std::uint64_t epoch = 0;
    bool present = true;
  };
  /// True where the participant belongs to the followed bridge.
  bool followed(const Program& program, const Known& known) const;

  /// The participant by which the bridge that is followed was heard last.
  std::optional<Program> bridge_;
  std::uint64_t instance_ = 0;  ///< that bridge's
  std::uint64_t epoch_ = 0;
  std::map<Program, Known> described_;
  std::set<std::uint64_t> left_;
};

}  // namespace saphira::bus::internal

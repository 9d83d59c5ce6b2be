#pragma once

// The presence of the programs that a node is matched with. Pure bookkeeping: no DDS, no clock.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "internal.hpp"

namespace saphira::bus::internal {

/// The other ends that one endpoint is matched with.
class Ends {
 public:
  enum class Side { readers, writers };  ///< of the other ends; losses are told of writers
  explicit Ends(Side side) : side_(side) {}
  /// Those whose program is there.
  std::size_t present() const { return present_; }

 private:
  friend class Peers;

  void lose(const WriterId& other) {
    if (side_ != Side::writers)
      return;
    lost_.push_back(other);
    std::erase(returned_, other);
  }
  /// A loss that nobody has taken yet is forgotten.
  void come_back(const WriterId& other) {
    if (side_ == Side::writers && std::erase(lost_, other) == 0)
      returned_.push_back(other);
  }

  const Side side_;
  std::set<WriterId> matched_;
  std::set<WriterId> before_;  ///< of the session before, not matched again yet
  int ticks_left_ = 0;         ///< until those of `before_` are lost
  std::vector<WriterId> lost_;
  std::vector<WriterId> returned_;
  std::atomic<std::size_t> present_{0};
};

/// A killed program stays matched until its participant's lease is over. The lease is long, so that
/// a program that stood still for a while is not dropped and discovered anew. Its presence is
/// missed within a second: from then on its endpoints count as unmatched, until it is heard again.
///
/// Silence is counted in ticks of this program, not by a clock: a program that stood still itself
/// does not report all others as dead.
class Peers {
 public:
  /// The first part of an endpoint's id, which is the same for all endpoints of a program.
  using Program = std::array<std::uint8_t, 12>;
  static Program program_of(const WriterId& endpoint);

  static constexpr int kTickMs = 100;
  /// Ticks of silence after which a program counts as gone.
  static constexpr int kSilent = 7;
  /// The same for a program that was never heard: it may not have found our reader yet.
  static constexpr int kSilentAtFirst = 50;
  /// Ticks in which the matches of the session before have to be made again.
  static constexpr int kRestart = 50;

  explicit Peers(std::shared_ptr<Wake> wake) : wake_(std::move(wake)) {}

  // An endpoint of this node and the matches that are made and ended by discovery.
  void add(Ends& ends);
  void remove(Ends& ends);
  void match(Ends& ends, const WriterId& other);
  void unmatch(Ends& ends, const WriterId& other);
  /// This node begins anew on the bus: its matches are to be made again soon, or count as lost.
  void restart(Ends& ends);
  /// Other ends that are gone since the last call, by discovery or by their program's silence.
  std::vector<WriterId> take_lost(Ends& ends);
  /// Ends that were named as lost and are heard again, without a new match, since the last call;
  /// those that are lost once more are not.
  std::vector<WriterId> take_returned(Ends& ends);
  /// True where one of them is matched and not there.
  bool any_absent(const Ends& ends) const;

  // The presence of the others. A program of which none is expected is judged by discovery alone.
  /// Discovery found a program that sends its presence. It is expected from the first match on: a
  /// program that is killed while it joins may never match with its presence.
  void join(const Program& program);
  void leave(const Program& program);
  /// The match with a program's presence is made, or has ended.
  void expect(const Program& program);
  void forget(const Program& program);
  /// Ten times a second, with the programs that were heard since the last time.
  void tick(const std::set<Program>& heard);
  bool absent(const Program& program) const;

 private:
  struct Silence {
    int ticks = 0;
    bool heard = false;
    bool absent = false;
    bool matched = false;  ///< with its presence
  };

  bool is_absent(const Program& program) const;
  void count(Ends& ends) const;
  void change(const Program& program, bool absent);
  void lose_old_matches(Ends& ends);
  bool has_matches(const Program& program) const;

  const std::shared_ptr<Wake> wake_;
  mutable std::mutex mutex_;
  std::set<Ends*> ends_;
  std::multiset<Program> joined_;  ///< by session
  std::map<Program, Silence> programs_;
};

}  // namespace saphira::bus::internal

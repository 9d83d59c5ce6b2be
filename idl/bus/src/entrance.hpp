#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/boot_clock.hpp"

namespace saphira::bus::internal {

/// The participants that want to be let in, by their GUID prefix. Anybody can announce as many as
/// he likes. Fast DDS 2.9 begins a handshake with each, has room for 100, keeps each for as long as
/// it says, and ends by an assertion where there is no room. So only a few wait at a time, each for
/// a short time. Pure bookkeeping: no clock. From any thread.
class Entrance {
 public:
  using Time = BootClock::time_point;
  using Prefix = std::array<std::uint8_t, 12>;
  static Prefix prefix_at(const std::uint8_t* bytes) {
    Prefix prefix{};
    std::copy_n(bytes, prefix.size(), prefix.begin());
    return prefix;
  }

  /// The seal of the site on announcements. Preferred: strangers without it take none of the places
  /// that are kept for those with it, so that these get in whatever the strangers do.
  enum class Seal { unknown, preferred, required };

  /// `seed`: a stranger does not know it.
  explicit Entrance(std::uint64_t seed, Seal seal = Seal::unknown) : seed_(seed), seal_(seal) {}

  /// The treatment of a packet.
  enum class Fate {
    passes,
    waits,  ///< passes; an announcement is good for kLease alone
    drops,
  };
  /// A good seal: its time by the sender's clock, and its age by the clocks of two machines.
  struct Sealed {
    std::chrono::seconds time{0};
    std::chrono::seconds age{0};
  };
  /// `address`: where it comes from.
  Fate announced(const Prefix& prefix, const std::string& address, Time now,
                 std::optional<Sealed> sealed = std::nullopt);
  /// Of a message of a handshake: of one that was not announced nothing passes.
  Fate shakes_hands(const Prefix& prefix, Time now);
  /// Of any other packet.
  Fate sends(const Prefix& prefix, Time now);

  // As Fast DDS reports it.
  void found(const Prefix& prefix);
  void let_in(const Prefix& prefix);
  void refuse(const Prefix& prefix);
  void forget(const Prefix& prefix, Time now);
  bool is_in(const Prefix& prefix) const;
  bool is_refused(const Prefix& prefix) const;
  /// The robot that its permissions are for, as its handshake says [empty: every one].
  void limit(const Prefix& prefix, const std::string& robot);
  std::string robot_of(const Prefix& prefix) const;
  /// Where one that is known was announced from.
  std::string address_of(const Prefix& prefix) const;

  /// Another packet that was dropped. `proof`: they, its senders, do what no member does; empty: of
  /// a member some may be dropped as well, so that only kStranger of them count.
  Fate drop(const std::string& address, Time now, const std::string& proof = {});
  /// In words, the strangers of the last minutes: their addresses, how many packets, since when and
  /// until when. Empty: none.
  std::string strangers(Time now) const;
  /// In words, the strangers that were not named before, for each proof once.
  std::vector<std::string> take_new_strangers();

  /// Those that wait at most: with what Fast DDS keeps of those that were let in it stays below its
  /// limit.
  static constexpr std::size_t kMost = 40;
  /// From this number on, as in an attack, one is admitted when it is heard twice, and waits for
  /// kPatience. Otherwise a program on a busy machine has time for its handshake.
  static constexpr std::size_t kCrowd = 16;
  /// Those without a seal that wait at most where seals are preferred. Strangers who repeat what
  /// others have sealed: from this number of sealed ones that wait on, a seal has to be fresh.
  static constexpr std::size_t kMostUnsealed = 16;
  static constexpr std::size_t kRepeated = 5;
  static constexpr std::chrono::seconds kFresh{600};
  /// A program's seals never go back in time, but the network may swap announcements.
  static constexpr std::chrono::seconds kSwapped{2};
  static constexpr std::chrono::seconds kPatience{3};
  static constexpr std::chrono::seconds kPatienceInPeace{20};
  static constexpr std::chrono::seconds kLease{3};
  /// Between the two times.
  static constexpr std::chrono::milliseconds kTwice{150};
  static constexpr std::chrono::seconds kTwiceAtMost{3};
  /// A participant that was refused, as of another site, is not heard for so long. Of so many.
  static constexpr std::chrono::seconds kRefusal{10};
  static constexpr std::size_t kMostRefused = 1000;
  /// One is a stranger from this number of dropped packets on: a member may lose some. So many
  /// addresses are named, until they have been silent for so long.
  static constexpr std::uint64_t kStranger = 100;
  static constexpr std::size_t kMostAddresses = 8;
  static constexpr std::size_t kMostProofs = 8;  ///< of an address
  static constexpr std::chrono::seconds kSilence{600};

 private:
  struct Known {
    Time since;
    std::string address;
    std::string robot = {};
    int found = 0;  ///< by Fast DDS, which tells when it forgets it; may be found again before
    bool in = false;
    bool refused = false;
    std::optional<std::chrono::seconds> sealed = std::nullopt;  ///< the newest time
  };
  struct Stranger {
    Time first;
    Time last;
    std::uint64_t packets = 0;
    std::map<std::string, bool> proofs;  ///< true: named; "" for kStranger packets
  };
  struct Heard {
    Prefix prefix{};
    Time when;
  };

  Fate fate(const Known& known, Time now) const;
  Fate dropped(const std::string& address, Time now, const std::string& proof = {});
  bool heard_twice(const Prefix& prefix, Time now);
  bool has_place(const Prefix& prefix, Time now, const std::optional<Sealed>& sealed);
  void leave(const Known& known);
  std::chrono::seconds patience(const Known& known) const {
    return waiting_ >= kCrowd && !known.sealed ? kPatience : kPatienceInPeace;
  }

  const std::uint64_t seed_;
  const Seal seal_;
  mutable std::mutex mutex_;
  std::map<Prefix, Known> known_;
  std::size_t waiting_ = 0;         ///< of them, with those that Fast DDS refused and still keeps
  std::size_t sealed_waiting_ = 0;  ///< of these
  std::map<Prefix, Time> refused_;  ///< and forgotten since
  std::map<std::string, Stranger> strangers_;  ///< by address; "" for all others
  std::vector<Heard> heard_ = std::vector<Heard>(8192);
};

}  // namespace saphira::bus::internal

#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "saphira/authority/latches.hpp"
#include "saphira/base/age.hpp"
#include "saphira/base/archived.hpp"
#include "saphira/idl/common.hpp"

namespace saphira::authority {

inline constexpr std::array kRoles{Role::estop, Role::teleop, Role::direct, Role::behaviors};

const char* name(Role role);

/// The part of a motor command that arbitration needs. Times are seconds of the caller's clock: the
/// steady clock live, cycles x 0.1 s in lockstep.
struct Command {
  Role role = Role::none;
  WriterId writer{};
  std::string source;        ///< the driver, for people
  std::uint64_t epoch = 0;   ///< of the robot state that it answers
  std::uint64_t cycle = 0;   ///< the same; 0 from a writer without cycles
  std::uint64_t number = 0;  ///< counts the writer's commands
  bool active = false;       ///< the dead-man: false releases
  bool hand_back = false;    ///< a person's release that lets autonomy drive again
  v1::StopId heeds;          ///< the newest stop that its intent comes after
  double received = 0.0;     ///< [s]
};

struct Settings {
  /// [s] A command drives for this long after its receipt. Later commands extend the lease only
  /// where they answer newer cycles. The lease separates a cut link, or a hanging driver, from a
  /// slow one, so it does not depend on the age of the commands.
  double lease = 0.3;
  /// [s] After a person has driven, autonomy drives again without a hand-back once the person's
  /// program has reported without a pause for this long that it does not drive.
  double quiet = std::numeric_limits<double>::infinity();
  double oldest = kOldest;  ///< [s] a command that answers an older cycle is refused
  /// [s] A person who could not drive for longer, with the lease run out or the bridge deaf, has to
  /// let go before driving on.
  double interruption = 0.5;
};

struct Refusal {
  Role role = Role::none;
  std::string source;
  std::string reason;
  bool operator==(const Refusal&) const = default;
};

struct Grant {
  Role role = Role::none;  ///< none: nobody drives, the robot is to be stopped
  WriterId writer{};
  std::string source;
  std::string reason;       ///< why this driver, or why none
  double expires_in = 0.0;  ///< [s] until the lease of the newest command ends
  /// [s] Of the newest command: the time since the cycle that it answers, or since its receipt for
  /// a writer without cycles.
  double command_age = 0.0;
  bool estopped = false;             ///< an emergency stop is latched
  std::string estop_source;          ///< which program pressed it
  bool waits_for_hand_back = false;  ///< autonomy waits until a person hands the robot back
  v1::StopId stop;                   ///< the newest stop
  std::string stop_source;           ///< who stopped the robot last, also by an emergency stop
  v1::Stamp answers;         ///< the robot state that the newest command answers; cycle 0: none
  std::uint64_t number = 0;  ///< of that command

  /// True where the same writer drives. A change means: stop first, then obey.
  bool same_driver(const Grant& other) const {
    return role == other.role && writer == other.writer;
  }
};

/// Decides who drives the robot: the strongest role whose newest command is younger than its lease.
/// Keeps the offered commands and knows no clock. Refuses, with a reason: a repeated number,
/// another epoch, an answer to an old cycle, a second writer in a role that is held.
///
/// A person does not drive on after an interruption: a longer one than `interruption`, the loss of
/// the writer, or a new connection. The same writer has to let go first. Thus a robot does not jump
/// off when a link comes back.
///
/// A stop (stop()) ends the driving of every writer, in every role, also of those that are refused
/// at that time. A stopped writer does not drive before it has released, or before a command heeds
/// the stop. A command of the behaviors has to heed it: the release of a cycle says nothing about
/// the intent of the next one.
///
/// Three states are latched, over connections and, with latches() and restore(), over a restart:
/// - A stop, as above.
/// - An emergency stop: nobody drives until it is reset. A driver that was active before the reset
///   does not drive after it: a person or a direct driver has to let go first. Autonomy must have
///   come to rest by itself, as it does when its goals end, and no program may have tried to drive
///   just before; otherwise autonomy waits for a hand-back. The behaviors have to heed an emergency
///   stop like any other.
/// - After a person has driven, autonomy waits for a hand-back.
class Arbiter {
 public:
  explicit Arbiter(Settings settings = {}) : settings_(settings) {}

  const Settings& settings() const { return settings_; }

  /// A connection to a robot began (or ended: epoch 0). Earlier grants end.
  void connect(std::uint64_t epoch);
  /// The caller was deaf for a while (stopped, hung, without packets): earlier grants end. Commands
  /// received before `until`, or answering a cycle up to `cycle`, may have waited in a queue and
  /// are refused, with `why` as the reason [empty: the usual one].
  void forget(std::uint64_t cycle, double until, std::string why = {});

  /// Takes a command as it comes, at robot cycle `cycle`. True when it was accepted: it is then the
  /// newest of its role. An accepted command need not drive: see decide().
  bool offer(const Command& command, std::uint64_t cycle);
  /// A writer is gone from the bus: as if it had released its role. An emergency stop stays.
  void lost(Role role, const WriterId& writer, double now);
  /// Refuses a command for a reason that the caller found (such as NaN).
  void refuse(Role role, const std::string& source, const std::string& reason);

  /// Stops every driver. Returns those that asked to move, strongest first, in words.
  std::vector<std::string> stop(const v1::StopId& id, const std::string& source, double now,
                                std::uint64_t cycle);
  /// Releases the emergency stop. Returns the reason where it may not be released, in words; empty
  /// where it is released.
  std::string reset(const std::string& source, double now);
  const Latches& latches() const { return latches_; }
  void restore(const Latches& latches);

  /// The writer that drives now.
  Grant decide(double now, std::uint64_t cycle);

  /// Drivers that were refused since the last call, each role, source and reason once; at most 16.
  std::vector<Refusal> take_refused();
  /// The number of refused commands since the start.
  std::uint64_t refused_count() const { return refused_count_; }

  SAPHIRA_ARCHIVE(epoch_, deaf_cycle_, deaf_until_, deaf_why_, players_, numbers_, offers_,
                  last_stopper_, stop_cycle_, latches_, pressed_, began_pressed_, person_,
                  quiet_since_, quiet_heard_, refused_, refused_count_)

 private:
  /// The writer in a role, by its newest accepted command.
  struct Player {
    bool held = false;
    Command newest;
    double moved_on = 0.0;  ///< [s] receipt of the newest command that answered a newer cycle
  };

  const Player& player(Role role) const { return players_[static_cast<std::size_t>(role)]; }
  Player& player(Role role) { return players_[static_cast<std::size_t>(role)]; }
  void let_go();
  void press(const Command& command);
  bool release(const Command& command, std::uint64_t cycle);
  std::string stale(const Command& command, std::uint64_t cycle) const;
  bool fresh(const Player& p, double now) const;
  bool live(const Player& p, double now, std::uint64_t cycle) const;
  std::string why_not(const Player& p, double now, std::uint64_t cycle) const;
  Role strongest(double now, std::uint64_t cycle) const;
  std::string why_to_stand(Role role) const;
  void end_wait(double now);
  void watch_person(double now, std::uint64_t cycle);
  void must_let_go(const WriterId& person, const char* why);
  std::string why_to_let_go(const Command& command) const;

  Settings settings_;
  std::uint64_t epoch_ = 0;
  std::uint64_t deaf_cycle_ = 0;
  double deaf_until_ = -1e300;
  std::string deaf_why_;
  std::array<Player, 5> players_;
  struct Numbers {
    std::uint64_t newest = 0;
    std::uint64_t used = 0;     ///< the number of that offer
    double newest_at = -1e300;  ///< [s] of an active command, since its newest release
    std::string source;
    // Since its newest release:
    double drove = -1e300;    ///< [s] of a person's program: newest time with a live command
    std::string must_let_go;  ///< why a release has to come before driving [empty: it need not]
    bool stopped = false;     ///< because of the newest stop, which a command may heed instead
  };

  void must_heed(Numbers& said) const;
  void keep_stopped();

  /// Newest number by role and writer. Kept over connections, so that a repeated old command never
  /// drives.
  std::map<std::pair<Role, WriterId>, Numbers> numbers_;
  std::uint64_t offers_ = 0;

  std::string last_stopper_;      ///< of a stop or an emergency stop
  std::uint64_t stop_cycle_ = 0;  ///< of this epoch; a command that answers it was before the stop

  Latches latches_;
  struct Press {
    std::string source;
    double received = 0.0;
  };
  std::map<WriterId, Press> pressed_;  ///< emergency stops that have not been let go
  double began_pressed_ = -1e300;      ///< [s] a direct driver began to ask under an emergency stop
  WriterId person_{};                  ///< the person's program that drove last
  double quiet_since_ = 0.0;           ///< since then it reports that it does not drive
  double quiet_heard_ = -1e300;        ///< its newest such report

  std::vector<Refusal> refused_;
  std::uint64_t refused_count_ = 0;
};

}  // namespace saphira::authority

#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "play.hpp"
#include "saphira/authority/arbiter.hpp"
#include "saphira/bridge/core.hpp"
#include "saphira/protocol/command.hpp"

namespace saphira::bridge::test {

/// The rules of play.hpp. Gets each event before the core, and each output after it.
class Rules {
 public:
  Rules(const CoreSettings& settings, Played& played) : settings_(settings), played_(played) {}

  // ---- Events.
  void at(double now) { now_ = now; }
  void command(const DriveCommand& command);
  void writer_lost(authority::Role role, const authority::WriterId& writer);
  void released(bool latched_now);
  void stopped(const v1::StopId& id);
  void permit(std::uint64_t until) { permit_ = until; }
  void gap();
  /// The core is about to check the time.
  void tick();

  // ---- Outputs.
  void output(const Output& output);
  /// All outputs of one event, or piece of work, are out.
  void settled(const Core& core);
  /// All consequences of an event are out.
  void answered(const Core& core);

 private:
  /// An active command.
  struct Wish {
    double received = 0.0;
    std::uint64_t epoch = 0;
    std::uint64_t cycle = 0;
  };
  using Writer = std::pair<authority::Role, authority::WriterId>;

  double time() const;
  void wrong(const std::string& what);
  void packets(const protocol::Bytes& bytes);
  void command_sent(const protocol::Command& command);
  void moves(const std::string& what);
  bool somebody_drives() const;
  void begins(const v1::Stamp& stamp);

  CoreSettings settings_;
  Played& played_;
  double now_ = 0.0;

  v1::Stamp stamp_;  ///< epoch 0: no session
  std::uint64_t last_epoch_ = 0;
  double last_packet_ = 0.0;
  double good_after_ = 0.0;  ///< [s] commands received before this time are old
  bool silent_ = false;
  bool must_stop_ = false;  ///< zero setpoints are due in the outputs of this event

  std::map<Writer, std::vector<Wish>> wishes_;  ///< of this session, since they were let go
  std::map<Writer, std::uint64_t> numbers_;     ///< the newest
  v1::StopId stop_;                             ///< the newest
  std::set<Writer> must_heed_;                  ///< drove before it, and have not let go since
  bool latched_ = false;
  std::map<authority::WriterId, double> pressed_;
  std::uint64_t permit_ = 0;
  bool answered_ = false;  ///< this cycle, by the behaviors
  bool stepping_ = false;

  // The robot's commands.
  bool zero_velocity_ = false;  ///< since zero setpoints were due first
  bool zero_turn_ = false;
  bool velocity_is_zero_ = true;
  bool turn_is_zero_ = true;
};

}  // namespace saphira::bridge::test

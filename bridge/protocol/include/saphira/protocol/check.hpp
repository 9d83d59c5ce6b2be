#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/protocol/command.hpp"
#include "saphira/protocol/packet.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/server_packet.hpp"

namespace saphira::protocol {

enum class Side : std::uint8_t { kClient, kServer };

/// A violation of the tables, or a remark.
struct Finding {
  enum class Kind : std::uint8_t {
    kViolation,  ///< against the manual or the robots' tables
    kNote,       ///< allowed, and seldom intended
  };
  Kind kind = Kind::kViolation;
  Side side = Side::kClient;
  std::uint64_t offset = 0;  ///< of the packet (or byte) in the bytes sent by this side
  std::string text;
};

/// "client byte 120: violation: ...", without a line break.
std::string to_string(const Finding& finding);

/// Watches the bytes of one line, both ways, and reports deviations from the tables. Strict: it
/// names faults that a good client or server tolerates.
///
/// Keeps the requests, so it finds answers without a question. Bytes must be fed in the order in
/// which they pass. Times are the caller's [s], of any origin; without them the rules about time
/// are left out.
class Checker {
 public:
  /// `find_parameters` gives the parameters of a robot by its identity; may be empty. Without a
  /// result, the rules that need it are left out.
  using FindParameters = std::function<std::optional<RobotParameters>(const RobotIdentity&)>;
  explicit Checker(FindParameters find_parameters = {});

  void feed(Side side, ByteView bytes, std::optional<double> time = std::nullopt);
  /// The connection is closed; a half sent packet is a finding. Offsets go on.
  void disconnect();

  const std::vector<Finding>& findings() const { return findings_; }
  std::size_t violations() const { return violations_; }
  const std::optional<RobotIdentity>& identity() const { return identity_; }

  /// Counts of the packets so far, by command number and by packet type.
  const std::map<std::uint8_t, std::uint64_t>& commands() const { return commands_; }
  const std::map<std::uint8_t, std::uint64_t>& packets() const { return packets_; }
  /// Both counts, and the number of findings, as lines to print.
  std::string summary() const;

 private:
  enum class State { kSync0, kSync1, kSync2, kSynchronized, kOpen };

  // One direction's bytes, cut strictly into packets.
  struct Stream {
    Bytes pending;
    std::uint64_t offset = 0;  // of pending's first byte
  };

  void cut(Side side);
  void junk(Side side, std::size_t count);
  void add(Finding::Kind kind, Side side, std::string text);
  void violation(Side side, std::string text) {
    add(Finding::Kind::kViolation, side, std::move(text));
  }
  void note(Side side, std::string text) { add(Finding::Kind::kNote, side, std::move(text)); }

  void client_packet(ByteView body);
  void command(ByteView body);
  void argument(const CommandRule& rule, ByteView body);
  void remember(const Command& command);
  void server_packet(ByteView body);
  bool sync_answer(ByteView body);
  void information(ByteView body);
  void position(const InformationPacket& packet);
  void device_packet(ByteView body);
  void close();

  FindParameters find_parameters_;
  std::optional<RobotParameters> parameters_;
  std::optional<RobotIdentity> identity_;
  std::array<Stream, 2> streams_;
  std::vector<Finding> findings_;
  std::size_t violations_ = 0;
  std::uint64_t at_ = 0;  // offset of the present packet

  State state_ = State::kSync0;  // of the client's side
  int echoes_due_[3] = {0, 0, 0};
  int after_close_ = 0;  // information packets since CLOSE
  bool closed_ = false;
  std::optional<double> time_;
  std::optional<double> last_command_;  // when
  bool silent_ = false;                 // already reported
  std::optional<InformationPacket> last_;
  std::optional<double> last_packet_;
  struct Asked {
    bool with_each = false;
    int once = 0;
  };
  std::map<PacketType, Asked> asked_;
  std::map<std::uint8_t, std::uint64_t> commands_;
  std::map<std::uint8_t, std::uint64_t> packets_;
};

}  // namespace saphira::protocol

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

/// Something that the tables do not allow, or that is worth a look.
struct Finding {
  enum class Kind : std::uint8_t {
    kViolation,  ///< against the manual or the robots' tables
    kNote,       ///< allowed, and seldom meant
  };
  Kind kind = Kind::kViolation;
  Side side = Side::kClient;
  std::uint64_t offset = 0;  ///< of the packet (or byte) in what this side has sent
  std::string text;
};

/// "client byte 120: violation: ...", without a line break.
std::string to_string(const Finding& finding);

/// Watches the bytes of one line, both ways, and says what of it is not as the tables say. Strict:
/// where a good client or server bears with the other's fault, this one names it.
///
/// It knows what was asked for, so it finds answers without a question. Bytes must be fed in the
/// order in which they pass. Times are the caller's [s], of any origin; rules about time are left
/// out where he gives none.
class Checker {
 public:
  /// `find_parameters` says what a robot that calls itself so is like; may be empty. Without an
  /// answer, the rules that need it are left out.
  using FindParameters = std::function<std::optional<RobotParameters>(const RobotIdentity&)>;
  explicit Checker(FindParameters find_parameters = {});

  void feed(Side side, ByteView bytes, std::optional<double> time = std::nullopt);
  /// The connection is closed; what was half sent is a finding. Offsets go on.
  void disconnect();

  const std::vector<Finding>& findings() const { return findings_; }
  std::size_t violations() const { return violations_; }
  const std::optional<RobotIdentity>& identity() const { return identity_; }

  /// The counts of what has passed, by command's number and packet's type.
  const std::map<std::uint8_t, std::uint64_t>& commands() const { return commands_; }
  const std::map<std::uint8_t, std::uint64_t>& packets() const { return packets_; }
  /// Both of them, and the number of findings, as lines to print.
  std::string summary() const;

 private:
  enum class State { kSync0, kSync1, kSync2, kSynchronized, kOpen };

  // One direction's bytes, cut into packets without mercy.
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
  std::uint64_t at_ = 0;  // offset of what is looked at

  State state_ = State::kSync0;  // of the client's side
  int echoes_due_[3] = {0, 0, 0};
  int after_close_ = 0;  // information packets since CLOSE
  bool closed_ = false;
  std::optional<double> time_;
  std::optional<double> last_command_;  // when
  bool silent_ = false;                 // has been said
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

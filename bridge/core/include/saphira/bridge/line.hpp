#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "saphira/base/archived.hpp"
#include "saphira/protocol/impossible.hpp"

namespace saphira::bridge {

/// The quality of the line to the robot: damaged packets among the newest, and losses while it
/// moved. Outlives sessions. Pure; times are seconds of the caller's clock.
class Line {
 public:
  /// A session begins, with its count of damaged packets at 0.
  void begin() { damaged_ = 0; }
  /// A whole packet came, `gap` [s] after the one before; `damaged` counts the session's damaged
  /// packets. `moved`: the robot was told to move meanwhile. True where the robot has to stand for
  /// a while: repeatedly it was not heard after it began to move.
  bool packet(std::uint64_t damaged, double gap, bool moved, double now);
  /// The session ends, `gap` [s] after its last whole packet.
  void end(double gap, bool moved, double now) { listen(gap, moved, now); }
  /// Damaged packets without a whole one.
  void damage(std::uint64_t damaged);

  /// True where one packet in ten is damaged, or more.
  bool bad() const;
  /// Such as "the line to the robot is bad: 12 of its last 50 packets were damaged (...)".
  std::string words() const;
  /// Nobody drives before this time.
  double stands_until() const { return stands_until_; }
  std::string why_it_stands(double now) const;

  SAPHIRA_ARCHIVE(newest_, count_, next_, damaged_, heard_moving_, unheard_, stands_until_)

 private:
  static constexpr std::size_t kWindow = 50;
  void add(bool damaged);
  bool listen(double gap, bool moved, double now);
  std::size_t damaged_in_window() const;
  std::string damaged_words() const;

  std::array<bool, kWindow> newest_{};  ///< damaged
  std::size_t count_ = 0;               ///< of them, at most kWindow
  std::size_t next_ = 0;
  std::uint64_t damaged_ = 0;
  int heard_moving_ = 0;  ///< whole packets since it began to move
  int unheard_ = 0;       ///< starts of motion in a row without a packet
  double stands_until_ = 0.0;
};

/// Keeps the robot's impossible values, for the counter, the status and the log.
class Doubts {
 public:
  /// For a new connection.
  void reset() { *this = {}; }
  void add(const protocol::Impossible& impossible, double now);

  std::uint64_t count() const { return count_; }
  /// The newest doubt of the last seconds; empty: none.
  std::string newest(double now) const;
  /// New doubts, each once, and no more often than a person can read.
  std::optional<std::string> take_words(double now);

  SAPHIRA_ARCHIVE(count_, newest_, at_, news_, told_)

 private:
  std::uint64_t count_ = 0;
  std::string newest_;
  double at_ = 0.0;
  bool news_ = false;
  double told_ = -1e9;
};

}  // namespace saphira::bridge

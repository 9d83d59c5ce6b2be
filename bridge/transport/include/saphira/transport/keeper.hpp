#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "saphira/base/boot_clock.hpp"

namespace saphira::transport {

/// A second process (saphira-keeper) that holds a copy of the link to the robot and listens to the
/// bridge's heart. When the bridge falls silent (stopped, hung, killed) it sends the stop packets
/// to the robot by itself, again and again, until it hears the bridge. It ends with the bridge,
/// after stopping the robot.
///
/// One that dies or hangs is replaced, at most once a second.
class Keeper {
 public:
  /// `silence`: how long the bridge may be silent; `program`: empty for the one beside this
  /// program. std::runtime_error where it cannot be started.
  explicit Keeper(std::chrono::milliseconds silence = std::chrono::milliseconds(300),
                  std::string program = {});
  ~Keeper();
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

  /// The robot is behind this descriptor from now on, of which the keeper gets a copy; `stop`: the
  /// packets that stop it, at most 64 bytes.
  void watch(int fd, std::vector<std::uint8_t> stop);
  /// There is no robot any more, or it needs no keeping (it is single-stepped).
  void unwatch();
  /// The bridge is alive. Cheap; at least three times as often as the silence allows.
  void beat();
  /// False while there is none that answers.
  bool alive() const { return alive_; }
  /// How often one has been replaced.
  int restarts() const { return restarts_; }
  int pid() const { return pid_; }

 private:
  std::string start();
  void end();
  bool send(char word, int fd, const std::vector<std::uint8_t>& rest = {});
  void hear();

  std::chrono::milliseconds silence_;
  std::string program_;
  int socket_ = -1;
  int pid_ = -1;
  bool alive_ = false;
  int unanswered_ = 0;  ///< heartbeats
  int restarts_ = 0;
  BootClock::time_point started_;
  int watched_ = -1;
  std::vector<std::uint8_t> stop_;
  bool told_ = true;  ///< whether the keeper knows what is watched
};

/// The keeper's process: hears the bridge on this socket, and ends with it.
inline constexpr int kKeeperSocket = 3;
[[noreturn]] void keep(int socket, std::chrono::milliseconds silence);

}  // namespace saphira::transport

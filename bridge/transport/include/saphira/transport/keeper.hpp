#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "saphira/base/boot_clock.hpp"
#include "saphira/base/descriptor.hpp"

namespace saphira::transport {

/// A second process (saphira-keeper) that holds a copy of the link to the robot and listens to the
/// bridge's heartbeats. When the bridge falls silent (stopped, hung, killed) the keeper repeats the
/// stop packets to the robot until it hears the bridge. It ends with the bridge, after stopping the
/// robot.
///
/// A dead or hanging keeper is replaced, at most once a second.
class Keeper {
 public:
  /// `silence`: the tolerated silence of the bridge; `program`: empty for the keeper beside this
  /// program. std::runtime_error where it cannot be started.
  explicit Keeper(std::chrono::milliseconds silence = std::chrono::milliseconds(300),
                  std::string program = {});
  ~Keeper();
  Keeper& operator=(Keeper&&) = delete;

  /// The robot is behind this descriptor from now on, and the keeper gets a copy of it; `stop`: the
  /// packets that stop the robot, at most 64 bytes.
  void watch(int fd, std::vector<std::uint8_t> stop);
  /// There is no robot any more, or it needs no keeper (it is single-stepped).
  void unwatch();
  /// The bridge is alive. Cheap; at least three times as often as the silence allows.
  void beat();
  /// False while no keeper answers.
  bool alive() const { return alive_; }
  /// Number of replacements.
  int restarts() const { return restarts_; }
  int pid() const { return pid_; }

 private:
  std::string start();
  void end();
  bool send(char word, int fd, const std::vector<std::uint8_t>& rest = {});
  void hear();

  std::chrono::milliseconds silence_;
  std::string program_;
  Descriptor socket_;
  int pid_ = -1;
  bool alive_ = false;
  int unanswered_ = 0;  ///< heartbeats
  int restarts_ = 0;
  BootClock::time_point started_;
  int watched_ = -1;
  std::vector<std::uint8_t> stop_;
  bool told_ = true;  ///< true: the keeper knows the watched descriptor
};

/// The keeper's process: hears the bridge on this socket, and ends with it.
inline constexpr int kKeeperSocket = 3;
[[noreturn]] void keep(int socket, std::chrono::milliseconds silence);

}  // namespace saphira::transport

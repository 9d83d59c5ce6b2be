#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

namespace saphira::transport {

/// A second process that holds a copy of the link to the robot and listens to the bridge's heart.
/// When the bridge falls silent (stopped, hung, killed) it sends the stop packets to the robot by
/// itself, again and again, until it hears the bridge. It ends with the bridge, after stopping the
/// robot.
///
/// It is forked, so make it before the process has a second thread.
class Keeper {
 public:
  /// `stop`: the packets that stop the robot; `silence`: how long the bridge may be silent.
  /// std::runtime_error where no process can be made.
  explicit Keeper(const std::vector<std::uint8_t>& stop,
                  std::chrono::milliseconds silence = std::chrono::milliseconds(300));
  ~Keeper();
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

  /// The robot is behind this descriptor from now on; the keeper gets a copy.
  void watch(int fd);
  /// There is no robot any more, or it needs no keeping (it is single-stepped).
  void unwatch();
  /// The bridge is alive. Cheap; at least three times as often as the silence allows.
  void beat();
  /// False once the keeper is gone.
  bool alive() const { return alive_; }
  int pid() const { return pid_; }

 private:
  bool send(char word, int fd);

  int socket_ = -1;
  int pid_ = -1;
  bool alive_ = false;
  int watched_ = -1;
  bool told_ = true;  ///< whether the keeper knows what is watched
};

}  // namespace saphira::transport

#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace saphira::test {

/// A serial line between a robot server, which listens on a local socket, and a pseudo-terminal
/// that a bridge opens. Each way has the real speed: ten bits a byte. A robot that is switched off
/// (its socket is gone) is silent, as behind a real line, and returns when it is switched on.
class SerialLine {
 public:
  /// `device`: the path of the pseudo-terminal, a symbolic link. `baud` 0: not paced.
  SerialLine(std::string device, std::string robot_socket, int baud = 9600);
  ~SerialLine();

  /// True where the robot is switched on. Bytes sent before that are lost, perhaps half a packet.
  bool has_robot();
  /// The cable out of its socket: no byte passes either way, without a signal to either side.
  void cut(bool out) { cut_ = out; }

  /// Bytes that went through, to and from the robot.
  std::uint64_t to_robot() const { return bytes_[0]; }
  std::uint64_t from_robot() const { return bytes_[1]; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Direction {
    std::deque<std::uint8_t> waiting;
    Clock::time_point due;  ///< time at which the first of them has passed
  };

  void run();
  void open_device();
  void close_device();
  bool take(int fd, int direction);
  bool give(int fd, int direction);

  std::string device_;
  std::string socket_;
  std::chrono::nanoseconds byte_;
  std::mutex mutex_;  ///< of the following members
  int master_ = -1;
  bool listened_ = false;  ///< the device is open
  int robot_ = -1;
  Direction directions_[2];  ///< to the robot, from it
  std::atomic<bool> cut_{false};
  std::atomic<std::uint64_t> bytes_[2]{0, 0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace saphira::test

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
/// that a bridge opens. Each way is as slow as the real thing: ten bits a byte. A robot that is
/// switched off (its socket is gone) is just silent, as behind a real line, and is there again when
/// it is.
class SerialLine {
 public:
  /// `device`: where the pseudo-terminal is to be found, a symbolic link. `baud` 0: not paced.
  SerialLine(std::string device, std::string robot_socket, int baud = 9600);
  ~SerialLine();
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;

  /// True where the robot is switched on. Before, what is sent to it is lost, and then perhaps half
  /// a packet.
  bool has_robot();
  /// The cable out of its socket: nothing comes through either way, and nobody is told.
  void cut(bool out) { cut_[0] = cut_[1] = out; }
  /// Only what the robot says is lost.
  void cut_from_robot(bool out) { cut_[1] = out; }

  /// Bytes that went through, to and from the robot.
  std::uint64_t to_robot() const { return bytes_[0]; }
  std::uint64_t from_robot() const { return bytes_[1]; }
  /// The most bytes that ever waited for the line to take them.
  std::uint64_t waited_to_robot() const { return waited_[0]; }
  std::uint64_t waited_from_robot() const { return waited_[1]; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Direction {
    std::deque<std::uint8_t> waiting;
    Clock::time_point due;  ///< when the first of them has gone through
  };

  void run();
  void open_device();
  void close_device();
  bool take(int fd, int direction);
  bool give(int fd, int direction);

  std::string device_;
  std::string socket_;
  std::chrono::nanoseconds byte_;
  std::mutex mutex_;  ///< of what follows
  int master_ = -1;
  bool listened_ = false;  ///< whether somebody has the device open
  int robot_ = -1;
  Direction directions_[2];  ///< to the robot, from it
  std::atomic<bool> cut_[2]{false, false};
  std::atomic<std::uint64_t> bytes_[2]{0, 0};
  std::atomic<std::uint64_t> waited_[2]{0, 0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace saphira::test

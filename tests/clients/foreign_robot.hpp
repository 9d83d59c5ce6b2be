#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "saphira/protocol/check.hpp"

namespace saphira::test {

/// A third-party robot server, after AMRISim's behavior with a Pioneer 3 DX: it listens on a TCP
/// port, sends 0x32 at rest and in motion, sends all sixteen sonars in every packet of 89 bytes,
/// has no watchdog, accepts one client, and ignores unknown commands. It drives on an empty plane.
class ForeignRobot {
 public:
  ForeignRobot();
  ~ForeignRobot();
  ForeignRobot(const ForeignRobot&) = delete;
  ForeignRobot& operator=(const ForeignRobot&) = delete;

  int port() const { return port_; }
  double velocity() const { return velocity_; }  ///< [mm/s]
  double rotation() const { return rotation_; }  ///< [deg/s]
  double x() const { return x_; }                ///< [mm]
  bool motors() const { return motors_; }
  /// Changes the body of each following information packet before it is sent; the checker gets the
  /// unchanged packet.
  void spoil(std::function<void(std::vector<std::uint8_t>&)> how);
  /// Bytes outside of packets, and the strict checker's findings on both sides.
  std::string trouble() const;

 private:
  void run();
  void handle(const std::vector<std::uint8_t>& body);
  std::vector<std::uint8_t> information() const;
  void watch(protocol::Side side, const std::vector<std::uint8_t>& bytes);
  void inform();
  void send(const std::vector<std::uint8_t>& body);
  void put(const std::vector<std::uint8_t>& bytes) const;

  int listener_ = -1;
  int client_ = -1;
  int port_ = 0;
  std::atomic<bool> stop_{false};
  std::atomic<bool> open_{false};
  std::atomic<bool> motors_{false};
  std::atomic<double> velocity_{0.0};
  std::atomic<double> rotation_{0.0};
  std::atomic<double> x_{0.0};
  std::atomic<double> th_{0.0};
  double y_ = 0.0;
  double heading_ = 0.0;
  bool heads_ = false;
  int syncs_ = 0;
  mutable std::mutex mutex_;
  std::function<void(std::vector<std::uint8_t>&)> spoil_;
  std::string trouble_;
  protocol::Checker checker_;
  std::thread thread_;
};

}  // namespace saphira::test

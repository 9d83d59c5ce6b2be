#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/idl/robot.hpp"
#include "saphira/idl/vision.hpp"
#include "saphira/protocol/packet.hpp"
#include "saphira/protocol/server_packet.hpp"

namespace saphira::bridge {

/// A Fast Track vision system (manual 9.1): repeats its commands until packets come, and publishes
/// these.
class Camera {
 public:
  /// `words`: the commands, such as "pioneer_a_mode=2".
  Camera(bus::Node& node, std::vector<std::string> words);

  /// A setting that has been sent: it takes the place of an earlier one of the same name when the
  /// commands are repeated.
  void keep(const std::string& text);
  /// A session begins.
  void connect();
  /// The robot's cycle `cycle` begins: returns the commands to the camera. A command may be lost on
  /// a serial line, so it is repeated where no packet comes.
  std::vector<protocol::Bytes> begin(std::uint64_t cycle);
  /// Of the last second, at begin().
  std::uint16_t packets_per_s() const { return static_cast<std::uint16_t>(packets_.size()); }
  /// A packet came while `state` was the robot's newest.
  void packet(const protocol::VisionPacket& packet, const v1::RobotState& state);

 private:
  std::vector<std::string> words_;
  bus::Writer<v1::VisionChannels> channels_;
  std::uint64_t asked_ = 0;            ///< cycle of the newest commands; 0: none yet
  std::deque<std::uint64_t> packets_;  ///< cycles of those of the last second
};

}  // namespace saphira::bridge

#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "base/shell/processes.hpp"
#include "saphira/bus/cycle.hpp"
#include "saphira/vision/vision.hpp"
#include "vision/shell/pictures.hpp"

namespace saphira::vision {

struct ShellOptions {
  std::string stereo_socket;  ///< where stereo pictures come from; empty: nowhere
  ColorCamera camera;         ///< of the channels
};

/// The vision service on the bus. To be made and run in one thread.
class Shell {
 public:
  explicit Shell(bus::Node& node, const ShellOptions& options = {});

  /// Steps until stop is requested.
  void run(const bus::Stop& stop) {
    while (step(stop)) {
    }
  }
  /// Waits for one cycle and steps it; false when stop was requested.
  bool step(const bus::Stop& stop);

 private:
  /// Where the robot was in a cycle.
  struct Place {
    std::uint64_t cycle = 0;
    Pose pose_in_odom;
  };

  void look(std::uint64_t cycle);
  void look_at_colors(const v1::RobotState& robot, const bus::Stop& stop);
  void tell_of_pictures();

  bus::Node& node_;
  ProcessTable table_;
  Process& stereo_ = table_.add("find-people", "looks for people in the stereo pictures");
  Process& colors_ = table_.add("find-colors", "places what the camera's channels show");
  bus::Cycle cycle_;
  bus::Reader<v1::VisionChannels> channels_;
  bus::Writer<v1::Vision> writer_;
  ProcessesOnBus processes_;
  Pictures pictures_;
  Vision vision_;
  std::deque<Place> places_;              ///< of the last cycles
  std::deque<v1::VisionChannels> newer_;  ///< channels of cycles that are still to be stepped
  std::optional<std::uint64_t> odom_;     ///< of the newest step
  std::uint64_t picture_ = 0;             ///< cycle of the newest one that was looked at
  std::uint64_t color_ = 0;               ///< cycle of the newest channels
  std::string told_;                      ///< of what has happened to the pictures
};

}  // namespace saphira::vision

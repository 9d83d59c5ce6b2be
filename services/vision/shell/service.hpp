#pragma once

#include <string>
#include <vector>

#include "saphira/runtime/component.hpp"
#include "saphira/vision/core.hpp"
#include "vision/shell/pictures.hpp"

namespace saphira::vision {

struct Options {
  std::string stereo_socket;  ///< the source of stereo pictures; empty: none
  ColorCamera camera;         ///< of the channels
};

runtime::Component component();

/// The vision service on the bus.
class Service final : public runtime::Service {
 public:
  Service(runtime::Ports& ports, const Options& options);

  ProcessTable& processes() override { return core_->processes(); }
  void step(const runtime::Turn& turn) override;
  std::string save() const override { return saved(*core_); }
  void restore(std::string_view state) override { renew(core_, state, camera_); }

 private:
  void take_channels(std::uint64_t epoch);
  std::string missing(const v1::RobotState& state);

  runtime::Ports& ports_;
  bool stereo_;  ///< there is a socket for pictures
  bus::Reader<v1::VisionChannels> channels_;
  runtime::Output<v1::Vision> output_;
  Pictures pictures_;
  ColorCamera camera_;
  std::optional<Core> core_;
  std::uint64_t epoch_ = 0;       ///< of the newest step
  std::vector<Core::Seen> seen_;  ///< since then
};

}  // namespace saphira::vision

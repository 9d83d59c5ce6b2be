#pragma once

#include <optional>
#include <string>

#include "saphira/registration/core.hpp"
#include "saphira/runtime/component.hpp"
#include "saphira/runtime/saver.hpp"

namespace saphira::registration {

struct Options {
  std::string map_file;  ///< a map file, or the name of a shipped one; "none", empty: no map
  /// The robot's start pose: as in start_pose.
  std::string start = "start";
  std::string memory_file;                          ///< the memory over a restart; empty: none
  std::optional<bool> add_features = std::nullopt;  ///< as Core::Settings has it
  bool snap = true;                                 ///< the same
};

runtime::Component component();

/// The registration service on the bus.
class Service final : public runtime::Service {
 public:
  /// Throws FileError, std::runtime_error or std::invalid_argument for wrong options or files.
  Service(runtime::Ports& ports, const Options& options);
  Service(runtime::Ports& ports, const Core::Settings& settings, std::string memory_file = "");

  const Core& core() const { return *core_; }

  ProcessTable& processes() override { return core_->processes(); }
  void step(const runtime::Turn& turn) override;
  void between(double silence) override;
  std::string save() const override { return saved(*core_); }
  void restore(std::string_view state) override { renew(core_, state, settings_); }

 private:
  void publish_map();
  void remember();

  runtime::Ports& ports_;
  std::string memory_file_;
  bus::Input<v1::Perception>& perception_;
  runtime::Output<v1::Registration> registrations_;
  runtime::Output<v1::FloorMap> maps_;
  Desk& requests_;
  Core::Settings settings_;
  std::optional<Core> core_;
  runtime::Saver saver_;
  std::optional<std::uint64_t> published_;  ///< revision of the map
};

}  // namespace saphira::registration

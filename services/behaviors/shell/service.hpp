#pragma once

#include <optional>
#include <string>
#include <vector>

#include "saphira/behaviors/core.hpp"
#include "saphira/behaviors/folder.hpp"
#include "saphira/runtime/component.hpp"

namespace saphira::behaviors {

struct Options {
  /// Behaviors that cover shipped ones of the same name; empty: none.
  std::string folder;
  std::vector<std::string> plugins;  ///< files, see plugin.hpp
};

runtime::Component component();

/// The behaviors service on the bus.
class Service final : public runtime::Service {
 public:
  /// std::runtime_error where a plug-in, or the shipped behaviors, cannot be loaded at all.
  Service(runtime::Ports& ports, const Options& options);

  ProcessTable& processes() override { return core_->processes(); }
  void step(const runtime::Turn& turn) override;
  void check_files() override;
  std::string save() const override { return saved(*core_); }
  void restore(std::string_view state) override { renew(core_, state, registry_); }

 private:
  std::optional<double> command_age(const runtime::Turn& turn);

  runtime::Ports& ports_;
  bus::Input<v1::Intentions>& intentions_;
  std::optional<bus::Reader<v1::Grant>> grants_;  ///< none in lockstep: there is no delay
  runtime::Output<v1::MotorCommand> commands_;
  runtime::Output<v1::BehaviorSet> behaviors_;
  runtime::Output<v1::BehaviorSet> recall_;
  runtime::Output<v1::BehaviorSchemas> schemas_;
  std::optional<Core> core_{std::in_place};
  Sources sources_;
  Registry registry_;     ///< of the sources
  bool changed_ = false;  ///< since the last step
  bool looked_ = false;
};

}  // namespace saphira::behaviors

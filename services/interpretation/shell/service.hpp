#pragma once

#include "saphira/interpretation/core.hpp"
#include "saphira/runtime/component.hpp"

namespace saphira::interpretation {

runtime::Component component();

/// The interpretation service on the bus.
class Service final : public runtime::Service {
 public:
  explicit Service(runtime::Ports& ports);

  ProcessTable& processes() override { return core_->processes(); }
  void step(const runtime::Turn& turn) override;
  std::string save() const override { return saved(*core_); }
  void restore(std::string_view state) override { renew(core_, state); }

 private:
  runtime::Output<v1::Perception> perceptions_;
  runtime::Output<v1::GridTile> tiles_;
  std::optional<Core> core_{std::in_place};
};

}  // namespace saphira::interpretation

#pragma once

#include "saphira/interpretation/core.hpp"
#include "saphira/runtime/component.hpp"

namespace saphira::interpretation {

runtime::Component component();

/// The interpretation service on the bus.
class Service final : public runtime::Service {
 public:
  explicit Service(runtime::Ports& ports);

  ProcessTable& processes() override { return core_.processes(); }
  void step(const runtime::Turn& turn) override;

 private:
  runtime::Output<v1::Perception> perceptions_;
  runtime::Output<v1::GridTile> tiles_;
  Core core_;
};

}  // namespace saphira::interpretation

// A behavior file: it compiles or there are messages; a compiled behavior runs, with finite
// outputs.

#include <cmath>
#include <vector>

#include "fuzz.hpp"
#include "saphira/behaviors/executive.hpp"
#include "saphira/behaviors/language.hpp"

namespace {

using namespace saphira;
using namespace saphira::behaviors;

Intended intended(const Schema& schema) {
  Intended wanted{schema.name, schema.name, 0, true, {}};
  for (const ParameterSpec& spec : schema.parameters)
    if (spec.kind == Kind::point && spec.required)
      wanted.parameters.push_back(
          {spec.name, saphira::PlacedPoint{{1.0, 2.0, 0.5}, saphira::Frame::robot}});
    else if (spec.kind == Kind::number && spec.required)
      wanted.parameters.push_back({spec.name, spec.low / 2.0 + spec.high / 2.0});
  return wanted;
}

}  // namespace

void saphira::fuzz::run(std::string_view text) {
  Compiled compiled = compile(text, "fuzz.beh");
  for (const std::vector<FileError>* messages : {&compiled.errors, &compiled.warnings})
    for (const FileError& message : *messages)
      require(message.line() >= 1 && message.column() >= 1);
  if (!compiled.errors.empty()) {
    require(compiled.schemas.empty());
    return;
  }
  RobotModel model;
  model.lps.sonars.push_back({0, {0.1, 0.0, 0.0}});
  Registry registry;
  Intent intent{0, true, {}};
  for (Schema& schema : compiled.schemas) {
    intent.behaviors.push_back(intended(schema));
    registry.add(std::move(schema));
  }
  Executive executive(std::move(registry), model);
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle) {
    Inputs inputs;
    inputs.cycle = cycle;
    inputs.robot = {{0.1 * static_cast<double>(cycle), 0.0, 0.3}, 0.2, 0.1};
    inputs.sonars = {{0, 0.8, true}};
    intent.cycle = cycle;
    inputs.intent = &intent;
    const Output output = executive.step(inputs);
    require(std::isfinite(output.speed) && std::isfinite(output.heading_in_odom));
  }
}

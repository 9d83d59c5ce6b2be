// A behavior file: it compiles or there are messages; a compiled behavior runs, with finite
// outputs.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

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

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Compiled compiled = compile(text, "fuzz.beh");
  for (const std::vector<FileError>* messages : {&compiled.errors, &compiled.warnings})
    for (const FileError& message : *messages)
      if (message.line() < 1 || message.column() < 1)
        std::abort();
  if (!compiled.errors.empty()) {
    if (!compiled.schemas.empty())
      std::abort();
    return 0;
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
    if (!std::isfinite(output.speed) || !std::isfinite(output.heading_in_odom))
      std::abort();
  }
  return 0;
}

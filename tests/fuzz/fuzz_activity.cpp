// A file of activities: it compiles or has errors with their place, and compiled activities run for
// any time without harm. The same bytes as a value of a belief.

#include "fuzz.hpp"
#include "saphira/intentions/executor.hpp"
#include "saphira/intentions/functors.hpp"
#include "saphira/intentions/language.hpp"
#include "saphira/intentions/navigation.hpp"

using namespace saphira::intentions;

namespace {

void run(const Loaded& loaded) {
  Registry registry = built_in();
  Inputs inputs;
  inputs.epoch = 1;
  inputs.robot.connected = true;
  inputs.robot.odom = 1;
  for (const Schema& schema : loaded.schemas) {
    GoalEvent event;
    event.goal.id = {1, inputs.events.size() + 1};
    event.goal.functor = schema.name;
    for (const Parameter& parameter : schema.parameters) {
      if (parameter.any || parameter.kind == saphira::ArgumentKind::text)
        event.goal.arguments.push_back(saphira::text(parameter.name, "x"));
      else if (parameter.kind == saphira::ArgumentKind::number)
        event.goal.arguments.push_back(saphira::number(parameter.name, parameter.low));
      else
        event.goal.arguments.push_back(
            saphira::point(parameter.name, {1.0, 2.0, 0.5}, saphira::Frame::robot));
    }
    event.goal.priority = static_cast<int>(inputs.events.size());
    inputs.events.push_back(event);
    registry.add(schema);
  }
  ExecutorOptions options;
  options.forest.max_intentions = 300;
  options.forest.max_begun = 50;
  Executor executor(std::move(registry), {}, options);
  for (int i = 0; i < 30; ++i) {
    ++inputs.cycle;
    inputs.robot.pose_in_odom.x += 0.03;
    inputs.robot.left_stalled = i % 7 == 3;
    const Outputs out = executor.step(inputs);
    inputs.events.clear();
    inputs.behaviors.clear();
    inputs.behaviors_cycle = inputs.cycle;
    for (const IntendedBehavior& behavior : out.behaviors)
      inputs.behaviors.push_back({behavior.name, i % 5 == 0 ? 1.0 : 0.5, 0.0});
    saphira::fuzz::require(out.nodes.size() <= 302);
    for (const Belief& belief : executor.beliefs().all())
      to_text(belief.value);
  }
}

}  // namespace

void saphira::fuzz::run(std::string_view content) {
  static const Functions kFunctions = [] {
    Functions all = core_functions();
    add_navigation(all);
    return all;
  }();
  static const Registry kBuiltIn = built_in();
  const Loaded loaded = load_activities({{"fuzz.act", std::string(content)}}, kFunctions, kBuiltIn);
  for (const Diagnostic& trouble : loaded.troubles) {
    require(trouble.line >= 1 && trouble.column >= 1 && !trouble.message.empty());
    static_cast<void>(trouble.text());
  }
  require(loaded.ok() || loaded.schemas.empty());
  if (!loaded.schemas.empty())
    ::run(loaded);
  reads([&] {
    const Value value = parse_value(content);
    require(value == parse_value(to_text(value)));
  });
}

#include "agent_interface/shell/convert.hpp"

#include "requests/shell/convert.hpp"
#include "saphira/base/namesakes.hpp"
#include "saphira/bus/agent.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kUnlimited = 1e12;

Parameter from_bus(const v1::CapabilityParameter& parameter) {
  auto result = translated<Parameter>(parameter);
  result.kind = saphira::from_bus(parameter.kind);
  result.frame = saphira::from_bus(parameter.frame);
  const bool limited = parameter.low != 0.0 || parameter.high != 0.0;
  result.low = limited ? parameter.low : -kUnlimited;
  result.high = limited ? parameter.high : kUnlimited;
  return result;
}

}  // namespace

AgentInfo from_bus(const v1::Agent& agent) {
  AgentInfo result{agent.id, agent.name, bus::agent_address(agent.id, agent.name), {}};
  for (const v1::Capability& one : agent.capabilities) {
    Capability capability{{one.functor, one.summary, {}}, one.acts, one.cost};
    for (const v1::CapabilityParameter& parameter : one.parameters)
      capability.functor.parameters.push_back(from_bus(parameter));
    result.capabilities.push_back(std::move(capability));
  }
  return result;
}

Trigger from_bus(const v1::Trigger& trigger) {
  return {{trigger.id.writer, trigger.id.number},
          trigger.source,
          kPairs<TriggerKind, v1::TriggerKind>.ours(trigger.kind, TriggerKind::event),
          trigger.period,
          trigger.condition,
          saphira::from_bus(trigger.condition_arguments),
          trigger.action,
          saphira::from_bus(trigger.action_arguments),
          trigger.times,
          std::nullopt};
}

v1::Advice to_bus(const Advice& advice) {
  auto result = translated<v1::Advice>(advice);
  result.functor = describe(advice.kind);
  result.arguments = {bus::text("about", advice.about), bus::text("value", advice.value)};
  result.words = describe(advice);
  return result;
}

}  // namespace saphira::agent_interface

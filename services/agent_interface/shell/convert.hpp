#pragma once

#include "saphira/agent_interface/facilitator.hpp"
#include "saphira/agent_interface/knowledge.hpp"
#include "saphira/idl/agents.hpp"

/// Conversions between the bus and plain types: pure functions.
namespace saphira::agent_interface {

AgentInfo from_bus(const v1::Agent& agent);
Trigger from_bus(const v1::Trigger& trigger);
v1::Advice to_bus(const Advice& advice);

}  // namespace saphira::agent_interface

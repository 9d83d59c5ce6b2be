#pragma once

#include "saphira/behaviors/executive.hpp"
#include "saphira/idl/behavior.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/idl/motion.hpp"
#include "saphira/idl/robot.hpp"

/// Conversions between the types of the bus and those of the library: pure functions.
namespace saphira::behaviors {

RobotModel from_bus(const v1::RobotDescription& description);
RobotNow from_bus(const v1::RobotState& state);
Intent from_bus(const v1::Intentions& intentions);

v1::BehaviorState to_bus(const BehaviorState& state);
/// The behaviors sample; its stamp is the caller's.
v1::BehaviorSet to_bus(const Output& output);
v1::BehaviorSchema to_bus(const Schema& schema);
/// All schemas of a registry; the stamp is the caller's.
v1::BehaviorSchemas to_bus(const Registry& registry, const std::string& trouble);
/// The motor command; its stamp, source and number are the caller's.
v1::MotorCommand command_to_bus(const Output& output);

}  // namespace saphira::behaviors

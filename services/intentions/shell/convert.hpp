#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "saphira/bus/endpoint.hpp"
#include "saphira/idl/behavior.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/idl/map.hpp"
#include "saphira/idl/motion.hpp"
#include "saphira/idl/perception.hpp"
#include "saphira/idl/robot.hpp"
#include "saphira/idl/system.hpp"
#include "saphira/idl/vision.hpp"
#include "saphira/intentions/core.hpp"
#include "saphira/lps/percept.hpp"

namespace saphira::intentions {

/// Conversions between the types of the bus and those of the library. An enumerator outside of the
/// contract becomes the value that is refused, or the cautious one.

Goal from_bus(const v1::Goal& goal);
Core::Received::Goal from_bus(const bus::Sample<v1::Goal>& sample);

v1::Intentions to_bus(const Core::Outputs& outputs, const Executor& executor);
v1::BeliefSet to_bus(const std::vector<Belief>& beliefs, const Executor& executor);
/// The instance and the source are the caller's.
v1::Drawing drawing_of(const std::vector<Vec2>& way);

Robot from_bus(const v1::RobotState& robot);
Core::Received::Grant from_bus(const v1::Grant& grant);
Core::Vision from_bus(const v1::Vision& vision);
std::vector<BehaviorLevel> from_bus(const v1::BehaviorSet& behaviors);
/// [cycles] of the intentions that they evaluated.
std::uint64_t intent_age_from_bus(const v1::BehaviorSet& behaviors);
std::vector<BehaviorSignature> from_bus(const v1::BehaviorSchemas& schemas);

v1::ActivitySchema to_bus(const Schema& schema);
/// FileError for a value that is not of the activity language; also of a withdrawn claim, whose
/// value does not count.
ClaimEvent from_bus(const v1::BeliefClaim& claim, ClaimEvent::Kind kind);

/// The age [cycles] from which on a sample of registration or interpretation is ignored.
inline constexpr std::uint64_t kRegistrationLease = 20;
/// Its content, for the step of `cycle`: none where the sample is too old.
Registered registered_from_bus(const v1::Registration& registration, std::uint64_t cycle);
/// The origin of that odom frame on the map, for the step of `cycle`; none where registration has
/// no pose, uses another odom frame, or was not heard.
std::optional<Pose> odom_in_map_from_bus(const v1::Registration& registration, std::uint64_t cycle,
                                         std::uint64_t odom);
/// The percepts for the step of `cycle`: none where the sample is too old; empty for another odom
/// frame.
std::optional<std::vector<lps::Percept>> percepts_from_bus(const v1::Perception& perception,
                                                           std::uint64_t cycle, std::uint64_t odom);

}  // namespace saphira::intentions

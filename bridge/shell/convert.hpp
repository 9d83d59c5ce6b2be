#pragma once

#include <string>
#include <vector>

#include "saphira/authority/arbiter.hpp"
#include "saphira/authority/guard.hpp"
#include "saphira/bridge/events.hpp"
#include "saphira/idl/device.hpp"
#include "saphira/idl/motion.hpp"
#include "saphira/idl/robot.hpp"
#include "saphira/idl/system.hpp"
#include "saphira/idl/vision.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/parameters.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/reflector/reflector.hpp"

namespace saphira::bridge {

// Between the contract's types and the libraries'. Pure functions.

v1::RobotState to_bus(const reflector::State& state, const v1::Stamp& stamp,
                      std::uint64_t bad_packets);
v1::SonarBuckets to_bus(const std::vector<reflector::Bucket>& buckets, std::uint64_t odom,
                        const v1::Stamp& stamp);
v1::RobotDescription to_bus(const protocol::RobotParameters& parameters,
                            const protocol::RobotIdentity& identity, const v1::Stamp& stamp,
                            const std::string& link, bool lockstep);
v1::VisionChannels to_bus(const protocol::VisionPacket& packet);

/// A grant, the driver's setpoints, the guard's result, the refused drivers.
v1::Grant to_bus(const authority::Grant& grant, const DriverSetpoints& told,
                 const authority::Guarded& guarded, const std::vector<authority::Refusal>& refused,
                 const v1::Stamp& stamp);

/// The error in a motor command; empty: none. Anybody may write one: NaN, infinity, or an unknown
/// enumerator is refused here.
std::string trouble(const v1::MotorCommand& command);
/// Only for a command without trouble.
reflector::Motion to_motion(const v1::MotorCommand& command);
/// A whole command, with its errors.
DriveCommand to_drive(const v1::MotorCommand& command, authority::Role role,
                      const authority::WriterId& writer);

v1::Devices to_bus(const std::vector<reflector::DeviceRequest>& requests,
                   const reflector::Devices::Reports& reports,
                   const protocol::Information& information, const v1::Stamp& stamp);

}  // namespace saphira::bridge

#pragma once

#include <optional>

#include "../src/robot.hpp"
#include "saphira/bus/request_client.hpp"

/// The C library's types and those of the bus.
namespace saphira::c {

/// A request to a program on the bus.
struct Call {
  bus::RequestTopic topic;
  v1::Request request;
};

protocol::RobotParameters parameters_of(const v1::RobotDescription& robot);
/// Without the readings of earlier cycles.
reflector::State state_of(const v1::RobotState& robot);
v1::MotorCommand command_of(const reflector::Motion& motion);
protocol::VisionPacket seen_in(const v1::VisionChannels& channels);
/// In the colors of manual Table 6-4.
v1::Drawing drawing_of(const Drawn& drawn);
v1::ProgramMind mind_of(const SharedMind& mind);
/// A client command (manual 5.2) for a device of the robot; nothing: there is none.
std::optional<Call> device_call(const protocol::Bytes& packet);

}  // namespace saphira::c

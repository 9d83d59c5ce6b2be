#pragma once

#include "saphira/base/namesakes.hpp"
#include "saphira/idl/motion.hpp"
#include "saphira/idl/robot.hpp"
#include "saphira/idl/vision.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/reflector/reflector.hpp"

/// Enumerations of the robot's packets and motion, and those of the bus with the same meaning.
namespace saphira::bridge {

inline constexpr EnumPairs<protocol::Motors, v1::MotorStatus, 3> kMotors{
    {{
        {protocol::Motors::kStopped, v1::MOTORS_STOPPED},
        {protocol::Motors::kMoving, v1::MOTORS_MOVING},
        {protocol::Motors::kNoPower, v1::MOTORS_NO_POWER},
    }},
    {},
    {v1::MOTORS_NOT_CONNECTED}};

}  // namespace saphira::bridge

namespace saphira {

using VisionMode = protocol::VisionChannel::Mode;
template <>
inline constexpr EnumPairs<VisionMode, v1::VisionMode, 3> kPairs<VisionMode, v1::VisionMode>{{{
    {VisionMode::kBlob, v1::VISION_BLOB},
    {VisionMode::kBlobWithBox, v1::VISION_BLOB_BOX},
    {VisionMode::kLine, v1::VISION_LINE},
}}};

}  // namespace saphira

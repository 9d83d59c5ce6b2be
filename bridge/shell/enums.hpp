#pragma once

#include "saphira/base/enum_pairs.hpp"
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
inline constexpr auto kTranslations = pairs_by_name<reflector::Translation, v1::TranslationMode>();
inline constexpr auto kRotations = pairs_by_name<reflector::Rotation, v1::RotationMode>();
inline constexpr EnumPairs<protocol::VisionChannel::Mode, v1::VisionMode, 3> kVisionModes{{{
    {protocol::VisionChannel::Mode::kBlob, v1::VISION_BLOB},
    {protocol::VisionChannel::Mode::kBlobWithBox, v1::VISION_BLOB_BOX},
    {protocol::VisionChannel::Mode::kLine, v1::VISION_LINE},
}}};

}  // namespace saphira::bridge

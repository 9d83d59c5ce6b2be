#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "device.h"
#include "robot.h"

namespace saphira::cli {

using DeviceCommand = std::variant<v1::ServoCommand, v1::GripperCommand, v1::DigitalOutputCommand,
                                   v1::AnalogCommand, v1::TimerCommand, v1::SonarCommand,
                                   v1::SoundCommand, v1::ServerCommand, v1::SerialCommand>;

/// What may be asked of a device, as people type it; one line each.
extern const char* const kDeviceWords;

/// A device command as a person types it: the device and what it is to do (kDeviceWords).
/// std::invalid_argument that says what was expected where it is none.
DeviceCommand parse_device(const std::vector<std::string>& words);

/// A request, and what became of it: "servo 1500 us, asked for by me: shown".
std::string describe(const v1::DeviceRequest& request);

/// What the robot shows of its devices: name and value, those that it has. A robot without
/// robot/devices (an older bridge) shows what is in its state.
std::vector<std::vector<std::string>> device_rows(const v1::RobotState& robot,
                                                  const std::optional<v1::Devices>& devices);

}  // namespace saphira::cli

#pragma once

#include <cstdint>

#include "saphira/base/cycle.hpp"

namespace saphira::bridge {

inline constexpr double kSilent =
    0.5;                              // [s] without a packet: the link is silent, the robot stands
inline constexpr double kDead = 2.0;  // [s] then the link is closed
inline constexpr double kDeadStep = 10;  // [s] for the simulator to make a step
inline constexpr double kMinute = 60.0;  // [s]
inline constexpr double kForEver = 1e300;
inline constexpr double kGap = 0.25;    // [s] pause of the bridge's own loop that counts as a gap
inline constexpr double kSettle = 0.1;  // [s] after a gap: inputs of this time waited in a queue
// [s] from a packet until the outputs go without the driver's answer
inline constexpr double kWaitForDriver = 0.05;
inline constexpr double kPacketPause = 0.05;  // [s] longer than any pause within a packet
inline constexpr double kHoldOff = 2.0;       // [s] until a robot that is not served is tried again
inline constexpr double kTellKeeper = 10.0;   // [s] for which the status reports a new keeper
inline constexpr double kTellWait = 3.0;      // [s] of silent waiting for its robot
inline constexpr double kSlowLine = 0.25;     // [s] round trip of a slow line
inline constexpr double kUsualLine = 0.1;     // [s] share of it that the guard includes anyway
inline constexpr double kMeasureDelay = 2.0;  // [s] a slow line is measured again
inline constexpr double kRestVelocity = 0.02;    // [m/s] with room for the packet's rounding
inline constexpr double kRestHeading = 0.05;     // [rad] from its target
inline constexpr double kRestRotation = 0.05;    // [rad/s] the same
inline constexpr std::uint64_t kEdgesKept = 10;  // [cycles] for which edges count
inline constexpr unsigned kStopCycles = 2;  // least time of a stop: every service has heard of it
inline constexpr unsigned kMostStopCycles = 50;  // then it has failed
inline constexpr unsigned kMotorsCycles = 10;    // after these the motors should be on
inline constexpr double kNearlyLow = 1.02;       // of the voltage at which the robot complains
inline constexpr double kNoSuchBattery = 0.75;   // of it: the robot has another kind of battery
inline constexpr double kLowCharge = 0.2;        // [0..1]
// A motor that starts draws the voltage down for a moment.
inline constexpr unsigned kLowBatteryCycles = 100;
inline constexpr unsigned kConfigCycles = 30;  // then its configuration should be known

}  // namespace saphira::bridge

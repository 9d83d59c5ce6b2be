#pragma once

namespace saphira::bridge {

inline constexpr double kCycle = 0.1;  // [s] manual 2.1.1
inline constexpr double kSilent =
    0.5;                              // [s] without a packet: the link is silent, the robot stands
inline constexpr double kDead = 2.0;  // [s] then the link is given up
inline constexpr double kDeadStep = 10;  // [s] for the simulator to make a step
inline constexpr double kForEver = 1e300;
inline constexpr double kGap = 0.25;    // [s] the bridge's own loop was not heard for so long
inline constexpr double kSettle = 0.1;  // [s] after a gap: what comes now waited in some queue
// [s] from a packet until what is due goes without the driver's answer
inline constexpr double kWaitForDriver = 0.05;
inline constexpr double kPacketPause = 0.05;  // [s] no packet pauses so long within itself
inline constexpr double kHoldOff = 2.0;       // [s] until a robot that is not served is tried again
inline constexpr double kTellKeeper = 10.0;   // [s] that the status tells of a new keeper
inline constexpr double kTellWait = 3.0;      // [s] that it waits for its robot in silence
inline constexpr double kSlowLine = 0.25;     // [s] there and back: it is slow
inline constexpr double kUsualLine = 0.1;     // [s] of it that the guard reckons with anyway
inline constexpr double kMeasureDelay = 2.0;  // [s] a slow line is measured again
inline constexpr unsigned kMotorsCycles = 10;  // then the motors should be on
inline constexpr unsigned kConfigCycles = 30;  // then it should have said how it is set

}  // namespace saphira::bridge

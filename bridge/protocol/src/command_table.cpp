#include <algorithm>
#include <array>

#include "saphira/protocol/command.hpp"

namespace saphira::protocol {

namespace {

// By number. The names of later commands are from the robots' own header files. Ranges are those of
// the argument's meaning, where it is known, and otherwise those of its form.
constexpr auto kRules = [] {
  using enum Number;
  using enum ArgumentForm;
  using enum Origin;
  return std::to_array<CommandRule>({
      {kPulse, "PULSE", kNone, kManual, 0, 0, ""},
      {kOpen, "OPEN", kOptional, kManual, 0, 1, ""},
      {kClose, "CLOSE", kOptional, kManual, 0, 1, ""},
      {kPolling, "POLLING", kString, kManual, 0, 0, ""},
      {kEnable, "ENABLE", kInteger, kLater, 0, 1, ""},
      {kAcceleration, "SETA", kInteger, kLater, -32767, 32767, "mm/s2"},
      {kMaxVelocity, "SETV", kInteger, kLater, 0, 32767, "mm/s"},
      {kSetOrigin, "SETO", kOptional, kManual, 0, 65535, ""},
      {kMove, "MOVE", kInteger, kLater, -32767, 32767, "mm"},
      {kRotate, "ROTATE", kInteger, kLater, -32767, 32767, "deg/s"},
      {kMaxRotationVelocity, "SETRV", kInteger, kLater, 0, 32767, "deg/s"},
      {kVelocity, "VEL", kInteger, kManual, -32767, 32767, "mm/s"},
      {kHeading, "HEAD", kInteger, kManual, -360, 360, "deg"},
      {kDeltaHeading, "DHEAD", kInteger, kManual, -360, 360, "deg"},
      {kSay, "SAY", kString, kLater, 0, 0, ""},
      {kJoystickRequest, "JOYINFO", kInteger, kLater, 0, 2, ""},
      {kConfigRequest, "CONFIG", kOptional, kLater, 0, 1, ""},
      {kEncoderRequest, "ENCODER", kInteger, kLater, 0, 2, ""},
      {kRotationVelocity, "RVEL", kInteger, kManual, -32767, 32767, "deg/s"},
      {kDeltaSetpoint, "DCHEAD", kInteger, kLater, -360, 360, "deg"},
      {kRotationAcceleration, "SETRA", kInteger, kLater, -32767, 32767, "deg/s2"},
      {Number{26}, "IMU", kInteger, kLater, 0, 2, ""},
      {kSonar, "SONAR", kInteger, kLater, 0, 255, ""},
      {kStop, "STOP", kOptional, kLater, 0, 65535, ""},
      {kDigitalOutput, "DIGOUT", kInteger, kManual, 0, 65535, "bits"},
      // The manual knows pins 0 to 7. Clients of later robots switch the power of a laser by it:
      // the port (11) in the high byte, on or off in the low one.
      {kTimer, "TIMER", kInteger, kManual, 0, 0x0BFF, "pin"},
      {kWheelVelocities, "VEL2", kPair, kManual, -127, 127, "Vel2Divisor"},
      {kGripper, "GRIPPER", kInteger, kManual, 0, 17, ""},
      {kAnalogSelect, "ADSEL", kInteger, kLater, 0, 255, "port"},
      {kGripperValue, "GRIPPERVAL", kInteger, kLater, 0, 65535, ""},
      {kGripperRequest, "GRIPPERPACREQUEST", kInteger, kLater, 0, 2, ""},
      {Number{38}, "LASERINC", kInteger, kSimulator, 0, 65535, "0.01 deg"},
      {kIoRequest, "IOREQUEST", kInteger, kLater, 0, 2, ""},
      {kPtu, "PTUPOS", kInteger, kManual, 0, 65535, "us"},
      {kAux1Send, "TTY2", kString, kLater, 0, 0, ""},
      {kAux1Read, "GETAUX", kInteger, kLater, 0, 255, "bytes"},
      {kBumpStall, "BUMPSTALL", kInteger, kLater, 0, 3, ""},
      {Number{45}, "TCM2", kInteger, kLater, 0, 65535, ""},
      {Number{47}, "JOYDRIVE", kInteger, kLater, 0, 1, ""},
      {Number{49}, "MOVINGBLINK", kInteger, kLater, 0, 1, ""},
      {kHostBaud, "HOSTBAUD", kInteger, kLater, 0, 4, ""},
      {Number{51}, "AUX1BAUD", kInteger, kLater, 0, 4, ""},
      {Number{52}, "AUX2BAUD", kInteger, kLater, 0, 4, ""},
      {kVision, "VISION_COM", kString, kManual, 0, 0, ""},
      {kEmergencyStop, "ESTOP", kOptional, kLater, 0, 65535, ""},
      {Number{56}, "ESTALL", kInteger, kLater, 0, 65535, ""},
      {kEmergencyStop2, "ESTOP2", kOptional, kSimulator, 0, 65535, ""},
      {kGyroRequest, "GYRO", kInteger, kLater, 0, 2, ""},
      {kAux3Send, "TTY4", kString, kLater, 0, 0, ""},
      {kAux3Read, "GETAUX3", kInteger, kLater, 0, 255, "bytes"},
      {kBatteryRequest, "BATTERYINFO", kInteger, kLater, 0, 2, ""},
      {Number{63}, "LOADWORLD", kString, kSimulator, 0, 0, ""},
      {kStep, "STEP", kNone, kManual, 0, 0, ""},
      {Number{65}, "CALCOMP", kInteger, kLater, 0, 65535, ""},
      {kAux2Send, "TTY3", kString, kLater, 0, 0, ""},
      {kAux2Read, "GETAUX2", kInteger, kLater, 0, 255, "bytes"},
      {kTrueHeading, "SETTRUETH", kInteger, kSimulator, -360, 360, "deg"},
      {kTrueOrigin, "RESETTRUE", kOptional, kSimulator, 0, 65535, ""},
      {Number{70}, "ARM_INFO", kOptional, kLater, 0, 65535, ""},
      {Number{71}, "ARM_STATUS", kInteger, kLater, 0, 65535, ""},
      {Number{72}, "ARM_INIT", kOptional, kLater, 0, 65535, ""},
      {Number{73}, "ARM_CHECK", kOptional, kLater, 0, 65535, ""},
      {Number{74}, "ARM_POWER", kInteger, kLater, 0, 65535, ""},
      {Number{75}, "ARM_HOME", kInteger, kLater, 0, 65535, ""},
      {Number{76}, "ARM_PARK", kOptional, kLater, 0, 65535, ""},
      {Number{77}, "ARM_POS", kInteger, kLater, 0, 65535, ""},
      {Number{78}, "ARM_SPEED", kInteger, kLater, 0, 65535, ""},
      {Number{79}, "ARM_STOP", kOptional, kLater, 0, 65535, ""},
      {Number{80}, "ARM_AUTOPARK", kInteger, kLater, 0, 65535, ""},
      {Number{81}, "ARM_GRIPPARK", kInteger, kLater, 0, 65535, ""},
      {Number{82}, "ROTKP", kInteger, kLater, 0, 65535, ""},
      {Number{83}, "ROTKV", kInteger, kLater, 0, 65535, ""},
      {Number{84}, "ROTKI", kInteger, kLater, 0, 65535, ""},
      {Number{85}, "TRANSKP", kInteger, kLater, 0, 65535, ""},
      {Number{86}, "TRANSKV", kInteger, kLater, 0, 65535, ""},
      {Number{87}, "TRANSKI", kInteger, kLater, 0, 65535, ""},
      {kSound, "SOUND", kInteger, kLater, 0, 65535, ""},
      {Number{91}, "PLAYLIST", kInteger, kLater, 0, 65535, ""},
      {Number{92}, "SOUNDTOG", kInteger, kLater, 0, 1, ""},
      {Number{95}, "POWER95", kInteger, kLater, 0, 65535, ""},
      {Number{96}, "POWER96", kInteger, kLater, 0, 65535, ""},
      {Number{97}, "POWER97", kInteger, kLater, 0, 65535, ""},
      {Number{98}, "POWER98", kInteger, kLater, 0, 65535, ""},
      {kLateralVelocity, "LATVEL", kInteger, kLater, -32767, 32767, "mm/s"},
      {Number{113}, "LATACCEL", kInteger, kLater, -32767, 32767, "mm/s2"},
      {Number{125}, "POWER125", kInteger, kLater, 0, 65535, ""},
      {Number{126}, "POWER126", kInteger, kLater, 0, 65535, ""},
      {Number{127}, "POWER127", kInteger, kLater, 0, 65535, ""},
      {Number{128}, "POWER128", kInteger, kLater, 0, 65535, ""},
      {Number{129}, "POWER129", kInteger, kLater, 0, 65535, ""},
      {kTruePose, "SIM_SET_POSE", kRaw, kSimulator, 0, 0, ""},
      {kSimReset, "SIM_RESET", kOptional, kSimulator, 0, 65535, ""},
      {Number{226}, "SIM_MODEL_CONFIG", kRaw, kSimulator, 0, 0, ""},
      {Number{230}, "SIM_LRF_ENABLE", kInteger, kSimulator, 0, 2, ""},
      {Number{231}, "SIM_LRF_FOV_START", kInteger, kSimulator, -32767, 32767, ""},
      {Number{232}, "SIM_LRF_FOV_END", kInteger, kSimulator, -32767, 32767, ""},
      {Number{233}, "SIM_LRF_RES", kInteger, kSimulator, 0, 65535, ""},
      {kSimControl, "SIM_CTRL", kRaw, kSimulator, 0, 0, ""},
      {kSimStatus, "SIM_STAT", kInteger, kSimulator, 0, 2, ""},
      {kSimMessage, "SIM_MESSAGE", kString, kSimulator, 0, 0, ""},
      {Number{239}, "SIM_EXIT", kInteger, kSimulator, 0, 65535, ""},
      {kBatteryTest, "BATTEST", kInteger, kSimulator, 0, 65535, "0.1 V"},
      {Number{251}, "TEMPTEST1", kInteger, kSimulator, -32767, 32767, ""},
      {Number{252}, "TEMPTEST2", kInteger, kSimulator, -32767, 32767, ""},
      {kReset, "RESET", kOptional, kLater, 0, 65535, ""},
      {kMaintenance, "MAINTENANCE", kOptional, kLater, 0, 65535, ""},
  });
}();

static_assert(std::ranges::is_sorted(kRules, [](const CommandRule& a, const CommandRule& b) {
  return a.number < b.number;
}));

}  // namespace

std::span<const CommandRule> rules() {
  return kRules;
}

const CommandRule* rule(std::uint8_t number) {
  const auto* const found = std::ranges::find_if(kRules, [number](const CommandRule& r) {
    return static_cast<std::uint8_t>(r.number) == number;
  });
  return found == kRules.end() ? nullptr : found;
}

}  // namespace saphira::protocol

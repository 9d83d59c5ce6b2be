#pragma once

#include "behavior.h"
#include "device.h"
#include "intention.h"
#include "map.h"
#include "motion.h"
#include "perception.h"
#include "robot.h"
#include "saphira/bus/qos.hpp"
#include "system.h"
#include "vision.h"

namespace saphira::bus {

/// A topic: its name, its type and the name of its QoS. Writer, rate and meaning are with the type
/// in idl/*.idl.
template <class T>
struct Topic {
  const char* name;
  Qos qos;
};

namespace topics {

inline constexpr Topic<v1::RobotState> kRobotState{"robot/state", Qos::cyclic};
inline constexpr Topic<v1::RobotDescription> kRobotDescription{"robot/description", Qos::latched};
inline constexpr Topic<v1::Devices> kDevices{"robot/devices", Qos::latched};
inline constexpr Topic<v1::SerialData> kSerialData{"robot/serial", Qos::event};
inline constexpr Topic<v1::ServoCommand> kServo{"device/servo", Qos::command};
inline constexpr Topic<v1::GripperCommand> kGripper{"device/gripper", Qos::command};
inline constexpr Topic<v1::DigitalOutputCommand> kDigitalOutput{"device/output", Qos::command};
inline constexpr Topic<v1::AnalogCommand> kAnalog{"device/analog", Qos::command};
inline constexpr Topic<v1::TimerCommand> kTimer{"device/timer", Qos::command};
inline constexpr Topic<v1::SonarCommand> kSonar{"device/sonar", Qos::command};
inline constexpr Topic<v1::SoundCommand> kSound{"device/sound", Qos::command};
inline constexpr Topic<v1::ServerCommand> kServer{"device/server", Qos::command};
inline constexpr Topic<v1::SerialCommand> kSerial{"device/serial", Qos::command};
inline constexpr Topic<v1::MotorCommand> kDriveEstop{"drive/estop", Qos::motion};
inline constexpr Topic<v1::MotorCommand> kDriveTeleop{"drive/teleop", Qos::motion};
inline constexpr Topic<v1::MotorCommand> kDriveDirect{"drive/direct", Qos::motion};
inline constexpr Topic<v1::MotorCommand> kDriveBehaviors{"drive/behaviors", Qos::motion};
inline constexpr Topic<v1::EstopReset> kEstopReset{"drive/estop/reset", Qos::command};
inline constexpr Topic<v1::Grant> kGrant{"drive/grant", Qos::cyclic};
inline constexpr Topic<v1::StepPermit> kStepPermit{"lockstep/permit", Qos::latched};
inline constexpr Topic<v1::Perception> kPerception{"perception", Qos::cyclic};
inline constexpr Topic<v1::GridTile> kGrid{"perception/grid", Qos::latched};
inline constexpr Topic<v1::VisionChannels> kVisionChannels{"vision/channels", Qos::cyclic};
inline constexpr Topic<v1::Vision> kVision{"vision", Qos::cyclic};
inline constexpr Topic<v1::Map> kMap{"map", Qos::latched};
inline constexpr Topic<v1::Registration> kRegistration{"registration", Qos::cyclic};
inline constexpr Topic<v1::RegistrationRequest> kRegistrationRequest{"registration/request",
                                                                     Qos::command};
inline constexpr Topic<v1::RegistrationAnswer> kRegistrationAnswer{"registration/answers",
                                                                   Qos::event};
inline constexpr Topic<v1::Behaviors> kBehaviors{"behaviors/state", Qos::cyclic};
inline constexpr Topic<v1::Intentions> kIntentions{"intentions", Qos::cyclic};
inline constexpr Topic<v1::Goal> kGoals{"goals", Qos::goal};
inline constexpr Topic<v1::GoalStatus> kGoalStatus{"goals/status", Qos::latched};
inline constexpr Topic<v1::BehaviorSchemas> kBehaviorSchemas{"behaviors/schemas", Qos::latched};
inline constexpr Topic<v1::ActivitySchemas> kActivitySchemas{"intentions/schemas", Qos::latched};
inline constexpr Topic<v1::Beliefs> kBeliefs{"beliefs", Qos::latched};
inline constexpr Topic<v1::BeliefClaim> kBeliefClaims{"beliefs/said", Qos::goal};
inline constexpr Topic<v1::Processes> kProcesses{"processes", Qos::latched};
inline constexpr Topic<v1::ProcessRequest> kProcessRequest{"processes/request", Qos::command};
inline constexpr Topic<v1::ProcessAnswer> kProcessAnswer{"processes/answers", Qos::event};
inline constexpr Topic<v1::Message> kMessages{"messages", Qos::event};
// What the same writers published in the last minute, for who asks why afterwards.
inline constexpr Topic<v1::RobotState> kRecallRobot{"recall/robot", Qos::recall};
inline constexpr Topic<v1::Grant> kRecallGrant{"recall/grant", Qos::recall};
inline constexpr Topic<v1::Behaviors> kRecallBehaviors{"recall/behaviors", Qos::recall};
inline constexpr Topic<v1::Intentions> kRecallIntentions{"recall/intentions", Qos::recall};
inline constexpr Topic<v1::ServiceStatus> kStatus{"system/status", Qos::status};
inline constexpr Topic<v1::Presence> kPresence{"system/presence", Qos::presence};
inline constexpr Topic<v1::LogRecord> kLog{"system/log", Qos::event};

}  // namespace topics

/// Calls f(topic) for each of them.
template <class F>
void for_each_topic(F&& f) {
  using namespace topics;
  f(kRobotState);
  f(kRobotDescription);
  f(kDevices);
  f(kSerialData);
  f(kServo);
  f(kGripper);
  f(kDigitalOutput);
  f(kAnalog);
  f(kTimer);
  f(kSonar);
  f(kSound);
  f(kServer);
  f(kSerial);
  f(kDriveEstop);
  f(kDriveTeleop);
  f(kDriveDirect);
  f(kDriveBehaviors);
  f(kEstopReset);
  f(kGrant);
  f(kStepPermit);
  f(kPerception);
  f(kGrid);
  f(kVisionChannels);
  f(kVision);
  f(kMap);
  f(kRegistration);
  f(kRegistrationRequest);
  f(kRegistrationAnswer);
  f(kBehaviors);
  f(kIntentions);
  f(kGoals);
  f(kGoalStatus);
  f(kBehaviorSchemas);
  f(kActivitySchemas);
  f(kBeliefs);
  f(kBeliefClaims);
  f(kProcesses);
  f(kProcessRequest);
  f(kProcessAnswer);
  f(kMessages);
  f(kRecallRobot);
  f(kRecallGrant);
  f(kRecallBehaviors);
  f(kRecallIntentions);
  f(kStatus);
  f(kPresence);
  f(kLog);
}

}  // namespace saphira::bus

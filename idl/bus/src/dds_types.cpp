#include "dds_types.hpp"

#include <mutex>

#include "behaviorPubSubTypes.h"
#include "devicePubSubTypes.h"
#include "intentionPubSubTypes.h"
#include "mapPubSubTypes.h"
#include "motionPubSubTypes.h"
#include "perceptionPubSubTypes.h"
#include "robotPubSubTypes.h"
#include "systemPubSubTypes.h"
#include "visionPubSubTypes.h"

namespace saphira::bus::internal {
namespace {

// The generated getKey works in a buffer of the object, and one object serves every endpoint of
// a participant: a write by the program and a sample received by the transport would meet in it.
template <class Generated>
class OneAtATime : public Generated {
 public:
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle,
              bool force_md5) override {
    const std::scoped_lock lock(mutex_);
    return Generated::getKey(data, handle, force_md5);
  }

 private:
  std::mutex mutex_;
};

template <class... Generated>
std::vector<eprosima::fastdds::dds::TypeSupport> make() {
  std::vector<eprosima::fastdds::dds::TypeSupport> types;
  (types.emplace_back(new OneAtATime<Generated>), ...);
  for (auto& type : types) {
    // With a TypeObject attached, a participant that is discovered meanwhile can crash Fast DDS.
    type->auto_fill_type_object(false);
    type->auto_fill_type_information(false);
  }
  return types;
}

}  // namespace

std::vector<eprosima::fastdds::dds::TypeSupport> all_types() {
  return make<v1::RobotStatePubSubType, v1::RobotDescriptionPubSubType, v1::DevicesPubSubType,
              v1::SerialDataPubSubType, v1::ServoCommandPubSubType, v1::GripperCommandPubSubType,
              v1::DigitalOutputCommandPubSubType, v1::AnalogCommandPubSubType,
              v1::TimerCommandPubSubType, v1::SonarCommandPubSubType, v1::SoundCommandPubSubType,
              v1::ServerCommandPubSubType, v1::SerialCommandPubSubType, v1::MotorCommandPubSubType,
              v1::EstopResetPubSubType, v1::GrantPubSubType, v1::StepPermitPubSubType,
              v1::PerceptionPubSubType, v1::GridTilePubSubType, v1::VisionChannelsPubSubType,
              v1::VisionPubSubType, v1::MapPubSubType, v1::RegistrationPubSubType,
              v1::RegistrationRequestPubSubType, v1::RegistrationAnswerPubSubType,
              v1::BehaviorsPubSubType, v1::IntentionsPubSubType, v1::GoalPubSubType,
              v1::GoalStatusPubSubType, v1::BehaviorSchemasPubSubType,
              v1::ActivitySchemasPubSubType, v1::BeliefsPubSubType, v1::BeliefClaimPubSubType,
              v1::ProcessesPubSubType, v1::ProcessRequestPubSubType, v1::ProcessAnswerPubSubType,
              v1::MessagePubSubType, v1::ServiceStatusPubSubType, v1::PresencePubSubType,
              v1::LogRecordPubSubType>();
}

}  // namespace saphira::bus::internal

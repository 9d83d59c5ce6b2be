#include "dds_types.hpp"

#include <exception>
#include <mutex>
#include <utility>

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

thread_local bool last_was_malformed = false;

/// What the generated code lacks. It throws at a sample that is not of its type, through the thread
/// that takes it or through one of Fast DDS's own, which ends the process. And its getKey works in
/// a buffer of the object, while one object serves every endpoint of a participant: a write by the
/// program and a sample received by the transport would meet in it.
template <class Generated>
class Guarded : public Generated {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  bool serialize(void* data, Payload* payload) override {
    try {
      return Generated::serialize(data, payload);
    } catch (const std::exception&) {
      return false;
    }
  }
  // "Read" also where it was not: what Fast DDS cannot read it does not take from the history, and
  // one such sample would stand before all later ones.
  bool deserialize(Payload* payload, void* data) override {
    last_was_malformed = true;
    try {
      last_was_malformed = !Generated::deserialize(payload, data);
    } catch (const std::exception&) {
    }
    return true;
  }
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle,
              bool force_md5) override {
    const std::scoped_lock lock(mutex_);
    try {
      return Generated::getKey(data, handle, force_md5);
    } catch (const std::exception&) {
      return false;
    }
  }

 private:
  std::mutex mutex_;
};

template <class... Generated>
std::vector<eprosima::fastdds::dds::TypeSupport> make() {
  std::vector<eprosima::fastdds::dds::TypeSupport> types;
  (types.emplace_back(new Guarded<Generated>), ...);
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

bool take_malformed() {
  return std::exchange(last_was_malformed, false);
}

}  // namespace saphira::bus::internal

#include <type_traits>

#include "json.hpp"
#include "saphira/bus/endpoint.hpp"
#include "saphira/bus/topics.hpp"
#include "saphira_visit.hpp"

namespace saphira::bus {
namespace {

using internal::to_json;

// Integers, in their order; a struct within the key counts whole, as fastddsgen has it.
struct KeyWords {
  template <class T>
  void operator()(const char* /*name*/, const T& value) {
    if constexpr (std::is_integral_v<T>)
      words.at(count++) = static_cast<std::uint64_t>(value);
    else
      visit_members(value, *this);
  }
  InstanceKey words{};
  std::size_t count = 0;
};

template <class T>
InstanceKey key_of(const T& sample) {
  KeyWords words;
  visit_keys(sample, words);
  return words.words;
}

template <class T>
TypeInfo make_type(const char* name) {
  return {
      .name = name,
      .keyed = T::isKeyDefined(),
      .key = [](const void* sample) { return key_of(*static_cast<const T*>(sample)); },
      .create = []() -> void* { return new T; },
      .copy = [](const void* from,
                 void* to) { *static_cast<T*>(to) = *static_cast<const T*>(from); },
      .destroy = [](void* sample) { delete static_cast<T*>(sample); },
      .json = [](const void* sample,
                 const char* prefix) { return to_json(*static_cast<const T*>(sample), prefix); }};
}

}  // namespace

#define SAPHIRA_TYPE(T)                                                \
  template <>                                                          \
  const TypeInfo& type_of<v1::T>() {                                   \
    static const TypeInfo type = make_type<v1::T>("saphira::v1::" #T); \
    return type;                                                       \
  }
SAPHIRA_TYPE(RobotState)
SAPHIRA_TYPE(RobotDescription)
SAPHIRA_TYPE(Devices)
SAPHIRA_TYPE(SerialData)
SAPHIRA_TYPE(ServoCommand)
SAPHIRA_TYPE(GripperCommand)
SAPHIRA_TYPE(DigitalOutputCommand)
SAPHIRA_TYPE(AnalogCommand)
SAPHIRA_TYPE(TimerCommand)
SAPHIRA_TYPE(SonarCommand)
SAPHIRA_TYPE(SoundCommand)
SAPHIRA_TYPE(ServerCommand)
SAPHIRA_TYPE(SerialCommand)
SAPHIRA_TYPE(MotorCommand)
SAPHIRA_TYPE(EstopReset)
SAPHIRA_TYPE(Grant)
SAPHIRA_TYPE(StepPermit)
SAPHIRA_TYPE(Perception)
SAPHIRA_TYPE(GridTile)
SAPHIRA_TYPE(VisionChannels)
SAPHIRA_TYPE(Vision)
SAPHIRA_TYPE(Map)
SAPHIRA_TYPE(Registration)
SAPHIRA_TYPE(RegistrationRequest)
SAPHIRA_TYPE(RegistrationAnswer)
SAPHIRA_TYPE(Behaviors)
SAPHIRA_TYPE(Intentions)
SAPHIRA_TYPE(Goal)
SAPHIRA_TYPE(GoalStatus)
SAPHIRA_TYPE(BehaviorSchemas)
SAPHIRA_TYPE(ActivitySchemas)
SAPHIRA_TYPE(Beliefs)
SAPHIRA_TYPE(BeliefClaim)
SAPHIRA_TYPE(Processes)
SAPHIRA_TYPE(ProcessRequest)
SAPHIRA_TYPE(ProcessAnswer)
SAPHIRA_TYPE(Message)
SAPHIRA_TYPE(ServiceStatus)
SAPHIRA_TYPE(Presence)
SAPHIRA_TYPE(LogRecord)
#undef SAPHIRA_TYPE

}  // namespace saphira::bus

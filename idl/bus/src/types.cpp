#include "saphira/bus/endpoint.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus {
namespace {

InstanceKey key_of(const v1::Goal& sample) {
  return {sample.id().writer(), sample.id().number()};
}
InstanceKey key_of(const v1::GoalStatus& sample) {
  return {sample.id().writer(), sample.id().number()};
}
InstanceKey key_of(const v1::ServiceStatus& sample) {
  return {sample.instance(), 0};
}
template <class T>
InstanceKey key_of(const T& /*sample*/) {
  return {};
}

template <class T>
TypeInfo make_type(const char* name) {
  return {.name = name,
          .keyed = T::isKeyDefined(),
          .key = [](const void* sample) { return key_of(*static_cast<const T*>(sample)); },
          .create = []() -> void* { return new T; },
          .copy = [](const void* from,
                     void* to) { *static_cast<T*>(to) = *static_cast<const T*>(from); },
          .destroy = [](void* sample) { delete static_cast<T*>(sample); },
          .json = [](const void*, const char*) { return std::string("{}"); }};
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
SAPHIRA_TYPE(DeviceCommand)
SAPHIRA_TYPE(MotorCommand)
SAPHIRA_TYPE(Grant)
SAPHIRA_TYPE(StepPermit)
SAPHIRA_TYPE(Behaviors)
SAPHIRA_TYPE(Intentions)
SAPHIRA_TYPE(Goal)
SAPHIRA_TYPE(GoalStatus)
SAPHIRA_TYPE(ServiceStatus)
SAPHIRA_TYPE(LogRecord)
#undef SAPHIRA_TYPE

}  // namespace saphira::bus

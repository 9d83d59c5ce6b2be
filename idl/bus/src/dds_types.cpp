#include "dds_types.hpp"

#include <exception>
#include <mutex>
#include <utility>

#include "saphira_pub_sub_types.h"

namespace saphira::bus::internal {
namespace {

thread_local bool last_was_malformed = false;

/// Adds the safety that the generated code lacks. That code throws at a sample that is not of its
/// type, also in a thread of Fast DDS, which ends the process. Its getKey uses a buffer of the
/// object, while one object serves every endpoint of a participant: a write by the program and a
/// sample received by the transport would use the buffer at the same time.
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
  // Returns true for an unreadable sample as well. Fast DDS does not remove a sample that it cannot
  // read, and one such sample would block all later ones.
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

template <class Generated>
eprosima::fastdds::dds::TypeSupport make() {
  eprosima::fastdds::dds::TypeSupport type(new Guarded<Generated>);
  // With a TypeObject attached, a participant that is discovered meanwhile can crash Fast DDS.
  type->auto_fill_type_object(false);
  type->auto_fill_type_information(false);
  return type;
}

}  // namespace

std::vector<eprosima::fastdds::dds::TypeSupport> all_types() {
  return {
#define SAPHIRA_TYPE(type) make<v1::type##PubSubType>(),
#include "saphira/bus/topics.def"
  };
}

bool take_malformed() {
  return std::exchange(last_was_malformed, false);
}

}  // namespace saphira::bus::internal

#include "dds_types.hpp"

#include <fastrtps/utils/md5.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <utility>

#include "cdr.hpp"
#include "saphira/bus/endpoint.hpp"

namespace saphira::bus::internal {
namespace {

using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

thread_local bool last_was_malformed = false;

/// A type of the contract for Fast DDS. One object serves every endpoint of a participant, in
/// several threads at once, so it has no state. No exception leaves it: in a thread of Fast DDS it
/// would end the process.
template <class T>
class ContractType : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit ContractType(const TypeInfo& type) {
    setName(type.name);
    m_isGetKeyDefined = type.keyed;
    m_typeSize = cdr_size(T{});  // buffers grow
    // With a TypeObject attached, a participant that is discovered meanwhile can crash Fast DDS.
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, SerializedPayload_t* payload) override {
    try {
      payload->encapsulation = CDR_LE;
      payload->length = write_cdr(*static_cast<const T*>(data),
                                  reinterpret_cast<char*>(payload->data), payload->max_size);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }
  // Returns true for an unreadable sample as well. Fast DDS does not remove a sample that it cannot
  // read, and one such sample would block all later ones.
  bool deserialize(SerializedPayload_t* payload, void* data) override {
    last_was_malformed = true;
    try {
      read_cdr(reinterpret_cast<char*>(payload->data), payload->length, *static_cast<T*>(data));
      last_was_malformed = false;
    } catch (const std::exception&) {
    }
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return cdr_size(*static_cast<const T*>(data)); };
  }
  void* createData() override { return new T; }
  void deleteData(void* data) override { delete static_cast<T*>(data); }
  // The key is at most 16 bytes, so it is its own hash.
  bool getKey(void* data, InstanceHandle_t* handle, bool force_md5) override {
    if (!m_isGetKeyDefined)
      return false;
    CdrKey key(*static_cast<const T*>(data));
    if (force_md5) {
      MD5 md5;
      md5.init();
      md5.update(key.bytes.data(), static_cast<MD5::size_type>(key.size));
      md5.finalize();
      std::copy_n(md5.digest, key.bytes.size(), key.bytes.begin());
    }
    for (unsigned i = 0; i < key.bytes.size(); ++i)
      handle->value[i] = static_cast<unsigned char>(key.bytes[i]);
    return true;
  }
};

}  // namespace

std::vector<eprosima::fastdds::dds::TypeSupport> all_types() {
  using eprosima::fastdds::dds::TypeSupport;
  return {
#define SAPHIRA_TYPE(type) TypeSupport(new ContractType<v1::type>(type_of<v1::type>())),
#include "saphira/idl/topic_types.def"
  };
}

bool take_malformed() {
  return std::exchange(last_was_malformed, false);
}

}  // namespace saphira::bus::internal

#pragma once

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <string>

#include "process.hpp"

namespace saphira::ros2 {

/// As ROS 2 on one machine does it.
inline constexpr const char* kCyclone =
    "<General><Interfaces><NetworkInterface address='127.0.0.1'/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto"
    "</ParticipantIndex><Peers><Peer address='127.0.0.1'/></Peers></Discovery>";

inline constexpr auto kLong = std::chrono::seconds(60);

class Client {
 public:
  Client() {
    const auto domain = static_cast<dds_domainid_t>(std::stoul(test::domain()));
    dds_create_domain(domain, kCyclone);
    participant_ = dds_create_participant(domain, nullptr, nullptr);
    EXPECT_GT(participant_, 0);
  }
  ~Client() { dds_delete(participant_); }
  Client& operator=(Client&&) = delete;

  dds_entity_t reader(const std::string& name, const dds_topic_descriptor_t& type,
                      bool latched = false) const {
    dds_qos_t* const qos = qos_of(latched);
    const dds_entity_t made = dds_create_reader(participant_, topic(name, type), qos, nullptr);
    dds_delete_qos(qos);
    return made;
  }
  dds_entity_t writer(const std::string& name, const dds_topic_descriptor_t& type,
                      bool latched = false) const {
    dds_qos_t* const qos = qos_of(latched);
    const dds_entity_t made = dds_create_writer(participant_, topic(name, type), qos, nullptr);
    dds_delete_qos(qos);
    return made;
  }

 private:
  static dds_qos_t* qos_of(bool latched) {
    dds_qos_t* const qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_durability(qos, latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 100);
    return qos;
  }
  dds_entity_t topic(const std::string& name, const dds_topic_descriptor_t& type) const {
    return dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr);
  }

  dds_entity_t participant_;
};

/// Takes the new samples. True where `each` was true for one of them.
template <class T>
bool take(dds_entity_t reader, const std::function<bool(const T&)>& each) {
  bool found = false;
  void* sample = nullptr;
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) > 0) {
    found = (info.valid_data && each(*static_cast<const T*>(sample))) || found;
    dds_return_loan(reader, &sample, 1);
    sample = nullptr;
  }
  return found;
}

template <class T>
bool comes(dds_entity_t reader, const std::function<bool(const T&)>& each) {
  return test::wait_until([&] { return take<T>(reader, each); }, kLong);
}

}  // namespace saphira::ros2

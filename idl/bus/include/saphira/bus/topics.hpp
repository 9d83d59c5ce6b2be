#pragma once

#include "saphira/bus/qos.hpp"
#include "saphira/idl/types.hpp"

namespace saphira::bus {

/// A topic: its name, its type and the name of its QoS. All of them are in topics.def.
template <class T>
struct Topic {
  const char* name;
  Qos qos;
};

/// A topic of requests, and the topic of their answers.
struct RequestTopic : Topic<v1::Request> {
  Topic<v1::Answer> answers;
};

namespace topics {

#define SAPHIRA_TOPIC(constant, topic, type, qos) \
  inline constexpr Topic<v1::type> constant{topic, Qos::qos};
#define SAPHIRA_REQUESTS(constant, topic, answers) \
  inline constexpr RequestTopic constant{{topic, Qos::command}, answers};
#include "saphira/bus/topics.def"

}  // namespace topics

/// Calls f(topic) for each of them.
template <class F>
void for_each_topic(F&& f) {
#define SAPHIRA_TOPIC(constant, topic, type, qos) f(topics::constant);
#include "saphira/bus/topics.def"
}

}  // namespace saphira::bus

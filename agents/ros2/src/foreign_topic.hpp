#pragma once

#include <string>

#include "saphira/bus/foreign.hpp"
#include "saphira/ros2/messages.hpp"

namespace saphira::ros2 {

/// A topic for the endpoints of this program.
template <class T>
bus::ForeignTopic foreign(const Topic<T>& of, const std::string& name) {
  bus::ForeignTopic topic{.name = name,
                          .type = of.type,
                          .reliable = of.kind != Kind::wish,
                          .transient_local = of.kind == Kind::latched,
                          .depth = of.kind == Kind::many      ? 100
                                   : of.kind == Kind::latched ? 1
                                                              : 10};
  topic.user_data = std::string("typehash=RIHS01_") + of.hash + ";";
  return topic;
}
template <class T>
bus::ForeignTopic foreign(const Topic<T>& of) {
  return foreign(of, of.name);
}

}  // namespace saphira::ros2

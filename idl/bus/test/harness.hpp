#pragma once

// The same tests over both transports, and waiting for conditions.

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "internal.hpp"
#include "node_options.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus::test {

using saphira::test::node_options;
using std::chrono::milliseconds;

/// A robot that no other test process has.
inline std::string robot(const std::string& name) {
  return "t" + std::to_string(getpid()) + name;
}

/// Parameter: "memory" or "dds".
class OnEachBus : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Node> node(const std::string& name, const std::string& robot_name = "",
                             bool lockstep = false) {
    const NodeOptions options =
        node_options(name, robot_name.empty() ? robot("a") : robot_name, lockstep);
    return GetParam() == "dds" ? std::make_unique<Node>(options)
                               : std::make_unique<Node>(options, memory_);
  }
  /// The node "a" with a writer of the topic, and "b" with a reader.
  template <class T>
  struct Pair {
    std::unique_ptr<Node> a;
    std::unique_ptr<Node> b;
    Writer<T> writer;
    Reader<T> reader;
  };
  template <class T>
  Pair<T> pair(const Topic<T>& topic) {
    auto a = node("a");
    auto b = node("b");
    Writer<T> writer = a->writer(topic);
    Reader<T> reader = b->reader(topic);
    return {std::move(a), std::move(b), std::move(writer), std::move(reader)};
  }

 private:
  std::shared_ptr<MemoryBus> memory_ = make_memory_bus();
};

/// Waits until the condition holds; it is asked again whenever the node wakes.
template <class Condition>
bool eventually(Node& node, Condition&& condition, milliseconds limit = milliseconds(20000)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  do {
    node.clear_wake();
    if (condition())
      return true;
    node.wait(milliseconds(20));
  } while (std::chrono::steady_clock::now() < end);
  return condition();
}

template <class T>
std::vector<Sample<T>> take_at_least(Node& node, Reader<T>& reader, std::size_t count) {
  std::vector<Sample<T>> samples;
  EXPECT_TRUE(eventually(node,
                         [&] {
                           for (auto& sample : reader.take())
                             samples.push_back(std::move(sample));
                           return samples.size() >= count;
                         }))
      << "got " << samples.size() << " of " << count;
  return samples;
}

inline v1::Goal goal(std::uint64_t number, const std::string& functor = "go_to") {
  return {.id = {77, number}, .functor = functor};
}

inline v1::Stamp stamp(std::uint64_t epoch, std::uint64_t cycle) {
  return {.epoch = epoch, .cycle = cycle};
}

inline v1::RobotState robot_state(std::uint64_t epoch, std::uint64_t cycle) {
  return {.stamp = stamp(epoch, cycle)};
}

inline v1::RobotDescription description(std::uint64_t epoch) {
  return {.stamp = stamp(epoch, 0)};
}

inline v1::Intentions intentions(std::uint64_t epoch, std::uint64_t cycle) {
  return {.stamp = stamp(epoch, cycle)};
}

}  // namespace saphira::bus::test

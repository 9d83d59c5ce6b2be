#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/viewer/protocol.hpp"
#include "saphira/viewer/scene.hpp"

namespace saphira::viewer {

/// A running robot's channels: its topics as they are, and those of Scene. A topic is read only
/// while somebody has subscribed. For the thread that waits on the node.
class Live {
 public:
  explicit Live(bus::Node& node);

  const std::vector<Channel>& channels() const { return channels_; }
  /// For a new subscription: the topic is read anew, so that its kept samples come again. Returns
  /// the reason why it cannot be read, in words; empty: it can.
  std::string subscribe(std::size_t channel);
  using Wants = std::function<bool(std::size_t channel)>;
  using Put = std::function<void(std::size_t channel, const std::string& json)>;
  /// Takes the new samples of the channels that a client wants, and ends reading the others.
  void poll(std::int64_t now_ns, const Wants& wants, const Put& put);

 private:
  bus::Node& node_;
  std::vector<Channel> channels_;  // the topics, then those of Scene
  std::size_t topics_ = 0;
  std::map<std::size_t, std::unique_ptr<bus::Echo>> echoes_;
  std::map<std::string, std::unique_ptr<bus::Echo>> drawn_;  // by topic
  Scene scene_;
};

}  // namespace saphira::viewer

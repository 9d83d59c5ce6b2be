#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace saphira::viewer {

/// A channel of a server, which is numbered by its place in the list.
struct Channel {
  std::string topic;
  std::string type;
  std::string schema;  ///< JSON Schema
};

/// The names of the Foxglove WebSocket protocol, version 1, that a client may ask for.
constexpr const char* kProtocols[]{"foxglove.sdk.v1", "foxglove.websocket.v1"};

/// A client of the Foxglove WebSocket protocol: it subscribes to channels, and does nothing else.
/// Without sockets.
class Client {
 public:
  struct Frame {
    bool binary = false;
    std::string content;
  };

  /// Begins with the server's name and its channels. `most`: bytes of samples that wait; above it
  /// the oldest are dropped, but never the newest of all.
  Client(const std::string& name, const std::vector<Channel>& channels, std::size_t most);

  /// A message of the client. The channels that it has subscribed to by it. Nothing: it is no
  /// message of the protocol, and the connection is to be closed. A message that asks for more
  /// than reading, such as publishing, gets a status.
  std::optional<std::vector<std::size_t>> take(const std::string& text);
  /// A sample of a channel: it waits for next() where the client has subscribed.
  void offer(std::size_t channel, std::int64_t time_ns, const std::string& json);
  bool wants(std::size_t channel) const;
  /// The next frame to send, if there is any.
  std::optional<Frame> next();
  std::uint64_t dropped() const { return dropped_; }

 private:
  void refuse(const std::string& reason);

  std::size_t channels_;
  std::size_t most_;
  std::map<std::uint32_t, std::size_t> subscribed_;  // channel by the client's number
  std::deque<Frame> first_;                          // texts, which are never dropped
  std::deque<std::string> samples_;
  std::size_t waiting_ = 0;  // [bytes]
  std::uint64_t dropped_ = 0;
};

}  // namespace saphira::viewer

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/viewer/protocol.hpp"
#include "sockets.hpp"

namespace saphira::viewer {

/// The Foxglove WebSocket protocol at a network address (libwebsockets), in one thread. Each client
/// needs a key, ws://HOST:PORT/?key=KEY, and is dropped when it holds no more.
class Server {
 public:
  struct Options {
    web::Place place{"127.0.0.1", 8765, {}, {}};
    std::string name;  ///< of the robot, for people
    /// True while the key lets its client watch.
    std::function<bool(const std::string& key)> admits;
    std::function<void(const std::string& key)> refused;  ///< of a client with a key
    std::function<void(const std::string& key)> came;
  };
  struct Events {
    std::function<void(std::size_t channel)> subscribed;
    std::function<void()> readable;  ///< the file descriptor of watch()
    std::function<void()> tick;      ///< ten times a second
  };

  /// std::runtime_error that names the cause (the port, the certificate).
  Server(const Options& options, std::vector<Channel> channels, Events events);
  Server& operator=(Server&&) = delete;

  int port() const { return sockets_.port(); }
  bool wants(std::size_t channel) const;
  /// A sample of a channel, for each client that has subscribed.
  void offer(std::size_t channel, std::int64_t time_ns, const std::string& json);
  void watch(int fd) { sockets_.watch(fd, events_.readable); }
  /// Runs until `stop` is readable.
  void run(int stop);

 private:
  using Connection = web::Sockets::Connection;
  struct Open {
    Client client;
    std::string key;
  };

  static int http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
  std::string refusal(lws* wsi) const;
  void opened(Connection id, lws* wsi);
  bool came(Connection id, const std::string& text);
  std::optional<web::Sockets::Message> next(Connection id);

  Options options_;
  std::vector<Channel> channels_;
  Events events_;
  std::map<Connection, Open> open_;
  web::Sockets sockets_;  // its end needs the rest
};

}  // namespace saphira::viewer

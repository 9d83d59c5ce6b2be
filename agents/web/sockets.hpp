#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "loop.hpp"

namespace saphira::web {

/// A server of WebSockets, in one thread: messages to and from each connection. Bounded:
/// connections, sizes, silences. All other requests are those of `http`.
class Sockets {
 public:
  using Connection = std::uint64_t;  ///< from 1
  struct Message {
    bool bytes = false;  ///< no text
    std::string content;
  };
  /// Each is called from the loop alone.
  struct Events {
    /// The reason, in words, to refuse a handshake; empty: none.
    std::function<std::string(lws*)> refusal;
    std::function<void(Connection, lws*)> opened;
    /// A text. False closes the connection.
    std::function<bool(Connection, const std::string& text)> came;
    std::function<void(Connection)> closed;
    /// The next message for a connection, when it can be sent; nothing: none.
    std::function<std::optional<Message>(Connection)> next;
  };
  struct Options {
    std::vector<const char*> protocols;  ///< that a client may ask for
    std::size_t connections = 0;         ///< at once
    std::size_t longest = 0;             ///< [bytes] of a client's message
    lws_callback_function* http = nullptr;
    std::size_t http_record = 0;  ///< [bytes] per connection
  };

  /// `owner`: as in Loop. `encrypts`: likewise.
  Sockets(void* owner, const Options& options, Events events, bool encrypts);

  Loop& loop() { return loop_; }
  /// Null: it cannot. The first one is that of port().
  lws_vhost* listen(const char* name, const Place& place);
  int port() const { return lws_get_vhost_listen_port(vhost_); }
  /// From now on calls `readable` when the descriptor is.
  void watch(int fd, std::function<void()> readable) {
    loop_.watch(vhost_, fd, std::move(readable));
  }
  /// Calls `tick` once a period [us], until `stop` is readable.
  void run(int stop, long period, std::function<void()> tick);
  /// There may be something to send: next() is called soon.
  void want(Connection connection);
  void want_all();
  /// A hundredth of a second later: simultaneous news go together.
  void want_all_soon();
  void close(Connection connection);

 private:
  struct Open {
    lws* wsi = nullptr;
    std::string incoming;  // the pieces of one message
  };

  static int on_socket(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                       std::size_t size);
  int filter(lws* wsi) const;
  int receive(Connection from, const char* data, std::size_t size);
  int send(Connection to);

  Options options_;
  Events events_;
  std::vector<lws_protocols> protocols_;
  std::map<Connection, Open> open_;
  Connection last_ = 0;
  lws_vhost* vhost_ = nullptr;
  bool soon_ = false;
  // A timer of libwebsockets, with a pointer to us.
  struct Timer {
    lws_sorted_usec_list_t list;
    Sockets* sockets;
  };
  Timer together_{{}, this};
  Loop loop_;  // its end needs the rest
};

}  // namespace saphira::web

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "chunks.hpp"
#include "loop.hpp"
#include "saphira/console/access.hpp"
#include "saphira/mcp/session.hpp"

namespace saphira::mcp {

/// A complete request of HTTP.
struct HttpRequest {
  std::string method;  ///< GET, POST, DELETE [empty: another]
  std::string path;
  console::Caller caller;
  std::string authorization;
  std::string session;  ///< Mcp-Session-Id
  std::string version;  ///< MCP-Protocol-Version
  std::string mcp_method;
  std::string mcp_name;
  std::string body;
};

/// HTTP on this machine (127.0.0.1) by libwebsockets, in one thread. Bounded: connections, sizes,
/// silences.
class HttpServer {
 public:
  using Exchange = std::uint64_t;  ///< a request and its answer; from 1

  /// The callbacks for events. Each is called from run() alone.
  struct Events {
    /// The headers of a request have come: true for one whose body is of interest.
    std::function<bool(const HttpRequest&)> admits;
    std::function<void(Exchange, HttpRequest)> came;
    /// The connection was lost before the complete answer.
    std::function<void(Exchange)> lost;
    std::function<void()> readable;  ///< the file descriptor of watch()
    std::function<void()> tick;      ///< 20 times a second
  };

  /// port 0: any that is free. std::runtime_error where the port is taken.
  HttpServer(int port, Events events);
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const { return lws_get_vhost_listen_port(vhost_); }
  void watch(int fd) { loop_.watch(vhost_, fd, events_.readable); }

  /// A complete answer. session: becomes the header Mcp-Session-Id [empty: none].
  void answer(Exchange exchange, int status, const std::string& type, std::string body,
              const std::string& session = {});
  /// A message of a stream of events, which begins with the first one. last: the stream ends.
  /// An empty message is a sign of life, which no client reads.
  void event(Exchange exchange, const std::string& message, bool last);
  /// [s] since the client's side of the connection has acknowledged anything: a second at most
  /// while it is there. Nothing: the connection is closed.
  std::optional<double> silence(Exchange exchange) const;

  /// Runs until `stop` is readable.
  void run(int stop);

  static constexpr std::size_t kLongestBody = Session::kLongestLine;

 private:
  struct Connection;
  struct Open {
    lws* wsi = nullptr;
    HttpRequest request;
    std::optional<web::Chunks> chunks;  // nothing: the body comes whole
    bool is_admitted = false;           // its body is kept
    bool too_long = false;
    bool has_come = false;
    int status = 0;  // of the answer [0: none yet]
    std::string type;
    std::string session;
    std::string body;  // to be sent
    bool streams = false;
    bool begun = false;  // the headers are sent
    bool complete = false;
    int silent = 0;  // ticks
  };

  int begin(lws* wsi, Connection& connection, const char* path);
  int take(const Connection& connection, std::string_view data);
  int complete(const Connection& connection);
  int send(lws* wsi, Connection& connection);
  int finish(Connection& connection);
  static bool send_headers(lws* wsi, const Open& answer);
  void closed(Exchange exchange);
  void tick();
  static int http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);

  Events events_;
  std::map<Exchange, Open> open_;
  Exchange last_ = 0;
  lws_vhost* vhost_ = nullptr;
  web::Loop loop_;  // its end needs the rest
};

}  // namespace saphira::mcp

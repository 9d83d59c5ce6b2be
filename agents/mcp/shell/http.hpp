#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

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
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  void watch(int fd);

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
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::mcp

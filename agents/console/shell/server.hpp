#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/console/access.hpp"
#include "sockets.hpp"

namespace saphira::console {

/// A page: a document with its script and its style sheet inside.
struct PageFile {
  std::string path;  ///< such as /index.html
  std::string_view content;
};

/// The files of the page, embedded in the program.
std::vector<PageFile> page_files();

struct ServerOptions {
  /// To listen on. port: the first to try.
  web::Place place{"127.0.0.1", 8642, {}, {}};
  int ports = 20;        ///< how many to try
  int before = 0;        ///< tried before them, if in their range
  bool relayed = false;  ///< visitors of a relay come too, to kRelayed
};

/// The address for visitors of a relay, who count as remote.
constexpr const char* kRelayed = "127.0.0.77";

/// The kinds of a page's connections: so that telemetry never delays a command, nor a picture
/// either. simulator: both ways, of the page of the simulator's own view. The messages of pictures
/// are bytes.
enum class Channel { telemetry, commands, pictures, simulator };

/// HTTP and WebSockets (libwebsockets), in one thread: the page's files, and texts to and from each
/// connection. Bounded: connections, sizes, and silences.
class Server {
 public:
  using Connection = web::Sockets::Connection;

  /// The callbacks for events. Each is called from run() alone.
  struct Events {
    std::function<void(Connection, Channel, const Caller&)> opened;
    /// False closes the connection.
    std::function<bool(Connection, const std::string& text)> came;
    std::function<void(Connection)> closed;
    /// The next text for a connection, when it can be sent; nothing: none.
    std::function<std::optional<std::string>(Connection)> next;
    std::function<void()> readable;  ///< the file descriptor of watch()
    std::function<void()> tick;      ///< 20 times a second
  };

  /// std::runtime_error that names the cause (no port, no certificate).
  Server(const ServerOptions& options, const AccessSettings& access,
         const std::vector<PageFile>& files, Events events);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const { return sockets_.port(); }
  /// At kRelayed.
  int relayed_port() const { return lws_get_vhost_listen_port(relayed_); }
  /// From now on Events::readable is called when this is readable.
  void watch(int fd) { sockets_.watch(fd, events_.readable); }
  /// There may be something to send: next() is called soon.
  void want(Connection connection) { sockets_.want(connection); }
  /// The same for all connections, a hundredth of a second later: simultaneous news go together.
  void want_all_soon() { sockets_.want_all_soon(); }
  void close(Connection connection) { sockets_.close(connection); }

  /// Runs until `stop` is readable.
  void run(int stop);

 private:
  struct Page;
  struct Http;

  Caller caller_of(lws* wsi) const;
  int answer(lws* wsi, Http& http, std::string_view path) const;
  void opened(Connection id, lws* wsi);
  std::optional<web::Sockets::Message> next(Connection id) const;
  void listen(const ServerOptions& options);
  static int http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);

  AccessSettings access_;
  std::vector<Page> pages_;
  Events events_;
  std::set<Connection> pictures_;  ///< what goes out is no text
  lws_vhost* relayed_ = nullptr;   ///< null: nobody comes by a relay
  web::Sockets sockets_;           // its end needs the rest
};

}  // namespace saphira::console

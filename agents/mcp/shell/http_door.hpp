#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "door.hpp"
#include "http.hpp"
#include "saphira/mcp/lease.hpp"

namespace saphira::mcp {

struct HttpDoorOptions {
  int port = 0;       ///< 0: any that is free
  std::string token;  ///< required in every request
  std::string who;    ///< the asker, as shown to others
  std::string version;
  std::string instructions;
  std::vector<std::string> described;  ///< agents, as of Robot
};

/// Streamable HTTP: up to 8 clients, each with a door of its own. A client without a request or a
/// pending answer for 30 s has left, and its goals end; with a goal underway likewise a client that
/// closes a connection or stream, and sends no request for 1.5 s.
class HttpDoor {
 public:
  HttpDoor(bus::Node& node, HttpDoorOptions options);

  int port() const { return server_.port(); }
  void run(const bus::Stop& stop);

 private:
  using Exchange = HttpServer::Exchange;

  struct Client {
    Client(bus::Node& node, const Robot& robot, const HttpDoorOptions& options, double now)
        : session("saphira", options.version, options.instructions),
          door(node, robot, session, options.who),
          lease(now) {}
    Session session;
    Door door;
    Lease lease;
    bool is_new = false;             ///< its first answer will contain its session
    std::map<Exchange, bool> waits;  ///< requests without an answer; true: it streams
    Exchange stream = 0;             ///< the one for messages outside of an answer [0: none]
  };

  HttpServer::Events events();
  void came(Exchange exchange, const HttpRequest& request);
  void lost(Exchange exchange);
  void open_stream(Exchange exchange, Client& client);
  void turn();
  void tick();
  Client* client_of(Exchange exchange, const HttpRequest& request, std::string& id);
  void tell(const std::string& id, Client& client);
  void refuse(Exchange exchange, int status, const std::string& text);

  bus::Node& node_;
  const HttpDoorOptions options_;
  const console::AccessSettings access_;
  Robot robot_;
  std::map<std::string, std::unique_ptr<Client>> clients_;  ///< by session or identity
  HttpServer server_;
};

}  // namespace saphira::mcp

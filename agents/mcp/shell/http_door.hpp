#pragma once

#include <map>
#include <memory>
#include <string>

#include "door.hpp"
#include "http.hpp"

namespace saphira::mcp {

struct HttpDoorOptions {
  int port = 0;       ///< 0: any that is free
  std::string token;  ///< what every request has to carry
  std::string who;    ///< asks, as others see it
  std::string version;
  std::string instructions;
};

/// Streamable HTTP: any number of clients up to 8, each with a door of its own. A client that
/// neither asks nor waits for an answer for 30 s has left, and its goals end; likewise one that
/// breaks a connection on which it waits, and does not ask again for 2 s.
class HttpDoor {
 public:
  HttpDoor(bus::Node& node, HttpDoorOptions options);

  int port() const { return server_.port(); }
  void run(const bus::Stop& stop);

 private:
  using Exchange = HttpServer::Exchange;

  struct Client {
    Client(bus::Node& node, const Robot& robot, const HttpDoorOptions& options)
        : session("saphira", options.version, options.instructions),
          door(node, robot, session, options.who) {}
    Session session;
    Door door;
    bool broken = false;  ///< its connection has ended before an answer, since it last asked
    double heard = 0.0;   ///< [s] when it last asked
    bool is_new = false;  ///< its first answer names its session
    std::map<Exchange, bool> waits;  ///< requests that are not answered, and whether one streams
  };

  HttpServer::Events events();
  void came(Exchange exchange, const HttpRequest& request);
  void lost(Exchange exchange);
  void turn();
  void tick();
  Client* client_of(Exchange exchange, const HttpRequest& request, std::string& id);
  void tell(const std::string& id, Client& client);
  void refuse(Exchange exchange, int status, const std::string& text);

  bus::Node& node_;
  const HttpDoorOptions options_;
  const console::AccessSettings access_;
  Robot robot_;
  std::map<std::string, std::unique_ptr<Client>> clients_;  ///< by session, or what it says it is
  HttpServer server_;
};

}  // namespace saphira::mcp

#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "door.hpp"
#include "http.hpp"
#include "saphira/bus/audit.hpp"
#include "saphira/mcp/clients.hpp"

namespace saphira::mcp {

struct HttpDoorOptions {
  int port = 0;       ///< 0: any that is free
  std::string token;  ///< required in every request
  std::string who;    ///< the asker, as shown to others
  std::string version;
  std::string instructions;
  std::vector<std::string> described;  ///< agents, as of Robot
  std::vector<std::string> names;      ///< host names of proxies before it
  std::vector<std::string> person_keys = security::door_key_files();
};

/// Streamable HTTP: one door for each client. `Clients` decides which clients are there.
class HttpDoor {
 public:
  HttpDoor(bus::Node& node, HttpDoorOptions options);

  int port() const { return server_.port(); }
  void run(const bus::Stop& stop);

 private:
  using Exchange = HttpServer::Exchange;

  struct Client {
    Client(bus::Node& node, const Robot& robot, const HttpDoorOptions& options,
           const std::string& name, const console::Visitor& by)
        : visitor(by),
          session("saphira", options.version, options.instructions),
          door(node, robot, session, options.who + " " + name, by.person) {}
    const console::Visitor visitor;
    Session session;
    Door door;
    bool is_new = false;             ///< its first answer will contain its session
    std::map<Exchange, bool> waits;  ///< requests without an answer; true: it streams
    Exchange stream = 0;             ///< the one for messages outside of an answer [0: none]
  };

  HttpServer::Events events();
  console::Visitor visitor_of(const HttpRequest& request) const;
  void came(Exchange exchange, const HttpRequest& request);
  void lost(Exchange exchange);
  void open_stream(Exchange exchange, Client& client);
  void turn();
  void tick();
  Client* client_of(Exchange exchange, const HttpRequest& request, const Sender& sender,
                    const console::Visitor& visitor, std::string& id);
  bool is_stop(const Sender& sender) const;
  std::map<std::string, std::unique_ptr<Client>>::iterator end(const std::string& id);
  void see(const std::string& id, Client& client);
  void tell(const std::string& id, Client& client);
  void refuse(Exchange exchange, int status, const std::string& text);

  bus::Node& node_;
  const HttpDoorOptions options_;
  const console::AccessSettings access_;
  security::DoorKeysFile keys_;
  bus::Audit audit_;
  Robot robot_;
  std::map<std::string, std::unique_ptr<Client>> clients_;  ///< by session or identity
  Clients presence_;                                        ///< of the same
  HttpServer server_;
};

}  // namespace saphira::mcp

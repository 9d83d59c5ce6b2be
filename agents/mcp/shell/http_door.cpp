#include "http_door.hpp"

#include "key.hpp"
#include "saphira/base/boot_clock.hpp"

namespace saphira::mcp {

namespace {

constexpr std::size_t kMostClients = 8;
constexpr const char* kPath = "/mcp";
constexpr const char* kJson = "application/json";

double now() {
  return BootClock::seconds();
}

}  // namespace

HttpDoor::HttpDoor(bus::Node& node, HttpDoorOptions options)
    : node_(node),
      options_(std::move(options)),
      access_{options_.token, {}},
      robot_(node, options_.described),
      server_(options_.port, events()) {
  server_.watch(node.wake_fd());
}

HttpServer::Events HttpDoor::events() {
  return {[this](Exchange exchange, const HttpRequest& request) { came(exchange, request); },
          [this](Exchange exchange) { lost(exchange); },
          [this] {
            node_.clear_wake();
            turn();
          },
          [this] { tick(); }};
}

void HttpDoor::refuse(Exchange exchange, int status, const std::string& text) {
  server_.answer(exchange, status, "text/plain", text + "\n");
}

/// The session of a request. Null: the request is refused.
HttpDoor::Client* HttpDoor::client_of(Exchange exchange, const HttpRequest& request,
                                      std::string& id) {
  const Sender sender = sender_of(request.body);
  const bool modern = sender.modern || request.version == Session::kModern;
  const bool begins = !modern && sender.begins;
  // The newer era has no sessions: clients are distinguished by their own identity.
  id = modern ? "client " + sender.client : begins ? console::new_key() : request.session;
  if (const auto found = clients_.find(id); found != clients_.end())
    return found->second.get();
  if (!modern && !begins) {
    if (id.empty())
      refuse(exchange, 400, "Mcp-Session-Id is missing: a session begins with initialize");
    else
      refuse(exchange, 404, "there is no such session any more: begin with initialize");
    return nullptr;
  }
  if (clients_.size() >= kMostClients) {
    refuse(exchange, 503, "8 clients are here; one that is silent for 30 s makes room");
    return nullptr;
  }
  auto& client = clients_[id];
  client = std::make_unique<Client>(node_, robot_, options_, now());
  client->is_new = begins;
  return client.get();
}

void HttpDoor::came(Exchange exchange, const HttpRequest& request) {
  if (const std::string why = console::refusal(access_, request.caller); !why.empty())
    return refuse(exchange, 403, why);
  if (request.path != kPath)
    return refuse(exchange, 404, "there is only /mcp");
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view given = request.authorization;
  if (!given.starts_with(kBearer) || !console::right_key(access_, given.substr(kBearer.size())))
    return refuse(exchange, 401, "expected the header Authorization: Bearer TOKEN");
  if (request.method == "DELETE") {
    const auto found = clients_.find(request.session);
    if (found == clients_.end())
      return refuse(exchange, 404, "there is no such session");
    found->second->door.close();
    for (const auto& [open, streams] : found->second->waits)
      server_.event(open, "", true);
    clients_.erase(found);
    return server_.answer(exchange, 200, "text/plain", "");
  }
  // The newer era has streams of a request alone.
  if (request.method != "POST" && (request.method != "GET" || request.version == Session::kModern))
    return refuse(exchange, 405, "messages come by POST");
  std::string id;
  Client* const client = client_of(exchange, request, id);
  if (client == nullptr)
    return;
  client->lease.came(now());
  const Headers headers{request.version, request.mcp_method, request.mcp_name};
  client->waits[exchange] = false;
  if (request.method == "GET")
    return open_stream(exchange, *client);
  robot_.poll(now());
  client->door.turn(now());
  if (!client->session.take(request.body, exchange, &headers)) {
    client->waits.erase(exchange);
    server_.answer(exchange, 202, kJson, "");
  }
  client->door.turn(now());
  tell(id, *client);
}

/// A stream for messages outside of an answer. It replaces the one before.
void HttpDoor::open_stream(Exchange exchange, Client& client) {
  if (client.waits.erase(client.stream) > 0)
    server_.event(client.stream, "", true);
  client.stream = exchange;
  client.waits[exchange] = true;
  server_.event(exchange, "", false);
}

/// Sends a client's messages. A message without an open connection cannot be sent.
void HttpDoor::tell(const std::string& id, Client& client) {
  for (const Line& line : client.session.take_lines()) {
    const auto waits = client.waits.find(line.exchange == 0 ? client.stream : line.exchange);
    if (waits == client.waits.end())
      continue;
    if (line.last && !waits->second) {
      server_.answer(line.exchange, line.status, kJson, line.text, client.is_new ? id : "");
      client.is_new = false;
    } else {
      server_.event(waits->first, line.text, line.last);
      waits->second = true;
    }
    if (line.last)
      client.waits.erase(waits);
  }
}

void HttpDoor::lost(Exchange exchange) {
  for (const auto& [id, client] : clients_)
    if (client->waits.erase(exchange) > 0) {
      client->session.close(exchange);
      client->lease.broke(now());
    }
}

void HttpDoor::turn() {
  robot_.poll(now());
  for (const auto& [id, client] : clients_) {
    client->door.turn(now());
    tell(id, *client);
  }
}

void HttpDoor::tick() {
  turn();
  for (auto each = clients_.begin(); each != clients_.end();) {
    Client& client = *each->second;
    if (!client.lease.is_over(now(), !client.waits.empty(), client.door.is_busy())) {
      ++each;
      continue;
    }
    client.door.close();
    each = clients_.erase(each);
  }
}

void HttpDoor::run(const bus::Stop& stop) {
  server_.run(stop.fd());
  for (const auto& [id, client] : clients_)
    client->door.close_and_wait();
}

}  // namespace saphira::mcp

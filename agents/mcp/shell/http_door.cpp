#include "http_door.hpp"

#include <algorithm>
#include <utility>

#include "key.hpp"
#include "saphira/base/boot_clock.hpp"

namespace saphira::mcp {

namespace {

constexpr const char* kPath = "/mcp";
constexpr const char* kJson = "application/json";

double now() {
  return BootClock::seconds();
}

/// Empty: none.
std::string_view key_of(const HttpRequest& request) {
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view given = request.authorization;
  return given.starts_with(kBearer) ? given.substr(kBearer.size()) : std::string_view();
}

bool is_of(const console::Visitor& one, const console::Visitor& other) {
  return one.person.has_value() == other.person.has_value() &&
         (!one.person || one.person->name == other.person->name);
}

}  // namespace

HttpDoor::HttpDoor(bus::Node& node, HttpDoorOptions options)
    : node_(node),
      options_(std::move(options)),
      access_{options_.token, options_.names},
      keys_(options_.person_keys),
      audit_(node),
      robot_(node, options_.described),
      server_(options_.port, events()) {
  server_.watch(node.wake_fd());
}

HttpServer::Events HttpDoor::events() {
  return {[this](const HttpRequest& request) {
            return visitor_of(request).may(security::DoorRight::watch);
          },
          [this](Exchange exchange, const HttpRequest& request) { came(exchange, request); },
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

/// The call of a tool that is always allowed.
bool HttpDoor::is_stop(const Sender& sender) const {
  return std::ranges::any_of(
      robot_.tools(), [&](const Tool& tool) { return tool.always && tool.name == sender.tool; });
}

/// The client of a request. Null: the request is refused.
HttpDoor::Client* HttpDoor::client_of(Exchange exchange, const HttpRequest& request,
                                      const Sender& sender, const console::Visitor& visitor,
                                      std::string& id) {
  const bool modern = sender.modern || request.version == Session::kModern;
  const bool begins = !modern && sender.begins;
  // The newer era has no sessions: clients are distinguished by their own identity.
  id = modern   ? "client " + (visitor.person ? visitor.person->name + " " : "") + sender.client
       : begins ? console::new_key()
                : request.session;
  if (const auto found = clients_.find(id); found != clients_.end() && id != Clients::kNobody) {
    if (is_of(found->second->visitor, visitor))
      return found->second.get();
    refuse(exchange, 403, "this session began with another key");
    return nullptr;
  }
  const auto place = modern || begins ? presence_.place() : std::nullopt;
  if (!place) {
    if (!is_stop(sender)) {
      if (modern || begins)
        refuse(exchange, 503,
               "every place has a client with a goal underway; a stop is taken all the same, "
               "without a session: tools/call of emergency_stop");
      else if (id.empty())
        refuse(exchange, 400, "Mcp-Session-Id is missing: a session begins with initialize");
      else
        refuse(exchange, 404, "there is no such session any more: begin with initialize");
      return nullptr;
    }
    id = Clients::kNobody;
    if (const auto found = clients_.find(id); found != clients_.end())
      return found->second.get();
  } else if (!place->empty()) {
    node_.info(clients_.at(*place)->door.who() + " gives its place to a new client");
    end(*place);
  }
  auto& client = clients_[id];
  client =
      std::make_unique<Client>(node_, robot_, options_, presence_.begin(id, sender.name, now()),
                               id == Clients::kNobody ? console::Visitor{} : visitor);
  if (visitor.person)
    audit_.write({.act = v1::AUDIT_LET_IN,
                  .who = visitor.person->name + " by " + client->door.who(),
                  .text = std::string("to ") + security::name_of(visitor.right)});
  client->is_new = begins;
  return client.get();
}

/// Its goals end, and its streams.
std::map<std::string, std::unique_ptr<HttpDoor::Client>>::iterator HttpDoor::end(
    const std::string& id) {
  const auto found = clients_.find(id);
  found->second->door.close();
  for (const auto& [open, streams] : found->second->waits)
    server_.event(open, "", true);
  presence_.end(id);
  return clients_.erase(found);
}

console::Visitor HttpDoor::visitor_of(const HttpRequest& request) const {
  return console::visitor_of(access_, keys_.keys(), key_of(request), unix_seconds());
}

void HttpDoor::came(Exchange exchange, const HttpRequest& request) {
  if (const std::string why = console::refusal(access_, request.caller); !why.empty())
    return refuse(exchange, 403, why);
  if (!request.path.ends_with(kPath))  // a proxy may pass its own path on
    return refuse(exchange, 404, "there is only /mcp");
  const console::Visitor visitor = visitor_of(request);
  if (!visitor.may(security::DoorRight::watch)) {
    if (!request.authorization.empty())
      audit_.wrong_key("MCP by HTTP", now(), keys_.keys().ended(key_of(request), unix_seconds()));
    return refuse(exchange, 401,
                  "expected the header Authorization: Bearer TOKEN; TOKEN is the first line of the "
                  "file that saphira mcp names at its start, or a person's key (saphira keys)");
  }
  if (request.method == "DELETE") {
    const auto found = clients_.find(request.session);
    if (request.session == Clients::kNobody || found == clients_.end() ||
        !is_of(found->second->visitor, visitor))
      return refuse(exchange, 404, "there is no such session");
    end(request.session);
    return server_.answer(exchange, 200, "text/plain", "");
  }
  // The newer era has streams of a request alone.
  if (request.method != "POST" && (request.method != "GET" || request.version == Session::kModern))
    return refuse(exchange, 405, "messages come by POST");
  const Sender sender = sender_of(request.body);
  std::string id;
  Client* const client = client_of(exchange, request, sender, visitor, id);
  if (client == nullptr)
    return;
  console::AccessSettings here;
  here.port = port();
  presence_.came(id, !console::may_watch(here, request.caller), now());
  if (sender.answers)
    presence_.answered(id);
  see(id, *client);
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
    if (client->waits.erase(exchange) > 0)
      client->session.close(exchange);
}

void HttpDoor::turn() {
  robot_.poll(now());
  for (const auto& [id, client] : clients_) {
    client->door.turn(now());
    tell(id, *client);
  }
}

/// Tells a client's state, and asks if it may begin anything.
void HttpDoor::see(const std::string& id, Client& client) {
  const double time = now();
  Clients::State state;
  for (const auto& [exchange, streams] : client.waits)
    if (const auto silence = server_.silence(exchange)) {
      ++state.connections;
      state.heard = std::max(state.heard, time - *silence);
    }
  state.streams = client.waits.contains(client.stream);
  state.waits = client.door.is_asked();
  state.busy = client.door.is_busy();
  state.silent = client.door.is_silent();
  presence_.see(id, state, time);
  client.door.allow(presence_.may_begin(id));
}

void HttpDoor::tick() {
  turn();
  audit_.tend(now());
  if (const std::string trouble = keys_.reload(unix_seconds()); !trouble.empty())
    node_.error(trouble);
  for (auto each = clients_.begin(); each != clients_.end();) {
    const auto& [id, client] = *each;
    if (const auto& person = client->visitor.person;
        person && !keys_.keys().holds(*person, unix_seconds())) {
      node_.info("the key of " + person->name + " holds no more: " + client->door.who() + " ends");
      each = end(std::string(id));
      continue;
    }
    see(id, *client);
    if (presence_.is_gone(id, now())) {
      each = end(std::string(id));
      continue;
    }
    if (presence_.loses_goals(id, now())) {
      node_.info(client->door.who() + " is not there: its goals end");
      client->door.close(presence_.is_hidden(id)
                             ? "its client sent nothing for a while, and a proxy hides the rest"
                             : "its client had no stream and no call open");
    }
    if (presence_.is_pinged(id, now())) {
      client->session.ping();
      tell(id, *client);
    }
    ++each;
  }
}

void HttpDoor::run(const bus::Stop& stop) {
  server_.run(stop.fd());
  for (const auto& [id, client] : clients_)
    client->door.close_and_wait();
}

}  // namespace saphira::mcp

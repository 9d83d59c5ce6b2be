#include "http.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "saphira/base/base64.hpp"

namespace saphira::mcp {

namespace {

constexpr unsigned kMostDescriptors = 1024;
constexpr int kTick = 50'000;                       // [us]
constexpr int kTicksOfSilence = 100;                // then a stream sends a sign of life
constexpr std::size_t kLongestQueue = 1024 * 1024;  // of a client that does not read
constexpr int kUnauthorized = 401;
constexpr const char* kSign = ": \r\n";  // of life, in a stream

using web::header;

/// Text that is not ASCII comes as =?base64?...?=.
std::string decoded_header(lws* wsi, const char* name) {
  const std::string value = web::custom_header(wsi, name);
  if (!value.starts_with("=?base64?") || !value.ends_with("?=") || value.size() < 11)
    return value;
  return from_base64(value.substr(9, value.size() - 11)).value_or("");
}

/// The system asks the client's side every second for a sign of life, as silence() promises.
void ask_for_life(int fd) {
  constexpr int kOne = 1;
  constexpr int kMost = 3;
  setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &kOne, sizeof kOne);
  setsockopt(fd, IPPROTO_TCP, TCP_KEEPIDLE, &kOne, sizeof kOne);
  setsockopt(fd, IPPROTO_TCP, TCP_KEEPINTVL, &kOne, sizeof kOne);
  setsockopt(fd, IPPROTO_TCP, TCP_KEEPCNT, &kMost, sizeof kMost);
}

/// As HttpServer::silence.
std::optional<double> silence_of(lws* wsi) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (getsockopt(lws_get_socket_fd(wsi), IPPROTO_TCP, TCP_INFO, &info, &size) != 0 ||
      info.tcpi_state != TCP_ESTABLISHED)
    return std::nullopt;
  return std::min(info.tcpi_last_ack_recv, info.tcpi_last_data_recv) / 1000.0;
}

}  // namespace

/// The record of libwebsockets for each connection; it begins as zeros.
struct HttpServer::Connection {
  Exchange exchange;
};

/// The headers of a request have come.
int HttpServer::begin(lws* wsi, Connection& connection, const char* path) {
  if (connection.exchange != 0)
    return -1;  // a request behind another one: see web::kAnswered
  ask_for_life(lws_get_socket_fd(wsi));
  connection.exchange = ++last_;
  Open& exchange = open_[connection.exchange];
  exchange.wsi = wsi;
  HttpRequest& request = exchange.request;
  request.path = path;
  request.method = lws_hdr_total_length(wsi, WSI_TOKEN_POST_URI) > 0     ? "POST"
                   : lws_hdr_total_length(wsi, WSI_TOKEN_DELETE_URI) > 0 ? "DELETE"
                   : lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) > 0    ? "GET"
                                                                         : "";
  request.caller = {web::host(wsi), header(wsi, WSI_TOKEN_ORIGIN), web::is_here(wsi)};
  request.authorization = header(wsi, WSI_TOKEN_HTTP_AUTHORIZATION);
  request.session = decoded_header(wsi, "mcp-session-id:");
  request.version = decoded_header(wsi, "mcp-protocol-version:");
  request.mcp_method = decoded_header(wsi, "mcp-method:");
  request.mcp_name = decoded_header(wsi, "mcp-name:");
  exchange.is_admitted = events_.admits(request);
  if (request.method != "POST")
    return complete(connection);
  if (lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_TRANSFER_ENCODING) > 0) {
    exchange.chunks.emplace();
    return 0;
  }
  const std::string length = header(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH);
  return length.empty() || length == "0" ? complete(connection) : 0;
}

int HttpServer::take(const Connection& connection, std::string_view data) {
  const auto found = open_.find(connection.exchange);
  if (found == open_.end())
    return -1;
  Open& exchange = found->second;
  if (exchange.has_come)
    return 0;  // more than the request
  std::string& body = exchange.request.body;
  std::string piece;
  if (exchange.chunks) {
    if (!exchange.chunks->take(data, piece))
      return -1;
    data = piece;
  }
  exchange.too_long = exchange.too_long || body.size() + data.size() > kLongestBody;
  if (!exchange.too_long && exchange.is_admitted)
    body.append(data);
  return exchange.chunks && exchange.chunks->ended() ? complete(connection) : 0;
}

int HttpServer::complete(const Connection& connection) {
  const auto found = open_.find(connection.exchange);
  if (found == open_.end() || found->second.has_come)
    return found == open_.end() ? -1 : 0;
  found->second.has_come = true;
  lws_set_timeout(found->second.wsi, NO_PENDING_TIMEOUT, 0);  // its answer may take its time
  if (found->second.too_long) {
    found->second.status = HTTP_STATUS_REQ_ENTITY_TOO_LARGE;
    found->second.type = "text/plain";
    found->second.body = "a message has at most " + std::to_string(kLongestBody) + " bytes\n";
    found->second.complete = true;
    lws_callback_on_writable(found->second.wsi);
    return 0;
  }
  events_.came(connection.exchange, std::move(found->second.request));
  return 0;
}

bool HttpServer::send_headers(lws* wsi, const Open& answer) {
  web::Headers headers{{"x-accel-buffering:", "no"}};
  if (!answer.session.empty())
    headers.emplace_back("mcp-session-id:", answer.session);
  if (answer.status == kUnauthorized)
    headers.emplace_back("www-authenticate:", "Bearer");
  if (answer.status == HTTP_STATUS_METHOD_NOT_ALLOWED)
    headers.emplace_back("allow:", "GET, POST, DELETE");
  return web::begin_answer(wsi, answer.status, answer.type,
                           answer.streams ? LWS_ILLEGAL_HTTP_CONTENT_LEN : answer.body.size(),
                           headers);
}

int HttpServer::send(lws* wsi, Connection& connection) {
  const auto found = open_.find(connection.exchange);
  if (found == open_.end() || found->second.status == 0)
    return 0;
  Open& answer = found->second;
  if (!answer.begun) {
    answer.begun = true;
    if (!send_headers(wsi, answer))
      return -1;
    if (!answer.complete || !answer.body.empty()) {
      lws_callback_on_writable(wsi);
      return 0;
    }
    return finish(connection);
  }
  if (answer.body.empty() && !answer.complete)
    return 0;
  const std::string body = std::exchange(answer.body, {});
  const bool final = answer.complete;
  if (!web::write(wsi, body, final ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP))
    return -1;
  return final ? finish(connection) : 0;
}

/// The answer is sent.
int HttpServer::finish(Connection& connection) {
  const auto found = open_.find(connection.exchange);
  open_.erase(found);
  connection.exchange = 0;
  return web::kAnswered;
}

void HttpServer::closed(Exchange exchange) {
  const auto found = open_.find(exchange);
  if (found == open_.end())
    return;
  const bool is_known = found->second.has_come;
  open_.erase(found);
  if (is_known)
    events_.lost(exchange);
}

/// libwebsockets notices the end of a client when it writes; the socket knows it at once.
void HttpServer::tick() {
  for (auto each = open_.begin(); each != open_.end();) {
    const auto [exchange, wsi] = std::pair(each->first, each->second.wsi);
    ++each;
    if (silence_of(wsi))
      continue;
    web::drop(wsi);
    closed(exchange);
  }
  events_.tick();
  for (auto& [exchange, answer] : open_) {
    if (!answer.streams || answer.complete || !answer.body.empty() ||
        ++answer.silent < kTicksOfSilence)
      continue;
    answer.silent = 0;
    answer.body = kSign;  // clients give up a stream that is silent for minutes
    lws_callback_on_writable(answer.wsi);
  }
}

int HttpServer::http(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                     std::size_t size) {
  auto* const connection = static_cast<Connection*>(user);
  const auto self = [wsi]() -> HttpServer& {
    return *static_cast<HttpServer*>(lws_context_user(lws_get_context(wsi)));
  };
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return self().begin(wsi, *connection, static_cast<const char*>(in));
    case LWS_CALLBACK_HTTP_BODY:
      return self().take(*connection, {static_cast<const char*>(in), size});
    case LWS_CALLBACK_HTTP_BODY_COMPLETION:
      return self().complete(*connection);
    case LWS_CALLBACK_HTTP_WRITEABLE:
      return self().send(wsi, *connection);
    case LWS_CALLBACK_CLOSED_HTTP:
      if (connection != nullptr)
        self().closed(connection->exchange);
      return 0;
    default:
      return web::Loop::otherwise(wsi, reason, user, in, size);
  }
}

HttpServer::HttpServer(int port, Events events)
    : events_(std::move(events)), loop_(this, kMostDescriptors, false) {
  static const std::array<lws_protocols, 3> protocols{
      {{"http", http, sizeof(Connection), 0, 0, nullptr, 0},
       web::Loop::descriptors(),
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  lws_context_creation_info info{};
  info.protocols = protocols.data();
  info.timeout_secs = 5;  // for clients without a complete request
  info.keepalive_timeout = 30;
  info.vhost_name = "mcp";
  vhost_ = loop_.listen(info, {"127.0.0.1", port, {}, {}});
  if (vhost_ == nullptr)
    throw std::runtime_error("cannot listen on 127.0.0.1 port " + std::to_string(port) +
                             ": another program has it");
}

void HttpServer::answer(Exchange exchange, int status, const std::string& type, std::string body,
                        const std::string& session) {
  const auto found = open_.find(exchange);
  if (found == open_.end() || found->second.status != 0)
    return;
  Open& answer = found->second;
  answer.status = status;
  answer.type = type;
  answer.body = std::move(body);
  answer.session = session;
  answer.complete = true;
  lws_callback_on_writable(answer.wsi);
}

void HttpServer::event(Exchange exchange, const std::string& message, bool last) {
  const auto found = open_.find(exchange);
  if (found == open_.end() || found->second.complete)
    return;
  Open& answer = found->second;
  answer.status = HTTP_STATUS_OK;
  answer.type = "text/event-stream";
  answer.streams = true;
  answer.silent = 0;
  answer.complete = last;
  answer.body += message.empty() ? kSign : "event: message\ndata: " + message + "\n\n";
  if (answer.body.size() > kLongestQueue)
    web::drop(answer.wsi);
  lws_callback_on_writable(answer.wsi);
}

std::optional<double> HttpServer::silence(Exchange exchange) const {
  const auto found = open_.find(exchange);
  return found == open_.end() ? std::nullopt : silence_of(found->second.wsi);
}

void HttpServer::run(int stop) {
  loop_.every(kTick, [this] { tick(); });
  loop_.run(vhost_, stop);
}

}  // namespace saphira::mcp

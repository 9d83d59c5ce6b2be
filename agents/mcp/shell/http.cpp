#include "http.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "chunks.hpp"
#include "loop.hpp"

namespace saphira::mcp {

namespace {

constexpr unsigned kMostDescriptors = 1024;
constexpr int kTick = 50'000;         // [us]
constexpr int kTicksOfSilence = 100;  // then a stream sends a sign of life
constexpr std::size_t kLongestHeader = 1024;
constexpr std::size_t kLongestQueue = 1024 * 1024;  // of a client that does not read
constexpr int kUnauthorized = 401;
constexpr const char* kSign = ": \r\n";  // of life, in a stream

using web::header;

/// Text that is not ASCII comes as =?base64?...?=.
std::string decoded_header(lws* wsi, const char* name) {
  std::string value = web::custom_header(wsi, name);
  if (!value.starts_with("=?base64?") || !value.ends_with("?=") || value.size() < 11)
    return value;
  std::array<char, kLongestHeader> decoded{};
  const int size = lws_b64_decode_string(value.substr(9, value.size() - 11).c_str(), decoded.data(),
                                         static_cast<int>(decoded.size()));
  return size > 0 ? std::string(decoded.data(), static_cast<std::size_t>(size)) : std::string();
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

struct HttpServer::Impl {
  /// The record of libwebsockets for each connection; it begins as zeros.
  struct Connection {
    Exchange exchange;
  };
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

  Events events;
  std::optional<web::Loop> loop;
  lws_vhost* vhost = nullptr;
  std::map<Exchange, Open> open;
  Exchange last = 0;

  int begin(lws* wsi, Connection& connection, const char* path);
  int take(const Connection& connection, std::string_view data);
  int complete(const Connection& connection);
  int send(lws* wsi, Connection& connection);
  int finish(Connection& connection);
  static bool send_headers(lws* wsi, const Open& answer);
  void closed(Exchange exchange);
  void tick();

  static Impl& of(lws* wsi) { return *static_cast<Impl*>(lws_context_user(lws_get_context(wsi))); }
  static int http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
};

/// The headers of a request have come.
int HttpServer::Impl::begin(lws* wsi, Connection& connection, const char* path) {
  if (connection.exchange != 0)
    return -1;  // a request behind another one: see web::kAnswered
  ask_for_life(lws_get_socket_fd(wsi));
  connection.exchange = ++last;
  Open& exchange = open[connection.exchange];
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
  exchange.is_admitted = events.admits(request);
  if (request.method != "POST")
    return complete(connection);
  if (lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_TRANSFER_ENCODING) > 0) {
    exchange.chunks.emplace();
    return 0;
  }
  const std::string length = header(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH);
  return length.empty() || length == "0" ? complete(connection) : 0;
}

int HttpServer::Impl::take(const Connection& connection, std::string_view data) {
  const auto found = open.find(connection.exchange);
  if (found == open.end())
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

int HttpServer::Impl::complete(const Connection& connection) {
  const auto found = open.find(connection.exchange);
  if (found == open.end() || found->second.has_come)
    return found == open.end() ? -1 : 0;
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
  events.came(connection.exchange, std::move(found->second.request));
  return 0;
}

bool HttpServer::Impl::send_headers(lws* wsi, const Open& answer) {
  std::array<unsigned char, LWS_PRE + 2048> buffer{};
  unsigned char* const start = buffer.data() + LWS_PRE;
  unsigned char* at = start;
  unsigned char* const end = buffer.data() + buffer.size() - 1;
  const auto add = [&](const char* name, const std::string& value) {
    return lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(name),
                                       reinterpret_cast<const unsigned char*>(value.c_str()),
                                       static_cast<int>(value.size()), &at, end) == 0;
  };
  const lws_filepos_t length = answer.streams ? LWS_ILLEGAL_HTTP_CONTENT_LEN : answer.body.size();
  return lws_add_http_common_headers(wsi, static_cast<unsigned>(answer.status), answer.type.c_str(),
                                     length, &at, end) == 0 &&
         add("cache-control:", "no-cache") && add("x-accel-buffering:", "no") &&
         add("x-content-type-options:", "nosniff") && add("connection:", "close") &&
         (answer.session.empty() || add("mcp-session-id:", answer.session)) &&
         (answer.status != kUnauthorized || add("www-authenticate:", "Bearer")) &&
         (answer.status != HTTP_STATUS_METHOD_NOT_ALLOWED || add("allow:", "GET, POST, DELETE")) &&
         lws_finalize_write_http_header(wsi, start, &at, end) == 0;
}

int HttpServer::Impl::send(lws* wsi, Connection& connection) {
  const auto found = open.find(connection.exchange);
  if (found == open.end() || found->second.status == 0)
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
  std::vector<unsigned char> buffer(LWS_PRE + body.size());
  std::memcpy(buffer.data() + LWS_PRE, body.data(), body.size());
  const bool final = answer.complete;
  if (lws_write(wsi, buffer.data() + LWS_PRE, body.size(),
                final ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < static_cast<int>(body.size()))
    return -1;
  return final ? finish(connection) : 0;
}

/// The answer is sent.
int HttpServer::Impl::finish(Connection& connection) {
  const auto found = open.find(connection.exchange);
  open.erase(found);
  connection.exchange = 0;
  return web::kAnswered;
}

void HttpServer::Impl::closed(Exchange exchange) {
  const auto found = open.find(exchange);
  if (found == open.end())
    return;
  const bool is_known = found->second.has_come;
  open.erase(found);
  if (is_known)
    events.lost(exchange);
}

/// libwebsockets notices the end of a client when it writes; the socket knows it at once.
void HttpServer::Impl::tick() {
  for (auto each = open.begin(); each != open.end();) {
    const auto [exchange, wsi] = std::pair(each->first, each->second.wsi);
    ++each;
    if (silence_of(wsi))
      continue;
    lws_set_timeout(wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
    closed(exchange);
  }
  events.tick();
  for (auto& [exchange, answer] : open) {
    if (!answer.streams || answer.complete || !answer.body.empty() ||
        ++answer.silent < kTicksOfSilence)
      continue;
    answer.silent = 0;
    answer.body = kSign;  // clients give up a stream that is silent for minutes
    lws_callback_on_writable(answer.wsi);
  }
}

int HttpServer::Impl::http(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                           std::size_t size) {
  auto* const connection = static_cast<Connection*>(user);
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return of(wsi).begin(wsi, *connection, static_cast<const char*>(in));
    case LWS_CALLBACK_HTTP_BODY:
      return of(wsi).take(*connection, {static_cast<const char*>(in), size});
    case LWS_CALLBACK_HTTP_BODY_COMPLETION:
      return of(wsi).complete(*connection);
    case LWS_CALLBACK_HTTP_WRITEABLE:
      return of(wsi).send(wsi, *connection);
    case LWS_CALLBACK_CLOSED_HTTP:
      if (connection != nullptr)
        of(wsi).closed(connection->exchange);
      return 0;
    default:
      return lws_callback_http_dummy(wsi, reason, user, in, size);
  }
}

HttpServer::HttpServer(int port, Events events) : impl_(std::make_unique<Impl>()) {
  impl_->events = std::move(events);
  static const std::array<lws_protocols, 3> protocols{
      {{"http", Impl::http, sizeof(Impl::Connection), 0, 0, nullptr, 0},
       web::Loop::descriptors(),
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  impl_->loop.emplace(impl_.get(), kMostDescriptors, false);
  lws_context_creation_info info{};
  info.protocols = protocols.data();
  info.timeout_secs = 5;  // for clients without a complete request
  info.keepalive_timeout = 30;
  info.vhost_name = "mcp";
  impl_->vhost = impl_->loop->listen(info, {"127.0.0.1", port, {}, {}});
  if (impl_->vhost == nullptr)
    throw std::runtime_error("cannot listen on 127.0.0.1 port " + std::to_string(port) +
                             ": another program has it");
}

HttpServer::~HttpServer() {
  impl_->loop.reset();  // its callbacks need the rest
}

int HttpServer::port() const {
  return lws_get_vhost_listen_port(impl_->vhost);
}

void HttpServer::watch(int fd) {
  impl_->loop->watch(impl_->vhost, fd, [this] { impl_->events.readable(); });
}

void HttpServer::answer(Exchange exchange, int status, const std::string& type, std::string body,
                        const std::string& session) {
  const auto found = impl_->open.find(exchange);
  if (found == impl_->open.end() || found->second.status != 0)
    return;
  Impl::Open& answer = found->second;
  answer.status = status;
  answer.type = type;
  answer.body = std::move(body);
  answer.session = session;
  answer.complete = true;
  lws_callback_on_writable(answer.wsi);
}

void HttpServer::event(Exchange exchange, const std::string& message, bool last) {
  const auto found = impl_->open.find(exchange);
  if (found == impl_->open.end() || found->second.complete)
    return;
  Impl::Open& answer = found->second;
  answer.status = HTTP_STATUS_OK;
  answer.type = "text/event-stream";
  answer.streams = true;
  answer.silent = 0;
  answer.complete = last;
  answer.body += message.empty() ? kSign : "event: message\ndata: " + message + "\n\n";
  if (answer.body.size() > kLongestQueue)
    lws_set_timeout(answer.wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
  lws_callback_on_writable(answer.wsi);
}

std::optional<double> HttpServer::silence(Exchange exchange) const {
  const auto found = impl_->open.find(exchange);
  return found == impl_->open.end() ? std::nullopt : silence_of(found->second.wsi);
}

void HttpServer::run(int stop) {
  impl_->loop->every(kTick, [this] { impl_->tick(); });
  impl_->loop->run(impl_->vhost, stop);
}

}  // namespace saphira::mcp

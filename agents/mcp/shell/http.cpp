#include "http.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "loop.hpp"
#include "saphira/base/format.hpp"

namespace saphira::mcp {

namespace {

constexpr unsigned kMostDescriptors = 1024;
constexpr std::size_t kMostIdle = 64;  // connections that wait for a further request
constexpr int kIdle = 600;             // [s] that such a connection stays open
constexpr int kTick = 50'000;          // [us]
constexpr std::size_t kLongestHeader = 1024;
constexpr std::size_t kLongestQueue = 1024 * 1024;  // of a client that does not read
constexpr int kUnauthorized = 401;
constexpr const char* kComment = ": \r\n";  // of a stream

using web::header;

/// Without surrounding blanks. Text that is not ASCII comes as =?base64?...?=.
std::string custom_header(lws* wsi, const char* name) {
  std::array<char, kLongestHeader> text{};
  if (lws_hdr_custom_copy(wsi, text.data(), static_cast<int>(text.size()), name,
                          static_cast<int>(std::strlen(name))) <= 0)
    return {};
  std::string value = text.data();
  const std::size_t first = value.find_first_not_of(" \t");
  if (first == std::string::npos)
    return {};
  value = value.substr(first, value.find_last_not_of(" \t") - first + 1);
  if (!value.starts_with("=?base64?") || !value.ends_with("?=") || value.size() < 11)
    return value;
  std::array<char, kLongestHeader> decoded{};
  const int size = lws_b64_decode_string(value.substr(9, value.size() - 11).c_str(), decoded.data(),
                                         static_cast<int>(decoded.size()));
  return size > 0 ? std::string(decoded.data(), static_cast<std::size_t>(size)) : std::string();
}

/// The system asks the other side every second for a sign of life, as silence() promises.
void ask_for_life(int fd) {
  constexpr int kYes = 1;
  constexpr int kSecond = 1;
  constexpr int kMost = 3;
  setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &kYes, sizeof kYes);
  setsockopt(fd, IPPROTO_TCP, TCP_KEEPIDLE, &kSecond, sizeof kSecond);
  setsockopt(fd, IPPROTO_TCP, TCP_KEEPINTVL, &kSecond, sizeof kSecond);
  setsockopt(fd, IPPROTO_TCP, TCP_KEEPCNT, &kMost, sizeof kMost);
}

/// As HttpServer::silence.
std::optional<double> silence_of(int fd) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 ||
      info.tcpi_state != TCP_ESTABLISHED)
    return std::nullopt;
  return std::min(info.tcpi_last_ack_recv, info.tcpi_last_data_recv) / 1000.0;
}

}  // namespace

struct HttpServer::Impl {
  /// A connection of a client.
  struct Peer {
    lws* wsi = nullptr;
    Exchange exchange = 0;  // the request that is being answered [0: none]
  };
  struct Open {
    lws* wsi = nullptr;
    HttpRequest request;
    bool keeps = false;  // the connection is for further requests
    bool chunks = false;
    bool too_long = false;
    bool has_come = false;
    int status = 0;  // of the answer [0: none yet]
    std::string type;
    std::string session;
    std::string body;  // to be sent
    bool streams = false;
    bool begun = false;  // the headers are sent
    bool complete = false;
  };

  Events events;
  std::optional<web::Loop> loop;
  lws_vhost* vhost = nullptr;
  std::map<Exchange, Open> open;
  std::map<Connection, Peer> peers;
  Exchange last = 0;
  Connection last_connection = 0;

  std::map<Connection, Peer>::iterator peer_of(lws* wsi);
  Open* open_of(lws* wsi);
  int begin(lws* wsi, const char* path);
  int take(lws* wsi, const char* data, std::size_t size);
  int complete(lws* wsi);
  int send(lws* wsi);
  int finish(lws* wsi, bool keeps);
  static bool send_headers(lws* wsi, const Open& answer);
  void closed(std::map<Connection, Peer>::iterator peer);
  void tick();

  static Impl& of(lws* wsi) { return *static_cast<Impl*>(lws_context_user(lws_get_context(wsi))); }
  static int http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
};

std::map<HttpServer::Connection, HttpServer::Impl::Peer>::iterator HttpServer::Impl::peer_of(
    lws* wsi) {
  return std::find_if(peers.begin(), peers.end(),
                      [&](const auto& each) { return each.second.wsi == wsi; });
}

/// The request of a connection that is not answered yet; null: there is none.
HttpServer::Impl::Open* HttpServer::Impl::open_of(lws* wsi) {
  const auto peer = peer_of(wsi);
  const auto found = peer == peers.end() ? open.end() : open.find(peer->second.exchange);
  return found == open.end() ? nullptr : &found->second;
}

/// The headers of a request have come.
int HttpServer::Impl::begin(lws* wsi, const char* path) {
  if (open_of(wsi) != nullptr)
    return -1;  // a request behind another one: see web::kAnswered
  auto peer = peer_of(wsi);
  if (peer == peers.end()) {
    peer = peers.emplace(++last_connection, Peer{wsi}).first;
    ask_for_life(lws_get_socket_fd(wsi));
  }
  peer->second.exchange = ++last;
  Open& exchange = open[last];
  exchange.wsi = wsi;
  exchange.chunks = header(wsi, WSI_TOKEN_HTTP) == "HTTP/1.1";
  HttpRequest& request = exchange.request;
  request.connection = peer->first;
  request.path = path;
  request.method = lws_hdr_total_length(wsi, WSI_TOKEN_POST_URI) > 0     ? "POST"
                   : lws_hdr_total_length(wsi, WSI_TOKEN_DELETE_URI) > 0 ? "DELETE"
                   : lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) > 0    ? "GET"
                                                                         : "";
  request.caller = {header(wsi, WSI_TOKEN_HOST), header(wsi, WSI_TOKEN_ORIGIN), true};
  request.authorization = header(wsi, WSI_TOKEN_HTTP_AUTHORIZATION);
  request.session = custom_header(wsi, "mcp-session-id:");
  request.version = custom_header(wsi, "mcp-protocol-version:");
  request.mcp_method = custom_header(wsi, "mcp-method:");
  request.mcp_name = custom_header(wsi, "mcp-name:");
  const bool sends = header(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH) != "0" &&
                     lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH) > 0;
  const bool has_body = request.method == "POST" && sends;
  // A body that is not read would be taken for the next request.
  exchange.keeps = exchange.chunks && header(wsi, WSI_TOKEN_CONNECTION) != "close" &&
                   sends == has_body &&
                   lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_TRANSFER_ENCODING) <= 0;
  return has_body ? 0 : complete(wsi);
}

int HttpServer::Impl::take(lws* wsi, const char* data, std::size_t size) {
  Open* const exchange = open_of(wsi);
  if (exchange == nullptr)
    return -1;
  std::string& body = exchange->request.body;
  exchange->too_long = exchange->too_long || body.size() + size > kLongestBody;
  if (!exchange->too_long)
    body.append(data, size);
  return 0;
}

int HttpServer::Impl::complete(lws* wsi) {
  Open* const exchange = open_of(wsi);
  if (exchange == nullptr)
    return -1;
  if (exchange->has_come) {  // a request behind another one: see web::kAnswered
    exchange->keeps = false;
    return exchange->status == 0 ? -1 : 0;
  }
  exchange->has_come = true;
  lws_set_timeout(wsi, NO_PENDING_TIMEOUT, 0);  // its answer may take its time
  if (exchange->too_long) {
    exchange->status = HTTP_STATUS_REQ_ENTITY_TOO_LARGE;
    exchange->type = "text/plain";
    exchange->body = "a message has at most 65536 bytes\n";
    exchange->complete = true;
    lws_callback_on_writable(wsi);
    return 0;
  }
  events.came(peer_of(wsi)->second.exchange, std::move(exchange->request));
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
  return lws_add_http_header_status(wsi, static_cast<unsigned>(answer.status), &at, end) == 0 &&
         add("content-type:", answer.type) &&
         (answer.streams || add("content-length:", std::to_string(answer.body.size()))) &&
         add("cache-control:", "no-cache") && add("x-accel-buffering:", "no") &&
         add("x-content-type-options:", "nosniff") &&
         add("connection:", answer.keeps ? "keep-alive" : "close") &&
         (!answer.keeps || add("keep-alive:", "timeout=" + std::to_string(kIdle))) &&
         (!answer.streams || !answer.chunks || add("transfer-encoding:", "chunked")) &&
         (answer.session.empty() || add("mcp-session-id:", answer.session)) &&
         (answer.status != kUnauthorized || add("www-authenticate:", "Bearer")) &&
         (answer.status != HTTP_STATUS_METHOD_NOT_ALLOWED || add("allow:", "GET, POST, DELETE")) &&
         lws_finalize_write_http_header(wsi, start, &at, end) == 0;
}

int HttpServer::Impl::send(lws* wsi) {
  Open* const found = open_of(wsi);
  if (found == nullptr || found->status == 0)
    return 0;
  Open& answer = *found;
  if (!answer.begun) {
    answer.begun = true;
    answer.keeps = answer.keeps && answer.status < HTTP_STATUS_BAD_REQUEST;
    if (!send_headers(wsi, answer))
      return -1;
    if (!answer.complete || !answer.body.empty()) {
      lws_callback_on_writable(wsi);
      return 0;
    }
    return finish(wsi, answer.keeps);
  }
  if (answer.body.empty() && !answer.complete)
    return 0;
  std::string body = std::exchange(answer.body, {});
  const bool final = answer.complete;
  if (answer.streams && answer.chunks) {
    if (!body.empty())
      body = format("%zx\r\n", body.size()) + body + "\r\n";
    body += final ? "0\r\n\r\n" : "";
  }
  std::vector<unsigned char> buffer(LWS_PRE + body.size());
  std::memcpy(buffer.data() + LWS_PRE, body.data(), body.size());
  if (lws_write(wsi, buffer.data() + LWS_PRE, body.size(),
                final ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < static_cast<int>(body.size()))
    return -1;
  return final ? finish(wsi, answer.keeps) : 0;
}

/// The answer is sent.
int HttpServer::Impl::finish(lws* wsi, bool keeps) {
  const auto peer = peer_of(wsi);
  open.erase(peer->second.exchange);
  peer->second.exchange = 0;
  if (!keeps || lws_http_transaction_completed(wsi) != 0)
    return web::kAnswered;
  std::size_t idle = 0;
  for (const auto& [connection, each] : peers)
    idle += each.exchange == 0 ? 1 : 0;
  if (idle <= kMostIdle)
    return 0;
  const auto oldest = std::find_if(peers.begin(), peers.end(),
                                   [](const auto& each) { return each.second.exchange == 0; });
  lws_set_timeout(oldest->second.wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
  return 0;
}

void HttpServer::Impl::closed(std::map<Connection, Peer>::iterator peer) {
  if (peer == peers.end())
    return;
  const Exchange exchange = peer->second.exchange;
  peers.erase(peer);
  const auto found = open.find(exchange);
  if (found == open.end())
    return;
  const bool is_known = found->second.has_come;
  open.erase(found);
  if (is_known)
    events.lost(exchange);
}

/// libwebsockets does not notice the end of a client that it writes to: the socket says it.
void HttpServer::Impl::tick() {
  for (auto each = peers.begin(); each != peers.end();) {
    const auto peer = each++;
    lws* const wsi = peer->second.wsi;
    if (silence_of(lws_get_socket_fd(wsi)))
      continue;
    closed(peer);
    lws_set_timeout(wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
  }
  events.tick();
}

int HttpServer::Impl::http(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                           std::size_t size) {
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return of(wsi).begin(wsi, static_cast<const char*>(in));
    case LWS_CALLBACK_HTTP_BODY:
      return of(wsi).take(wsi, static_cast<const char*>(in), size);
    case LWS_CALLBACK_HTTP_BODY_COMPLETION:
      return of(wsi).complete(wsi);
    case LWS_CALLBACK_HTTP_WRITEABLE:
      return of(wsi).send(wsi);
    case LWS_CALLBACK_CLOSED_HTTP:
    case LWS_CALLBACK_WSI_DESTROY:
      of(wsi).closed(of(wsi).peer_of(wsi));
      return 0;
    default:
      return lws_callback_http_dummy(wsi, reason, user, in, size);
  }
}

HttpServer::HttpServer(int port, Events events) : impl_(std::make_unique<Impl>()) {
  impl_->events = std::move(events);
  static const std::array<lws_protocols, 3> protocols{{{"http", Impl::http, 0, 0, 0, nullptr, 0},
                                                       web::Loop::descriptors(),
                                                       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  impl_->loop.emplace(impl_.get(), kMostDescriptors, false);
  lws_context_creation_info info{};
  info.protocols = protocols.data();
  info.iface = "127.0.0.1";
  info.port = port;
  info.timeout_secs = 5;  // for clients without a complete request
  info.keepalive_timeout = kIdle + 10;
  info.vhost_name = "mcp";
  impl_->vhost = lws_create_vhost(impl_->loop->context(), &info);
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
  answer.complete = last;
  answer.body += message.empty() ? kComment : "event: message\ndata: " + message + "\n\n";
  if (answer.body.size() > kLongestQueue)
    lws_set_timeout(answer.wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
  lws_callback_on_writable(answer.wsi);
}

std::optional<double> HttpServer::silence(Connection connection) const {
  const auto found = impl_->peers.find(connection);
  return found == impl_->peers.end() ? std::nullopt
                                     : silence_of(lws_get_socket_fd(found->second.wsi));
}

void HttpServer::run(int stop) {
  impl_->loop->every(kTick, [this] { impl_->tick(); });
  impl_->loop->run(impl_->vhost, stop);
}

}  // namespace saphira::mcp

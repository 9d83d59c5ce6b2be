#include "server.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

#include "dialer.hpp"
#include "loop.hpp"

namespace saphira::console {

namespace {

using web::header;

constexpr std::size_t kMostConnections = 96;  // WebSockets; a page has two, one that drives four
constexpr unsigned kMostDescriptors = 192;
constexpr std::size_t kLongestMessage = 4096;
constexpr int kSendBuffer = 128 * 1024;  // the kernel's buffer for a slow browser
constexpr int kTick = 50'000;            // [us]
constexpr int kTogether = 10'000;        // [us]
constexpr const char* kTelemetry = "saphira.telemetry";
constexpr const char* kCommands = "saphira.commands";
constexpr const char* kSimulator = "saphira.simulator";
constexpr const char* kSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' data:; manifest-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

Caller caller_of(lws* wsi) {
  const std::string address = web::peer(wsi);
  return {header(wsi, WSI_TOKEN_HOST), header(wsi, WSI_TOKEN_ORIGIN),
          address != kRelayed && (address.starts_with("127.") || address == "::1")};
}

Channel channel_of(const char* protocol) {
  return std::strcmp(protocol, kCommands) == 0    ? Channel::commands
         : std::strcmp(protocol, kSimulator) == 0 ? Channel::simulator
                                                  : Channel::telemetry;
}

/// libwebsockets reports no error for another word, and listens nowhere.
bool is_address(const std::string& text) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1 || if_nametoindex(text.c_str()) != 0;
}

}  // namespace

struct Server::Impl {
  /// The record of libwebsockets for each connection; it begins as zeros.
  struct Http {
    const PageFile* file;
  };
  struct Socket {
    Connection id;
  };
  struct Open {
    lws* wsi = nullptr;
    std::string incoming;  // the pieces of one message
  };

  AccessSettings access;
  std::vector<PageFile> files;
  Events events;
  std::optional<web::Loop> loop;
  lws_vhost* vhost = nullptr;
  std::map<Connection, Open> open;
  Connection last = 0;
  bool soon = false;

  // A timer of libwebsockets, with a pointer to us.
  struct Timer {
    lws_sorted_usec_list_t list{};
    Impl* impl = nullptr;
  };
  Timer together;

  int answer_http(lws* wsi, Http& http, const char* path);
  int send_http(lws* wsi, Http& http) const;
  int filter(lws* wsi) const;
  void established(lws* wsi, Socket& socket, Channel channel);
  int receive(lws* wsi, const Socket& socket, const char* data, std::size_t size);
  int send(lws* wsi, const Socket& socket);
  void closed(const Socket& socket);

  static Impl& of(lws* wsi) { return *static_cast<Impl*>(lws_context_user(lws_get_context(wsi))); }
  void want_all();

  static int http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
  static int socket(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
  static Impl& of(lws_sorted_usec_list_t* list) { return *reinterpret_cast<Timer*>(list)->impl; }
};

int Server::Impl::answer_http(lws* wsi, Http& http, const char* path) {
  // A request behind another one, which is being answered, or one with a body: see web::kAnswered.
  if (http.file != nullptr || lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) <= 0 ||
      lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH) > 0)
    return -1;
  const std::string why = refusal(access, caller_of(wsi));
  if (!why.empty()) {
    lws_return_http_status(wsi, HTTP_STATUS_FORBIDDEN, why.c_str());
    return -1;
  }
  const std::string name = std::string(path) == "/" ? "/index.html" : path;
  const auto file =
      std::find_if(files.begin(), files.end(), [&](const PageFile& f) { return f.path == name; });
  if (file == files.end()) {
    lws_return_http_status(wsi, HTTP_STATUS_NOT_FOUND, "There is only the page: /");
    return web::kAnswered;
  }
  http.file = &*file;
  std::array<unsigned char, LWS_PRE + 2048> buffer{};
  unsigned char* const begin = buffer.data() + LWS_PRE;
  unsigned char* at = begin;
  unsigned char* const end = buffer.data() + buffer.size() - 1;
  const auto add = [&](const char* header_name, const std::string& value) {
    return lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(header_name),
                                       reinterpret_cast<const unsigned char*>(value.c_str()),
                                       static_cast<int>(value.size()), &at, end) == 0;
  };
  if (lws_add_http_common_headers(wsi, HTTP_STATUS_OK, file->type.c_str(), file->content.size(),
                                  &at, end) != 0 ||
      !add("content-security-policy:", kSecurityPolicy) ||
      !add("x-content-type-options:", "nosniff") || !add("referrer-policy:", "no-referrer") ||
      !add("cache-control:", "no-cache") || !add("connection:", "close") ||
      lws_finalize_write_http_header(wsi, begin, &at, end) != 0)
    return -1;
  lws_callback_on_writable(wsi);
  return 0;
}

int Server::Impl::send_http(lws* wsi, Http& http) const {
  if (http.file == nullptr)
    return 0;
  std::vector<unsigned char> buffer(LWS_PRE + http.file->content.size());
  std::memcpy(buffer.data() + LWS_PRE, http.file->content.data(), http.file->content.size());
  const int size = static_cast<int>(http.file->content.size());
  if (lws_write(wsi, buffer.data() + LWS_PRE, http.file->content.size(), LWS_WRITE_HTTP_FINAL) !=
      size)
    return -1;
  http.file = nullptr;
  return web::kAnswered;
}

/// True where a WebSocket may be opened: 0, or -1.
int Server::Impl::filter(lws* wsi) const {
  const std::string why = refusal(access, caller_of(wsi));
  if (!why.empty()) {
    lws_return_http_status(wsi, HTTP_STATUS_FORBIDDEN, why.c_str());
    return -1;
  }
  return open.size() < kMostConnections ? 0 : -1;
}

void Server::Impl::established(lws* wsi, Socket& socket, Channel channel) {
  setsockopt(lws_get_socket_fd(wsi), SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
  socket.id = ++last;
  open[socket.id].wsi = wsi;
  events.opened(socket.id, channel, caller_of(wsi));
}

int Server::Impl::receive(lws* wsi, const Socket& socket, const char* data, std::size_t size) {
  const auto found = open.find(socket.id);
  if (found == open.end())
    return -1;
  std::string& incoming = found->second.incoming;
  if (lws_frame_is_binary(wsi) != 0 || incoming.size() + size > kLongestMessage)
    return -1;
  incoming.append(data, size);
  if (lws_is_final_fragment(wsi) == 0 || lws_remaining_packet_payload(wsi) != 0)
    return 0;
  const std::string text = std::exchange(incoming, {});
  return events.came(socket.id, text) ? 0 : -1;
}

int Server::Impl::send(lws* wsi, const Socket& socket) {
  const auto text = events.next(socket.id);
  if (!text)
    return 0;
  std::vector<unsigned char> buffer(LWS_PRE + text->size());
  std::memcpy(buffer.data() + LWS_PRE, text->data(), text->size());
  if (lws_write(wsi, buffer.data() + LWS_PRE, text->size(), LWS_WRITE_TEXT) < 0)
    return -1;
  lws_callback_on_writable(wsi);  // there may be more
  return 0;
}

void Server::Impl::closed(const Socket& socket) {
  if (open.erase(socket.id) > 0)
    events.closed(socket.id);
}

void Server::Impl::want_all() {
  for (const auto& [id, connection] : open)
    lws_callback_on_writable(connection.wsi);
}

int Server::Impl::http(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                       std::size_t size) {
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return of(wsi).answer_http(wsi, *static_cast<Http*>(user), static_cast<const char*>(in));
    case LWS_CALLBACK_HTTP_WRITEABLE:
      return of(wsi).send_http(wsi, *static_cast<Http*>(user));
    default:
      return lws_callback_http_dummy(wsi, reason, user, in, size);
  }
}

int Server::Impl::socket(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                         std::size_t size) {
  auto* const socket = static_cast<Socket*>(user);
  switch (reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return of(wsi).filter(wsi);
    case LWS_CALLBACK_ESTABLISHED:
      of(wsi).established(wsi, *socket, channel_of(lws_get_protocol(wsi)->name));
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return of(wsi).receive(wsi, *socket, static_cast<const char*>(in), size);
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return of(wsi).send(wsi, *socket);
    case LWS_CALLBACK_CLOSED:
      of(wsi).closed(*socket);
      return 0;
    default:
      return 0;
  }
}

Server::Server(const ServerOptions& options, const AccessSettings& access,
               std::vector<PageFile> files, Events events)
    : impl_(std::make_unique<Impl>()) {
  if (!is_address(options.address))
    throw std::invalid_argument(
        "--listen: expected an address or an interface of this machine, such as 0.0.0.0, found \"" +
        options.address + "\"");
  impl_->access = access;
  impl_->files = std::move(files);
  impl_->events = std::move(events);
  static const std::array<lws_protocols, 6> protocols{
      {{"http", Impl::http, sizeof(Impl::Http), 0, 0, nullptr, 0},
       {kTelemetry, Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       {kCommands, Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       {kSimulator, Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       web::Loop::descriptors(),
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  // A sleeping or disconnected browser is dropped after half a minute.
  static const lws_retry_bo_t patience{nullptr, 0, 0, 10, 30, 0};

  const bool encrypts = !options.certificate.empty();
  impl_->loop.emplace(impl_.get(), kMostDescriptors, encrypts);
  lws_context_creation_info info{};
  if (encrypts)
    info.options = LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
  info.protocols = protocols.data();
  info.iface = options.address == "0.0.0.0" ? nullptr : options.address.c_str();
  info.timeout_secs = 5;  // for clients without a complete request
  info.keepalive_timeout = 5;
  info.retry_and_idle_policy = &patience;
  info.vhost_name = "console";
  info.alpn = "http/1.1";  // with HTTP/2, a browser has other headers and WebSockets
  if (encrypts) {
    info.ssl_cert_filepath = options.certificate.c_str();
    info.ssl_private_key_filepath = options.certificate_key.c_str();
  }
  const int count = options.port == 0 ? 1 : std::max(1, options.ports);
  const auto listen = [&](int port) {
    info.port = port;
    impl_->vhost = lws_create_vhost(impl_->loop->context(), &info);
  };
  if (options.before > options.port && options.before < options.port + count)
    listen(options.before);
  for (int i = 0; i < count && impl_->vhost == nullptr; ++i)
    listen(options.port + i);
  if (impl_->vhost == nullptr)
    throw std::runtime_error(
        "cannot listen on " + options.address + " port " + std::to_string(options.port) +
        (count > 1 ? " or the " + std::to_string(count - 1) + " after it" : "") +
        (options.certificate.empty()
             ? ": another program has it, or it is no address of this machine"
             : ": another program has it, or certificate and key do not fit"));
}

Server::~Server() {
  impl_->loop.reset();  // its callbacks need the rest
}

int Server::port() const {
  return lws_get_vhost_listen_port(impl_->vhost);
}

void Server::watch(int fd) {
  impl_->loop->watch(impl_->vhost, fd, [this] { impl_->events.readable(); });
}

void Server::want(Connection connection) {
  if (const auto found = impl_->open.find(connection); found != impl_->open.end())
    lws_callback_on_writable(found->second.wsi);
}

void Server::want_all_soon() {
  if (impl_->soon)
    return;
  impl_->soon = true;
  impl_->together.impl = impl_.get();
  lws_sul_schedule(
      impl_->loop->context(), 0, &impl_->together.list,
      [](lws_sorted_usec_list_t* list) {
        Impl& impl = Impl::of(list);
        impl.soon = false;
        impl.want_all();
      },
      kTogether);
}

void Server::close(Connection connection) {
  if (const auto found = impl_->open.find(connection); found != impl_->open.end())
    lws_set_timeout(found->second.wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
}

void Server::run(int stop) {
  impl_->loop->every(kTick, [this] {
    impl_->events.tick();
    impl_->want_all();
  });
  impl_->loop->run(impl_->vhost, stop);
}

}  // namespace saphira::console

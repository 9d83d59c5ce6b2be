#include "foxglove_server.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace saphira::viewer {

namespace {

constexpr std::size_t kMostClients = 16;
constexpr unsigned kMostDescriptors = 64;
constexpr std::size_t kLongestMessage = 65536;                      // of a client
constexpr std::size_t kMostWaiting = std::size_t{4} * 1024 * 1024;  // [bytes] for one client
constexpr int kTick = 100'000;                                      // [us]
constexpr int kSendBuffer = 128 * 1024;  // the kernel's, of a slow client

/// The key in the address; empty: none.
std::string key_of(lws* wsi) {
  std::array<char, 200> given{};
  const char* const key =
      lws_get_urlarg_by_name(wsi, "key=", given.data(), static_cast<int>(given.size()));
  return key == nullptr ? "" : key;
}

}  // namespace

struct Server::Impl {
  struct Open {
    lws* wsi = nullptr;
    Client client;
    std::string key;
    std::string incoming;  // the pieces of one message
  };
  struct Socket {
    std::uint64_t id;  // 0: none yet
  };

  Options options;
  std::vector<Channel> channels;
  Events events;
  std::map<std::uint64_t, Open> open;
  std::uint64_t last = 0;
  std::optional<web::Loop> loop;
  lws_vhost* vhost = nullptr;

  int filter(lws* wsi) const;
  int receive(lws* wsi, const Socket& socket, const char* data, std::size_t size);
  int send(lws* wsi, const Socket& socket);

  static Impl& of(lws* wsi) { return *static_cast<Impl*>(lws_context_user(lws_get_context(wsi))); }
  static int http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
  static int socket(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
};

/// 0: the client may connect.
int Server::Impl::filter(lws* wsi) const {
  if (const std::string key = key_of(wsi); !options.admits(key)) {
    if (!key.empty())
      options.refused(key);
    lws_return_http_status(wsi, HTTP_STATUS_FORBIDDEN,
                           "the address has to end with the key that saphira foxglove prints");
    return -1;
  }
  return open.size() < kMostClients ? 0 : -1;
}

int Server::Impl::receive(lws* wsi, const Socket& socket, const char* data, std::size_t size) {
  const auto found = open.find(socket.id);
  if (found == open.end())
    return -1;
  Open& from = found->second;
  if (lws_frame_is_binary(wsi) != 0 || from.incoming.size() + size > kLongestMessage)
    return -1;
  from.incoming.append(data, size);
  if (lws_is_final_fragment(wsi) == 0 || lws_remaining_packet_payload(wsi) != 0)
    return 0;
  const auto added = from.client.take(std::exchange(from.incoming, {}));
  if (!added)
    return -1;
  for (const std::size_t channel : *added)
    events.subscribed(channel);
  lws_callback_on_writable(wsi);
  return 0;
}

int Server::Impl::send(lws* wsi, const Socket& socket) {
  const auto found = open.find(socket.id);
  const auto frame = found == open.end() ? std::nullopt : found->second.client.next();
  if (!frame)
    return 0;
  std::vector<unsigned char> buffer(LWS_PRE + frame->content.size());
  std::memcpy(buffer.data() + LWS_PRE, frame->content.data(), frame->content.size());
  if (lws_write(wsi, buffer.data() + LWS_PRE, frame->content.size(),
                frame->binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT) < 0)
    return -1;
  lws_callback_on_writable(wsi);  // there may be more
  return 0;
}

int Server::Impl::http(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                       std::size_t size) {
  if (reason != LWS_CALLBACK_HTTP)
    return web::Loop::otherwise(wsi, reason, user, in, size);
  lws_return_http_status(wsi, HTTP_STATUS_NOT_FOUND,
                         "Here is no page: open this address in Foxglove or Lichtblick, as a "
                         "Foxglove WebSocket");
  return web::kAnswered;
}

int Server::Impl::socket(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                         std::size_t size) {
  auto* const socket = static_cast<Socket*>(user);
  Impl& impl = of(wsi);
  switch (reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return impl.filter(wsi);
    case LWS_CALLBACK_ESTABLISHED:
      setsockopt(lws_get_socket_fd(wsi), SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
      socket->id = ++impl.last;
      impl.open.emplace(
          socket->id,
          Open{wsi, Client(impl.options.name, impl.channels, kMostWaiting), key_of(wsi), {}});
      impl.options.came(key_of(wsi));
      lws_callback_on_writable(wsi);
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return impl.receive(wsi, *socket, static_cast<const char*>(in), size);
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return impl.send(wsi, *socket);
    case LWS_CALLBACK_CLOSED:
      impl.open.erase(socket->id);
      return 0;
    default:
      return 0;
  }
}

Server::Server(const Options& options, std::vector<Channel> channels, Events events)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->channels = std::move(channels);
  impl_->events = std::move(events);
  static const std::array<lws_protocols, 5> protocols{
      {{"http", Impl::http, 0, 0, 0, nullptr, 0},
       {kProtocols[0], Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       {kProtocols[1], Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       web::Loop::descriptors(),
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  // A client that sleeps or is cut off is dropped after half a minute.
  static const lws_retry_bo_t patience{nullptr, 0, 0, 10, 30, 0};
  impl_->loop.emplace(impl_.get(), kMostDescriptors, !options.place.certificate.empty());
  lws_context_creation_info info{};
  info.protocols = protocols.data();
  info.timeout_secs = 5;
  info.keepalive_timeout = 5;
  info.retry_and_idle_policy = &patience;
  info.vhost_name = "foxglove";
  info.alpn = "http/1.1";
  impl_->vhost = impl_->loop->listen(info, options.place);
  if (impl_->vhost == nullptr)
    throw std::runtime_error("cannot listen on " + options.place.address + " port " +
                             std::to_string(options.place.port) +
                             ": another program has it, it is no address of this machine, or "
                             "certificate and key do not fit; --port names another one");
}

Server::~Server() {
  impl_->loop.reset();  // its callbacks need the rest
}

int Server::port() const {
  return lws_get_vhost_listen_port(impl_->vhost);
}

bool Server::wants(std::size_t channel) const {
  return std::any_of(impl_->open.begin(), impl_->open.end(),
                     [channel](const auto& each) { return each.second.client.wants(channel); });
}

void Server::offer(std::size_t channel, std::int64_t time_ns, const std::string& json) {
  for (auto& [id, open] : impl_->open)
    if (open.client.wants(channel)) {
      open.client.offer(channel, time_ns, json);
      lws_callback_on_writable(open.wsi);
    }
}

void Server::watch(int fd) {
  impl_->loop->watch(impl_->vhost, fd, [this] { impl_->events.readable(); });
}

void Server::run(int stop) {
  impl_->loop->every(kTick, [this] {
    impl_->events.tick();
    for (const auto& [id, each] : impl_->open)
      if (!impl_->options.admits(each.key))
        lws_set_timeout(each.wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
  });
  impl_->loop->run(impl_->vhost, stop);
}

}  // namespace saphira::viewer

#include "sockets.hpp"

#include <sys/socket.h>

#include <utility>

namespace saphira::web {

namespace {

constexpr int kTogether = 10'000;        // [us]
constexpr int kSendBuffer = 128 * 1024;  // the kernel's, of a slow client

}  // namespace

Sockets::Sockets(void* owner, const Options& options, Events events, bool encrypts)
    : options_(options),
      events_(std::move(events)),
      protocols_{{"http", options.http, options.http_record, 0, 0, nullptr, 0}},
      loop_(owner, static_cast<unsigned>(2 * options.connections) + 32, encrypts) {
  for (const char* const name : options.protocols)
    protocols_.push_back({name, on_socket, sizeof(Connection), options.longest, 0, this, 0});
  protocols_.push_back(Loop::descriptors());
  protocols_.push_back({});
}

lws_vhost* Sockets::listen(const char* name, const Place& place) {
  // A client that sleeps or is cut off is dropped after half a minute.
  static const lws_retry_bo_t patience{nullptr, 0, 0, 10, 30, 0};
  lws_context_creation_info info{};
  info.protocols = protocols_.data();
  info.timeout_secs = 5;  // for clients without a complete request
  info.keepalive_timeout = 5;
  info.retry_and_idle_policy = &patience;
  info.vhost_name = name;
  lws_vhost* const vhost = loop_.listen(info, place);
  if (vhost_ == nullptr)
    vhost_ = vhost;
  return vhost;
}

void Sockets::run(int stop, long period, std::function<void()> tick) {
  loop_.every(period, std::move(tick));
  loop_.run(vhost_, stop);
}

void Sockets::want(Connection connection) {
  if (const auto found = open_.find(connection); found != open_.end())
    lws_callback_on_writable(found->second.wsi);
}

void Sockets::want_all() {
  for (const auto& [id, open] : open_)
    lws_callback_on_writable(open.wsi);
}

void Sockets::want_all_soon() {
  if (soon_ || open_.empty())
    return;
  soon_ = true;
  lws_sul_schedule(
      loop_.context(), 0, &together_.list,
      [](lws_sorted_usec_list_t* list) {
        Sockets& self = *reinterpret_cast<Timer*>(list)->sockets;
        self.soon_ = false;
        self.want_all();
      },
      kTogether);
}

void Sockets::close(Connection connection) {
  if (const auto found = open_.find(connection); found != open_.end())
    drop(found->second.wsi);
}

/// 0: the client may connect.
int Sockets::filter(lws* wsi) const {
  if (const std::string why = events_.refusal(wsi); !why.empty()) {
    lws_return_http_status(wsi, HTTP_STATUS_FORBIDDEN, why.c_str());
    return -1;
  }
  return open_.size() < options_.connections ? 0 : -1;
}

int Sockets::receive(Connection from, const char* data, std::size_t size) {
  const auto found = open_.find(from);
  if (found == open_.end())
    return -1;
  auto& [wsi, incoming] = found->second;
  if (lws_frame_is_binary(wsi) != 0 || incoming.size() + size > options_.longest)
    return -1;
  incoming.append(data, size);
  if (lws_is_final_fragment(wsi) == 0 || lws_remaining_packet_payload(wsi) != 0)
    return 0;
  return events_.came(from, std::exchange(incoming, {})) ? 0 : -1;
}

int Sockets::send(Connection to) {
  const auto found = open_.find(to);
  const auto message = found == open_.end() ? std::nullopt : events_.next(to);
  if (!message)
    return 0;
  lws* const wsi = found->second.wsi;
  if (!write(wsi, message->content, message->bytes ? LWS_WRITE_BINARY : LWS_WRITE_TEXT))
    return -1;
  lws_callback_on_writable(wsi);  // there may be more
  return 0;
}

int Sockets::on_socket(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                       std::size_t size) {
  auto* const id = static_cast<Connection*>(user);  // it begins as zero
  const lws_protocols* const protocol = lws_get_protocol(wsi);
  if (protocol == nullptr || protocol->user == nullptr)
    return 0;
  auto& self = *static_cast<Sockets*>(protocol->user);
  switch (reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return self.filter(wsi);
    case LWS_CALLBACK_ESTABLISHED:
      setsockopt(lws_get_socket_fd(wsi), SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
      *id = ++self.last_;
      self.open_[*id].wsi = wsi;
      self.events_.opened(*id, wsi);
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return self.receive(*id, static_cast<const char*>(in), size);
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return self.send(*id);
    case LWS_CALLBACK_CLOSED:
      if (self.open_.erase(*id) > 0)
        self.events_.closed(*id);
      return 0;
    default:
      return 0;
  }
}

}  // namespace saphira::web

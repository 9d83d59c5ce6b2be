#include "dialer.hpp"

#include <openssl/x509_vfy.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "loop.hpp"
#include "server.hpp"
#include "splice.hpp"

namespace saphira::console {

namespace {

using relay::Splice;

constexpr const char* kDial = "saphira.dial";
constexpr const char* kCarry = "saphira.carry";
constexpr unsigned kMostVisitors = 64;
constexpr int kLongestPause = 30;  // [s] between two attempts

}  // namespace

struct Dialer::Impl {
  /// One of our connections in libwebsockets: of a visitor, or to the relay (0).
  struct Leg {
    Impl* impl = nullptr;
    std::uint64_t visitor = 0;
  };
  struct Visitor {
    Leg leg;
    Splice splice;  ///< near: the relay, far: our server
  };

  DialOptions options;
  std::function<void(int)> reached;
  std::function<void(const std::string&)> lost;
  std::optional<web::Loop> loop;
  lws_vhost* vhost = nullptr;
  int stop = -1;
  std::map<std::uint64_t, Visitor> visitors;
  std::uint64_t last = 0;
  Leg dial{this, 0};
  int pause = 1;  // [s]
  bool is_lost = false;
  std::string distrust;  // the reason against the relay's certificate
  struct Timer {
    lws_sorted_usec_list_t list{};
    Impl* impl = nullptr;
  } redial;
  std::thread thread;

  void run();
  bool connect(const std::string& path, const char* protocol, Leg& leg);
  void dial_now();
  void dial_later(const std::string& why);
  std::string words_of(std::string_view error);
  void heard(std::string_view line);
  void fetch(const std::string& ticket);
  void ended(std::uint64_t visitor, Splice::Side side);
  bool authorize(lws* wsi, void* in, std::size_t size) const;

  static Leg& leg_of(lws* wsi) { return *static_cast<Leg*>(lws_get_opaque_user_data(wsi)); }
  static int on_dial(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
  template <Splice::Side side>
  static int on_leg(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
};

/// Of a failure to dial, from the words of libwebsockets.
std::string Dialer::Impl::words_of(std::string_view error) {
  if (!distrust.empty())
    return "its certificate is not accepted: " + std::exchange(distrust, {}) +
           "; --dial-authority has to be that certificate, or its authority's, with HOST as a name "
           "in it";
  if (error.find("unauthorized") != std::string_view::npos)
    return "it has no robot " + options.address.robot + " with the token of --dial-token-file";
  return error.empty() ? "no answer" : std::string(error);
}

/// A WebSocket to the relay.
bool Dialer::Impl::connect(const std::string& path, const char* protocol, Leg& leg) {
  static const lws_retry_bo_t patience{nullptr, 0, 0, 5, 12, 0};
  lws_client_connect_info info{};
  info.context = loop->context();
  info.vhost = vhost;
  info.address = options.address.host.c_str();
  info.host = info.address;
  info.origin = info.address;
  info.port = options.address.port;
  info.path = path.c_str();
  info.protocol = protocol;
  info.local_protocol_name = protocol;
  info.ssl_connection = options.address.encrypted ? LCCSCF_USE_SSL : 0;
  info.opaque_user_data = &leg;
  info.retry_and_idle_policy = &patience;
  return lws_client_connect_via_info(&info) != nullptr;
}

void Dialer::Impl::dial_now() {
  if (!connect("/dial/" + options.address.robot, kDial, dial))
    dial_later("it cannot be dialled");
}

void Dialer::Impl::dial_later(const std::string& why) {
  if (!is_lost)
    lost(why);
  is_lost = true;
  redial.impl = this;
  lws_sul_schedule(
      loop->context(), 0, &redial.list,
      [](lws_sorted_usec_list_t* list) { reinterpret_cast<Timer*>(list)->impl->dial_now(); },
      static_cast<lws_usec_t>(pause) * LWS_US_PER_SEC);
  pause = std::min(kLongestPause, 2 * pause);
}

/// "port NUMBER", and "fetch TICKET" for each visitor.
void Dialer::Impl::heard(std::string_view line) {
  if (line.starts_with("port ")) {
    pause = 1;
    is_lost = false;
    reached(std::atoi(std::string(line.substr(5, 5)).c_str()));
  } else if (line.starts_with("fetch ")) {
    fetch(std::string(line.substr(6, 64)));
  }
}

void Dialer::Impl::fetch(const std::string& ticket) {
  if (visitors.size() >= kMostVisitors)
    return;
  const std::uint64_t number = ++last;
  Visitor& visitor = visitors[number];
  visitor.leg = {this, number};
  lws_client_connect_info local{};
  local.context = loop->context();
  local.vhost = vhost;
  local.address = kRelayed;
  local.port = options.port;
  local.method = "RAW";
  local.local_protocol_name = "server";
  local.opaque_user_data = &visitor.leg;
  if (lws_client_connect_via_info(&local) == nullptr) {
    visitors.erase(number);  // its other side is not opened
    return;
  }
  if (visitors.contains(number) &&
      !connect("/carry/" + options.address.robot + "/" + ticket, kCarry, visitors[number].leg))
    ended(number, Splice::kNear);
}

/// A side of a visitor is closed, or was never opened.
void Dialer::Impl::ended(std::uint64_t number, Splice::Side side) {
  const auto visitor = visitors.find(number);
  if (visitor == visitors.end())
    return;
  visitor->second.splice.closed(side);
  if (visitor->second.splice.is_over())
    visitors.erase(visitor);
}

bool Dialer::Impl::authorize(lws* wsi, void* in, std::size_t size) const {
  auto** const at = static_cast<unsigned char**>(in);
  const std::string value = "Bearer " + options.token;
  return lws_add_http_header_by_token(wsi, WSI_TOKEN_HTTP_AUTHORIZATION,
                                      reinterpret_cast<const unsigned char*>(value.data()),
                                      static_cast<int>(value.size()), at, *at + size) == 0;
}

int Dialer::Impl::on_dial(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                          std::size_t size) {
  const auto text = [&] {
    return in == nullptr ? std::string_view() : std::string_view(static_cast<char*>(in), size);
  };
  switch (reason) {
    case LWS_CALLBACK_CLIENT_APPEND_HANDSHAKE_HEADER:
      return leg_of(wsi).impl->authorize(wsi, in, size) ? 0 : -1;
    case LWS_CALLBACK_CLIENT_RECEIVE:
      leg_of(wsi).impl->heard(text());
      return 0;
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
      leg_of(wsi).impl->dial_later(leg_of(wsi).impl->words_of(text()));
      return 0;
    case LWS_CALLBACK_OPENSSL_PERFORM_SERVER_CERT_VERIFICATION:
      if (size == 0)  // it is not accepted
        leg_of(wsi).impl->distrust = X509_verify_cert_error_string(
            X509_STORE_CTX_get_error(static_cast<X509_STORE_CTX*>(user)));
      return 0;
    case LWS_CALLBACK_CLIENT_CLOSED:
      leg_of(wsi).impl->dial_later("the connection has ended");
      return 0;
    default:
      return 0;
  }
}

/// A side of a visitor: to the relay a WebSocket, to our server bytes.
template <Splice::Side side>
int Dialer::Impl::on_leg(lws* wsi, lws_callback_reasons reason, void* /*user*/, void* in,
                         std::size_t size) {
  if (lws_get_opaque_user_data(wsi) == nullptr)
    return 0;
  Impl& impl = *leg_of(wsi).impl;
  const auto found = impl.visitors.find(leg_of(wsi).visitor);
  if (found == impl.visitors.end())
    return 0;
  Splice& splice = found->second.splice;
  switch (reason) {
    case LWS_CALLBACK_CLIENT_APPEND_HANDSHAKE_HEADER:
      return impl.authorize(wsi, in, size) ? 0 : -1;
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
    case LWS_CALLBACK_RAW_CONNECTED:
      splice.attach(side, wsi, side == Splice::kNear);
      return 0;
    case LWS_CALLBACK_CLIENT_RECEIVE:
    case LWS_CALLBACK_RAW_RX:
      splice.came(side, {static_cast<const char*>(in), size});
      return 0;
    case LWS_CALLBACK_CLIENT_WRITEABLE:
    case LWS_CALLBACK_RAW_WRITEABLE:
      return splice.write(side);
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
    case LWS_CALLBACK_CLIENT_CLOSED:
    case LWS_CALLBACK_RAW_CLOSE:
      lws_set_opaque_user_data(wsi, nullptr);
      impl.ended(found->first, side);
      return 0;
    default:
      return 0;
  }
}

void Dialer::Impl::run() {
  dial_now();
  try {
    loop->run(vhost, stop);
  } catch (const std::exception& error) {
    lost(error.what());
  }
}

Dialer::Dialer(DialOptions options, std::function<void(int)> reached,
               std::function<void(const std::string&)> lost)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = std::move(options);
  impl_->reached = std::move(reached);
  impl_->lost = std::move(lost);
  static const std::array<lws_protocols, 5> protocols{
      {{kDial, Impl::on_dial, 0, 4096, 0, nullptr, 0},
       {kCarry, Impl::on_leg<Splice::kNear>, 0, 16384, 0, nullptr, 0},
       {"server", Impl::on_leg<Splice::kFar>, 0, 16384, 0, nullptr, 0},
       web::Loop::descriptors(),
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  impl_->loop.emplace(impl_.get(), 3 * kMostVisitors, true);
  lws_context_creation_info info{};
  info.options = LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
  info.port = CONTEXT_PORT_NO_LISTEN;
  info.protocols = protocols.data();
  info.vhost_name = "dialer";
  if (!impl_->options.authority.empty())
    info.client_ssl_ca_filepath = impl_->options.authority.c_str();
  impl_->vhost = lws_create_vhost(impl_->loop->context(), &info);
  if (impl_->vhost == nullptr)
    throw std::runtime_error("the relay cannot be dialled: " + impl_->options.authority +
                             " may be no certificate");
  impl_->stop = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  impl_->thread = std::thread([this] { impl_->run(); });
}

Dialer::~Dialer() {
  const std::uint64_t one = 1;
  if (write(impl_->stop, &one, sizeof one) == sizeof one)
    impl_->thread.join();
  else
    impl_->thread.detach();
  impl_->loop.reset();  // its callbacks need the rest
  close(impl_->stop);
}

}  // namespace saphira::console

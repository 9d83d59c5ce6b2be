#include "relay.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

#include <array>
#include <cstdio>
#include <map>
#include <optional>
#include <stdexcept>

#include "saphira/base/boot_clock.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/log_line.hpp"
#include "splice.hpp"

namespace saphira::relay {

namespace {

constexpr unsigned kMostDescriptors = 1024;
constexpr int kTick = 500'000;     // [us]
constexpr double kSilence = 60.0;  // [s]
constexpr const char* kDial = "saphira.dial";
constexpr const char* kCarry = "saphira.carry";
constexpr std::string_view kBearer = "Bearer ";

using web::header;

}  // namespace

void say(const std::string& text) {
  std::printf("%s\n", log_line(unix_time(), "info", "relay", text).c_str());
  std::fflush(stdout);
}

namespace {

/// Once a minute the same words: a gateway that is refused dials again and again.
void complain(const std::string& text) {
  static std::string last;
  static double said = 0.0;
  if (text == last && BootClock::seconds() - said < kSilence)
    return;
  last = text;
  said = BootClock::seconds();
  say(text);
}

/// The slot of a connection's address, which is kept from the start of its handshake: a client that
/// has gone meanwhile has none.
int address_slot() {
  static const int slot =
      SSL_get_ex_new_index(0, nullptr, nullptr, nullptr,
                           [](void* /*ssl*/, void* address, CRYPTO_EX_DATA* /*data*/, int /*slot*/,
                              long /*number*/, void* /*more*/) {  // NOLINT(google-runtime-int)
                             delete static_cast<std::string*>(address);
                           });
  return slot;
}

void keep_address(SSL* ssl) {
  std::array<char, 64> address{};
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  if (SSL_get_ex_data(ssl, address_slot()) == nullptr &&
      getpeername(SSL_get_fd(ssl), reinterpret_cast<sockaddr*>(&peer), &size) == 0 &&
      lws_get_peer_simple_fd(SSL_get_fd(ssl), address.data(), address.size()) != nullptr)
    SSL_set_ex_data(ssl, address_slot(), new std::string(address.data()));
}

/// A gateway that does not trust this certificate ends the handshake with an alert.
void note_alert(const SSL* ssl, int where, int alert) {
  if ((where & SSL_CB_HANDSHAKE_START) != 0)
    keep_address(const_cast<SSL*>(ssl));
  if ((where & SSL_CB_READ_ALERT) != SSL_CB_READ_ALERT || SSL_is_init_finished(ssl) != 0)
    return;
  const auto* const address = static_cast<const std::string*>(SSL_get_ex_data(ssl, address_slot()));
  complain((address != nullptr ? *address : "somebody") +
           " does not accept this relay's certificate (" + SSL_alert_desc_string_long(alert) +
           "): a gateway needs it, or that of its authority, as --dial-authority, and dials the "
           "name that it has");
}

/// The path of a gateway's request; empty for any other.
Path path_of(lws* wsi) {
  return parse_path(header(wsi, WSI_TOKEN_GET_URI)).value_or(Path{});
}

}  // namespace

struct Relay::Impl {
  using Visitor = Rendezvous::Visitor;

  /// The record of libwebsockets for each connection; it begins as zeros.
  struct Leg {
    Visitor visitor;       ///< the visitor it carries; 0: none
    const Robot* dialled;  ///< the robot of its gateway; null: none
  };
  /// A gateway that has dialled in.
  struct Gateway {
    lws* wsi = nullptr;
    std::vector<std::string> out;
  };

  explicit Impl(std::vector<Robot> robots) : rendezvous(std::move(robots)) {}

  Rendezvous rendezvous;
  std::optional<web::Loop> loop;
  lws_vhost* dial = nullptr;
  std::map<const lws_vhost*, const Robot*> doors;
  std::map<std::string, Gateway> gateways;  ///< by robot
  std::map<Visitor, Splice> splices;        ///< near: the visitor, far: the gateway
  Visitor last = 0;

  static Impl& of(lws* wsi) { return *static_cast<Impl*>(lws_context_user(lws_get_context(wsi))); }
  const Robot* robot_of(const std::string& name) const;
  bool refuses(lws* wsi, bool dials) const;
  int dialled(lws* wsi, Leg& leg);
  int tell(lws* wsi, const Leg& leg);
  void hung_up(lws* wsi, const Leg& leg);
  int arrived(lws* wsi, Leg& leg);
  int fetched(lws* wsi, Leg& leg);
  int writable(const Leg& leg, Splice::Side side);
  void came(const Leg& leg, Splice::Side side, std::string_view bytes);
  void left(const Leg& leg, Splice::Side side);
  void tick();
  void close(Visitor visitor);

  static int on_dial(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size);
  static int on_carry(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                      std::size_t size);
  static int on_visitor(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                        std::size_t size);
};

const Robot* Relay::Impl::robot_of(const std::string& name) const {
  for (const Robot& robot : rendezvous.robots())
    if (robot.name == name)
      return &robot;
  return nullptr;
}

/// Only a gateway with its robot's token passes the handshake.
bool Relay::Impl::refuses(lws* wsi, bool dials) const {
  const std::string given = header(wsi, WSI_TOKEN_HTTP_AUTHORIZATION);
  const Path path = path_of(wsi);
  if (given.starts_with(kBearer) && path.ticket.empty() == dials &&
      rendezvous.knows(path.robot, std::string_view(given).substr(kBearer.size())))
    return false;
  complain(robot_of(path.robot) == nullptr
               ? web::peer(wsi) + " is refused: it dials for a robot that has no line in --robots"
               : web::peer(wsi) + " is refused: its token is another one than that of " +
                     path.robot + " in --robots");
  lws_return_http_status(wsi, HTTP_STATUS_UNAUTHORIZED, "no such robot, or another token");
  return true;
}

/// A gateway dials in. An earlier one of the same robot is dropped: it may be dead.
int Relay::Impl::dialled(lws* wsi, Leg& leg) {
  leg.dialled = robot_of(path_of(wsi).robot);
  if (leg.dialled == nullptr)
    return -1;
  Gateway& gateway = gateways[leg.dialled->name];
  if (gateway.wsi != nullptr)
    web::drop(gateway.wsi);
  gateway = {wsi, {"port " + std::to_string(leg.dialled->port)}};
  lws_callback_on_writable(wsi);
  say(leg.dialled->name + " has dialled in");
  return 0;
}

int Relay::Impl::tell(lws* wsi, const Leg& leg) {
  const auto found = leg.dialled == nullptr ? gateways.end() : gateways.find(leg.dialled->name);
  if (found == gateways.end() || found->second.wsi != wsi || found->second.out.empty())
    return 0;
  const std::string line = found->second.out.front();
  found->second.out.erase(found->second.out.begin());
  if (!web::write(wsi, line, LWS_WRITE_TEXT))
    return -1;
  if (!found->second.out.empty())
    lws_callback_on_writable(wsi);
  return 0;
}

void Relay::Impl::hung_up(lws* wsi, const Leg& leg) {
  if (leg.dialled == nullptr)
    return;
  const auto found = gateways.find(leg.dialled->name);
  if (found == gateways.end() || found->second.wsi != wsi)
    return;
  gateways.erase(found);
  say(leg.dialled->name + " has hung up");
}

/// A visitor has come to the port of a robot.
int Relay::Impl::arrived(lws* wsi, Leg& leg) {
  const auto door = doors.find(lws_get_vhost(wsi));
  const auto gateway = door == doors.end() ? gateways.end() : gateways.find(door->second->name);
  if (gateway == gateways.end())
    return -1;                                // no gateway has dialled in
  const std::string ticket = random_hex(16);  // unguessable
  if (gateway->second.out.size() > Rendezvous::kMost)
    return -1;
  leg.visitor = ++last;
  if (const auto gone = rendezvous.arrive(door->second->name, web::peer(wsi), leg.visitor, ticket,
                                          BootClock::seconds()))
    close(*gone);
  const int one = 1;
  setsockopt(lws_get_socket_fd(wsi), IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
  splices[leg.visitor].attach(Splice::kNear, wsi, false);
  gateway->second.out.push_back("fetch " + ticket);
  lws_callback_on_writable(gateway->second.wsi);
  return 0;
}

/// The gateway has opened a connection for a visitor.
int Relay::Impl::fetched(lws* wsi, Leg& leg) {
  const Path path = path_of(wsi);
  const auto visitor = rendezvous.fetch(path.robot, path.ticket);
  const auto splice = visitor ? splices.find(*visitor) : splices.end();
  if (splice == splices.end())
    return -1;
  leg.visitor = *visitor;
  splice->second.attach(Splice::kFar, wsi, true);
  return 0;
}

int Relay::Impl::writable(const Leg& leg, Splice::Side side) {
  const auto splice = splices.find(leg.visitor);
  return splice == splices.end() ? -1 : splice->second.write(side);
}

void Relay::Impl::came(const Leg& leg, Splice::Side side, std::string_view bytes) {
  if (const auto splice = splices.find(leg.visitor); splice != splices.end())
    splice->second.came(side, bytes);
}

void Relay::Impl::left(const Leg& leg, Splice::Side side) {
  const auto splice = splices.find(leg.visitor);
  if (splice == splices.end())
    return;
  splice->second.closed(side);
  // A visitor who leaves while waiting is never fetched.
  if (splice->second.is_over() ||
      !splice->second.is_attached(side == Splice::kNear ? Splice::kFar : Splice::kNear)) {
    rendezvous.leave(leg.visitor);
    splices.erase(splice);
  }
}

void Relay::Impl::tick() {
  for (const Visitor visitor : rendezvous.expire(BootClock::seconds()))
    close(visitor);
}

void Relay::Impl::close(Visitor visitor) {
  if (const auto splice = splices.find(visitor); splice != splices.end())
    splice->second.close();
}

int Relay::Impl::on_dial(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                         std::size_t size) {
  auto* const leg = static_cast<Leg*>(user);
  switch (reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return of(wsi).refuses(wsi, true) ? -1 : 0;
    case LWS_CALLBACK_ESTABLISHED:
      return of(wsi).dialled(wsi, *leg);
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return of(wsi).tell(wsi, *leg);
    case LWS_CALLBACK_RECEIVE:
      return -1;  // a gateway must not send here
    case LWS_CALLBACK_CLOSED:
      of(wsi).hung_up(wsi, *leg);
      return 0;
    case LWS_CALLBACK_HTTP:
      lws_return_http_status(wsi, HTTP_STATUS_NOT_FOUND,
                             "a relay: gateways of robots dial in here");
      return -1;
    case LWS_CALLBACK_OPENSSL_LOAD_EXTRA_SERVER_VERIFY_CERTS:
      SSL_CTX_set_info_callback(static_cast<SSL_CTX*>(user), note_alert);
      [[fallthrough]];
    default:
      return web::Loop::otherwise(wsi, reason, user, in, size);
  }
}

int Relay::Impl::on_carry(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                          std::size_t size) {
  auto* const leg = static_cast<Leg*>(user);
  switch (reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return of(wsi).refuses(wsi, false) ? -1 : 0;
    case LWS_CALLBACK_ESTABLISHED:
      return of(wsi).fetched(wsi, *leg);
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return of(wsi).writable(*leg, Splice::kFar);
    case LWS_CALLBACK_RECEIVE:
      of(wsi).came(*leg, Splice::kFar, {static_cast<const char*>(in), size});
      return 0;
    case LWS_CALLBACK_CLOSED:
      of(wsi).left(*leg, Splice::kFar);
      return 0;
    default:
      return 0;
  }
}

int Relay::Impl::on_visitor(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                            std::size_t size) {
  auto* const leg = static_cast<Leg*>(user);
  switch (reason) {
    case LWS_CALLBACK_RAW_ADOPT:
      return of(wsi).arrived(wsi, *leg);
    case LWS_CALLBACK_RAW_RX:
      of(wsi).rendezvous.heard(leg->visitor, BootClock::seconds());
      of(wsi).came(*leg, Splice::kNear, {static_cast<const char*>(in), size});
      return 0;
    case LWS_CALLBACK_RAW_WRITEABLE:
      return of(wsi).writable(*leg, Splice::kNear);
    case LWS_CALLBACK_RAW_CLOSE:
      if (leg != nullptr)
        of(wsi).left(*leg, Splice::kNear);
      return 0;
    default:
      return 0;
  }
}

Relay::Relay(const RelayOptions& options, std::vector<Robot> robots)
    : impl_(std::make_unique<Impl>(std::move(robots))) {
  static const std::array<lws_protocols, 4> dial_protocols{
      {{kDial, Impl::on_dial, sizeof(Impl::Leg), 4096, 0, nullptr, 0},
       {kCarry, Impl::on_carry, sizeof(Impl::Leg), 16384, 0, nullptr, 0},
       web::Loop::descriptors(),
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  static const std::array<lws_protocols, 2> door_protocols{
      {{"visitor", Impl::on_visitor, sizeof(Impl::Leg), 16384, 0, nullptr, 0},
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  // A gateway without an answer is dropped: it dials in again.
  static const lws_retry_bo_t patience{nullptr, 0, 0, 5, 12, 0};

  const bool encrypts = !options.place.certificate.empty();
  impl_->loop.emplace(impl_.get(), kMostDescriptors, encrypts);
  impl_->loop->serve_renewed(say);
  lws_context_creation_info info{};
  const auto listen = [&](const char* name, const web::Place& place) {
    info.vhost_name = name;
    lws_vhost* const vhost = impl_->loop->listen(info, place);
    if (vhost == nullptr)
      throw std::runtime_error("cannot listen on " + place.address + " port " +
                               std::to_string(place.port) + " (" + name +
                               "): another program has it, it is no address of this machine, or "
                               "certificate and key do not fit");
    return vhost;
  };
  // The visitors' ports first: they have no certificate, since their bytes are not for the relay to
  // read.
  info.options |= LWS_SERVER_OPTION_ADOPT_APPLY_LISTEN_ACCEPT_CONFIG;
  info.listen_accept_role = "raw-skt";
  info.listen_accept_protocol = "visitor";
  info.protocols = door_protocols.data();
  for (const Robot& robot : impl_->rendezvous.robots())
    impl_->doors[listen(robot.name.c_str(), {options.place.address, robot.port, {}, {}})] = &robot;
  info.options &= ~static_cast<std::uint64_t>(LWS_SERVER_OPTION_ADOPT_APPLY_LISTEN_ACCEPT_CONFIG);
  info.listen_accept_role = nullptr;
  info.listen_accept_protocol = nullptr;
  info.protocols = dial_protocols.data();
  info.timeout_secs = 5;
  info.retry_and_idle_policy = &patience;
  // Without a certificate the tokens would cross the network in clear.
  web::Place place = options.place;
  if (!encrypts)
    place.address = "127.0.0.1";
  impl_->dial = listen("dial", place);
}

Relay::~Relay() {
  impl_->loop.reset();  // its callbacks need the rest
}

void Relay::run(int stop) {
  impl_->loop->every(kTick, [this] { impl_->tick(); });
  impl_->loop->run(impl_->dial, stop);
}

}  // namespace saphira::relay

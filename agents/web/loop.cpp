#include "loop.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <strings.h>
#include <sys/stat.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace saphira::web {

namespace {

constexpr const char* kDescriptor = "descriptor";
constexpr long kSecond = 1'000'000;     // [us]
constexpr long kRenewal = 2 * kSecond;  // [us] between two looks at the certificates
constexpr std::size_t kLongestHeader = 1024;
constexpr unsigned short kLongestHeaders =
    16384;  // of a request: cookies of others, behind a proxy

int readable(lws* wsi, lws_callback_reasons reason, void* /*user*/, void* /*in*/,
             std::size_t /*size*/) {
  if (reason == LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION)
    return -1;  // a client may name this protocol, too
  auto* const call = static_cast<std::function<void()>*>(lws_get_opaque_user_data(wsi));
  if (reason == LWS_CALLBACK_RAW_RX_FILE && call != nullptr)
    (*call)();
  return 0;
}

/// Changes with each change of the file.
std::string state_of(const std::string& file) {
  struct stat state {};
  if (stat(file.c_str(), &state) != 0)
    return {};
  return std::to_string(state.st_ino) + " " + std::to_string(state.st_size) + " " +
         std::to_string(state.st_mtim.tv_sec) + "." + std::to_string(state.st_mtim.tv_nsec);
}

}  // namespace

/// Two files, as they were when they were read last.
struct Loop::Certificate {
  std::string file;
  std::string key_file;
  std::string seen;  ///< state of the files
  std::string read;  ///< likewise, when they were read last
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> renewed{nullptr, SSL_CTX_free};

  std::string state() const { return state_of(file) + " " + state_of(key_file); }
  bool renew();
  static int serve(SSL* ssl, void* certificate);
};

/// False: the files do not fit.
bool Loop::Certificate::renew() {
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> next(SSL_CTX_new(TLS_server_method()),
                                                         SSL_CTX_free);
  const bool fits =
      next != nullptr && SSL_CTX_use_certificate_chain_file(next.get(), file.c_str()) == 1 &&
      SSL_CTX_use_PrivateKey_file(next.get(), key_file.c_str(), SSL_FILETYPE_PEM) == 1 &&
      SSL_CTX_check_private_key(next.get()) == 1;
  ERR_clear_error();  // libwebsockets would take it for its own
  if (fits)
    renewed = std::move(next);
  return fits;
}

/// Before each handshake. Its key may be of another kind than that of the first certificate.
int Loop::Certificate::serve(SSL* ssl, void* certificate) {
  SSL_CTX* const renewed = static_cast<Certificate*>(certificate)->renewed.get();
  if (renewed == nullptr)
    return 1;
  STACK_OF(X509)* chain = nullptr;
  SSL_CTX_get0_chain_certs(renewed, &chain);
  SSL_certs_clear(ssl);
  return SSL_use_cert_and_key(ssl, SSL_CTX_get0_certificate(renewed),
                              SSL_CTX_get0_privatekey(renewed), chain, 1);
}

std::string header(lws* wsi, lws_token_indexes which) {
  std::array<char, kLongestHeader> text{};
  const int size = lws_hdr_copy(wsi, text.data(), static_cast<int>(text.size()), which);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : std::string();
}

std::string custom_header(lws* wsi, const char* name) {
  std::array<char, kLongestHeader> text{};
  if (lws_hdr_custom_copy(wsi, text.data(), static_cast<int>(text.size()), name,
                          static_cast<int>(std::strlen(name))) <= 0)
    return {};
  const std::string_view value = text.data();
  const std::size_t first = value.find_first_not_of(" \t");
  if (first == std::string_view::npos)
    return {};
  return std::string(value.substr(first, value.find_last_not_of(" \t") - first + 1));
}

std::string host(lws* wsi) {
  const std::string asked = custom_header(wsi, "x-forwarded-host:");
  return asked.empty() ? header(wsi, WSI_TOKEN_HOST) : asked.substr(0, asked.find(','));
}

bool is_here(lws* wsi) {
  const std::string address = peer(wsi);
  const auto has = [wsi](std::string_view name) {
    return lws_hdr_custom_length(wsi, name.data(), static_cast<int>(name.size())) >= 0;
  };
  return (address.starts_with("127.") || address == "::1") &&
         header(wsi, WSI_TOKEN_HTTP) != "HTTP/1.0" &&  // nginx by its defaults
         lws_hdr_total_length(wsi, WSI_TOKEN_X_FORWARDED_FOR) <= 0 &&
         lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_X_REAL_IP) <= 0 &&
         lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_VIA) <= 0 && !has("forwarded:") &&
         !has("x-forwarded-host:") && !has("x-forwarded-proto:");
}

std::string peer(lws* wsi) {
  std::array<char, 64> text{};
  lws_get_peer_simple(wsi, text.data(), text.size());
  const std::string_view address = text.data();
  return std::string(address.starts_with("::ffff:") ? address.substr(7) : address);
}

bool begin_answer(lws* wsi, int status, const std::string& type, lws_filepos_t size,
                  const Headers& more) {
  std::array<unsigned char, LWS_PRE + 2048> buffer{};
  unsigned char* const begin = buffer.data() + LWS_PRE;
  unsigned char* at = begin;
  unsigned char* const end = buffer.data() + buffer.size() - 1;
  if (lws_add_http_common_headers(wsi, static_cast<unsigned>(status), type.c_str(), size, &at,
                                  end) != 0)
    return false;
  Headers all{{"x-content-type-options:", "nosniff"},
              {"cache-control:", "no-cache"},
              {"connection:", "close"}};
  all.insert(all.end(), more.begin(), more.end());
  for (const auto& [name, value] : all)
    if (lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(name),
                                    reinterpret_cast<const unsigned char*>(value.c_str()),
                                    static_cast<int>(value.size()), &at, end) != 0)
      return false;
  return lws_finalize_write_http_header(wsi, begin, &at, end) == 0;
}

bool write(lws* wsi, std::string_view content, lws_write_protocol how) {
  std::vector<unsigned char> buffer(LWS_PRE);
  buffer.insert(buffer.end(), content.begin(), content.end());
  return lws_write(wsi, buffer.data() + LWS_PRE, content.size(), how) >=
         static_cast<int>(content.size());
}

void drop(lws* wsi) {
  lws_set_timeout(wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
}

std::string host_name() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

std::string name_of(const Place& place) {
  const std::string& address = place.address;
  if (address == "127.0.0.1" || address == "::1")
    return "localhost";
  const bool in_digits = address.find_first_not_of("0123456789.") == std::string::npos;
  return in_digits && address != "0.0.0.0" && place.certificate.empty() ? address : host_name();
}

lws_protocols Loop::descriptors() {
  return {kDescriptor, readable, 0, 0, 0, nullptr, 0};
}

Loop::Loop(void* owner, unsigned most, bool encrypts) {
  lws_set_log_level(0, nullptr);  // this program reports errors itself
  lws_context_creation_info info{};
  info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
  if (encrypts)
    info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
  info.fd_limit_per_thread = most;
  info.max_http_header_data = kLongestHeaders;
  info.user = owner;
  info.gid = static_cast<gid_t>(-1);
  info.uid = static_cast<uid_t>(-1);
  context_ = lws_create_context(&info);
  if (context_ == nullptr)
    throw std::runtime_error("the event loop of the network could not be made");
}

Loop::~Loop() {
  lws_context_destroy(context_);
}

std::string exposure(const Place& place) {
  const bool here = place.address.starts_with("127.") || place.address == "::1" ||
                    place.address == "lo" || !place.certificate.empty();
  return here ? ""
              : "--listen " + place.address +
                    " without --certificate: the key crosses the network in the clear, and whoever "
                    "reads it may do what its owner may";
}

lws_vhost* Loop::listen(lws_context_creation_info info, const Place& place) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const bool is_ipv4 = inet_pton(AF_INET, place.address.c_str(), bytes.data()) == 1;
  // libwebsockets reports no error for another word, and listens nowhere.
  if (!is_ipv4 && inet_pton(AF_INET6, place.address.c_str(), bytes.data()) != 1 &&
      if_nametoindex(place.address.c_str()) == 0)
    throw std::invalid_argument(
        "--listen: expected an address or an interface of this machine, such as 0.0.0.0, found \"" +
        place.address + "\"");
  // With IPv6, libwebsockets 4.1 takes an IPv4 address for every address of this machine.
  if (is_ipv4)
    info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
  info.options |= LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  info.iface =
      place.address == "0.0.0.0" ? nullptr : addresses_.emplace_back(place.address).c_str();
  info.port = place.port;
  info.alpn = "http/1.1";  // with HTTP/2, a browser has other headers and WebSockets
  if (!place.certificate.empty()) {
    info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
    info.ssl_cert_filepath = place.certificate.c_str();
    info.ssl_private_key_filepath = place.certificate_key.c_str();
    Certificate& certificate = certificates_.emplace_back();
    certificate.file = place.certificate;
    certificate.key_file = place.certificate_key;
    certificate.seen = certificate.read = certificate.state();
    info.user = &certificate;
  }
  return lws_create_vhost(context_, &info);
}

int Loop::otherwise(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size) {
  // A WebSocket without a protocol comes to the first one.
  if (reason == LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION)
    return -1;
  // With HTTP/2 a connection has many requests, and lasts as long as the client wants.
  if (reason == LWS_CALLBACK_HTTP_CONFIRM_UPGRADE)
    return strcasecmp(static_cast<const char*>(in), "websocket") == 0 ? 0 : -1;
  if (reason != LWS_CALLBACK_OPENSSL_LOAD_EXTRA_SERVER_VERIFY_CERTS)
    return lws_callback_http_dummy(wsi, reason, user, in, size);
  SSL_CTX_set_cert_cb(static_cast<SSL_CTX*>(user), Certificate::serve,
                      lws_vhost_user(static_cast<lws_vhost*>(in)));
  return 0;
}

void Loop::serve_renewed(std::function<void(const std::string&)> say) {
  every(kRenewal, [this, say = std::move(say)] {
    for (Certificate& each : certificates_) {
      const std::string state = each.state();
      // Two files: they may be in the middle of their change.
      if (std::exchange(each.seen, state) != state || each.read == state)
        continue;
      each.read = state;
      say(each.file + (each.renew() ? " has changed, and is served from now on"
                                    : " or " + each.key_file +
                                          " has changed, and they do not fit: the certificate "
                                          "from before is still served"));
    }
  });
}

void Loop::watch(lws_vhost* vhost, int fd, std::function<void()> readable) {
  lws_sock_file_fd_type file{};
  file.filefd = dup(fd);  // libwebsockets closes it at the end
  lws* const wsi =
      lws_adopt_descriptor_vhost(vhost, LWS_ADOPT_RAW_FILE_DESC, file, kDescriptor, nullptr);
  if (wsi == nullptr)
    throw std::runtime_error("the event loop of the network cannot wait for a descriptor");
  watched_.push_back(std::move(readable));
  lws_set_opaque_user_data(wsi, &watched_.back());
}

Loop::Timer::Timer(long period, std::function<void()> the_tick)
    : fd(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)), tick(std::move(the_tick)) {
  const timespec each{period / kSecond, period % kSecond * 1000};
  const itimerspec times{each, each};
  if (fd < 0 || timerfd_settime(fd, 0, &times, nullptr) != 0)
    throw std::runtime_error("the event loop of the network cannot make a timer");
}

Loop::Timer::~Timer() {
  close(fd);
}

/// A timer of libwebsockets would poll without a pause in the last millisecond before its time.
void Loop::every(long period, std::function<void()> call) {
  timers_.emplace_back(period, std::move(call));
}

void Loop::run(lws_vhost* vhost, int stop) {
  watch(vhost, stop, [this] { stopping_ = true; });
  for (const Timer& timer : timers_)
    watch(vhost, timer.fd, [&timer] {
      std::uint64_t count = 0;
      if (read(timer.fd, &count, sizeof count) == sizeof count)
        timer.tick();
    });
  while (!stopping_)
    if (lws_service(context_, 0) < 0)
      throw std::runtime_error("the event loop of the network has failed");
}

}  // namespace saphira::web

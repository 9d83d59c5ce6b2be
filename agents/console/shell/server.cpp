#include "server.hpp"

#include <openssl/evp.h>
#include <openssl/sha.h>
#include <sys/socket.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

namespace saphira::console {

namespace {

using web::header;

// WebSockets. A page has 2, 3 more with the camera, and 5 more to drive.
constexpr std::size_t kMostConnections = 96;
constexpr unsigned kMostDescriptors = 192;
constexpr std::size_t kLongestMessage = 4096;
constexpr int kSendBuffer = 128 * 1024;          // the kernel's buffer for a slow browser
constexpr int kTick = 50'000;                    // [us]
constexpr int kTogether = 10'000;                // [us]
constexpr std::string_view kAccess = "/access";  // why a page may not connect; empty: it may
constexpr const char* kTelemetry = "saphira.telemetry";
constexpr const char* kCommands = "saphira.commands";
constexpr const char* kPictures = "saphira.pictures";
constexpr const char* kSimulator = "saphira.simulator";

Channel channel_of(const char* protocol) {
  return std::strcmp(protocol, kCommands) == 0    ? Channel::commands
         : std::strcmp(protocol, kPictures) == 0  ? Channel::pictures
         : std::strcmp(protocol, kSimulator) == 0 ? Channel::simulator
                                                  : Channel::telemetry;
}

/// SHA-256 in base64.
std::string digest(std::string_view text) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> bytes{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), bytes.data());
  std::array<unsigned char, 4 * (SHA256_DIGEST_LENGTH / 3 + 1) + 1> words{};
  EVP_EncodeBlock(words.data(), bytes.data(), static_cast<int>(bytes.size()));
  return reinterpret_cast<const char*>(words.data());
}

/// For gzip; empty where it fails.
std::string packed(std::string_view text) {
  constexpr int kWithGzipHeader = 16 + MAX_WBITS;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kWithGzipHeader, MAX_MEM_LEVEL,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    return {};
  std::string out(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const bool whole = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  out.resize(whole ? stream.total_out : 0);
  deflateEnd(&stream);
  return out;
}

}  // namespace

struct Server::Impl {
  /// A page, as it is sent.
  struct Page {
    explicit Page(const PageFile& file)
        : path(file.path),
          content(file.content),
          zipped(packed(content)),
          tag('"' + digest(content) + '"'),
          policy(
              "default-src 'none'; script-src" + source("<script type=\"module\">", "</script>") +
              "; style-src" + source("<style>", "</style>") +
              "; connect-src 'self'; img-src 'self' data:; manifest-src 'self'; base-uri 'none'; "
              "form-action 'none'; frame-ancestors 'none'") {}

    std::string path;
    std::string_view content;
    std::string zipped;
    std::string tag;     ///< another one for another content
    std::string policy;  ///< its own script and style, and no other

   private:
    /// The part between two marks as a source of the policy.
    std::string source(std::string_view begin, std::string_view end) const {
      const std::size_t at = content.find(begin);
      if (at == std::string_view::npos)
        return " 'none'";
      const std::string_view from = content.substr(at + begin.size());
      return " 'sha256-" + digest(from.substr(0, from.find(end))) + "'";
    }
  };

  /// The record of libwebsockets for each connection; it begins as zeros.
  struct Http {
    const Page* page;
    bool zipped;
  };
  struct Socket {
    Connection id;
    bool bytes;  // what goes out is no text
  };
  struct Open {
    lws* wsi = nullptr;
    std::string incoming;  // the pieces of one message
  };

  AccessSettings access;
  std::vector<Page> pages;
  Events events;
  std::optional<web::Loop> loop;
  lws_vhost* vhost = nullptr;
  lws_vhost* relayed = nullptr;  // null: nobody comes by a relay
  std::map<Connection, Open> open;
  Connection last = 0;
  bool soon = false;

  // A timer of libwebsockets, with a pointer to us.
  struct Timer {
    lws_sorted_usec_list_t list{};
    Impl* impl = nullptr;
  };
  Timer together;

  Caller caller_of(lws* wsi) const;
  using Headers = std::vector<std::pair<const char*, std::string>>;
  static bool begin_answer(lws* wsi, unsigned status, const std::string& type, std::size_t size,
                           const Headers& more);
  static int say(lws* wsi, unsigned status, const std::string& text);
  int answer_http(lws* wsi, Http& http, std::string_view path);
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

Caller Server::Impl::caller_of(lws* wsi) const {
  return {web::host(wsi), header(wsi, WSI_TOKEN_ORIGIN),
          lws_get_vhost(wsi) != relayed && web::is_here(wsi)};
}

bool Server::Impl::begin_answer(lws* wsi, unsigned status, const std::string& type,
                                std::size_t size, const Headers& more) {
  std::array<unsigned char, LWS_PRE + 2048> buffer{};
  unsigned char* const begin = buffer.data() + LWS_PRE;
  unsigned char* at = begin;
  unsigned char* const end = buffer.data() + buffer.size() - 1;
  const auto add = [&](const char* header_name, const std::string& value) {
    return lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(header_name),
                                       reinterpret_cast<const unsigned char*>(value.c_str()),
                                       static_cast<int>(value.size()), &at, end) == 0;
  };
  return lws_add_http_common_headers(wsi, status, type.c_str(), size, &at, end) == 0 &&
         std::all_of(more.begin(), more.end(),
                     [&](const auto& each) { return add(each.first, each.second); }) &&
         add("x-content-type-options:", "nosniff") && add("referrer-policy:", "no-referrer") &&
         add("cache-control:", "no-cache") && add("connection:", "close") &&
         lws_finalize_write_http_header(wsi, begin, &at, end) == 0;
}

int Server::Impl::say(lws* wsi, unsigned status, const std::string& text) {
  if (!begin_answer(wsi, status, "text/plain; charset=utf-8", text.size(),
                    {{"content-security-policy:", "default-src 'none'"}}))
    return -1;
  std::vector<unsigned char> buffer(LWS_PRE + text.size());
  std::memcpy(buffer.data() + LWS_PRE, text.data(), text.size());
  lws_write(wsi, buffer.data() + LWS_PRE, text.size(), LWS_WRITE_HTTP_FINAL);
  return web::kAnswered;
}

int Server::Impl::answer_http(lws* wsi, Http& http, std::string_view path) {
  // A request behind another one, which is being answered, or one with a body: see web::kAnswered.
  if (http.page != nullptr || lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) <= 0 ||
      lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH) > 0)
    return -1;
  Caller caller = caller_of(wsi);
  // A proxy may pass its own path on.
  const std::string_view name = path.substr(std::min(path.rfind('/'), path.size()));
  // A page cannot read why its WebSocket was refused.
  if (name == kAccess) {
    std::array<char, 300> argument{};
    const char* const origin =
        lws_get_urlarg_by_name(wsi, "origin=", argument.data(), static_cast<int>(argument.size()));
    caller.origin = origin == nullptr ? "" : origin;
    return say(wsi, HTTP_STATUS_OK, refusal(access, caller));
  }
  if (const std::string why = refusal(access, caller); !why.empty())
    return say(wsi, HTTP_STATUS_FORBIDDEN, why + "\n");
  const auto page = std::find_if(pages.begin(), pages.end(), [&](const Page& each) {
    return each.path == (name == "/" ? "/index.html" : name);
  });
  if (page == pages.end())
    return say(wsi, HTTP_STATUS_NOT_FOUND,
               "There is only the page; its address ends with a slash: /\n");
  Headers headers{{"content-security-policy:", page->policy},
                  {"etag:", page->tag},
                  {"vary:", "accept-encoding"}};
  const char* const type = name.ends_with(".json")  ? "application/manifest+json"
                           : name.ends_with(".svg") ? "image/svg+xml"
                                                    : "text/html; charset=utf-8";
  if (header(wsi, WSI_TOKEN_HTTP_IF_NONE_MATCH).find(page->tag) != std::string::npos)
    return begin_answer(wsi, HTTP_STATUS_NOT_MODIFIED, type, 0, headers) ? web::kAnswered : -1;
  http.zipped = !page->zipped.empty() &&
                header(wsi, WSI_TOKEN_HTTP_ACCEPT_ENCODING).find("gzip") != std::string::npos;
  if (http.zipped)
    headers.emplace_back("content-encoding:", "gzip");
  if (!begin_answer(wsi, HTTP_STATUS_OK, type,
                    http.zipped ? page->zipped.size() : page->content.size(), headers))
    return -1;
  http.page = &*page;
  lws_callback_on_writable(wsi);
  return 0;
}

int Server::Impl::send_http(lws* wsi, Http& http) const {
  if (http.page == nullptr)
    return 0;
  const std::string_view content = http.zipped ? http.page->zipped : http.page->content;
  std::vector<unsigned char> buffer(LWS_PRE + content.size());
  std::memcpy(buffer.data() + LWS_PRE, content.data(), content.size());
  if (lws_write(wsi, buffer.data() + LWS_PRE, content.size(), LWS_WRITE_HTTP_FINAL) !=
      static_cast<int>(content.size()))
    return -1;
  http.page = nullptr;
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
  socket.bytes = channel == Channel::pictures;
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
  if (lws_write(wsi, buffer.data() + LWS_PRE, text->size(),
                socket.bytes ? LWS_WRITE_BINARY : LWS_WRITE_TEXT) < 0)
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
      return web::Loop::otherwise(wsi, reason, user, in, size);
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
               const std::vector<PageFile>& files, Events events)
    : impl_(std::make_unique<Impl>()) {
  impl_->access = access;
  for (const PageFile& file : files)
    impl_->pages.emplace_back(file);
  impl_->events = std::move(events);
  static const std::array<lws_protocols, 7> protocols{
      {{"http", Impl::http, sizeof(Impl::Http), 0, 0, nullptr, 0},
       {kTelemetry, Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       {kCommands, Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       {kPictures, Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       {kSimulator, Impl::socket, sizeof(Impl::Socket), kLongestMessage, 0, nullptr, 0},
       web::Loop::descriptors(),
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  // A sleeping or disconnected browser is dropped after half a minute.
  static const lws_retry_bo_t patience{nullptr, 0, 0, 10, 30, 0};

  web::Place place = options.place;
  const bool encrypts = !place.certificate.empty();
  impl_->loop.emplace(impl_.get(), kMostDescriptors, encrypts);
  impl_->loop->serve_renewed(
      [](const std::string& text) { std::fprintf(stderr, "saphira-console: %s\n", text.c_str()); });
  lws_context_creation_info info{};
  info.protocols = protocols.data();
  info.timeout_secs = 5;  // for clients without a complete request
  info.keepalive_timeout = 5;
  info.retry_and_idle_policy = &patience;
  info.vhost_name = "console";
  info.alpn = "http/1.1";  // with HTTP/2, a browser has other headers and WebSockets
  const int first = place.port;
  const int count = first == 0 ? 1 : std::max(1, options.ports);
  const auto listen = [&](int port) {
    place.port = port;
    return impl_->loop->listen(info, place);
  };
  if (options.before > first && options.before < first + count)
    impl_->vhost = listen(options.before);
  for (int i = 0; i < count && impl_->vhost == nullptr; ++i)
    impl_->vhost = listen(first + i);
  if (options.relayed && impl_->vhost != nullptr) {
    place.address = kRelayed;
    info.vhost_name = "relayed";
    impl_->relayed = listen(0);
  }
  if (impl_->vhost == nullptr || (options.relayed && impl_->relayed == nullptr))
    throw std::runtime_error(
        "cannot listen on " + place.address + " port " + std::to_string(first) +
        (count > 1 ? " or the " + std::to_string(count - 1) + " after it" : "") +
        (!encrypts ? ": another program has it, or it is no address of this machine"
                   : ": another program has it, or certificate and key do not fit"));
}

Server::~Server() {
  impl_->loop.reset();  // its callbacks need the rest
}

int Server::port() const {
  return lws_get_vhost_listen_port(impl_->vhost);
}

int Server::relayed_port() const {
  return lws_get_vhost_listen_port(impl_->relayed);
}

void Server::watch(int fd) {
  impl_->loop->watch(impl_->vhost, fd, [this] { impl_->events.readable(); });
}

void Server::want(Connection connection) {
  if (const auto found = impl_->open.find(connection); found != impl_->open.end())
    lws_callback_on_writable(found->second.wsi);
}

void Server::want_all_soon() {
  if (impl_->soon || impl_->open.empty())
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

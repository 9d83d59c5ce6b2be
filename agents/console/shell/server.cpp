#include "server.hpp"

#include <openssl/evp.h>
#include <openssl/sha.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace saphira::console {

namespace {

using web::header;

// WebSockets. A page has 2, 3 more with the camera, and 5 more to drive.
constexpr std::size_t kMostConnections = 96;
constexpr std::size_t kLongestMessage = 4096;
constexpr int kTick = 50'000;                    // [us]
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

bool begin_answer(lws* wsi, int status, const std::string& type, std::size_t size,
                  web::Headers more) {
  more.emplace_back("referrer-policy:", "no-referrer");
  return web::begin_answer(wsi, status, type, size, more);
}

int say(lws* wsi, int status, const std::string& text) {
  if (begin_answer(wsi, status, "text/plain; charset=utf-8", text.size(),
                   {{"content-security-policy:", "default-src 'none'"}}))
    web::write(wsi, text, LWS_WRITE_HTTP_FINAL);
  return web::kAnswered;
}

}  // namespace

/// A page, as it is sent.
struct Server::Page {
  explicit Page(const PageFile& file)
      : path(file.path),
        content(file.content),
        zipped(packed(content)),
        tag('"' + digest(content) + '"'),
        policy("default-src 'none'; script-src" + source("<script type=\"module\">", "</script>") +
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
struct Server::Http {
  const Page* page;
  bool zipped;
};

Caller Server::caller_of(lws* wsi) const {
  return {web::host(wsi), header(wsi, WSI_TOKEN_ORIGIN),
          lws_get_vhost(wsi) != relayed_ && web::is_here(wsi)};
}

int Server::answer(lws* wsi, Http& http, std::string_view path) const {
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
    return say(wsi, HTTP_STATUS_OK, refusal(access_, caller));
  }
  if (const std::string why = refusal(access_, caller); !why.empty())
    return say(wsi, HTTP_STATUS_FORBIDDEN, why + "\n");
  const auto page = std::ranges::find_if(
      pages_, [&](const Page& each) { return each.path == (name == "/" ? "/index.html" : name); });
  if (page == pages_.end())
    return say(wsi, HTTP_STATUS_NOT_FOUND,
               "There is only the page; its address ends with a slash: /\n");
  web::Headers headers{{"content-security-policy:", page->policy},
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

void Server::opened(Connection id, lws* wsi) {
  const Channel channel = channel_of(lws_get_protocol(wsi)->name);
  if (channel == Channel::pictures)
    pictures_.insert(id);
  events_.opened(id, channel, caller_of(wsi));
}

std::optional<web::Sockets::Message> Server::next(Connection id) const {
  if (auto text = events_.next(id))
    return {{pictures_.contains(id), *std::move(text)}};
  return std::nullopt;
}

int Server::http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size) {
  auto* const http = static_cast<Http*>(user);
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return static_cast<const Server*>(lws_context_user(lws_get_context(wsi)))
          ->answer(wsi, *http, static_cast<const char*>(in));
    case LWS_CALLBACK_HTTP_WRITEABLE:
      if (http->page == nullptr)
        return 0;
      web::write(wsi, http->zipped ? http->page->zipped : http->page->content,
                 LWS_WRITE_HTTP_FINAL);
      http->page = nullptr;
      return web::kAnswered;
    default:
      return web::Loop::otherwise(wsi, reason, user, in, size);
  }
}

Server::Server(const ServerOptions& options, const AccessSettings& access,
               const std::vector<PageFile>& files, Events events)
    : access_(access),
      pages_(files.begin(), files.end()),
      events_(std::move(events)),
      sockets_(this,
               {.protocols = {kTelemetry, kCommands, kPictures, kSimulator},
                .connections = kMostConnections,
                .longest = kLongestMessage,
                .http = http,
                .http_record = sizeof(Http)},
               {[this](lws* wsi) { return refusal(access_, caller_of(wsi)); },
                [this](auto id, lws* wsi) { opened(id, wsi); }, events_.came,
                [this](auto id) {
                  pictures_.erase(id);
                  events_.closed(id);
                },
                [this](auto id) { return next(id); }},
               !options.place.certificate.empty()) {
  sockets_.loop().serve_renewed(
      [](const std::string& text) { std::fprintf(stderr, "saphira-console: %s\n", text.c_str()); });
  listen(options);
}

Server::~Server() = default;

void Server::listen(const ServerOptions& options) {
  web::Place place = options.place;
  const int first = place.port;
  const int count = first == 0 ? 1 : std::max(1, options.ports);
  place.port = options.before;
  bool listens = place.port > first && place.port < first + count &&
                 sockets_.listen("console", place) != nullptr;
  for (int i = 0; i < count && !listens; ++i) {
    place.port = first + i;
    listens = sockets_.listen("console", place) != nullptr;
  }
  if (options.relayed && listens) {
    place.address = kRelayed;
    place.port = 0;
    relayed_ = sockets_.listen("relayed", place);
    listens = relayed_ != nullptr;
  }
  if (!listens)
    throw std::runtime_error(
        "cannot listen on " + place.address + " port " + std::to_string(first) +
        (count > 1 ? " or the " + std::to_string(count - 1) + " after it" : "") +
        (place.certificate.empty()
             ? ": another program has it, or it is no address of this machine"
             : ": another program has it, or certificate and key do not fit"));
}

void Server::run(int stop) {
  sockets_.run(stop, kTick, [this] {
    events_.tick();
    sockets_.want_all();
  });
}

}  // namespace saphira::console

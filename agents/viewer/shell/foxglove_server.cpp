#include "foxglove_server.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace saphira::viewer {

namespace {

constexpr std::size_t kMostClients = 16;
constexpr std::size_t kLongestMessage = 65536;                      // of a client
constexpr std::size_t kMostWaiting = std::size_t{4} * 1024 * 1024;  // [bytes] for one client
constexpr int kTick = 100'000;                                      // [us]

/// The key in the address; empty: none.
std::string key_of(lws* wsi) {
  std::array<char, 200> given{};
  const char* const key =
      lws_get_urlarg_by_name(wsi, "key=", given.data(), static_cast<int>(given.size()));
  return key == nullptr ? "" : key;
}

}  // namespace

int Server::http(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size) {
  if (reason != LWS_CALLBACK_HTTP)
    return web::Loop::otherwise(wsi, reason, user, in, size);
  lws_return_http_status(wsi, HTTP_STATUS_NOT_FOUND,
                         "Here is no page: open this address in Foxglove or Lichtblick, as a "
                         "Foxglove WebSocket");
  return web::kAnswered;
}

std::string Server::refusal(lws* wsi) const {
  const std::string key = key_of(wsi);
  if (options_.admits(key))
    return {};
  if (!key.empty())
    options_.refused(key);
  return "the address has to end with the key that saphira foxglove prints";
}

void Server::opened(Connection id, lws* wsi) {
  open_.emplace(id, Open{Client(options_.name, channels_, kMostWaiting), key_of(wsi)});
  options_.came(key_of(wsi));
  sockets_.want(id);
}

bool Server::came(Connection id, const std::string& text) {
  const auto added = open_.at(id).client.take(text);
  if (!added)
    return false;
  for (const std::size_t channel : *added)
    events_.subscribed(channel);
  sockets_.want(id);
  return true;
}

std::optional<web::Sockets::Message> Server::next(Connection id) {
  if (auto frame = open_.at(id).client.next())
    return {{frame->binary, std::move(frame->content)}};
  return std::nullopt;
}

Server::Server(const Options& options, std::vector<Channel> channels, Events events)
    : options_(options),
      channels_(std::move(channels)),
      events_(std::move(events)),
      sockets_(this,
               {.protocols = {std::begin(kProtocols), std::end(kProtocols)},
                .connections = kMostClients,
                .longest = kLongestMessage,
                .http = http},
               {[this](lws* wsi) { return refusal(wsi); },
                [this](auto id, lws* wsi) { opened(id, wsi); },
                [this](auto id, const auto& text) { return came(id, text); },
                [this](auto id) { open_.erase(id); }, [this](auto id) { return next(id); }},
               !options.place.certificate.empty()) {
  if (sockets_.listen("foxglove", options.place) == nullptr)
    throw std::runtime_error("cannot listen on " + options.place.address + " port " +
                             std::to_string(options.place.port) +
                             ": another program has it, it is no address of this machine, or "
                             "certificate and key do not fit; --port names another one");
}

bool Server::wants(std::size_t channel) const {
  return std::ranges::any_of(
      open_, [channel](const auto& each) { return each.second.client.wants(channel); });
}

void Server::offer(std::size_t channel, std::int64_t time_ns, const std::string& json) {
  for (auto& [id, open] : open_)
    if (open.client.wants(channel)) {
      open.client.offer(channel, time_ns, json);
      sockets_.want(id);
    }
}

void Server::run(int stop) {
  sockets_.run(stop, kTick, [this] {
    events_.tick();
    for (const auto& [id, open] : open_)
      if (!options_.admits(open.key))
        sockets_.close(id);
  });
}

}  // namespace saphira::viewer

#include "loop.hpp"

#include <unistd.h>

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace saphira::web {

namespace {

constexpr const char* kDescriptor = "descriptor";

int readable(lws* wsi, lws_callback_reasons reason, void* /*user*/, void* /*in*/,
             std::size_t /*size*/) {
  auto* const call = static_cast<std::function<void()>*>(lws_get_opaque_user_data(wsi));
  if (reason == LWS_CALLBACK_RAW_RX_FILE && call != nullptr)
    (*call)();
  return 0;
}

}  // namespace

std::string header(lws* wsi, lws_token_indexes which) {
  std::array<char, 1024> text{};
  const int size = lws_hdr_copy(wsi, text.data(), static_cast<int>(text.size()), which);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : std::string();
}

std::string peer(lws* wsi) {
  std::array<char, 64> text{};
  lws_get_peer_simple(wsi, text.data(), text.size());
  const std::string_view address = text.data();
  return std::string(address.starts_with("::ffff:") ? address.substr(7) : address);
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

void Loop::tick(lws_sorted_usec_list_t* list) {
  Timer& timer = *reinterpret_cast<Timer*>(list);  // its first member
  timer.tick();
  lws_sul_schedule(timer.context, 0, list, tick, timer.period);
}

void Loop::every(lws_usec_t period, std::function<void()> call) {
  Timer& timer = timers_.emplace_back();
  timer.context = context_;
  timer.period = period;
  timer.tick = std::move(call);
  lws_sul_schedule(context_, 0, &timer.list, tick, period);
}

void Loop::run(lws_vhost* vhost, int stop) {
  watch(vhost, stop, [this] { stopping_ = true; });
  while (!stopping_)
    if (lws_service(context_, 0) < 0)
      throw std::runtime_error("the event loop of the network has failed");
}

}  // namespace saphira::web

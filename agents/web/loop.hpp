#pragma once

#include <libwebsockets.h>

#include <functional>
#include <list>
#include <string>

namespace saphira::web {

/// The text of a header; empty where it is missing or longer than 1023 bytes.
std::string header(lws* wsi, lws_token_indexes which);

/// The network address of the other side; IPv4 as four numbers.
std::string peer(lws* wsi);

/// The return value of a callback that has sent a whole answer; its headers said "connection:
/// close". A second request on a connection is never read: libwebsockets 4.1 takes its first bytes
/// for its body, and hangs.
constexpr int kAnswered = -1;

/// An event loop of libwebsockets, in one thread, with the further needs of our programs:
/// descriptors to wait for, a clock, an end.
class Loop {
 public:
  /// owner: the context's user, from lws_context_user(). most: descriptors at once. encrypts: TLS
  /// is used. std::runtime_error where the loop cannot be made.
  Loop(void* owner, unsigned most, bool encrypts);
  /// Closes all connections: their callbacks still need the owner.
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  lws_context* context() const { return context_; }
  /// From now on calls `readable` when the descriptor is. The vhost has to have the protocol
  /// descriptors().
  void watch(lws_vhost* vhost, int fd, std::function<void()> readable);
  /// From now on calls `tick` once a period [us].
  void every(lws_usec_t period, std::function<void()> tick);
  /// Runs until `stop` is readable. std::runtime_error where the loop fails.
  void run(lws_vhost* vhost, int stop);

  /// The protocol of watched descriptors.
  static lws_protocols descriptors();

 private:
  struct Timer {
    lws_sorted_usec_list_t list{};
    lws_context* context = nullptr;
    lws_usec_t period = 0;
    std::function<void()> tick;
  };
  static void tick(lws_sorted_usec_list_t* list);

  lws_context* context_ = nullptr;
  std::list<std::function<void()>> watched_;
  std::list<Timer> timers_;
  bool stopping_ = false;
};

}  // namespace saphira::web

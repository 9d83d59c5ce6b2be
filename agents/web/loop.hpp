#pragma once

#include <libwebsockets.h>

#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace saphira::web {

/// The text of a header; empty where it is missing or longer than 1023 bytes.
std::string header(lws* wsi, lws_token_indexes which);

/// The text of a header that libwebsockets has no number for, such as "mcp-session-id:"; empty
/// where it is missing or longer than 1023 bytes. Without surrounding blanks.
std::string custom_header(lws* wsi, const char* name);
/// The header Host; behind a proxy that names it, the one that the browser asked for.
std::string host(lws* wsi);
/// The network address of the other side; IPv4 as four numbers.
std::string peer(lws* wsi);
/// The other side runs on this machine, and says of nobody that it speaks for them. A tunnel that
/// says nothing is not noticed.
bool is_here(lws* wsi);

/// The return value of a callback that has sent a whole answer; its headers said "connection:
/// close". A second request on a connection is never read: libwebsockets 4.1 takes its first bytes
/// for its body, and hangs.
constexpr int kAnswered = -1;

using Headers = std::vector<std::pair<const char*, std::string>>;
/// Sends the headers of an answer, which is the only one on its connection. False: it failed.
bool begin_answer(lws* wsi, int status, const std::string& type, lws_filepos_t size,
                  const Headers& more);
/// Sends a message, or a piece of an answer. False: it failed.
bool write(lws* wsi, std::string_view content, lws_write_protocol how);
/// Closes a connection, soon.
void drop(lws* wsi);

/// The address, port and certificate of a server.
struct Place {
  /// IPv4, IPv6, or an interface of this machine. 0.0.0.0: every IPv4 address; ::, of IPv6 too.
  std::string address;
  int port = 0;             ///< 0: any that is free
  std::string certificate;  ///< PEM files; empty: no TLS. They are read again when they change
  std::string certificate_key;
};

/// The name of this machine on its network.
std::string host_name();
/// The name by which people reach a place, without the port. A certificate has the name of this
/// machine.
std::string name_of(const Place& place);

/// A warning where others read along on the network: no TLS, and not on this machine alone; empty:
/// none.
std::string exposure(const Place& place);

/// An event loop of libwebsockets, in one thread, with the further needs of our programs:
/// descriptors to wait for, a clock, an end.
class Loop {
 public:
  /// owner: the context's user, from lws_context_user(). most: descriptors at once. encrypts: TLS
  /// is used. std::runtime_error where the loop cannot be made.
  Loop(void* owner, unsigned most, bool encrypts);
  /// Closes all connections: their callbacks still need the owner.
  ~Loop();
  Loop& operator=(Loop&&) = delete;

  lws_context* context() const { return context_; }
  /// A vhost that listens at this place and nowhere else; null: it cannot. info: the rest.
  /// std::invalid_argument for another word than an address or an interface of this machine.
  lws_vhost* listen(lws_context_creation_info info, const Place& place);
  /// From now on changed certificates are served; the words of each change go to `say`.
  void serve_renewed(std::function<void(const std::string&)> say);
  /// From now on calls `readable` when the descriptor is. The vhost has to have the protocol
  /// descriptors().
  void watch(lws_vhost* vhost, int fd, std::function<void()> readable);
  /// Calls `tick` once a period [us], while the loop runs. Call before run().
  void every(long period, std::function<void()> tick);
  /// Runs until `stop` is readable. std::runtime_error where the loop fails.
  void run(lws_vhost* vhost, int stop);

  /// The rest of the callback of a server's first protocol, which takes no WebSocket.
  static int otherwise(lws* wsi, lws_callback_reasons reason, void* user, void* in,
                       std::size_t size);
  /// The protocol of watched descriptors.
  static lws_protocols descriptors();

 private:
  struct Certificate;
  struct Timer {
    Timer(long period, std::function<void()> tick);
    ~Timer();
    Timer& operator=(Timer&&) = delete;

    int fd;
    std::function<void()> tick;
  };

  lws_context* context_ = nullptr;
  std::list<std::function<void()>> watched_;
  std::list<Timer> timers_;
  std::list<std::string> addresses_;  // libwebsockets keeps pointers to them
  std::list<Certificate> certificates_;
  bool stopping_ = false;
};

}  // namespace saphira::web

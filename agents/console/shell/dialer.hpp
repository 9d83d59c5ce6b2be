#pragma once

#include <functional>
#include <memory>
#include <string>

#include "saphira/relay/rendezvous.hpp"

namespace saphira::console {

/// From this address of its own the dialer connects to the server: who comes from there is no
/// neighbour on this machine.
constexpr const char* kRelayed = "127.0.0.77";

struct DialOptions {
  relay::Address address;
  std::string token;
  std::string
      authority;  ///< PEM file that the relay's certificate is checked by; empty: the system's
  int port = 0;   ///< of our server
};

/// Keeps a connection to a relay, and for everybody who comes to the relay opens one to our server.
/// In a thread of its own. Where the relay is lost it dials again, after 1 s, then later, 30 s at
/// most.
class Dialer {
 public:
  /// Both are called from the dialer's thread. reached: the relay is there, and this is the port of
  /// the robot there. lost: what is wrong, once until it is reached again.
  Dialer(DialOptions options, std::function<void(int port)> reached,
         std::function<void(const std::string& why)> lost);
  ~Dialer();
  Dialer(const Dialer&) = delete;
  Dialer& operator=(const Dialer&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::console

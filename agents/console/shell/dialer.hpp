#pragma once

#include <functional>
#include <memory>
#include <string>

#include "saphira/relay/rendezvous.hpp"

namespace saphira::console {

struct DialOptions {
  relay::Address address;
  std::string token;
  std::string authority;  ///< PEM file to check the relay's certificate; empty: the system's
  int port = 0;           ///< of our server, at kRelayed
};

/// Keeps a connection to a relay, and opens one to our server for each visitor of the relay. In a
/// thread of its own. Dials again after a loss: after 1 s, then later, 30 s at most.
class Dialer {
 public:
  /// Both are called from the dialer's thread. reached: with the robot's port at the relay. lost:
  /// with the reason, once for each loss.
  Dialer(DialOptions options, std::function<void(int port)> reached,
         std::function<void(const std::string& why)> lost);
  ~Dialer();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::console

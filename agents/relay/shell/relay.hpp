#pragma once

#include <memory>
#include <string>

#include "loop.hpp"
#include "saphira/relay/rendezvous.hpp"

namespace saphira::relay {

struct RelayOptions {
  /// The port for gateways, and the address of all ports. Without a certificate only gateways of
  /// this machine are served.
  web::Place place{"0.0.0.0", 0, {}, {}};
};

/// Prints a line of the relay's log, to stdout.
void say(const std::string& text);

/// The relay: gateways dial in, people come to the port of a robot, and the relay carries bytes
/// between them. The traffic is encrypted from end to end; the relay has no key of it. For one
/// thread.
class Relay {
 public:
  /// std::runtime_error that names the cause (no port, no certificate).
  Relay(const RelayOptions& options, std::vector<Robot> robots);
  ~Relay();

  /// Runs until `stop` is readable.
  void run(int stop);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::relay

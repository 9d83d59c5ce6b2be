#pragma once

#include <memory>
#include <string>

#include "saphira/relay/rendezvous.hpp"

namespace saphira::relay {

struct RelayOptions {
  std::string address = "0.0.0.0";  ///< to listen on
  int dial_port = 0;                ///< where gateways dial in
  std::string certificate;          ///< files, of the dial port; empty: this machine only
  std::string certificate_key;
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
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// Runs until `stop` is readable.
  void run(int stop);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::relay

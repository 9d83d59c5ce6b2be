#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "saphira/base/descriptor.hpp"

namespace saphira::console {

/// The simulator's own view (saphira/sim/view.hpp), by its local socket: its newest lines, and
/// lines to it. A missing or lost simulator is tried again.
class SimulatorLink {
 public:
  explicit SimulatorLink(std::string socket) : socket_(std::move(socket)) {}

  /// Takes the input. True where there is news.
  bool poll(double now);
  /// False without a simulator.
  bool say(const std::string& text);

  /// A line, with a number that grows with each change; 0: none yet.
  struct Told {
    std::string line;
    std::uint64_t number = 0;
  };
  const Told& world() const { return world_; }
  const Told& scene() const { return scene_; }
  /// The simulator's complaints since the last call, one JSON text each.
  std::vector<std::string> take_troubles();

 private:
  void connect();
  void disconnect();
  void take(std::string line);

  std::string socket_;
  Descriptor fd_;
  double tried_ = -1e9;  ///< [s]
  std::string heard_;
  Told world_;
  Told scene_;
  std::vector<std::string> troubles_;
};

}  // namespace saphira::console

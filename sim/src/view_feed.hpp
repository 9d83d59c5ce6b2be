#pragma once

#include <poll.h>

#include <functional>
#include <string>
#include <vector>

#include "listener.hpp"

namespace saphira::sim {

/// The view's local socket: lines to and from any number of viewers. Whoever does not read misses
/// pictures and holds up nobody.
class ViewFeed {
 public:
  explicit ViewFeed(const std::string& path) : listener_(Listener::local(path)) {}

  void add_to(std::vector<pollfd>& fds) const;
  bool watched() const { return !viewers_.empty(); }
  /// Takes on who has come, whom it tells `world`, and hands on what viewers say, line by line;
  /// what `obey` returns is told to who has said it. True where there was anything.
  bool serve(const std::string& world, const std::function<std::string(const std::string&)>& obey);
  /// To each viewer who has taken what came before; `must`: to the others too.
  void tell(const std::string& line, bool must);

 private:
  struct Viewer {
    Fd fd;
    std::string said;
    std::string waiting;
  };
  static bool send(Viewer& viewer);
  static bool receive(Viewer& viewer);

  Listener listener_;
  std::vector<Viewer> viewers_;
};

}  // namespace saphira::sim

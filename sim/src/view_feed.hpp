#pragma once

#include <poll.h>

#include <functional>
#include <string>
#include <vector>

#include "listener.hpp"

namespace saphira::sim {

/// The view's local socket: lines to and from any number of viewers. A viewer that does not read
/// misses pictures, and delays nobody.
class ViewFeed {
 public:
  explicit ViewFeed(const std::string& path) : listener_(Listener::local(path)) {}

  void add_to(std::vector<pollfd>& fds) const;
  bool watched() const { return !viewers_.empty(); }
  /// Takes new viewers and sends them the line of `world`; passes the viewers' lines to `obey`,
  /// whose result goes back to the sender. True where there was any input.
  bool serve(const std::function<std::string()>& world,
             const std::function<std::string(const std::string&)>& obey);
  /// Sends to each viewer that has read the earlier lines; `must`: to the others too.
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

#pragma once

#include <poll.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "listener.hpp"
#include "saphira/sim/stereo.hpp"

namespace saphira::sim {

/// The viewers at a local socket. What one of them has not read waits for it and delays nobody.
class Viewers {
 public:
  struct Viewer {
    Descriptor fd;
    std::string waiting;
    std::string said = {};
  };

  explicit Viewers(const std::string& path) : listener_(Listener::local(path)) {}

  void add_to(std::vector<pollfd>& fds) const;
  /// Takes new viewers, at most so many in all, and tells them this first. True: there were some.
  bool accept(const std::function<std::string()>& first, std::size_t most);
  /// Takes their bytes, and sends what waits after `heard` has had them; ends those that have gone,
  /// and those with more bytes than these on their way.
  void serve(const std::function<void(Viewer& viewer)>& heard, std::size_t most_said,
             std::size_t most_waiting);

  std::vector<Viewer> all;

 private:
  Listener listener_;
};

/// The pictures of a robot's cameras, one a cycle, on a local socket to any number of clients, or a
/// file each in a folder. A picture that nobody takes is not rendered.
class PictureFeed {
 public:
  /// A picture in its format. `head`: direction of the cameras in the robot [rad].
  using Render =
      std::function<std::string(const Scene&, RobotNumber, double head, std::uint64_t cycle)>;

  /// An empty folder: none. A missing folder is created. `in_step`: the pictures that wait for a
  /// viewer in single-step, also for one that has yet to come; 1 where no step depends on them.
  PictureFeed(Render render, std::string folder, const std::optional<std::string>& socket,
              std::size_t in_step);

  void add_to(std::vector<pollfd>& fds) const;
  /// Takes new viewers, sends queued pictures, and adds the picture of `cycle` where it is new. A
  /// viewer with a full queue does not get it.
  void serve(const Scene& scene, RobotNumber robot, double head, std::uint64_t cycle,
             bool single_step);

 private:
  void write(const std::string& picture, std::uint64_t cycle) const;

  Render render_;
  std::string folder_;
  std::optional<Viewers> viewers_;
  std::size_t in_step_;
  std::uint64_t cycle_ = 0;
  std::deque<std::string> before_;
};

/// The noise of a picture depends on the seed and the cycle alone.
PictureFeed::Render stereo_pairs(std::uint64_t seed);
PictureFeed::Render color_pictures();

/// The view's local socket: lines to and from any number of viewers. A viewer that does not read
/// misses pictures.
class ViewFeed {
 public:
  explicit ViewFeed(const std::string& path) : viewers_(path) {}

  void add_to(std::vector<pollfd>& fds) const { viewers_.add_to(fds); }
  bool watched() const { return !viewers_.all.empty(); }
  /// Takes new viewers and sends them the line of `world`; passes the viewers' lines to `obey`,
  /// whose result goes back to the sender. True where there was any input.
  bool serve(const std::function<std::string()>& world,
             const std::function<std::string(const std::string&)>& obey);
  /// Sends to each viewer that has read the earlier lines; `must`: to the others too.
  void tell(const std::string& line, bool must);

 private:
  Viewers viewers_;
};

}  // namespace saphira::sim

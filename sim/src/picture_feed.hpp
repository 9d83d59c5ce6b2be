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

/// The pictures of a robot's cameras, one a cycle, on a local socket to any number of clients, or a
/// file each in a folder. A picture that nobody takes is not rendered.
class PictureFeed {
 public:
  /// A picture in its format. `head`: direction of the cameras in the robot [rad].
  using Render =
      std::function<std::string(const Scene&, RobotNumber, double head, std::uint64_t cycle)>;

  /// An empty folder: none. A missing folder is created.
  PictureFeed(Render render, std::string folder, const std::optional<std::string>& socket);

  void add_to(std::vector<pollfd>& fds) const;
  /// Takes new viewers, sends queued pictures, and adds the picture of `cycle` where it is new. A
  /// viewer with a full queue does not get it. Where the queue may hold more than one, a late
  /// viewer gets the earlier pictures as well.
  void serve(const Scene& scene, RobotNumber robot, double head, std::uint64_t cycle,
             std::size_t waiting);

 private:
  struct Viewer {
    Fd fd;
    std::string waiting;
  };
  static bool send(Viewer& viewer);
  void write(const std::string& picture, std::uint64_t cycle) const;

  Render render_;
  std::string folder_;
  std::optional<Listener> listener_;
  std::uint64_t cycle_ = 0;
  std::vector<Viewer> viewers_;
  std::deque<std::string> before_;
};

/// The noise of a picture depends on the seed and the cycle alone.
PictureFeed::Render stereo_pairs(std::uint64_t seed);
PictureFeed::Render color_pictures();

}  // namespace saphira::sim

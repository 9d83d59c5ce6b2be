#pragma once

#include <poll.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "listener.hpp"
#include "saphira/sim/stereo.hpp"

namespace saphira::sim {

/// The pictures of a robot's stereo cameras, one pair a cycle: PGM after PGM on a local socket, to
/// any number of clients, or a file each in a folder. The noise of a picture depends on the seed
/// and the cycle alone, so that further viewers do not change the pictures.
class StereoFeed {
 public:
  /// An empty folder: none. A missing folder is created.
  StereoFeed(std::string folder, const std::optional<std::string>& socket, std::uint64_t seed);

  void add_to(std::vector<pollfd>& fds) const;
  /// `head`: direction of the cameras in the robot [rad]. Takes new viewers, sends queued pictures,
  /// and adds the picture of `cycle` where it is new. A viewer with a full queue does not get it.
  /// Where the queue may hold more than one, a late viewer gets the earlier pictures as well.
  void serve(const Scene& scene, RobotNumber robot, double head, std::uint64_t cycle,
             std::size_t waiting);

 private:
  struct Viewer {
    Fd fd;
    std::string waiting;
  };
  static bool send(Viewer& viewer);
  void write(const std::string& picture, std::uint64_t cycle) const;

  std::string folder_;
  std::optional<Listener> listener_;
  std::uint64_t seed_;
  std::uint64_t cycle_ = 0;
  StereoRig rig_;
  std::vector<Viewer> viewers_;
  std::deque<std::string> before_;
};

}  // namespace saphira::sim

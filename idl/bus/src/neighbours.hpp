#pragma once

// The status of this robot's other programs, as a service uses it. Pure.

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "peers.hpp"
#include "saphira/bus/endpoint.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus::internal {

/// Of several programs of one name for one robot (two deployments, or a restart before the death of
/// the last one was noticed) one serves: the one that serves already; of two that do, the one that
/// has served for longer than a moment; of two that have, the one with the smaller instance. Each
/// program comes to the same result by itself.
class Neighbours {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void update(const WriterId& writer, const v1::ServiceStatus& status, Time now);
  void lose(const WriterId& writer);

  /// The program that serves in place of `own`, in words.
  std::optional<std::string> serves_instead(const v1::ServiceStatus& own) const;
  /// True where a status of that program is known.
  bool knows(const Peers::Program& program) const;
  /// True where another program has been stepping without a break since that time, which shows that
  /// its robot is heard.
  bool stepping_since(Time since, Time now) const;

 private:
  struct Neighbour {
    v1::ServiceStatus status;
    Time changed;  ///< its stamp, last
    Time began;    ///< to change without a break
  };

  std::map<WriterId, Neighbour> all_;
};

}  // namespace saphira::bus::internal

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/recorder/recording.hpp"

namespace saphira::recorder {

/// Records the last minute: the samples that its writers keep (recall/...), all latched samples,
/// and those that come while it listens. It may begin after the event.
class LastMinute {
 public:
  explicit LastMinute(bus::Node& node);

  /// Takes the new samples; call for two seconds. `now_ns`: since 1970.
  void poll(std::int64_t now_ns);
  /// Writes the samples at the times of their cycles; those of recall/... have the topics that they
  /// repeat. False: nothing of the robot was there.
  bool write(bus::Node& node, Writer& writer);

 private:
  struct Source {
    std::unique_ptr<bus::Echo> echo;
    std::string topic;  ///< for the recording
    std::string type;
  };
  struct Heard {
    std::size_t source = 0;
    std::string json;
    std::pair<std::uint64_t, std::uint64_t> stamp;  ///< epoch and cycle [0: none]
  };
  void keep(std::size_t source, std::string json, std::int64_t now_ns);

  std::vector<Source> sources_;
  std::size_t goal_source_ = 0;
  bus::Reader<v1::GoalStatusSet> goals_;
  std::vector<Heard> heard_;
  std::pair<std::uint64_t, std::uint64_t> newest_;  ///< stamp of the robot
  std::int64_t newest_ns_ = 0;                      ///< when that came
};

}  // namespace saphira::recorder

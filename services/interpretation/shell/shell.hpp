#pragma once

#include <cstdint>
#include <optional>
#include <set>

#include "base/shell/processes.hpp"
#include "saphira/bus/cycle.hpp"
#include "saphira/bus/known_robot.hpp"
#include "saphira/interpretation/interpretation.hpp"

namespace saphira::interpretation {

/// The interpretation service on the bus. To be made and run in one thread.
class Shell {
 public:
  explicit Shell(bus::Node& node);

  /// Steps until stop is requested.
  void run(const bus::Stop& stop) {
    while (step(stop)) {
    }
  }
  /// Waits for one cycle and steps it; false when stop was requested.
  bool step(const bus::Stop& stop);

 private:
  void publish_grid(const Output& output);
  void dispose(const TileKey& key);

  bus::Node& node_;
  ProcessTable table_;
  Tasks tasks_{table_};
  bus::Cycle cycle_;
  bus::KnownRobot robot_;
  bus::Writer<v1::Perception> perceptions_;
  bus::Writer<v1::GridTile> tiles_;
  ProcessesOnBus processes_;
  std::optional<std::uint64_t> odom_;  ///< of the newest step
  std::optional<Interpretation> interpretation_;
  std::set<TileKey> changed_;    ///< since they were published
  std::set<TileKey> published_;  ///< and not disposed
};

}  // namespace saphira::interpretation

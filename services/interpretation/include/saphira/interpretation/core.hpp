#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "saphira/base/process.hpp"
#include "saphira/interpretation/interpretation.hpp"

namespace saphira::interpretation {

/// The interpretation service without the bus: one step a cycle, from the readings to features,
/// hypotheses and the tiles of the grid that have changed.
class Core {
 public:
  struct Inputs {
    std::uint64_t cycle = 0;
    /// The first step of an epoch: the poses of the robot's sonars.
    const std::vector<lps::SonarMount>* new_robot = nullptr;
    bool new_frame = false;  ///< the odom frame has another origin since the last step
    Pose pose_in_odom;
    std::vector<lps::SonarReading> readings;  ///< new ones, in firing order
  };
  struct Outputs {
    const Output* output = nullptr;  ///< good until the next step
    std::vector<TileKey> tiles;      ///< of grid(), to be published
    std::vector<TileKey> gone;       ///< published earlier, and gone now
  };

  /// The first step has to bring a robot.
  Outputs step(const Inputs& inputs);

  const Grid& grid() const { return interpretation_->grid(); }
  ProcessTable& processes() { return processes_; }

  template <class Archive>
  void archive(Archive& a) {
    std::optional<std::vector<lps::SonarMount>> sonars;
    if (interpretation_)
      sonars = interpretation_->settings().sonars;
    a("processes", processes_)("changed", changed_)("told", told_)("sonars", sonars);
    if (a.restores() && sonars)
      make(*sonars);
    if (interpretation_)
      a("interpretation", *interpretation_);
  }

 private:
  void make(const std::vector<lps::SonarMount>& sonars);
  void begin(const std::vector<lps::SonarMount>& sonars, std::vector<TileKey>& gone);
  void note_tiles(const Output& output, std::uint64_t cycle, Outputs& outputs);

  ProcessTable processes_;
  Tasks tasks_{processes_};
  std::optional<Interpretation> interpretation_;
  std::set<TileKey> changed_;  ///< since the last publication
  std::set<TileKey> told_;     ///< published, and not gone
};

}  // namespace saphira::interpretation

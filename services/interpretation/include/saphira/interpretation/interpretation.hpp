#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "saphira/base/archived.hpp"
#include "saphira/base/process.hpp"
#include "saphira/interpretation/grid.hpp"
#include "saphira/interpretation/side_view.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"

namespace saphira::interpretation {

struct Settings {
  std::vector<lps::SonarMount> sonars;
  SideSettings side;
  GridSettings grid;
  /// [rad] largest angle from straight sideways of a sonar that makes walls
  double side_sector = radians(31.0);
  double steady_turn = radians(4.0);  ///< a cycle; in faster turns bearings are doubtful
  double parallel = radians(6.0);     ///< between the two walls of a corridor
  double min_corridor = 1.0;          ///< [m] wide
  double max_corridor = 3.2;
  double min_overlap = 2.0;      ///< [m] of the two walls along each other
  double beside = 0.6;           ///< [m] a wall that ended this far back is still beside the robot
  double min_confidence = 0.88;  ///< of a published wall
  double max_heading = radians(1.2);          ///< sigma of a published wall
  double max_opening_heading = radians(2.5);  ///< and of the wall of an opening
  double encoder = 0.015;                     ///< [m] one sigma of dead reckoning after 1 m
  double least_offset = 0.006;                ///< [m] least sigma of a wall's position
  double least_heading = radians(0.4);        ///< least sigma of a heading
};

struct Inputs {
  std::uint64_t cycle = 0;
  Pose pose_in_odom;
  std::vector<lps::SonarReading> readings;  ///< new ones, in firing order
};

struct Output {
  /// All present percepts, from the readings within the aperture's length of travel.
  std::vector<lps::Percept> percepts;
  std::optional<lps::Percept> left_wall;   ///< sfLeftWallHyp: beside the robot now
  std::optional<lps::Percept> right_wall;  ///< sfRightWallHyp
  std::vector<TileKey> changed_tiles;      ///< of the grid, in this cycle
  std::vector<TileKey> dropped_tiles;      ///< left behind
};

/// The micro-tasks of interpretation, by the names of sfInitInterpretationProcs: each can be
/// suspended and resumed. The percepts of a suspended task are removed at once, except for the
/// grid, which stays as it was; readings of that time are not used.
class Tasks {
 public:
  explicit Tasks(ProcessTable& table);

 private:
  friend class Interpretation;
  Process* grid_;
  Process* sides_;
  Process* walls_;
  Process* breaks_;
  Process* corridors_;
};

/// From sonar readings to features and hypotheses (paper 3.2.1, manual 6.7): side segments by
/// extended aperture, walls, their ends and breaks, doors, junctions and corridors.
///
/// A pure function of its inputs' history. Call reset() when the odom frame changes.
class Interpretation {
 public:
  /// tasks: the parts that work; without them, all. They outlive the interpretation, and their
  /// table is stepped before each step.
  explicit Interpretation(Settings settings, const Tasks* tasks = nullptr);
  Interpretation& operator=(Interpretation&&) = delete;

  const Output& step(const Inputs& inputs);
  /// Forgets everything but the settings; ids are not used again.
  void reset();

  const Settings& settings() const { return settings_; }
  const Grid& grid() const { return grid_; }
  /// The views to the left and to the right.
  const SideView& left() const { return sides_[0]; }
  const SideView& right() const { return sides_[1]; }

  SAPHIRA_ARCHIVE(placed_, pose_in_odom_, cycle_, travelled_, turned_, grid_, sides_, others_,
                  standing_, last_id_, output_)

 private:
  using Lines = std::array<std::uint32_t, 2>;
  struct Standing {
    lps::Percept percept;
    bool seen = false;
    Lines lines{0, 0};       // the walls on which it was seen
    double travelled = 0.0;  // at its placement
  };
  bool works(Process* Tasks::*task) const;
  void take(const lps::SonarReading& reading, const Pose& robot_in_odom, bool steady);
  void mind_tasks();
  void interpret();
  void find_walls(std::size_t side);
  void find_corridors();
  void stand(lps::Percept percept, const Lines& lines);
  void hold(std::uint32_t line, bool openings_too);
  double across_sigma(const Wall& wall, double u) const;
  double carried(const Line& line, const std::vector<const Return*>& through,
                 const Stretch& stretch) const;
  lps::Percept wall_percept(const Wall& wall, const Stretch& stretch, lps::Side side) const;
  lps::Percept end_percept(const Wall& wall, const Stretch& stretch, bool upper,
                           lps::Side side) const;
  lps::Percept opening_percept(const Wall& wall, const Opening& opening, lps::Side side) const;
  void choose_beside();

  Settings settings_;
  const Tasks* tasks_;
  bool placed_ = false;
  Pose pose_in_odom_;
  std::uint64_t cycle_ = 0;
  double travelled_ = 0.0;
  double turned_ = 0.0;
  Grid grid_;
  std::array<SideView, 2> sides_;
  std::array<bool, 2> changed_{false, false};
  std::deque<Return> others_;
  std::vector<Standing> standing_;
  std::uint32_t last_id_ = 0;
  Output output_;
};

}  // namespace saphira::interpretation

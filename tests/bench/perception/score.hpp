#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/interpretation/interpretation.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::test {

/// How many of one kind were reported, and how many of these are there.
struct Count {
  int reported = 0;
  int real = 0;  ///< in every report
  double precision() const {
    return reported == 0 ? 1.0 : static_cast<double>(real) / static_cast<double>(reported);
  }
};

struct Mistake {
  lps::Percept percept;
  Pose pose_in_world;
  std::uint64_t cycle = 0;
};

/// A robot somewhere on its way.
struct Moment {
  std::uint64_t cycle = 0;
  Pose pose_in_odom;
  Pose true_pose_in_world;
  double velocity = 0.0;
};

/// A door that the robot went by.
struct Passage {
  std::uint32_t door = 0;   ///< its id in the map
  std::uint64_t cycle = 0;  ///< when it was judged
  bool found = false;
};

/// A percept as it was reported last.
struct Judged {
  lps::Percept percept;
  Pose pose_in_world;
  bool real = true;  ///< in every report
};

/// Holds percepts against the world and its map while a robot drives: a percept is real when every
/// report of it is. Doors count as passed where the robot goes by along their wall.
class Score {
 public:
  /// The surfaces about a place, as they are now.
  using Surfaces = std::function<sim::Things(const Vec2& about)>;
  /// True where all that there is at a place is known; what is reported elsewhere is not judged.
  using Covered = std::function<bool(const Vec2& at)>;

  Score(maps::Map map, Surfaces surfaces, Covered covered = {})
      : map_(std::move(map)), surfaces_(std::move(surfaces)), covered_(std::move(covered)) {}
  /// Something else says what is real, as a percept and where it is. No door is passed.
  using Judge = std::function<bool(const lps::Percept& percept, const Pose& in_world)>;
  explicit Score(Judge judge) : judge_(std::move(judge)) {}
  /// In a simulated world. The drive outlives the score.
  Score(Drive& drive, maps::Map map);

  void look(const Moment& moment, const std::vector<lps::Percept>& percepts);
  /// At what interpretation has just said.
  void look(const Drive& drive);

  Count walls() const { return count(lps::PointType::wall); }
  Count doors() const { return count(lps::PointType::door); }
  Count count(lps::PointType type) const;
  int doors_passed() const { return passed_; }
  int doors_found() const { return found_; }
  double recall() const { return passed_ == 0 ? 1.0 : static_cast<double>(found_) / passed_; }
  const std::vector<Mistake>& mistakes() const { return mistakes_; }
  const std::vector<Passage>& passages() const { return passages_; }
  /// By id.
  const std::map<std::uint32_t, Judged>& judged() const { return judged_; }

  /// Errors of what is real, and the same in sigmas.
  std::vector<double> wall_offset, wall_heading, wall_offset_sigmas, wall_heading_sigmas;
  std::vector<double> door_place, door_place_sigmas, door_width;
  std::vector<double> breach_place, breach_place_sigmas;

 private:
  struct Passing {
    bool under_way = false;
    bool found = false;
    double entered = 0.0;  // along the wall
    std::uint64_t until = 0;
    bool waits = false;  // for a report
  };
  Pose in_world(const lps::Percept& percept) const;
  bool is_real(const lps::Percept& percept, const Pose& in_world);
  bool is_surface(const sim::Things& things, const Pose& middle, const lps::Percept& wall) const;
  const maps::Feature* door_at(const Pose& in_world, double width) const;
  void pass(const Moment& moment, const std::vector<lps::Percept>& percepts);

  maps::Map map_;
  Surfaces surfaces_;
  Covered covered_;
  Judge judge_;
  std::map<std::uint64_t, Pose> odom_in_world_;  // by cycle
  std::map<std::uint32_t, Judged> judged_;
  std::map<std::size_t, Passing> passing_;
  int passed_ = 0;
  int found_ = 0;
  std::vector<Mistake> mistakes_;
  std::vector<Passage> passages_;
};

/// The ground truth for a grid, in the grid's frame.
struct GridTruth {
  enum class Cell { unknown, free, occupied };
  std::vector<Vec2> surfaces;           ///< points of those within 2 m of the way that it sees
  std::vector<maps::Feature> doorways;  ///< open ones, within 1.5 m of it
  std::function<Cell(const Vec2& at)> cell;
};
/// True for a point within 2 m of the path that is not `blocked` from its nearest point.
bool seen_from(const std::vector<Vec2>& path, const Vec2& at,
               const std::function<bool(const Vec2& from, const Vec2& to)>& blocked);
std::vector<maps::Feature> doorways_beside(const std::vector<Vec2>& path, const maps::Map& map);
GridTruth grid_truth(const sim::World& world, const maps::Map& map, const std::vector<Vec2>& path);

struct GridScore {
  double walls = 0.0;  ///< share of the surfaces along the way that are in it
  /// Share of the open doorways along the way that it takes for blocked; nothing without any.
  std::optional<double> doorways;
  double free = 0.0;  ///< share of the free cells that it takes for occupied
  double auc = 0.0;   ///< that an occupied cell is likelier than a free one
};
GridScore score_grid(const interpretation::Grid& grid, const GridTruth& truth);
/// MURIEL's and the cone model's after a patrol, from the same readings at the true pose: what is
/// compared is the model alone.
std::array<GridScore, 2> compare_grids(const DriveOptions& options, std::uint64_t cycles);

/// The points of a patrol of a world of config/worlds that goes through all its corridors.
std::vector<Vec2> patrol(const std::string& world);

maps::Map map_of(const std::string& world);

}  // namespace saphira::test

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::test {

/// The number of reports of one kind, and of the true ones among them.
struct Count {
  int reported = 0;
  int real = 0;  ///< true in every report
  double precision() const {
    return reported == 0 ? 1.0 : static_cast<double>(real) / static_cast<double>(reported);
  }
};

/// The judgement of a percept.
struct Judged {
  lps::PointType type = lps::PointType::invalid;
  bool real = true;  ///< true in every report
};

/// Compares percepts with the world and its map while a robot drives: a percept is real when every
/// report of it is. Doors count as passed where the robot goes by along their wall.
class Score {
 public:
  /// In a simulated world. The drive outlives the score.
  Score(Drive& drive, maps::Map map);

  /// Judges interpretation's newest output.
  void look(const Drive& drive);

  Count walls() const { return count(lps::PointType::wall); }
  Count doors() const { return count(lps::PointType::door); }
  Count count(lps::PointType type) const;
  int doors_passed() const { return passed_; }
  int doors_found() const { return found_; }

 private:
  struct Passing {
    bool under_way = false;
    bool found = false;
    double entered = 0.0;  // along the wall
    std::uint64_t until = 0;
    bool waits = false;  // for a report
  };
  Pose in_world(const lps::Percept& percept) const;
  bool is_real(const lps::Percept& percept, const Pose& in_world) const;
  bool is_surface(const sim::Things& things, const Pose& middle, const lps::Percept& wall) const;
  const maps::Feature* door_at(const Pose& in_world, double width) const;
  void pass(const Seen& seen, const std::vector<lps::Percept>& percepts);

  maps::Map map_;
  std::function<sim::Things(const Vec2& about)> surfaces_;  // the present ones, near a place
  std::map<std::uint64_t, Pose> odom_in_world_;             // by cycle
  std::map<std::uint32_t, Judged> judged_;
  std::map<std::size_t, Passing> passing_;
  int passed_ = 0;
  int found_ = 0;
};

/// The points of a patrol of a world of config/worlds that goes through all its corridors.
std::vector<Vec2> patrol(const std::string& world);

maps::Map map_of(const std::string& world);

}  // namespace saphira::test

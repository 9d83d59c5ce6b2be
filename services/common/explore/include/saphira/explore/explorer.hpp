#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/explore/free_floor.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::explore {

struct Settings {
  std::vector<lps::SonarMount> sonars;
  double speed = 0.3;           ///< [m/s] slow enough to find doors
  double look_ahead = 1.5;      ///< [m] distance of the target point before the robot
  double beyond = 6.5;          ///< [m] without a wall beyond the mapped end: an open area
  double beyond_opening = 6.0;  ///< [m] the same behind an opening
  double entering = 1.5;        ///< [m] length of the turn into an opening
  double gap_in_walls = 1.2;    ///< [m] longest gap in the walls of a corridor
  double wide_door = 1.1;       ///< [m] a door of this width may be a corridor...
  double in_door = 2.0;         ///< [m] ...if there are walls on both sides this far inside
  double aside = 0.8;           ///< [m] off the middle: an obstacle ahead has turned the robot away
  double tried = 1.2;           ///< [m] an end nearer than this to a tried one is the same
  double by_a_box = 0.45;       ///< [m] off the middle, to pass a box in the way
  double front = 0.95;          ///< [m] a nearer echo ahead may be the end
  double open_side = 2.2;       ///< [m] a sonar without a nearer echo looks into another way
  double wider_than_a_door = 0.6;  ///< [m] of way without such an echo: wider than a door
  int reopen = 2;                  ///< times that closed ways are tried again before the end
  double min_progress = 0.15;      ///< [m] less progress...
  std::uint64_t patience = 80;     ///< [cycles] ...in this time counts as blocked
  int least_corridors = 1;         ///< with fewer on the map, try straight on
  /// [m] At the end, go back this far along the first way, which closes the last loop. 0: stay.
  double home = 5.0;
};

struct Inputs {
  std::uint64_t cycle = 0;
  Pose pose_in_map;
  const maps::Map& map;          ///< as built so far
  const std::vector<Vec2>& way;  ///< [map] the robot's way so far, in order, up to now
  const std::vector<lps::SonarReading>& readings;
};

/// The robot's next target.
struct Output {
  bool done = false;
  std::optional<Vec2> point_in_map;  ///< drive there; none: stand
  std::optional<Vec2> look_at;       ///< turn towards this point of the map on the spot
  double speed = 0.0;
  std::string reason;  ///< purpose, in words

  template <class Archive>
  void archive(Archive& a) {
    a("done", done)("point_in_map", point_in_map)("look_at", look_at)("speed", speed)("reason",
                                                                                      reason);
  }
};

/// Explores a floor corridor by corridor: drives to the end of the map built so far, and on, until
/// there is a wall or an open area. Looks to the sides there, and into every opening that is wider
/// than a door. Between leads it drives on its earlier ways. Unreachable leads are given up. Pure:
/// the map, the pose and the way come from registration::MapBuilder.
class Explorer {
 public:
  explicit Explorer(Settings settings = {});

  const Output& step(const Inputs& inputs);
  const Output& output() const { return output_; }
  /// Ways that were found and could not be followed, and are not on the map, and the way back to
  /// the start if the robot did not come there: each with the reason.
  std::vector<std::string> left(const maps::Map& map) const;
  /// True where hardly a corridor was found: then the free floor is explored as well.
  bool in_room() const { return in_room_; }
  Vec2 start() const { return start_in_map_.position(); }
  const FreeFloor& floor() const { return floor_; }

  template <class Archive>
  void archive(Archive& a) {
    a("settings", settings_)("floor", floor_)("output", output_)("doing", doing_)(
        "start_in_map", start_in_map_)("lead", lead_)("probe_from", probe_from_)("tried", tried_)(
        "left", left_)("seen_open", seen_open_)("gaps", gaps_)("shut", shut_)("path", path_)(
        "heard", heard_)("listened_at", listened_at_)("open_way", open_way_)("looks", looks_)(
        "turned", turned_)("aligned", aligned_)("look_cycle", look_cycle_)(
        "steady_cycle", steady_cycle_)("look_from", look_from_)("squeeze", squeeze_)(
        "aside", aside_)("may_squeeze", may_squeeze_)("open_aside", open_aside_)("probed", probed_)(
        "ended", ended_)("progress", progress_)("progress_cycle", progress_cycle_)(
        "reopened", reopened_)("stuck", stuck_)("begun", begun_)("home", home_)(
        "turning", turning_)("open", open_)("in_room", in_room_)("roamed", roamed_)("edge", edge_)(
        "tried_edges", tried_edges_)("roamed_way", roamed_way_)("roamed_at", roamed_at_)(
        "planned", planned_)("in_corridor", in_corridor_);
  }

 private:
  /// A way out of the mapped area: from a point, straight on.
  struct Lead {
    Vec2 point{0.0, 0.0};
    double heading = 0.0;
    std::string what;
    bool home = false;
    bool opening = false;  ///< in a wall: a new area begins behind it
    bool door = false;     ///< probably only a room is behind it
    bool aside = false;    ///< heard along a corridor, so its middle is unknown
  };
  enum class Doing { choosing, going, probing, looking, roaming };

  void listen(const Inputs& inputs);
  std::vector<Lead> leads(const Inputs& inputs) const;
  std::vector<Lead> wide_doors(const Inputs& inputs) const;
  bool is_tried(const Lead& lead) const;
  bool mapped_along(const maps::Map& map, const Vec2& point, double heading) const;
  void choose(const Inputs& inputs);
  void go(const Inputs& inputs);
  void probe(const Inputs& inputs);
  void begin_looking(const Inputs& inputs);
  void look(const Inputs& inputs);
  void listen_aside(const Inputs& inputs);
  bool mostly_room(const maps::Map& map) const;
  void roam(const Inputs& inputs);
  bool follow_bend(double done, double turned, const Inputs& inputs);
  void note_progress(const Inputs& inputs);
  bool looked(double heading, const Inputs& inputs);
  void hear_aside(double range, double heading, bool narrow, const Inputs& inputs);
  double room(double side) const;
  /// [m] The median of the recent echoes in that direction; none: no sonar looks there.
  std::optional<double> heard(double bearing) const;
  /// True where both sides had recent echoes of a wall.
  bool walled() const;
  /// True where the obstacle ahead leaves room to the left or right, by the sonars.
  bool passable() const;
  void finish(const Inputs& inputs);  ///< ends the present lead
  void leave(const Lead& lead, const std::string& why);
  void head_for(const Vec2& point, const Inputs& inputs);
  std::vector<std::size_t> path(const std::vector<Vec2>& way, const Vec2& to, double& length) const;

  Settings settings_;
  FreeFloor floor_;
  Output output_;
  Doing doing_ = Doing::choosing;
  Pose start_in_map_;
  std::optional<Lead> lead_;
  Vec2 probe_from_{0.0, 0.0};
  std::vector<Lead> tried_;
  std::vector<Lead> left_;
  std::vector<Lead> seen_open_;  ///< openings that were heard, not yet mapped
  std::vector<Lead> gaps_;       ///< where a side was silent for as long as a wide door
  std::vector<Vec2> shut_;       ///< places where the robot was stopped on a way it had driven
  std::vector<Vec2> path_;       ///< to the lead's point
  struct Heard {
    int sonar = 0;
    double range = 0.0;
    std::uint64_t cycle = 0;
    double heading = 0.0;  ///< [rad, map] of the robot
  };
  std::vector<Heard> heard_;
  Vec2 listened_at_{0.0, 0.0};
  std::array<double, 2> open_way_{};  ///< [m] since the left and the right were closed
  std::vector<double> looks_;         ///< [rad, map] headings still to look at
  bool turned_ = false;               ///< it was aslant when it began to look: the width is unknown
  bool aligned_ = true;               ///< it has looked along the way before
  std::uint64_t look_cycle_ = 0;      ///< start of this look...
  std::uint64_t steady_cycle_ = 0;    ///< ...and start of the right heading
  Vec2 look_from_{0.0, 0.0};
  /// After the looks to the sides: the way along the lead at which it began to pass the obstacle.
  std::optional<double> squeeze_;
  double aside_ = 0.0;        ///< [m] to the left of the middle, to pass an obstacle
  bool may_squeeze_ = false;  ///< the obstacle ahead may be a box
  bool open_aside_ = false;   ///< there is a way to a side
  double probed_ = 0.0;       ///< [m] along the lead
  Vec2 ended_{0.0, 0.0};      ///< end of the lead at an obstacle
  double progress_ = 0.0;
  std::uint64_t progress_cycle_ = 0;
  int reopened_ = 0;
  int stuck_ = 0;  ///< times that it was stopped on the way to this lead
  bool begun_ = false;
  bool home_ = false;     ///< on the way home, or there
  bool turning_ = false;  ///< towards the target, on the spot
  bool open_ = false;     ///< it ended in an open area, with no wall ahead
  // In a room, without corridors.
  bool in_room_ = false;
  bool roamed_ = false;            ///< no edge of the seen floor is left
  std::optional<Vec2> edge_;       ///< of the seen floor, where it drives to
  std::vector<Vec2> tried_edges_;  ///< reached, or out of reach
  double roamed_way_ = 0.0;        ///< [m]
  Vec2 roamed_at_{0.0, 0.0};
  std::uint64_t planned_ = 0;  ///< [cycle] of the way there
  bool in_corridor_ = false;   ///< the lead has become a corridor
};

}  // namespace saphira::explore

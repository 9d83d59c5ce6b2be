#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::explore {

struct Settings {
  std::vector<lps::SonarMount> sonars;
  double speed = 0.3;           ///< [m/s] doors are found at this pace
  double look_ahead = 1.5;      ///< [m] how far before the robot the point to drive to is kept
  double beyond = 6.5;          ///< [m] so far out of what is mapped nothing came: an open area
  double beyond_opening = 6.0;  ///< [m] the same behind an opening
  double entering = 1.5;        ///< [m] of way on which it turns into an opening
  double gap_in_walls = 1.2;    ///< [m] with no wall at a side that a corridor may have
  double wide_door = 1.1;       ///< [m] one that is as wide may be a corridor...
  double in_door = 2.0;         ///< [m] ...and so far inside it has walls on both sides then
  double aside = 0.8;           ///< [m] off the middle: what is ahead has turned the robot away
  double tried = 1.2;           ///< [m] nearer than this to where it was tried, an end is the same
  double by_a_box = 0.45;       ///< [m] off the middle, to get by one that stands in the way
  double front = 0.95;          ///< [m] what is nearer ahead may be the end
  double open_side = 2.2;       ///< [m] a sonar that hears nothing nearer looks into another way
  double wider_than_a_door = 0.6;  ///< [m] of way along which the sonar hears nothing there
  int reopen = 2;  ///< times that ways which were closed are tried again before all is given up
  double min_progress = 0.15;   ///< [m] less...
  std::uint64_t patience = 80;  ///< [cycles] ...in this time is being blocked
  int least_corridors = 1;      ///< where fewer are mapped, straight on is worth a try
  /// [m] When nothing is left, back to so far along the way that it went first: that closes the
  /// last loop. 0: stays where it is.
  double home = 5.0;
};

struct Inputs {
  std::uint64_t cycle = 0;
  Pose pose_in_map;
  const maps::Map& map;          ///< as built so far
  const std::vector<Vec2>& way;  ///< [map] where the robot has been, in order, ends with now
  const std::vector<lps::SonarReading>& readings;
};

/// Where the robot should drive now.
struct Output {
  bool done = false;
  std::optional<Vec2> point_in_map;  ///< drive there; none: stand
  std::optional<Vec2> look_at;       ///< turn towards this point of the map on the spot
  double speed = 0.0;
  std::string reason;  ///< what for, in words
};

/// Explores a floor corridor by corridor: drives to where the map as built so far ends, and on,
/// until a wall or an open area is there; looks to the sides there, and into every opening that is
/// wider than a door. The ways between are those that it has driven. What cannot be reached is
/// given up. Pure: the map, the pose and the way are another's (registration::MapBuilder).
class Explorer {
 public:
  explicit Explorer(Settings settings);

  const Output& step(const Inputs& inputs);
  const Output& output() const { return output_; }
  /// Ways that were found and could not be followed, and are not on the map: each with why.
  std::vector<std::string> left(const maps::Map& map) const;

 private:
  /// A way out of what is mapped: from a point, straight on.
  struct Lead {
    Vec2 point{0.0, 0.0};
    double heading = 0.0;
    std::string what;
    bool home = false;
    bool opening = false;  ///< in a wall: what is behind it begins there
    bool door = false;     ///< likely only a room is behind it
    bool aside = false;    ///< heard from the side, at the end of a way
  };
  enum class Doing { choosing, going, probing, looking };

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
  bool looked(double heading, const Inputs& inputs);
  void hear_aside(double range, double heading, bool narrow, const Inputs& inputs);
  double room(double side) const;
  /// [m] The middle one of what the sonars that look that way have heard of late; none: nothing
  /// looks there.
  std::optional<double> heard(double bearing) const;
  /// To both sides a wall has been heard of late.
  bool walled() const;
  /// True where the obstacle ahead leaves room to the left or right, as far as can be heard.
  bool passable() const;
  void finish(const Inputs& inputs);  ///< with the lead
  void leave(const Lead& lead, const std::string& why);
  void head_for(const Vec2& point, const Inputs& inputs);
  std::vector<std::size_t> path(const std::vector<Vec2>& way, const Vec2& to, double& length) const;

  Settings settings_;
  Output output_;
  Doing doing_ = Doing::choosing;
  Pose start_in_map_;
  std::optional<Lead> lead_;
  Vec2 probe_from_{0.0, 0.0};
  std::vector<Lead> tried_;
  std::vector<Lead> left_;
  std::vector<Lead> seen_open_;  ///< ways that were heard, not yet mapped
  std::vector<Vec2> shut_;       ///< where the robot came no farther on a way it had driven
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
  std::vector<double> looks_;         ///< [rad, map] headings that are still to be looked at
  bool turned_ = false;           ///< it stood aslant when it began to look: how wide is not known
  bool aligned_ = true;           ///< it has looked along the way before
  std::uint64_t look_cycle_ = 0;  ///< when this one was begun...
  std::uint64_t steady_cycle_ = 0;  ///< ...and since when the robot looks that way
  Vec2 look_from_{0.0, 0.0};
  /// The sides have been looked at; now it tries to get by what is ahead, begun so far along.
  std::optional<double> squeeze_;
  double aside_ = 0.0;        ///< [m] to the left of the middle, to get by
  bool may_squeeze_ = false;  ///< what is ahead may be a box
  bool open_aside_ = false;   ///< there is a way to a side
  double probed_ = 0.0;       ///< [m] along the lead
  Vec2 ended_{0.0, 0.0};      ///< where the lead ended at what is ahead
  double progress_ = 0.0;
  std::uint64_t progress_cycle_ = 0;
  int reopened_ = 0;
  int stuck_ = 0;  ///< times that it came no farther on the way to this lead
  bool begun_ = false;
  bool home_ = false;         ///< on the way home, or there
  bool turning_ = false;      ///< towards where it goes, on the spot
  bool open_ = false;         ///< it ended in the open, with no wall ahead
  bool in_corridor_ = false;  ///< what was probed last has become one
};

}  // namespace saphira::explore

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/feature_graph.hpp"

namespace saphira::registration {

struct MapBuilderSettings {
  std::vector<lps::SonarMount> sonars;    ///< those that look ahead find the ends of corridors
  bool snap_to_right_angle_grid = true;   ///< manual 6.9.2
  double grid_tolerance = radians(12.0);  ///< [rad] a wall with a larger deviation follows no grid

  double least_confidence = 0.5;  ///< of percepts; those below are ignored
  double node_way = 0.5;          ///< [m] between nodes of the way
  double node_turn = radians(20.0);
  double again_way = 2.0;  ///< [m] of way after which a wall that is still seen counts again

  // Limits for two sightings of the same object.
  double same_heading = radians(6.0);  ///< and three sigmas of the pose, up to...
  double most_heading = radians(25.0);
  double same_wall = 0.15;     ///< [m] across; likewise
  double same_opening = 0.45;  ///< [m] likewise
  double most_stray = 1.2;     ///< [m]
  double wall_gap = 5.5;       ///< [m] between stretches of one wall
  double closure_way = 15.0;   ///< [m] of way after which another sighting closes a loop

  // Limits for a corridor.
  double min_width = 1.0;
  double max_width = 3.6;
  double min_both = 1.2;    ///< [m] with a wall on either side
  double min_ratio = 2.2;   ///< [1] of length and width; a smaller one is a room
  double min_length = 3.0;  ///< [m]
  double max_gap = 0.3;     ///< [m] in both walls; more where the robot drove through
  double one_gap = 1.4;     ///< [m] between them and a wall that continues on one side
  double max_driven_gap = 7.0;
  double one_sided = 2.5;  ///< [m] by which one wall alone may extend a corridor
  double reach = 1.5;      ///< [m] an end this near to another corridor is a junction
  double min_wall = 1.5;   ///< [m] of walls that do not belong to a corridor

  FeatureGraphSettings graph;
};

struct MapBuilderInputs {
  std::uint64_t cycle = 0;
  std::uint64_t odom = 0;  ///< number of the odometry frame
  Pose pose_in_odom;
  const std::vector<lps::Percept>& percepts;
  const std::vector<lps::SonarReading>& readings;
  /// The robot's pose from registration on a known map; then new artifacts are placed from it.
  /// Nothing: the builder finds the pose together with the map.
  std::optional<Pose> pose_in_map;
};

/// The later checks of a door or object that was seen once.
struct Passes {
  int seen = 0;
  int missed = 0;  ///< in a row, since it was last seen
};

/// Builds maps by driving (manual 6.9.2): percepts without a match become artifacts. Stretches of
/// wall are joined to lines, opposite lines to corridors, corridors meet in junctions, openings
/// become doors and breaks; so does a gap beside the end of a corridor that the robot drove
/// through. The way and the features are one least-squares problem, so that seeing the first
/// corridor again corrects the whole map.
///
/// Walls and corridors stay until removed. A door that was open and is seen closed stays, and
/// counts as closed. A pure function of its inputs' history.
class MapBuilder {
 public:
  /// Begins with a known map (or none) and, without a given pose, at `start`.
  explicit MapBuilder(MapBuilderSettings settings = {}, maps::Map known = {},
                      Pose start_in_map = {});

  /// True when the map has changed.
  bool step(const MapBuilderInputs& inputs);

  /// Puts all walls on right angles from now on, or leaves them as they are seen.
  void snap(bool on);

  const maps::Map& map() const { return editor_.map(); }
  /// The known map was edited before: its earlier ids are not used again.
  void take_ids(const maps::Editor& known) { editor_ = known; }
  /// Another source adds an object to the map, as maps::Editor does; returns its id.
  std::uint32_t put(const maps::Feature& thing) { return editor_.put(thing); }
  /// Removes an artifact. The builder forgets its own artifact, so that it must be seen anew.
  /// False: no such artifact.
  bool remove(std::uint32_t id);
  /// The robot's pose on the map.
  const Pose& pose_in_map() const { return pose_in_map_; }
  /// Of x, y, th in the map, at the newest node of the way.
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  /// Doors of the map that were not open the last two times that the robot passed.
  std::vector<std::uint32_t> closed() const;
  /// The number of sightings again after a long way.
  int closures() const { return closures_; }
  const FeatureGraph& graph() const { return graph_; }

  template <class Archive>
  void archive(Archive& a) {
    a("sonars", settings_.sonars)("snap", settings_.snap_to_right_angle_grid)("given", given_)(
        "graph", graph_)("known_lines", known_lines_)("known_points", known_points_)(
        "taken", taken_)("ahead", ahead_)("driven_through", driven_through_)("editor", editor_)(
        "own", own_)("door_of", door_of_)("wall_of", wall_of_)("start_in_map", start_in_map_)(
        "placed", placed_)("believed", believed_)("odom", odom_)("pose_in_odom", pose_in_odom_)(
        "pose_in_map", pose_in_map_)("covariance", covariance_)("way", way_)(
        "settled_way", settled_way_)("news", news_)("closures", closures_);
  }

 private:
  /// Data of a line or an opening besides its place.
  struct Known {
    lps::PointType type = lps::PointType::wall;  ///< wall, door or junction
    double heading = 0.0;   ///< of an opening: its normal, in the map, at the first sighting
    double last_way = 0.0;  ///< [m] driven at the newest sighting
    Passes passes = {};
    bool beside = false;       ///< the robot is passing it
    bool found = false;        ///< ...and has seen it
    bool only_driven = false;  ///< a doorway that no percept shows: passing it by says nothing
  };
  /// A present percept, and its match.
  struct Taken {
    bool is_line = true;
    std::size_t index = 0;
    std::size_t seen = 0;     ///< the newest entry of its `seen`
    double way = 0.0;         ///< [m] driven at that entry
    std::uint64_t cycle = 0;  ///< its newest cycle
  };

  void drive(const MapBuilderInputs& inputs);
  bool take(const lps::Percept& percept, std::uint64_t cycle);
  bool take_line(const lps::Percept& percept, std::uint64_t cycle);
  bool take_opening(const lps::Percept& percept, std::uint64_t cycle);
  std::size_t node_near(const Pose& in_odom) const;
  SeenLine seen_line(const lps::Percept& percept) const;
  SeenPoint seen_point(const lps::Percept& percept) const;
  /// Three sigmas of the pose, along a direction of the map [m]...
  double stray(const Vec2& direction) const;
  /// ...and of its heading [rad].
  double stray_heading() const;
  std::optional<std::size_t> match_line(const SeenLine& seen) const;
  /// The matched opening, and the ambiguity of the match.
  struct Match {
    std::optional<std::size_t> index;
    bool is_ambiguous = false;
  };
  Match match_opening(const SeenPoint& seen, lps::PointType type) const;
  void hear_walls(const MapBuilderInputs& inputs);
  void listen_ahead(const MapBuilderInputs& inputs);
  void pass();
  void settle();
  void merge_lines();
  std::vector<std::pair<double, double>> stretches(const GraphLine& line) const;

  std::vector<std::pair<double, double>> side_of(const maps::Feature& hall, double side) const;
  struct Doorway {
    double middle = 0.0;  ///< [m] along the corridor
    double width = 0.0;
  };
  std::optional<Doorway> doorway(const maps::Feature& hall, double side, double x) const;
  void note_doorways(const std::vector<maps::Feature>& halls);
  bool publish();

  MapBuilderSettings settings_;
  maps::Map given_;
  FeatureGraph graph_;
  std::vector<Known> known_lines_;
  std::vector<Known> known_points_;
  std::map<std::uint32_t, Taken> taken_;  ///< by the percept's id
  std::vector<SeenPoint> ahead_;          ///< echoes from straight ahead
  std::set<std::size_t> driven_through_;  ///< nodes of the way just behind a doorway
  maps::Editor editor_;
  std::vector<std::uint32_t> own_;                ///< ids of the builder's features
  std::map<std::uint32_t, std::size_t> door_of_;  ///< feature to opening
  std::map<std::uint32_t, std::size_t> wall_of_;  ///< feature to line
  Pose start_in_map_;
  bool placed_ = false;
  bool believed_ = false;
  std::uint64_t odom_ = 0;
  Pose pose_in_odom_;
  Pose pose_in_map_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  ///< of the newest node's pose
  double way_ = 0.0;
  double settled_way_ = 0.0;
  bool news_ = false;
  int closures_ = 0;
};

}  // namespace saphira::registration

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/idl/map.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/matching.hpp"
#include "saphira/registration/object_finder.hpp"
#include "saphira/registration/particle_cloud.hpp"
#include "saphira/registration/pose_filter.hpp"
#include "saphira/registration/presence.hpp"
#include "saphira/registration/range_model.hpp"
#include "saphira/registration/search.hpp"

namespace saphira {
class Archive;
}

namespace saphira::registration {

/// One sigma of a pose.
struct Sigmas {
  double position = 0.2;          ///< [m] each way
  double heading = radians(5.0);  ///< [rad]
};

struct Settings {
  std::vector<lps::SonarMount> sonars;  ///< readings of others are ignored
  RangeModelSettings range;

  ReckoningErrors reckoning;
  double drift_error = radians(0.5);  ///< [rad/m] one sigma of the constant part, which is learnt

  MatchSettings match;
  double again = 0.4;                   ///< [m] the same wall is matched again after this way...
  double again_turned = radians(10.0);  ///< [rad] ...or turn
  double least_confidence = 0.5;        ///< of percepts; those below are ignored
  std::uint64_t fresh = 15;             ///< [cycles] older percepts are ignored
  /// [rad] Percepts are also ignored after a turn of more than this: dead reckoning errs most in
  /// turns, so that their place is wrong.
  double most_turned = radians(40.0);

  // Single readings of a wall that faces the sonar: small corrections between percepts.
  double wall_sigma = 0.15;  ///< [m] so large since they are not independent
  double wall_range = 2.5;   ///< [m] the farthest that count

  // Scores of raw readings at the present pose, see SearchSettings.
  double sure = 15.0;        ///< from this on they fit; a tracking robot has 20 to 50
  double lost = -6.0;        ///< below this the pose does not hold...
  double again_sure = 20.0;  ///< ...until it has fitted this well again
  // Evidence against the present pose: a robot that was carried must doubt before the good readings
  // of its old place have faded.
  double doubts = 3.0;    ///< up to this one the pose holds...
  double refuted = 10.0;  ///< ...and from this one on it does not, until it is below `doubts` again
  double furniture =
      3.0;  ///< the limit of that of walls in a room which does not lower the confidence
  SearchSettings search;

  // Other possible poses near by: a cloud beside the filter, which takes over where it is better.
  CloudSettings cloud;
  /// [m] The way of the cloud's lead before the filter is tried again; doubled at each failure.
  double trial = 30.0;
  double lead = 8.0;                    ///< in scores of raw readings: the lead of cloud or filter
  double lead_memory = 3.0;             ///< [m] of way in which the lead fades to a third
  double lead_apart = 0.2;              ///< [m] largest distance of the same place...
  double lead_turned = radians(8.0);    ///< [rad] ...and turn
  double dense = 0.5;                   ///< [m] one sigma of a cloud with a definite place...
  double dense_turned = radians(12.0);  ///< [rad] ...and of its heading

  // Missing and new artifacts, from a certain pose.
  double sure_position = 0.2;  ///< [m] one sigma of it
  PresenceSettings presence;
  ObjectFinderSettings objects;
};

std::string_view word(v1::RegistrationState state);

struct Inputs {
  std::uint64_t cycle = 0;
  std::uint64_t odom =
      0;  ///< number of the odometry frame; after a change the robot may be elsewhere
  Pose pose_in_odom;
  const std::vector<lps::Percept>& percepts;
  const std::vector<lps::SonarReading>& readings;  ///< new ones, in firing order
  /// True: search for objects that are not on the map (add_new_features, manual 6.9.2).
  bool find_objects = false;
};

struct Output {
  v1::RegistrationState state = v1::REGISTRATION_UNPLACED;
  std::string reason;  ///< of the state, in words
  Pose pose_in_map;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, th
  double confidence = 0.0;  ///< [0..1] that the pose is right within its covariance
  std::vector<Match> matches;
  /// The feature of the map around the robot: junction before corridor before lane before office.
  /// current_environment of manual 8.1.2.
  std::optional<std::size_t> environment;
  /// Artifacts of the map that are gone, closed or open again, and new ones, for the map's owner.
  Presence::Changes presence;
  std::vector<maps::Feature> objects;

  bool operator==(const Output&) const = default;
};

/// State for a restart.
struct Memory {
  std::uint64_t odom = 0;
  Pose pose_in_odom;
  std::optional<PoseFilter> filter;  ///< none: its place is unknown
  double confidence = 0.0;
  bool carried = false;  ///< as it seemed, and nothing has confirmed the pose since
};

struct RegistrationState;

/// The robot's pose in the map: test_match_proc and test_environment_proc of manual 6.9.2, and
/// anchoring of paper 3.2.
///
/// An extended Kalman filter of the pose and of dead reckoning's constant drift, corrected by
/// percepts that match artifacts: hypotheses first, then features whose readings no accepted
/// hypothesis has. An ambiguous percept is ignored. Raw readings confirm or refute the pose; where
/// it does not hold, or is unknown, a search over the whole map finds it.
/// The same inputs give the same outputs to the last bit.
class Registration {
 public:
  Registration(Settings settings, maps::Map map, std::optional<Pose> pose_in_map = std::nullopt);
  ~Registration();
  Registration(Registration&&) noexcept;
  Registration& operator=(Registration&&) noexcept;

  const Output& step(const Inputs& inputs);
  const Output& output() const;

  /// Another map, or a changed one. The state stays.
  void set_map(maps::Map map);
  const maps::Map& map() const;
  /// The present map is of another origin than the one before, so the pose on it is a guess;
  /// outside of the map it is forgotten.
  void doubt_the_map();
  /// Sets the robot's pose from outside.
  void set_pose(const Pose& pose_in_map, const Sigmas& sigmas = {});
  /// Forgets the robot's pose, and searches for it.
  void forget_pose();
  void switch_on(bool on);
  /// Doors by id that were closed when the robot last looked at them.
  const std::set<std::uint32_t>& closed_doors() const;
  void recall_closed(std::set<std::uint32_t> doors);

  /// The learnt state, see state.hpp.
  const RegistrationState& state() const;
  /// The part that the service saves over a restart.
  Memory save() const;
  /// Continues from there in the same odometry frame. In another one the pose is a guess, beside
  /// `start`: lost until the readings fit only one of them.
  void restore(const Memory& memory, const std::optional<Pose>& start = std::nullopt);
  /// Its map and learnt state.
  void archive(Archive& a);

 private:
  class Self;
  std::unique_ptr<Self> self_;
};

}  // namespace saphira::registration

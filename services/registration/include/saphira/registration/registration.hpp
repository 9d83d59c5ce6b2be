#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/registration/matching.hpp"
#include "saphira/registration/object_finder.hpp"
#include "saphira/registration/particle_cloud.hpp"
#include "saphira/registration/presence.hpp"
#include "saphira/registration/range_model.hpp"
#include "saphira/registration/search.hpp"

namespace saphira::registration {

/// One sigma of a pose.
struct Sigmas {
  double position = 0.2;          ///< [m] each way
  double heading = radians(5.0);  ///< [rad]
};

struct Settings {
  std::vector<lps::SonarMount> sonars;  ///< readings of others are left out
  RangeModelSettings range;

  ReckoningErrors reckoning;
  double drift_error = radians(0.5);  ///< [rad/m] one sigma of the constant part, which is learnt

  MatchSettings match;
  double again = 0.4;                   ///< [m] the same wall is matched again after this way...
  double again_turned = radians(10.0);  ///< [rad] ...or turn
  double least_confidence = 0.5;        ///< percepts that are less sure are left alone
  std::uint64_t fresh = 15;             ///< [cycles] percepts seen longer ago are left alone
  /// [rad] and those since whose readings the robot has turned by more: dead reckoning errs most in
  /// turns, so that they are not where they seem.
  double most_turned = radians(40.0);

  // Single readings of a wall that faces the sonar: little by little, between percepts.
  double wall_sigma = 0.15;  ///< [m] so much since they are not independent
  double wall_range = 2.5;   ///< [m] the farthest that count

  // Scores of raw readings at the believed pose, see SearchSettings.
  double sure = 15.0;        ///< from which on they fit; a robot that tracks has 20 to 50
  double lost = -6.0;        ///< below which the pose does not hold...
  double again_sure = 20.0;  ///< ...until it has fitted as well as this again
  // The same of the last two metres alone: a robot that was carried off doubts before what fitted
  // where it was has faded. On made floors (tests/bench/floors) one that tracks has 8 or more in 99
  // % of the cycles; of those that were carried, half have less than 4 after three metres.
  double recently_sure = 7.0;
  double recently_lost = -5.0;
  double recently_again = 2.0;  ///< from which on it may hold again
  SearchSettings search;

  // Where else near by it could be: a cloud beside the filter, which takes over where it is better.
  CloudSettings cloud;
  /// [m] of way that it leads before the filter is tried again; doubled each time that it fails.
  double trial = 30.0;
  double lead = 8.0;                    ///< in scores of raw readings, by which either is better
  double lead_memory = 3.0;             ///< [m] of way in which that fades to a third
  double lead_apart = 0.2;              ///< [m] they are at the same place if not farther apart...
  double lead_turned = radians(8.0);    ///< [rad] ...and turned
  double dense = 0.5;                   ///< [m] one sigma of a cloud that says where it is...
  double dense_turned = radians(12.0);  ///< [rad] ...and of its heading

  // Missing and new artifacts, from a pose that is sure.
  double sure_position = 0.2;  ///< [m] one sigma of it
  PresenceSettings presence;
  ObjectFinderSettings objects;
};

enum class State {
  off,       ///< switched off: the pose goes on by dead reckoning (manual 6.9.2)
  unplaced,  ///< it has no pose, and looks for one
  tracking,
  lost  ///< the pose does not hold; it looks for another
};
std::string_view word(State state);

struct Inputs {
  std::uint64_t cycle = 0;
  std::uint64_t odom =
      0;  ///< number of the odometry frame; another one: the robot may be elsewhere
  Pose pose_in_odom;
  const std::vector<lps::Percept>& percepts;
  const std::vector<lps::SonarReading>& readings;  ///< new ones, in firing order
  /// True where things are looked for that the map does not have (add_new_features, manual 6.9.2).
  bool find_objects = false;
};

struct Output {
  State state = State::unplaced;
  std::string_view reason;  ///< of the state, in words
  Pose pose_in_map;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, th
  double confidence = 0.0;  ///< [0..1] that the pose is right within its covariance
  std::vector<Match> matches;
  /// The feature of the map that the robot is in: junction before corridor before lane before
  /// office. current_environment of manual 8.1.2.
  std::optional<std::size_t> environment;
  /// Artifacts of the map that are gone, closed or open again, and new ones, for the owner of the
  /// map.
  Presence::News presence;
  std::vector<maps::Feature> objects;

  bool operator==(const Output&) const = default;
};

/// State that a restart takes over.
struct Memory {
  std::uint64_t odom = 0;
  Pose pose_in_odom;
  Pose pose_in_map;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< x, y, th, drift
  double drift = 0.0;                                    ///< [rad/m] of dead reckoning
  double confidence = 0.0;
  bool placed = false;
};

struct RegistrationState;

/// Where the robot is in the map: test_match_proc and test_environment_proc of manual 6.9.2, and
/// anchoring of paper 3.2.
///
/// An extended Kalman filter of the pose and of dead reckoning's constant drift, corrected by
/// percepts that are matched to artifacts: hypotheses first, then features whose readings no
/// accepted hypothesis has. What could be two artifacts is left alone. Raw readings say whether the
/// pose holds; where it does not, or is not known, a search over the whole map finds it.
/// The same inputs give the same outputs to the last bit.
class Registration {
 public:
  Registration(Settings settings, maps::Map map, std::optional<Pose> pose_in_map = std::nullopt);
  ~Registration();
  Registration(Registration&&) noexcept;
  Registration& operator=(Registration&&) noexcept;

  const Output& step(const Inputs& inputs);
  const Output& output() const;

  /// Another map, or the same one changed. The state stays.
  void set_map(maps::Map map);
  const maps::Map& map() const;
  /// Somebody says where the robot is.
  void set_pose(const Pose& pose_in_map, const Sigmas& sigmas = {});
  /// Forgets where the robot is, and looks for it.
  void forget_pose();
  void switch_on(bool on);
  bool on() const;
  /// Doors by id that were closed when the robot looked at them last.
  const std::set<std::uint32_t>& closed_doors() const;
  void recall_closed(std::set<std::uint32_t> doors);

  /// All that it has learnt, see state.hpp.
  const RegistrationState& state() const;
  /// Goes on from there: `state` is of a Registration with the same map and settings.
  void set_state(RegistrationState state);

  /// The part that the service keeps over a restart: much less.
  Memory save() const;
  /// Goes on from there in the same odometry frame. In another one the pose is a guess, beside
  /// `start`: State::lost until the readings fit one of them and not the other.
  void restore(const Memory& memory, const std::optional<Pose>& start = std::nullopt);

 private:
  class Self;
  std::unique_ptr<Self> self_;
};

}  // namespace saphira::registration

#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/base/notes.hpp"
#include "saphira/base/process.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/registration/map_builder.hpp"
#include "saphira/registration/registration.hpp"
#include "saphira/registration/remembered.hpp"
#include "saphira/registration/state.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::registration {

/// Where `start` is on the map: the name of a POS of it, "x,y,th" [m, rad], or "unknown"; nothing
/// for "unknown", and for "start" where the map has none. std::invalid_argument that says what was
/// expected.
std::optional<Pose> start_pose(const std::string& start, const maps::Map& map);

/// All that a Core has learnt, been told and decided, as one value, apart from what follows from
/// it: a copy that is put into another Core goes on to the last bit as the first one would have.
/// State that a step leaves for a later one belongs here.
struct CoreState {
  /// State of the core itself.
  struct Own {
    std::string option;  ///< the map that the service was started with
    maps::Editor editor;
    std::string source;                    ///< where the map came from
    bool changed = false;                  ///< the map, since it came from there
    std::optional<Pose> start;             ///< on the map that the service was started with
    std::optional<Remembered> remembered;  ///< until it is used
    std::vector<lps::SonarMount> sonars;
    bool on = true;  ///< a request may have switched it off
    bool adds_features = false;
    bool snaps = true;
    std::optional<MapBuilder> builder;
    /// The map began empty: the builder finds the pose together with the map.
    bool building = false;
    bool too_large = false;  ///< the map would be, if it grew further
    std::uint64_t odom = 0;  ///< of the newest step
    Pose pose_in_odom;
    Pose pose_in_map;  ///< as it was told in the newest step; before that, the start
    State told = State::unplaced;
  };
  /// Of the Registration.
  struct Placed {
    maps::Map map;  ///< while the map is being built, still the one before
    RegistrationState state;
  };

  Own own;
  std::optional<Placed> placed;  ///< none before the first robot
  std::vector<Process::Progress> processes;
};

/// The registration service without the bus: keeps the robot's place on the map true, and the map
/// as it changes: by what is seen, by requests, by building it from nothing. Files are the shell's.
class Core {
 public:
  struct Settings {
    maps::Map map;
    std::string source;         ///< where the map came from; empty: nowhere
    std::optional<Pose> start;  ///< of the robot in the map; none: it has to find itself
    /// add_new_features (manual 6.9.2): what is seen and matches nothing is added to the map. Where
    /// nothing is said, only a map that is empty at the start grows.
    std::optional<bool> add_features;
    bool snap = true;  ///< snap_to_right_angle_grid (manual 6.9.2)
  };
  /// `remembered`: of a service before this one. It counts where that one was started with the same
  /// map, settings.source. std::invalid_argument where no robot can be registered on a map.
  explicit Core(Settings settings, std::optional<Remembered> remembered = {});

  struct Inputs {
    std::uint64_t cycle = 0;
    /// The first step of an epoch: where the robot's sonars are.
    const std::vector<lps::SonarMount>* new_robot = nullptr;
    std::uint64_t odom = 0;
    Pose pose_in_odom;
    std::vector<lps::Percept> percepts;       ///< of the cycle before, in this odom frame
    std::vector<lps::SonarReading> readings;  ///< new ones, in firing order
  };
  /// The result of matching a percept.
  struct Matched {
    std::uint32_t percept = 0;
    std::uint32_t artifact = 0;  ///< 0: none
    bool accepted = false;
    std::string reason;   ///< why it was not
    Vec2 off{0.0, 0.0};   ///< [m] seen less expected, along the artifact and across it
    double turned = 0.0;  ///< [rad]
  };
  struct Outputs {
    State state = State::unplaced;
    std::string reason;
    Pose pose_in_map;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, th
    double confidence = 0.0;
    std::uint32_t environment = 0;  ///< id of what the robot is in; 0: nothing that is known
    std::vector<Matched> matches;
    std::vector<std::uint32_t> closed_doors;
    Notes notes;
  };
  /// The first step has to bring a robot.
  Outputs step(const Inputs& inputs);

  /// The requests that it takes.
  static const std::vector<Functor>& functors();
  /// In a cycle or between two: a request that functors() can take. What is refused has changed
  /// nothing. The result "id" is that of the artifact that was put or removed.
  Answer act(const Request& request);

  const maps::Map& map() const { return now_.editor.map(); }
  /// Goes up with every change of the map.
  std::uint64_t map_revision() const { return now_.editor.revision(); }
  /// Where the map came from, and whether it has changed since.
  const std::string& map_source() const { return now_.source; }
  bool map_changed() const { return now_.changed; }
  bool adds_features() const { return now_.adds_features; }
  bool snaps() const { return now_.snaps; }
  /// While what is seen is added to the map; nullptr otherwise.
  const MapBuilder* builder() const { return now_.builder ? &*now_.builder : nullptr; }
  /// State that a restart takes over; none before the first robot.
  std::optional<Remembered> remembered() const;

  /// Its micro-tasks. They are stepped before the core, for the same cycle.
  ProcessTable& processes() { return processes_; }

  CoreState save() const;
  void restore(CoreState saved);

 private:
  void begin(const std::vector<lps::SonarMount>& sonars);
  void take_up(Remembered remembered);
  void set_builder();
  void end_building();
  Outputs registered(const Inputs& inputs);
  Outputs built(const Inputs& inputs);
  bool amend(const Presence::News& news, const std::vector<maps::Feature>& objects, Notes& notes);
  bool grow(const Inputs& inputs, std::optional<Pose> pose_in_map, Notes& notes);
  Arguments obey(const Request& request);
  Registration& placed();
  void use(maps::Editor editor);
  void begin_anew(const std::string& source);

  ProcessTable processes_;
  // sfInitRegistrationProcs.
  Process& match_ = processes_.add(
      "test-match", "matches what is seen with the map (not while the map is being built)");
  Process& environment_ = processes_.add("test-environment", "says where on the map the robot is");

  CoreState::Own now_;
  std::optional<Registration> registration_;
};

}  // namespace saphira::registration

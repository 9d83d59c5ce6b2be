#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "saphira/base/notes.hpp"
#include "saphira/base/process.hpp"
#include "saphira/idl/map.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/registration/map_builder.hpp"
#include "saphira/registration/registration.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::registration {

/// State that outlives the service: the pose, and the changed map.
struct Remembered {
  Memory memory;
  std::string option;    ///< the map at the start of the service
  std::string source;    ///< the origin of this map: that one, or another that was loaded later
  bool changed = false;  ///< since its origin
  maps::Map map;
  std::set<std::uint32_t> closed_doors;
};

/// The pose of `start` on the map: the name of a POS of it, "x,y,th" [m, rad], or "unknown";
/// nothing for "unknown", and for "start" where the map has none. std::invalid_argument gives the
/// expected form.
std::optional<Pose> start_pose(const std::string& start, const maps::Map& map);

/// The registration service without the bus: keeps the robot's pose on the map, and the map's
/// changes by perception, by requests, or by building from nothing. Files are the shell's.
class Core {
 public:
  struct Settings {
    maps::Map map;
    std::string source;         ///< the origin of the map; empty: none
    std::optional<Pose> start;  ///< of the robot in the map; none: unknown
    /// add_new_features (manual 6.9.2): percepts without a match are added to the map. By default,
    /// only a map that is empty at the start grows.
    std::optional<bool> add_features;
    bool snap = true;  ///< snap_to_right_angle_grid (manual 6.9.2)
  };
  /// `remembered`: of an earlier service. It counts where that had the same map, settings.source.
  /// std::invalid_argument where no robot can be registered on a map.
  explicit Core(Settings settings, std::optional<Remembered> remembered = {});

  struct Inputs {
    std::uint64_t cycle = 0;
    /// The first step of an epoch: the poses of the robot's sonars.
    const std::vector<lps::SonarMount>* new_robot = nullptr;
    std::uint64_t odom = 0;
    Pose pose_in_odom;
    std::vector<lps::Percept> percepts;       ///< of the cycle before, in this odom frame
    std::vector<lps::SonarReading> readings;  ///< new ones, in firing order
    std::span<const Request> requests{};      ///< that functors() can take
  };
  struct Outputs {
    v1::RegistrationState state = v1::REGISTRATION_UNPLACED;
    std::string reason;
    Pose pose_in_map;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, th
    double confidence = 0.0;
    std::uint32_t environment = 0;  ///< id of the artifact around the robot; 0: none known
    std::vector<v1::Match> matches;
    std::vector<std::uint32_t> closed_doors;
    std::vector<Answer> answers;  ///< to the requests, in their order
    Notes notes;

    bool operator==(const Outputs&) const = default;
  };
  /// The first step has to bring a robot.
  Outputs step(const Inputs& inputs);
  /// The answers to requests between two cycles: there may be no robot.
  std::vector<Answer> between(std::span<const Request> requests);

  /// The requests of registration. A refused request has changed nothing. The result "id" is that
  /// of the added or removed artifact.
  static const std::vector<Functor>& functors();

  const maps::Map& map() const { return now_.editor.map(); }
  /// Increases with every change of the map.
  std::uint64_t map_revision() const { return now_.editor.revision(); }
  /// The origin of the map, and its changes since.
  const std::string& map_source() const { return now_.source; }
  bool map_changed() const { return now_.changed; }
  bool adds_features() const { return now_.adds_features; }
  bool snaps() const { return now_.snaps; }
  /// While percepts are added to the map; nullptr otherwise.
  const MapBuilder* builder() const { return now_.builder ? &*now_.builder : nullptr; }
  /// State for a restart; none before the first robot.
  std::optional<Remembered> remembered() const;

  /// Its micro-tasks. They are stepped before the core, for the same cycle.
  ProcessTable& processes() { return processes_; }

  template <class Archive>
  void archive(Archive& a) {
    bool begun = registration_.has_value();
    a("processes", processes_)("now", now_)("begun", begun);
    if (a.restores())
      make(begun);
    if (registration_)
      a("registration", *registration_);
  }

 private:
  /// Its learnt state but that of the Registration.
  struct State {
    std::string option;  ///< the map at the start of the service
    maps::Editor editor{};
    std::string source;                    ///< the origin of the map
    bool changed = false;                  ///< the map, since its origin
    std::optional<Pose> start;             ///< on the map at the start of the service
    std::optional<Remembered> remembered;  ///< until it is used
    std::vector<lps::SonarMount> sonars;
    bool on = true;  ///< false: switched off by a request
    bool adds_features = false;
    std::uint64_t lease = 0;  ///< [cycles] until it adds none any more; 0: no limit
    bool snaps = true;
    std::optional<MapBuilder> builder;
    /// The map began empty: the builder finds the pose together with the map.
    bool building = false;
    Pose built_from;         ///< in the map, when building began
    bool too_large = false;  ///< the map has reached its largest size
    std::uint64_t odom = 0;  ///< of the newest step
    Pose pose_in_odom;
    Pose pose_in_map;  ///< from the newest step; before that, the start
    v1::RegistrationState told = v1::REGISTRATION_UNPLACED;
  };

  void begin(const std::vector<lps::SonarMount>& sonars);
  void make(bool begun);
  void take_up(Remembered remembered);
  void set_builder();
  void end_building();
  Outputs registered(const Inputs& inputs);
  Outputs built(const Inputs& inputs);
  bool amend(const Presence::Changes& news, const std::vector<maps::Feature>& objects,
             Notes& notes);
  bool grow(const Inputs& inputs, std::optional<Pose> pose_in_map, Notes& notes);
  Arguments obey(const Request& request);
  Registration& placed();
  void use(maps::Editor editor);
  void begin_anew(const std::string& source);

  ProcessTable processes_;
  // sfInitRegistrationProcs.
  Process& match_ = processes_.add(
      "test-match", "matches features with the map (not while the map is being built)");
  Process& environment_ = processes_.add("test-environment", "says where on the map the robot is");

  State now_;
  std::optional<Registration> registration_;
};

}  // namespace saphira::registration

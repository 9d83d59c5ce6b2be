#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "base/shell/processes.hpp"
#include "registration/shell/memory_file.hpp"
#include "saphira/bus/cycle.hpp"
#include "saphira/bus/known_robot.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/registration/map_builder.hpp"
#include "saphira/registration/registration.hpp"

namespace saphira::registration {

struct ShellOptions {
  std::string map_file;  ///< empty: an empty map
  /// Where the robot is at the start: the name of a POS of the map, "x,y,th" [m, rad] in the map,
  /// or "unknown".
  std::string start = "start";
  std::string memory_file;  ///< what outlives the service; empty: nothing does
  /// add_new_features (manual 6.9.2): what is seen and matches nothing is added to the map. Where
  /// nothing is said, only a map that is empty at the start grows.
  std::optional<bool> add_features = std::nullopt;
  bool snap = true;  ///< snap_to_right_angle_grid (manual 6.9.2)
};

/// The path of what a person means by `name`: a map file, or one that is shipped; empty for "none"
/// and for nothing. std::invalid_argument that lists what there is where it is neither.
std::string find_map(const std::string& name);

/// Where `start` is on the map; nothing for "unknown", and for "start" where the map has none.
/// std::invalid_argument that says what was expected.
std::optional<Pose> start_pose(const std::string& start, const maps::Map& map);

/// The registration service on the bus. To be made and run in one thread.
class Shell {
 public:
  /// Throws FileError, std::runtime_error or std::invalid_argument for what the options name.
  explicit Shell(bus::Node& node, const ShellOptions& options = {});

  /// Steps until stop is requested.
  void run(const bus::Stop& stop) {
    while (step(stop)) {
    }
  }
  /// Waits for one cycle and steps it; false when stop was requested.
  bool step(const bus::Stop& stop);

 private:
  using Clock = std::chrono::steady_clock;

  void begin();
  void take_requests();
  /// Does it; throws what is told to the one who asked.
  std::uint32_t act(const v1::RegistrationRequest& request);
  void recall();
  void use(maps::Editor editor);
  void begin_anew(const std::string& source);
  void set_builder();
  v1::Registration registered(const bus::Step& step, const std::vector<lps::Percept>& percepts);
  v1::Registration built(const bus::Step& step, const std::vector<lps::Percept>& percepts);
  bool amend(const Presence::News& news, const std::vector<maps::Feature>& objects);
  bool grow(const std::vector<lps::Percept>& percepts,
            const std::vector<lps::SonarReading>& readings, std::optional<Pose> pose_in_map);
  void end_building();
  void publish_map();
  void remember();
  void tell_saved(bool good);

  bus::Node& node_;
  ShellOptions options_;
  bus::Cycle cycle_;
  bus::Input<v1::Perception>& perception_;
  bus::KnownRobot robot_;
  bus::Reader<v1::RegistrationRequest> requests_;
  bus::Writer<v1::Registration> registrations_;
  bus::Writer<v1::Map> maps_;
  bus::Writer<v1::RegistrationAnswer> answers_;
  ProcessTable table_;
  // sfInitRegistrationProcs.
  Process& match_ = table_.add(
      "test-match", "matches what is seen with the map (not while the map is being built)");
  Process& environment_ = table_.add("test-environment", "says where on the map the robot is");
  ProcessesOnBus processes_;

  maps::Editor editor_;
  std::string source_;                    ///< where the map came from
  bool changed_ = false;                  ///< the map, since it came from there
  std::optional<Pose> start_;             ///< on the map that the service was started with
  std::optional<Remembered> remembered_;  ///< until it is used
  std::optional<Registration> registration_;
  bool on_ = true;  ///< somebody may have switched it off
  bool adds_features_ = false;
  bool snaps_ = true;
  std::optional<MapBuilder> builder_;
  /// The map began empty: the builder finds the pose together with the map.
  bool building_ = false;
  bool too_large_ = false;  ///< the map would be, if it grew further
  bool saves_ = true;       ///< the memory could be written, as it was told
  std::uint64_t odom_ = 0;  ///< of the newest step
  Pose pose_in_odom_;
  Pose pose_in_map_;  ///< as it was told in the newest step; before that, the start
  std::uint64_t published_revision_ = 0;
  Clock::time_point saved_ = Clock::now();
  std::future<bool> saving_;  ///< waits for the disk
  State told_ = State::unplaced;
};

}  // namespace saphira::registration

#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/shell/processes.hpp"
#include "intentions/shell/memory_file.hpp"
#include "saphira/bus/cycle.hpp"
#include "saphira/bus/known_robot.hpp"
#include "saphira/intentions/activity_folders.hpp"
#include "saphira/intentions/executor.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::intentions {

struct ShellOptions {
  std::string memory_file;  ///< what outlives the service; empty: nothing does
  /// Whether there is a registration service: in lockstep its samples are waited for. Without it,
  /// what is on a map cannot be found.
  bool registration = true;
  /// The same of interpretation. Without it, activities see no doors and corridors but those of the
  /// map.
  bool interpretation = true;
  /// Whether there is a vision service whose samples are waited for in lockstep. Live it is heard
  /// without being asked for, as soon as there is one.
  bool vision = false;
  /// Activities that cover shipped ones of the same name; empty: none.
  std::string folder;
};

/// The intentions service on the bus. To be made and run in one thread.
class Shell {
 public:
  /// std::runtime_error where the memory file cannot be written.
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

  /// What somebody asks of an intention, named by its instance or number.
  std::optional<std::string> ask_intention(const std::string& name, ProcessAction action,
                                           std::uint32_t cycles);

  std::vector<GoalEvent> take_events();
  void take_estop();
  void idle();
  std::vector<ClaimEvent> take_claims();
  void take_map(std::optional<std::uint64_t> revision, const bus::Stop& stop);
  void look_through_cameras(const v1::RobotState& robot, Surroundings& around);
  void look_around(const v1::RobotState& robot, const bus::Stop& stop, Surroundings& around);
  /// Takes what can be intended, as the behaviors service tells it.
  void take_schemas();
  void wait_for_schemas(const bus::Stop& stop);
  /// Takes activity files that have changed.
  void look();
  void publish(const News& news);
  /// Onto the disk, before anybody hears of it: nothing that has been said or done is done again.
  void remember(const News& news);
  void publish(const std::vector<Said>& said);
  void publish(const std::vector<MapRequest>& requests);
  void publish_beliefs();

  bus::Node& node_;
  bus::Cycle cycle_;
  bus::Input<v1::Behaviors>& behaviors_;
  bus::Input<v1::Registration>* registration_;  ///< null where there is no such service
  bus::Input<v1::Perception>* perception_;
  bus::Input<v1::Vision>* vision_;
  std::optional<bus::Reader<v1::Vision>> unasked_vision_;
  std::optional<v1::Vision> newest_vision_;
  bus::KnownRobot robot_;
  bus::Reader<v1::Map> maps_;
  bus::Reader<v1::BehaviorSchemas> behavior_schemas_;
  bool schemas_known_ = false;
  bus::Reader<v1::BeliefClaim> claims_;
  bus::Reader<v1::Goal> goals_;
  bus::Reader<v1::Grant> grants_;
  std::string estop_;  ///< which program pressed the emergency stop that is latched
  bus::Writer<v1::Intentions> intentions_;
  bus::Writer<v1::Intentions> recall_;
  bus::Writer<v1::GoalStatus> statuses_;
  bus::Writer<v1::ActivitySchemas> schemas_;
  bus::Writer<v1::Beliefs> beliefs_;
  bus::Writer<v1::Message> messages_;
  bus::Writer<v1::RegistrationRequest> map_requests_;
  std::uint64_t next_request_;  ///< random at first
  MemoryFile memory_;
  std::shared_ptr<const Functions> functions_;
  ActivityFolders folders_;
  Executor executor_;
  std::optional<lps::LocalPerceptualSpace> lps_;
  std::optional<std::uint64_t> odom_;  ///< of the newest step
  std::optional<std::vector<lps::Percept>> percepts_;
  std::vector<lps::SeenThing> things_;
  std::vector<lps::SonarReading> readings_;
  std::shared_ptr<const maps::Topology> topology_;
  std::shared_ptr<const maps::Map> map_;
  std::uint64_t map_revision_ = 0;
  std::uint64_t places_revision_ = 0;          ///< of the map when its topology changed last
  std::deque<v1::Map> newer_maps_;             ///< lockstep: than the cycle that is stepped
  std::map<GoalId, bus::WriterId> claimants_;  ///< of claims that end with their writer
  std::uint64_t steps_ = 0;
  std::uint64_t beliefs_revision_ = 0;
  std::vector<IntentionNode> nodes_;  ///< of the newest step
  ProcessTable table_;
  /// Suspended it lets nothing be intended: the goals are suspended, and the robot is released.
  Process& execution_ =
      table_.add("execute-intentions", "pursues the goals: begins and steps intentions");
  ProcessesOnBus processes_;
  std::map<GoalId, bus::WriterId> writers_;  ///< who wrote each goal last
  std::map<GoalId, GoalState> logged_;
  v1::Stamp stamp_;  ///< of the newest step
  Clock::time_point stepped_ = Clock::now();
  bool robot_here_ = false;
};

}  // namespace saphira::intentions

#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/identity.hpp"
#include "saphira/base/notes.hpp"
#include "saphira/base/process.hpp"
#include "saphira/idl/system.hpp"
#include "saphira/intentions/activity_folders.hpp"
#include "saphira/intentions/executor.hpp"
#include "saphira/intentions/gaze.hpp"
#include "saphira/intentions/navigation.hpp"
#include "saphira/lps/local_perceptual_space.hpp"
#include "saphira/lps/percept.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/maps/line_map.hpp"

namespace saphira::intentions {

/// The intentions service without the bus: in, the inputs since the last cycle; out, the intended
/// behaviors and their status. Files, waiting and writing are the shell's.
class Core {
 public:
  /// A writer on the bus, unique for ever.
  using Writer = std::array<std::uint8_t, 16>;

  struct Settings {
    Registry registry;  ///< available intentions: those of the memory are among them
    Memory memory;      ///< the memory from before a restart
    bool remembers_work = false;
    bool lockstep = false;
    /// Roles, and beginnings of askers' names, whose goals wait until a person approves them.
    std::vector<std::string> approval{};
    std::shared_ptr<const Functions> functions;
  };
  explicit Core(Settings settings);

  /// The events of a cycle, or between two. Lost writers come before new samples, which include
  /// their earlier ones.
  struct Received {
    struct Goal {
      GoalEvent event;  ///< its requester: what that calls itself
      Writer writer{};
      Checked person{};  ///< who writes it, or for whom
      double age = 0.0;  ///< [s] since it was written
    };
    struct Claim {
      ClaimEvent event;
      Writer writer{};
      bool ends_with_writer = false;
      double age = 0.0;  ///< [s] since it was written, by the clocks of two machines
    };
    struct Grant {
      bool pressed = false;
      std::string source;
      /// The reason why the bridge does not let the behaviors drive [empty: it does, or they do not
      /// ask].
      std::string refusal{};
      std::string person{};              ///< that drives by teleop [empty: nobody does]
      bool waits_for_hand_back = false;  ///< a person drove last
      v1::StopId stop{};                 ///< the newest stop
      std::string stop_source{};         ///< its asker
      std::string driver{};  ///< that drives in a stronger role than the behaviors [empty: nobody]
    };
    double running = 0.0;  ///< [s] since this start of the service
    std::vector<Writer> lost_requesters;
    std::vector<Goal> goals;
    std::vector<Writer> lost_claimants;
    std::vector<Claim> claims;
    /// From the bridge's grants. For steps alone: all since the last one together.
    std::vector<Grant> grants;
    /// Answers of agents, by the number of the question (intentions::Outputs). For steps alone.
    std::vector<std::pair<std::uint64_t, Answer>> answers;
    /// The schemas that the behaviors service can evaluate, where they have changed.
    std::optional<std::vector<BehaviorSignature>> behaviors;
    /// The activities of files that have changed.
    std::optional<ActivityFolders::Reload> activities;
  };

  /// A map of the registration service.
  struct NewMap {
    std::uint64_t revision = 0;
    std::shared_ptr<const maps::Map> map;
  };
  /// A result of a vision service.
  struct Vision {
    v1::Stamp stamp;
    std::uint64_t odom = 0;
    bool sees = false;         ///< a camera delivers
    bool sees_colors = false;  ///< one for colours does
    std::vector<lps::SeenThing> things;
  };

  struct Inputs {
    v1::Stamp stamp;
    const lps::LpsSettings* new_robot = nullptr;  ///< the first step of an epoch
    double robot_radius = 0.0;                    ///< [m] of its hull, a circle; 0: unknown
    double deceleration = 0.0;                    ///< [m/s2] of a stop; 0: unknown
    double head_reach = 0.0;  ///< [rad] turn of the cameras to either side; 0: they are fixed
    bool new_frame = false;   ///< the odom frame has another origin
    Robot robot;              ///< with its place on the map, where that is known
    std::vector<lps::SonarReading> readings;  ///< new ones, in firing order
    // Of the cycle before.
    std::vector<BehaviorLevel> behaviors;
    std::vector<v1::MissingBehavior> troubles;
    std::uint64_t behaviors_cycle = 0;  ///< of this epoch; 0: none yet
    std::uint64_t intent_age = 1;       ///< [cycles] of the intent that they were computed from
    Registered registered;
    std::optional<std::uint64_t> map_revision;  ///< used by registration; none: it was not heard
    /// New ones. In lockstep a map counts from the step on for which registration used it.
    std::vector<NewMap> maps;
    std::optional<std::vector<lps::Percept>> percepts;  ///< none: no interpretation
    std::optional<Vision> vision;
    Received received;
    v1::StopId own_stop;  ///< of the stop that this step may ask for
  };
  struct Outputs {
    intentions::Outputs intended;
    /// All beliefs, where they have changed.
    std::optional<std::vector<Belief>> beliefs;
    /// The present way over the map [m] [map], from the robot's place, where it has changed; empty:
    /// none.
    std::optional<std::vector<Vec2>> way;
    SpeedLimit limit;            ///< for the intended behaviors
    std::vector<Edge> edges;     ///< [odom] of the map near the robot
    std::optional<double> look;  ///< [rad] the direction that the head has to turn to
    std::string degraded{};      ///< the trouble of the service [empty: none]
    Notes notes;
    std::vector<v1::AuditEntry> audit;
  };
  Outputs step(Inputs inputs);

  /// Outputs between cycles.
  struct BetweenOutputs {
    GoalUpdates updates;
    Notes notes;
    std::vector<v1::AuditEntry> audit;
  };
  /// Handles inputs that need no cycle; `silence` [s] since the newest one.
  BetweenOutputs between(const Received& received, double silence);

  /// The result of saving the endings and the work of the newest updates: the endings that the disk
  /// did not take, and why it did not take all [empty: it did].
  void know_saved(const std::vector<Ending>& unsaved, const std::string& trouble);

  const Executor& executor() const { return executor_; }
  ProcessTable& processes() { return processes_; }
  /// Carries out the action on an intention by its instance, its number, or I and its number
  /// (manual 6.5, 2.3.8), or approves a goal by resuming its id: empty where done, the reason where
  /// not; nothing: no such intention.
  std::optional<std::string> ask(const std::string& name, ProcessAction action,
                                 std::uint32_t cycles);

  /// Its state but the activities and behaviors that it knows: a restored core is made with them.
  void archive(Archive& a);

 private:
  void know(const ActivityFolders::Reload& reload, Notes& notes);
  void learn(const Received& received, Notes& notes);
  /// Out: Outputs or BetweenOutputs.
  template <class Out>
  std::vector<GoalEvent> events_of(const Received& received, Out& out);
  template <class Out>
  bool take_person(const Received::Goal& goal, bool is_old, GoalEvent& event, Out& out);
  std::vector<ClaimEvent> claims_of(const Received& received);
  void note_grants(const std::vector<Received::Grant>& estops);
  void look_around(const Inputs& inputs, Surroundings& around);
  void take_maps(std::optional<std::uint64_t> revision);
  std::optional<std::vector<Vec2>> look_for_way(const intentions::Inputs& now);
  void ask_for_features(const intentions::Inputs& now, std::vector<Request>& requests);
  std::vector<Edge> edges_near(const intentions::Inputs& now);
  SpeedLimit limit_of(const intentions::Inputs& now, const intentions::Outputs& intended) const;
  void report(const GoalUpdates& updates, Notes& notes);
  std::string who_is_gone(const Inputs& inputs);

  bool needs_approval(const std::string& says, const Checked& who) const;

  bool lockstep_;
  std::vector<std::string> approval_;
  bool remembers_ = false;  ///< the memory of goals from before this start is whole
  bool memory_damaged_ = false;
  Executor executor_;
  ProcessTable processes_;
  /// While suspended, nothing is intended: the goals are suspended, and the robot is released.
  Process& execution_ =
      processes_.add("execute-intentions", "pursues the goals: begins and steps intentions");
  Process& centering_ = processes_.add(
      "center-cameras", "keeps the cameras on the person or point of the belief gaze");
  Gaze gaze_;
  std::string disk_trouble_;    ///< why not all is saved; empty: all is
  std::string told_trouble_;    ///< as of the newest step
  bool adds_features_ = false;  ///< an intention lets the map grow
  bool hears_registration_ = false;
  std::string estop_;  ///< the program that pressed the latched emergency stop
  std::optional<Received::Grant> newest_grant_;
  std::optional<lps::LocalPerceptualSpace> lps_;
  std::optional<std::vector<lps::Percept>> percepts_;
  std::vector<lps::SeenThing> things_;
  std::vector<lps::SonarReading> readings_;
  std::shared_ptr<const maps::Map> map_;
  std::shared_ptr<const maps::Map> places_;  ///< the map of the topology
  std::shared_ptr<const maps::Topology> topology_;
  std::shared_ptr<const maps::LineMap> lines_;  ///< of the map
  Vec2 near_of_{0.0, 0.0};                      ///< a place in the map...
  std::vector<Edge> near_;                      ///< ...and the edges near it
  std::uint64_t places_revision_ = 0;           ///< of the map when its topology changed last
  std::deque<NewMap> newer_maps_;               ///< lockstep: newer than the present cycle
  std::map<GoalId, Writer> requesters_;
  /// The first asker of a goal.
  struct Owner {
    Checked person;
    Goal goal;          ///< as it was written last, with the first asker as its requester
    bool told = false;  ///< the refusal of another asker was reported
  };
  std::map<GoalId, Owner> owners_;
  std::map<std::uint64_t, Answer> answers_;  ///< the newest, by the number of the question
  std::map<GoalId, Writer> claimants_;       ///< of claims that end with their writer
  std::map<GoalId, GoalState> logged_;
  std::vector<IntentionNode> nodes_;  ///< of the newest step
  std::vector<Vec2> way_;             ///< as reported last, without the robot's place
  std::uint64_t beliefs_revision_ = 0;
  bool robot_here_ = false;
  std::uint64_t heard_epoch_ = 0;
  std::uint64_t registration_heard_ = 0;  ///< [cycle]
};

}  // namespace saphira::intentions

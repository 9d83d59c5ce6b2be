#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/intentions/value.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::test {

struct WholeOptions {
  DriveOptions drive = {};
  std::string map = {};  ///< a name of config/maps; empty: the world's; none: no map
  std::shared_ptr<const maps::Map> made_map = {};  ///< instead of it
  bool knows_pose = true;                          ///< registration gets the robot's start
  bool adds_objects = false;  ///< objects that are not on the map are added to it
  /// The things that a camera sees after a cycle. None: no camera.
  std::function<std::vector<lps::SeenThing>(Drive&)> sees = {};
};

/// The whole robot in one loop: simulated robot and all services. Repeatable to the last bit, and
/// hundreds of times as fast as the robot.
class Whole {
 public:
  explicit Whole(const WholeOptions& options);
  Whole& operator=(Whole&&) = delete;

  void advance();
  /// Advances until `done`, for `cycles` at most; returns the result of `done`.
  bool advance_until(const std::function<bool()>& done, int cycles);
  /// Until the goal has ended; `each` looks at every cycle.
  bool watch(const v1::GoalId& goal, int cycles, const std::function<void()>& each);

  /// Asks for a goal, which is taken in the next cycle.
  v1::GoalId ask(std::string functor, const Arguments& arguments = {}, int priority = 0,
                 double deadline = 0.0);
  /// Makes a claim, which is taken in the next cycle. `speaker`: of the dialogue, for that person.
  void claim(std::string name, intentions::Value value, const std::string& speaker = {});
  /// The newest status of a goal; kWaiting until there is one.
  const v1::GoalStatus& status(const v1::GoalId& goal) const;
  bool ended(const v1::GoalId& goal) const;
  /// Asks, and advances until the goal has ended, for that number of cycles at most.
  v1::GoalStatus achieve(std::string functor, const Arguments& arguments, int cycles);

  Drive& drive() { return drive_; }
  const Drive& drive() const { return drive_; }
  const v1::Registration& registered() const { return drive_.registered(); }
  Pose believed() const { return drive_.believed(); }
  const maps::Map& map() const { return drive_.registration().map(); }
  /// Of the present map.
  maps::Topology topology() const { return maps::Topology(map()); }
  const v1::Intentions& intentions() const { return drive_.intended(); }
  const std::vector<v1::Belief>& beliefs() const { return beliefs_; }
  Pose truth() const { return drive_.truth(); }
  std::uint64_t cycle() const { return drive_.seen().cycle; }
  bool at_rest() const;

  /// The newest behavior that could not be made, and the reason; empty: none.
  const std::string& trouble() const { return trouble_; }
  /// All messages to people.
  const std::vector<std::string>& said() const { return said_; }
  /// All changes in the intentions since the start, a line each: "12 go_to (1:1) begins, END".
  const std::vector<std::string>& transitions() const { return transitions_; }

 private:
  void note_transitions();

  Drive drive_;
  std::function<std::vector<lps::SeenThing>(Drive&)> sees_;
  bus::Writer<v1::Goal> goals_{drive_.node().writer(bus::topics::kGoals)};
  bus::Writer<v1::BeliefClaim> claims_{drive_.node().writer(bus::topics::kBeliefClaims)};
  bus::Reader<v1::BehaviorSet> behaviors_{drive_.node().reader(bus::topics::kBehaviors)};
  bus::Reader<v1::GoalStatus> goal_statuses_{drive_.node().reader(bus::topics::kGoalStatus)};
  bus::Reader<v1::Message> messages_{drive_.node().reader(bus::topics::kMessages)};
  bus::Reader<v1::BeliefSet> belief_sets_{drive_.node().reader(bus::topics::kBeliefs)};
  std::vector<v1::Belief> beliefs_;
  std::vector<std::string> said_;
  std::string trouble_;
  std::map<v1::GoalId, v1::GoalStatus> statuses_;
  std::uint64_t next_goal_ = 1;
  std::map<std::uint32_t, v1::IntentionNode> nodes_;
  std::vector<std::string> transitions_;
};

}  // namespace saphira::test

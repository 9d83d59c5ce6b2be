#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drive/drive.hpp"
#include "saphira/lps/seen_thing.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::test {

struct WholeOptions {
  DriveOptions drive;
  std::string map;  ///< a name of config/maps; empty: the world's; none: no map
  std::shared_ptr<const maps::Map> made_map;  ///< instead of it
  bool knows_pose = true;                     ///< registration gets the robot's start
  bool adds_objects = false;                  ///< objects that are not on the map are added to it
  /// Else the built-in schemas and the shipped activities.
  std::optional<intentions::Registry> schemas;
  /// The things that a camera sees after a cycle. None: no camera.
  std::function<std::vector<lps::SeenThing>(Drive&)> sees;
};

/// The built-in schemas, and those of config/activities. std::runtime_error where a file has an
/// error.
intentions::Registry shipped_schemas(const behaviors::Registry& behaviors);

/// The whole robot in one loop, without the bus: simulated robot and all services. Repeatable to
/// the last bit, and thousands of times as fast as the robot.
class Whole {
 public:
  explicit Whole(const WholeOptions& options);
  Whole(const Whole&) = delete;
  Whole& operator=(const Whole&) = delete;

  void advance();
  /// Advances until `done`, for `cycles` at most; returns the result of `done`.
  bool advance_until(const std::function<bool()>& done, int cycles);

  /// Asks for a goal, which is taken in the next cycle.
  intentions::GoalId ask(std::string functor, saphira::Arguments arguments = {}, int priority = 0,
                         double deadline = 0.0);
  /// Makes a claim, which is taken in the next cycle.
  void claim(std::string name, intentions::Value value);
  /// The newest status of a goal; kWaiting until there is one.
  const intentions::GoalStatus& status(const intentions::GoalId& goal) const;
  bool ended(const intentions::GoalId& goal) const;
  /// Asks, and advances until the goal has ended, for that number of cycles at most.
  intentions::GoalStatus achieve(std::string functor, saphira::Arguments arguments, int cycles);

  Drive& drive() { return drive_; }
  const Drive& drive() const { return drive_; }
  const registration::Core::Outputs& registered() const { return drive_.registered(); }
  Pose believed() const { return drive_.believed(); }
  const maps::Map& map() const { return drive_.cores().registration().map(); }
  /// Of the present map.
  maps::Topology topology() const { return maps::Topology(map()); }
  const intentions::Outputs& intentions() const {
    return drive_.cores().said().intentions.intended;
  }
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
  std::vector<std::string> said_;
  std::string trouble_;
  std::map<intentions::GoalId, intentions::GoalStatus> statuses_;
  std::uint64_t next_goal_ = 1;
  std::map<std::uint32_t, intentions::IntentionNode> nodes_;
  std::vector<std::string> transitions_;
};

}  // namespace saphira::test

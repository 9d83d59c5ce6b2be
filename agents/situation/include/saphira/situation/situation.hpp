#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/cycle.hpp"
#include "saphira/idl/behavior.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/idl/map.hpp"
#include "saphira/idl/motion.hpp"
#include "saphira/idl/robot.hpp"
#include "saphira/idl/system.hpp"

namespace saphira::situation {

/// The status is published once a second: with an older one [s], the program is lost.
inline constexpr double kLostAge = 3.0;

/// A program, by its newest status.
struct Program {
  v1::ServiceStatus status;
  double age = 0.0;       ///< [s] since its arrival
  bool namesake = false;  ///< it reports that another program of its name has this robot
  /// [s] that the clock of its machine is behind this one's, as far as samples show it [0: not
  /// known]
  double clock_behind = 0.0;
};

/// The cycles with known samples of a program; 0: none.
struct Known {
  std::uint64_t oldest = 0;
  std::uint64_t newest = 0;
};

/// The known state of a robot and its programs: at present, or in a past cycle. A plain value: the
/// code that fills it knows the bus and the clock, the code that puts it into words does not.
/// Unknown members are empty.
struct Situation {
  std::uint64_t cycle = 0;  ///< N, the cycle in question
  std::uint64_t now = 0;    ///< the robot's newest cycle
  bool past = false;        ///< N was requested, and is not the present cycle
  /// [s] since the newest robot/state. For a robot in single step, which may stand still: 0.
  double silence = 0.0;
  double listened = 0.0;  ///< [s] time of listening
  /// [1/s] the robot's cycles in a second of the clock that has statuses published: a simulation
  /// has more or fewer than a robot [0: not known yet].
  double pace = 1.0 / kCycle;

  std::optional<v1::RobotState> robot;       ///< of N: the behaviors' input
  std::optional<v1::Grant> grant;            ///< the grant for the command of N
  std::optional<v1::BehaviorSet> behaviors;  ///< of the cycle that this command answers
  std::optional<v1::Intentions> intentions;  ///< of the cycle before that
  /// These two are the driving program's own, not those of the services.
  bool own_mind = false;
  Known behaviors_known;
  Known intentions_known;

  std::vector<v1::Goal> goals;                   ///< of requesters that are still there
  std::vector<v1::GoalStatus> statuses;          ///< at that time
  bool statuses_known = false;                   ///< no status means no goal
  std::optional<v1::Registration> registration;  ///< at present: the robot's place on the map
  /// The cycle in which that place became doubtful [0: it is not, or nobody saw the change].
  std::uint64_t doubtful_since = 0;
  /// The cycles in which the emergency stop was pressed, and in which a wheel stalled [0: they are
  /// not, or were so before the known past].
  std::uint64_t estopped_since = 0;
  std::uint64_t stalled_since = 0;
  std::uint64_t behaviors_drove = 0;  ///< the newest cycle in which behaviors drove [0: not known]
  std::vector<v1::Belief> beliefs;    ///< at present: the activities' beliefs
  std::vector<v1::BehaviorSchema> schemas;  ///< for the rules in their written form
  std::vector<Program> programs;            ///< at present
  std::vector<std::string> found;  ///< on the bus, and their status has not come yet, or is late
  std::vector<v1::ProcessSet> processes;  ///< at present, of programs that are heard

  /// That of the robot's samples; 0: none is known.
  std::uint64_t robot_epoch() const {
    return robot ? robot->stamp.epoch : grant ? grant->stamp.epoch : 0;
  }
};

/// The machines whose clocks differ from this one's by seconds, in words, a line each; empty: none.
/// Nothing depends on it but the times of logs, of people's words and of certificates.
std::string clocks_apart(const std::vector<Program>& programs);

/// The robot has a place on the map that its readings hardly fit: it may have been carried away.
bool is_doubtful(const v1::Registration& registration);

/// The robot has no place on the map at present: it is lost, or has not found its place yet.
bool is_lost(const Situation& situation);
/// The robot may be elsewhere, and does not count as lost yet, in words; else empty.
std::string doubt(const Situation& situation);
/// The trouble with the robot's place on the map, with the remedy, in words; empty: none.
std::string place_trouble(const Situation& situation);

/// The health of a program.
enum class Health {
  running,
  fresh,    ///< running, and newly started
  late,     ///< some cycles behind
  waiting,  ///< up, and missing something
  hung,     ///< on the bus, without its cyclic samples
  lost,     ///< silent in every way
  absent,   ///< not on the bus
  unknown   ///< possibly well: no samples are kept
};

struct Condition {
  Health health = Health::running;
  std::string words;  ///< after the program's name, such as "is not heard: ..."

  /// True where its samples of the cycle are complete.
  bool heard() const { return health <= Health::late; }
};

/// The condition of a program, be it one of those that move the robot (bridge, behaviors,
/// intentions) or another: at present, or in the past cycle.
Condition condition(const Situation& situation, const std::string& program);

/// The trouble with the programs that move the robot, in words; empty: none.
std::string trouble(const Situation& situation);
/// The same, and that with the robot's place on the map.
std::string all_trouble(const Situation& situation);
/// The programs of the robot that are hung, silent or not on the bus: those that move it, and those
/// that others miss.
std::vector<std::string> unheard(const Situation& situation);
/// Others miss a program whose status has not come: more listening tells.
bool misses(const Situation& situation);
/// A program of this name is heard.
bool is_heard(const std::vector<Program>& programs, const std::string& name);

/// Suspended micro-tasks, such as "follow of behaviors"; empty: none.
std::string suspended(const Situation& situation);

/// The line about the driving program.
std::string driver(const Situation& situation);

/// The contents of `status`, as one JSON object on one line: programs with their health, drive,
/// goals, trouble.
std::string to_json(const Situation& situation);

}  // namespace saphira::situation

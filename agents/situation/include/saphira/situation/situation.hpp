#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "behavior.h"
#include "intention.h"
#include "motion.h"
#include "robot.h"
#include "system.h"

namespace saphira::situation {

/// The status is published once a second: older than this [s], the program is not heard any more.
inline constexpr double kLostAge = 3.0;

/// A program, by the newest of what it says of itself.
struct Program {
  v1::ServiceStatus status;
  double age = 0.0;       ///< [s] since that came
  bool namesake = false;  ///< it says that another program of its name has this robot
};

/// The cycles of which a program's samples are known; 0: none is.
struct Known {
  std::uint64_t oldest = 0;
  std::uint64_t newest = 0;
};

/// All that is known of a robot and its programs: of now, or of a cycle that is past. A plain
/// value: the code that fills it knows the bus and the clock, the code that puts it into words does
/// not. What is not known is left empty.
struct Situation {
  std::uint64_t cycle = 0;  ///< N, the cycle that it is about
  std::uint64_t now = 0;    ///< the robot's newest cycle
  bool past = false;        ///< N was asked for, and is not now
  /// [s] since a robot/state came. Of a robot in single step, which may stand still: 0.
  double silence = 0.0;
  double listened = 0.0;  ///< [s] for so long

  std::optional<v1::RobotState> robot;       ///< of N: what the behaviors saw
  std::optional<v1::Grant> grant;            ///< that let the command for N pass
  std::optional<v1::BehaviorSet> behaviors;  ///< of the cycle that this command answers
  std::optional<v1::Intentions> intentions;  ///< of the cycle before that
  /// These two are those of the program that drives, and not of the services.
  bool own_mind = false;
  Known behaviors_known;
  Known intentions_known;

  std::vector<v1::Goal> goals;              ///< as far as their requesters are still there
  std::vector<v1::GoalStatus> statuses;     ///< as they were then
  bool statuses_known = false;              ///< without one there was no goal
  std::vector<v1::Belief> beliefs;          ///< of now: what activities take to be true
  std::vector<v1::BehaviorSchema> schemas;  ///< for the rules as they are written
  std::vector<Program> programs;            ///< of now
  std::vector<v1::ProcessSet> processes;    ///< of now, of programs that are heard
};

/// How a program is.
enum class Health {
  running,
  fresh,    ///< it runs, and was started a moment ago
  late,     ///< some cycles behind
  waiting,  ///< up, and missing something
  hung,     ///< it is there, and says nothing of what it is to say in each cycle
  lost,     ///< nothing at all is heard of it any more
  absent,   ///< not on the bus
  unknown   ///< it may have been well: nothing of it is kept
};

struct Condition {
  Health health = Health::running;
  std::string words;  ///< behind the program's name, such as "is not heard: ..."

  /// True where what it said in the cycle can be relied on to be all that it had to say.
  bool heard() const { return health <= Health::late; }
};

/// How a program that makes the robot go (bridge, behaviors, intentions), or any other, is: now, or
/// was in the past cycle.
Condition condition(const Situation& situation, const std::string& program);

/// The trouble with the programs that make the robot go, in words; empty: nothing.
std::string trouble(const Situation& situation);
/// Which of them are not on the bus, or not heard, in words such as "behaviors and intentions";
/// empty: all are there.
std::string missing_services(const std::vector<Program>& programs);

/// Micro-tasks that are suspended, such as "follow of behaviors"; empty: none is.
std::string suspended(const Situation& situation);

/// The one line about which program drives.
std::string driver(const Situation& situation);

/// The contents of `status`, as one JSON object on one line: programs with their health, drive,
/// goals, trouble.
std::string to_json(const Situation& situation);

}  // namespace saphira::situation

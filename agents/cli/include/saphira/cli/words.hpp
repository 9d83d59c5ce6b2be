#pragma once

#include <string>
#include <vector>

#include "motion.h"
#include "system.h"

namespace saphira::cli {

/// Enumerators as people read them.
const char* name_of(v1::ServiceState state);
const char* name_of(v1::LogLevel level);
const char* name_of(v1::Role role);
const char* name_of(v1::GuardAction action);

/// What holds until a person releases it, with the command that does: an emergency stop and which
/// program pressed it, or that autonomy waits to be handed the robot back. Empty where neither
/// does.
std::string latched(const v1::Grant& grant);
/// One line: who holds the grant and why, what is latched, and what the guard did.
std::string describe(const v1::Grant& grant);

/// Text in aligned columns; numbers (what starts with a digit) to the right. The first row is the
/// heading. A last column is not padded. Ends with a line break.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// What `saphira status` knows of a process.
struct SeenProcess {
  v1::ServiceStatus status;
  double age = 0.0;       ///< [s] since its newest status came
  bool namesake = false;  ///< it says that another program of its name has this robot
};
/// The status is published once a second: older than this [s], take the process for dead.
inline constexpr double kLostAge = 3.0;

/// The table of processes, sorted by name.
std::string status_table(std::vector<SeenProcess> processes);

/// Which of the services that make a robot go are not among these, in words such as "behaviors and
/// intentions"; empty where all are there and alive.
std::string missing_services(const std::vector<SeenProcess>& processes);

}  // namespace saphira::cli

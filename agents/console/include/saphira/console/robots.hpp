#pragma once

#include <set>
#include <string>
#include <vector>

#include "saphira/idl/types.hpp"
#include "saphira/security/door_keys.hpp"

namespace saphira::console {

/// The robots for the list, its own first, then by name; 32 at most. partitions: those with a
/// bridge or a page. A fleet tool's wildcard is no robot.
std::vector<std::string> robots_of(const std::set<std::string>& partitions, const std::string& own);

/// A robot, as the console hears it.
struct RobotSeen {
  std::string name;
  bool own = false;                       ///< of this console
  std::string trouble{};                  ///< why it is not heard [empty: it may be]
  double age = 0.0;                       ///< [s] of its newest state
  const v1::RobotState* robot = nullptr;  ///< none: no state was ever heard
  const v1::Grant* grant = nullptr;       ///< likewise
  std::string why{};                      ///< what it does and why, in a sentence
  v1::ConsolePage page{};                 ///< of its own console [address empty: none is heard]
};

enum class RobotDoes { silent, stopped, drives, stands };
/// stopped: the emergency stop is latched. A state older than a second is silence.
RobotDoes does(const RobotSeen& seen);

/// For the pages: name, own, does, role, who, why, velocity, battery, trouble, host, address.
std::string to_json(const RobotSeen& seen);

/// A press of the list's stop. latched: the emergency stop, which needs the right to drive;
/// whoever only watches ends whatever moves the robots.
struct StopOrder {
  std::vector<std::string> robots;  ///< to tell, also those that are not heard
  bool latched = false;
  bool well = false;  ///< all of them are heard
  std::string text;   ///< the answer
};
/// chosen: a robot's name; empty: each of them.
StopOrder stop_order(const std::vector<RobotSeen>& seen, const std::string& chosen,
                     security::DoorRight right);

}  // namespace saphira::console

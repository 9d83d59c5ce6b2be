#include "saphira/console/robots.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "saphira/base/robot_name.hpp"
#include "saphira/base/text.hpp"
#include "saphira/idl/members.hpp"

namespace saphira::console {

namespace {

constexpr std::size_t kMostRobots = 32;
constexpr double kRobotSilence = 1.0;  // [s]
constexpr double kMoves = 0.01;        // [m/s], and of a turn [rad/s]

const char* word(RobotDoes does) {
  switch (does) {
    case RobotDoes::silent:
      return "silent";
    case RobotDoes::stopped:
      return "stopped";
    case RobotDoes::drives:
      return "drives";
    case RobotDoes::stands:
      break;
  }
  return "stands";
}

}  // namespace

std::vector<std::string> robots_of(const std::set<std::string>& partitions,
                                   const std::string& own) {
  std::vector<std::string> robots{own};
  for (const std::string& name : partitions)
    if (name != own && trouble_of_robot(name).empty() && robots.size() < kMostRobots)
      robots.push_back(name);
  return robots;
}

RobotDoes does(const RobotSeen& seen) {
  if (seen.robot == nullptr || seen.age > kRobotSilence)
    return RobotDoes::silent;
  if (seen.grant != nullptr && seen.grant->estopped)
    return RobotDoes::stopped;
  return std::abs(seen.robot->velocity) > kMoves || std::abs(seen.robot->rotation_velocity) > kMoves
             ? RobotDoes::drives
             : RobotDoes::stands;
}

std::string to_json(const RobotSeen& seen) {
  nlohmann::json json{{"name", seen.name},           {"own", seen.own}, {"does", word(does(seen))},
                      {"trouble", seen.trouble},     {"why", seen.why}, {"host", seen.page.host},
                      {"address", seen.page.address}};
  if (seen.robot != nullptr) {
    // As people see them: a list that does not change is not sent again.
    json["velocity"] = std::round(20.0 * seen.robot->velocity) / 20.0;
    json["battery"] = std::round(10.0 * seen.robot->battery) / 10.0;
  }
  if (seen.grant != nullptr) {
    json["role"] = v1::name_of(seen.grant->role);
    json["who"] = seen.grant->estopped ? seen.grant->estop_source : seen.grant->source;
  }
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

StopOrder stop_order(const std::vector<RobotSeen>& seen, const std::string& chosen,
                     security::DoorRight right) {
  StopOrder order;
  order.latched = right >= security::DoorRight::drive;
  std::vector<std::string> deaf;
  for (const RobotSeen& robot : seen)
    if (chosen.empty() || robot.name == chosen) {
      order.robots.push_back(robot.name);
      if (does(robot) == RobotDoes::silent)
        deaf.push_back(robot.name);
    }
  order.well = deaf.empty() && !order.robots.empty();
  if (order.robots.empty())
    order.text = "no robot " + chosen + " is in the list";
  else if (deaf.empty())
    order.text = (order.latched ? "emergency stop of " : "stop of ") + joined(order.robots);
  else
    order.text = "NOT HEARD: " + joined(deaf) + "; use the robot's own switch";
  return order;
}

}  // namespace saphira::console

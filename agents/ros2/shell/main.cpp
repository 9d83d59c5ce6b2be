// The robot as one of ROS 2's. README.md.
#include <map>
#include <string>
#include <utility>

#include "ros_robot.hpp"
#include "saphira/bus/namesakes.hpp"
#include "saphira/bus/program.hpp"

namespace {

using namespace saphira;

int serve(const bus::NodeOptions& node_options, ros2::Options options, const bus::Stop& stop) {
  bus::Node node(node_options);
  options.ros.name = "saphira_" + node_options.robot;
  for (char& letter : options.ros.name)
    if (letter == '-' || letter == '.')
      letter = '_';  // ROS 2 has no others
  ros2::RosRobot robot(node, options);
  node.status().state = v1::SERVICE_RUNNING;
  node.info("domain " + std::to_string(options.ros.domain) + " of ROS 2, on " +
            (options.ros.interface.empty() ? "all interfaces" : options.ros.interface));
  if (options.reads_only)
    node.info("nothing that ROS 2 says reaches the robot");
  bus::Namesakes others(node);
  others.act();
  bool told = false;
  while (!stop.requested()) {
    node.wait(cli::kDrivePeriod, &stop);
    v1::ServiceStatus& status = node.status();
    // A second one is right in another domain of ROS 2: it serves, too.
    if (others.poll()) {
      if (!std::exchange(told, true))
        node.warn(status.reason.substr(0, status.reason.find(';')) +
                  ", too: in one domain of ROS 2 both write its topics and both take cmd_vel, so "
                  "that one of them has to end");
      status.state = v1::SERVICE_RUNNING;
      status.reason.clear();
    }
    robot.poll();
  }
  return bus::kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  ros2::Options options;
  unsigned domain = 0;
  std::string cmd_vel = "twist";
  std::string role = "direct";
  std::string distribution;
  bool without_map = false;
  bool without_keys = false;
  return bus::run_program(
      argc, argv, "ros2", "Shows the robot to ROS 2, and lets ROS 2 drive it.",
      [&](CommandLine& app) {
        app.add_option("--ros-domain", domain, "domain of ROS 2")
            .environment("ROS_DOMAIN_ID")
            .in_range(0, 231);
        app.add_option("--ros-interface", options.ros.interface,
                       "address of the one interface for ROS 2; not given: this machine alone "
                       "with the profile host, else all")
            .ipv4();
        app.add_option("--cmd-vel", cmd_vel, "type of cmd_vel").one_of({"twist", "stamped"});
        app.add_option("--role", role, "role in which cmd_vel drives").one_of({"direct", "teleop"});
        app.add_option("--distribution", distribution,
                       "a node for `ros2 node list`, and messages as they are there")
            .one_of({"humble", "iron", "jazzy"});
        app.add_flag("--read-only", options.reads_only, "take no commands and goals of ROS 2");
        app.add_flag("--without-keys", without_keys,
                     "take them on a secured bus, too: ROS 2 has no keys");
        app.add_flag("--without-map", without_map,
                     "another program gives the map, and where odom is on it");
      },
      [&](const bus::NodeOptions& node, const bus::Stop& stop) {
        static const std::map<std::string, ros2::Distribution> distributions{
            {"humble", ros2::Distribution::humble},
            {"iron", ros2::Distribution::iron},
            {"jazzy", ros2::Distribution::jazzy}};
        options.ros.domain = domain;
        // A robot whose bus stays on this machine is not driven from another one by default.
        if (options.ros.interface.empty() && node.profile == bus::Profile::host)
          options.ros.interface = "127.0.0.1";
        options.stamped = cmd_vel == "stamped";
        options.teleop = role == "teleop";
        options.with_map = !without_map;
        const bool is_secured = !node.security.empty() && node.security != bus::kOpenBus;
        options.reads_only = options.reads_only || (is_secured && !without_keys);
        if (!distribution.empty())
          options.distribution = distributions.at(distribution);
        return node.dry_run ? static_cast<int>(bus::kExitOk) : serve(node, options, stop);
      });
}

// An agent: sends the robot to a point and follows it there.
//   go_there X Y       in meters, ahead and to the left of the robot's present place
// The bus comes from the environment: SAPHIRA_ROBOT, SAPHIRA_DOMAIN, SAPHIRA_PROFILE.

#include <chrono>
#include <iostream>
#include <saphira/bus/goal_client.hpp>
#include <saphira/bus/program.hpp>
#include <saphira/command_line/command_line.hpp>

namespace bus = saphira::bus;
namespace v1 = saphira::v1;

int main(int argc, char** argv) {
  double x = 0.0;
  double y = 0.0;
  const auto add_options = [&](saphira::CommandLine& app) {
    app.add_option("x", x, "meters ahead").required();
    app.add_option("y", y, "meters to the left").required();
  };
  const auto body = [&](const bus::NodeOptions& options, const bus::Stop& stop) -> int {
    bus::Node node(options);
    bus::GoalClient goals(node, "go_there");

    v1::Goal goal{.functor = "go_to",
                  .arguments = {bus::point("position", x, y, 0.0, v1::FRAME_ROBOT)}};
    const v1::GoalId id = goals.ask(goal);

    std::string told;
    while (!stop.requested()) {
      node.wait(std::chrono::milliseconds(500), &stop);
      goals.poll();
      const auto status = goals.status(id);
      if (!status)
        continue;
      if (const std::string line = bus::describe(*status); line != told)
        std::cout << (told = line) << std::endl;
      if (bus::ended(status->state))
        return status->state == v1::GOAL_SUCCEEDED ? bus::kExitOk : bus::kExitFailed;
    }
    goals.cancel(id);  // Ctrl-C
    goals.delivered(1000);
    return bus::kExitFailed;
  };
  return bus::run_program(argc, argv, "go_there", "Sends the robot to a point", add_options, body);
}

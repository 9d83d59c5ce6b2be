#include "agent_interface/shell/facilitator_shell.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/command_line/command_line.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  std::string memory;
  return bus::run_program(
      argc, argv, "facilitator", "Routes requests to the agents that can answer them",
      [&](CommandLine& app) {
        app.add_option("--memory", memory,
                       "a file by which a restart repeats no action and no trigger");
      },
      [&](const bus::NodeOptions& options, const bus::Stop& stop) {
        bus::Node node(options);
        using agent_interface::FacilitatorShell;
        do
          FacilitatorShell(node, FacilitatorShell::seconds(), memory).run(stop);
        while (!stop.requested());
        return bus::kExitOk;
      });
}

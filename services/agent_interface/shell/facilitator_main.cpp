#include "agent_interface/shell/facilitator_shell.hpp"
#include "saphira/bus/program.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  return bus::run_program(argc, argv, "facilitator",
                          "Routes requests to the agents that can answer them", {},
                          [](const bus::NodeOptions& options, const bus::Stop& stop) {
                            bus::Node node(options);
                            using agent_interface::FacilitatorShell;
                            FacilitatorShell(node, FacilitatorShell::seconds()).run(stop);
                            return bus::kExitOk;
                          });
}

#include "behaviors/shell/shell.hpp"
#include "saphira/bus/program.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  return bus::run_program(
      argc, argv, "behaviors", "Evaluates the behaviors that are intended and blends them",
      [](CLI::App&) {},
      [](const bus::NodeOptions& node_options, const bus::Stop& stop) {
        bus::Node node(node_options);
        behaviors::Shell(node).run(stop);
        return bus::kExitOk;
      });
}

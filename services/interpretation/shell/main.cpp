#include <CLI/CLI.hpp>

#include "interpretation/shell/shell.hpp"
#include "saphira/bus/program.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  return bus::run_program(
      argc, argv, "interpretation", "Finds walls, doors and corridors in the sonars' readings",
      [](CLI::App&) {},
      [](const bus::NodeOptions& node_options, const bus::Stop& stop) {
        bus::Node node(node_options);
        interpretation::Shell(node).run(stop);
        return bus::kExitOk;
      });
}

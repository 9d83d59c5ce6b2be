#include <CLI/CLI.hpp>

#include "behaviors/shell/shell.hpp"
#include "saphira/bus/program.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  behaviors::ShellOptions options;
  return bus::run_program(
      argc, argv, "behaviors", "Evaluates the behaviors that are intended and blends them",
      [&](CLI::App& app) {
        app.add_option("--behaviors", options.folder,
                       "folder of behavior files; they cover shipped ones of the same name");
        app.add_option("--plugin", options.plugins,
                       "shared library with behaviors in C++; may be given several times");
      },
      [&](const bus::NodeOptions& node_options, const bus::Stop& stop) {
        bus::Node node(node_options);
        behaviors::Shell(node, options).run(stop);
        return bus::kExitOk;
      });
}

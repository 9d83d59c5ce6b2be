#include <CLI/CLI.hpp>
#include <filesystem>

#include "intentions/shell/shell.hpp"
#include "saphira/bus/program.hpp"

namespace {

std::string in_a_folder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  return std::filesystem::is_directory(folder)
             ? ""
             : path + ": expected a file in a folder that exists, and there is no " +
                   folder.string();
}

}  // namespace

int main(int argc, char** argv) {
  using namespace saphira;
  intentions::ShellOptions options;
  return bus::run_program(
      argc, argv, "intentions", "Takes goals from anybody on the bus and intends what they need",
      [&](CLI::App& app) {
        app.add_option("--memory", options.memory_file,
                       "file that remembers ended goals over a restart, so that none is done twice")
            ->check(in_a_folder);
        app.add_flag("!--no-registration", options.registration,
                     "there is no registration service: do not wait for it in lockstep");
        app.add_flag("!--no-interpretation", options.interpretation, "the same of interpretation");
        app.add_flag("--vision", options.vision,
                     "there is a vision service: wait for it in lockstep");
        app.add_option("--activities", options.folder,
                       "folder of activity files; they cover shipped ones of the same name");
      },
      [&](const bus::NodeOptions& node_options, const bus::Stop& stop) {
        bus::Node node(node_options);
        intentions::Shell(node, options).run(stop);
        return bus::kExitOk;
      });
}

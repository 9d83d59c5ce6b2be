#include <CLI/CLI.hpp>

#include "registration/shell/shell.hpp"
#include "saphira/bus/program.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  registration::ShellOptions options;
  return bus::run_program(
      argc, argv, "registration", "Keeps the robot's place on the map true",
      [&](CLI::App& app) {
        app.add_option("--map", options.map_file,
                       "map file, or the name of one that is shipped; none: an empty map");
        app.add_option("--start", options.start,
                       "where the robot is at first: x,y,th [m, rad], the name of a POS of the "
                       "map, or unknown")
            ->capture_default_str();
        app.add_option("--map-memory", options.memory_file,
                       "file that keeps pose and map over a restart");
        app.add_option("--add-features", options.add_features,
                       "whether what is seen and not on the map is added to it; where it is not "
                       "said: only to an empty map");
        app.add_flag("!--no-snap", options.snap, "what is added is not put on right angles");
      },
      [&](const bus::NodeOptions& node_options, const bus::Stop& stop) {
        options.map_file = registration::find_map(options.map_file);
        bus::Node node(node_options);
        registration::Shell(node, options).run(stop);
        return bus::kExitOk;
      });
}

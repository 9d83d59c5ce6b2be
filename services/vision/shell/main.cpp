#include <CLI/CLI.hpp>
#include <array>
#include <string>

#include "saphira/bus/program.hpp"
#include "vision/shell/shell.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  vision::ShellOptions options;
  std::array<double, 3> heights{};
  return bus::run_program(
      argc, argv, "vision", "Finds people in stereo pictures, and what has the camera's colours",
      [&](CLI::App& app) {
        app.add_option("--stereo-socket", options.stereo_socket,
                       "local socket that the pairs of pictures come from");
        app.add_option("--camera-height", options.camera.height,
                       "of the colour camera above the floor [m]")
            ->capture_default_str();
        app.add_option("--camera-forward", options.camera.forward,
                       "of the colour camera before the robot's centre [m]")
            ->capture_default_str();
        for (std::size_t i = 0; i < heights.size(); ++i)
          app.add_option(std::string("--height-") + static_cast<char>('a' + i), heights.at(i),
                         "how high the things of that channel are [m]; without it they are taken "
                         "to stand on the floor")
              ->check(CLI::PositiveNumber);
      },
      [&](const bus::NodeOptions& node_options, const bus::Stop& stop) {
        for (std::size_t i = 0; i < heights.size(); ++i)
          if (heights.at(i) > 0.0)
            options.camera.heights.at(i) = heights.at(i);
        bus::Node node(node_options);
        vision::Shell(node, options).run(stop);
        return bus::kExitOk;
      });
}

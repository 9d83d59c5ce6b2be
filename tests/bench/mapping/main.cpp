// Maps that a simulated robot builds from nothing, exploring, against the maps drawn by hand.
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "drive/building.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  CommandLine app{"Maps built from nothing in simulated worlds, against the maps drawn by hand"};
  std::vector<std::string> worlds{"loop", "office-floor"};
  int seeds = 6;
  int first = 1;
  double errors = 1.0;
  double minutes = 60.0;
  bool no_grid = false;
  bool json = false;
  app.add_option("--world", worlds, "worlds that have a map of the same name");
  app.add_option("--seeds", seeds, "runs in each world").in_range(1, 1000);
  app.add_option("--first", first, "the first seed");
  app.add_option("--errors", errors, "factor on the dead-reckoning errors of the parameter file");
  app.add_option("--minutes", minutes, "of the robot, at most").positive();
  app.add_flag("--no-grid", no_grid, "walls are not snapped to right angles");
  app.add_flag("--json", json, "one JSON object on the last line");
  if (const auto code = app.parse(argc, argv))
    return *code;

  nlohmann::json runs = nlohmann::json::array();
  int whole = 0;
  try {
    for (const std::string& world : worlds) {
      const maps::Map reference =
          maps::load_map(find_file(config_folder() + "/maps", world, ".map"));
      for (int seed = first; seed < first + seeds; ++seed) {
        test::DriveOptions options;
        options.world = world;
        options.seed = static_cast<std::uint64_t>(seed);
        options.errors = errors;
        test::Building built(options, !no_grid);
        built.run(static_cast<std::uint64_t>(minutes * 600.0));
        built.draw(world + "-" + std::to_string(seed));
        const test::MapScore score = test::score(built.aligned_map(), reference);
        const bool complete = built.done() && score.corridors_found == score.corridors &&
                              score.corridors_false == 0 && score.doors_false == 0 &&
                              10 * score.doors_found >= 9 * score.doors &&
                              built.whole.drive().contacts() == 0;
        whole += complete ? 1 : 0;
        const double took = static_cast<double>(built.whole.drive().seen().cycle) / 600.0;
        std::printf(
            "%s %s, seed %d: %.0f min%s, corridors %d/%d and %d false, lengths to %.1f %%, doors "
            "%d/%d and %d false, %d closures, pose to %.2f m, %d contacts;%s\n",
            complete ? "whole" : "NOT  ", world.c_str(), seed, took,
            built.done() ? "" : " (not done)", score.corridors_found, score.corridors,
            score.corridors_false, 100.0 * score.worst_length, score.doors_found, score.doors,
            score.doors_false, built.closures, built.worst, built.whole.drive().contacts(),
            score.text.c_str());
        std::fflush(stdout);
        runs.push_back({{"world", world},
                        {"seed", seed},
                        {"whole", complete},
                        {"done", built.done()},
                        {"minutes", took},
                        {"corridors", score.corridors},
                        {"corridors_found", score.corridors_found},
                        {"corridors_false", score.corridors_false},
                        {"worst_length", score.worst_length},
                        {"doors", score.doors},
                        {"doors_found", score.doors_found},
                        {"doors_false", score.doors_false},
                        {"pose_worst_m", built.worst},
                        {"contacts", built.whole.drive().contacts()}});
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "saphira-bench-mapping: %s\n", error.what());
    return 1;
  }
  std::printf("%d of %zu maps whole: every corridor to 3 %%, nine of ten doors, nothing false\n",
              whole, runs.size());
  if (json)
    std::printf(
        "%s\n",
        nlohmann::json{{"errors", errors}, {"grid", !no_grid}, {"whole", whole}, {"runs", runs}}
            .dump()
            .c_str());
  return 0;
}

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "perception/score.hpp"

// saphira-bench-perception [--json] [--seeds N] [--errors E] [--seconds S] [--verbose]

namespace {

using namespace saphira;
using namespace saphira::test;

struct Options {
  bool json = false;
  bool verbose = false;
  int seeds = 3;
  double errors = 1.0;
  double seconds = 900.0;
  std::string world = "office-floor";
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::string value = i + 1 < argc ? argv[i + 1] : "";
    if (word == "--json")
      options.json = true;
    else if (word == "--verbose")
      options.verbose = true;
    else if (word == "--seeds")
      options.seeds = std::atoi(value.c_str()), ++i;
    else if (word == "--errors")
      options.errors = std::atof(value.c_str()), ++i;
    else if (word == "--seconds")
      options.seconds = std::atof(value.c_str()), ++i;
    else if (word == "--world")
      options.world = value, ++i;
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  for (int seed = 1; seed <= options.seeds; ++seed) {
    DriveOptions drive_options;
    drive_options.world = options.world;
    drive_options.seed = static_cast<std::uint64_t>(seed);
    drive_options.errors = options.errors;
    Drive drive(drive_options);
    interpretation::Interpretation interpretation(settings_of(drive));
    Score score(drive, map_of(options.world));
    Tour tour(patrol(options.world), true);
    std::vector<double> ms;
    while (static_cast<double>(drive.seen().cycle) < options.seconds * 10.0) {
      tour.act(drive, drive.seen().true_pose_in_world);
      const Seen& seen = drive.advance();
      const auto before = std::chrono::steady_clock::now();
      const auto& output = interpretation.step({seen.cycle, seen.pose_in_odom, seen.readings});
      ms.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before)
              .count());
      score.look(drive, output);
    }
    std::printf("seed %d: reached %zu contacts %d\n", seed, tour.reached(), drive.contacts());
    for (const auto& [type, name] :
         {std::pair{lps::PointType::wall, "walls"}, std::pair{lps::PointType::door, "doors"},
          std::pair{lps::PointType::junction, "junctions"},
          std::pair{lps::PointType::breach, "breaches"},
          std::pair{lps::PointType::corridor, "corridors"}}) {
      const Count count = score.count(type);
      std::printf("  %-10s %4d reported, %4d real: %.3f\n", name, count.reported, count.real,
                  count.precision());
    }
    std::printf("  doors passed %d found %d: %.3f\n", score.doors_passed(), score.doors_found(),
                score.recall());
    std::printf("  wall offset p50 %.3f p95 %.3f (sigmas p95 %.2f) heading p95 %.2f deg (%.2f)\n",
                quantile(score.wall_offset, .5), quantile(score.wall_offset, .95),
                quantile(score.wall_offset_sigmas, .95), degrees(quantile(score.wall_heading, .95)),
                quantile(score.wall_heading_sigmas, .95));
    std::printf("  door place p50 %.3f p95 %.3f (%.2f) width p50 %.3f p95 %.3f\n",
                quantile(score.door_place, .5), quantile(score.door_place, .95),
                quantile(score.door_place_sigmas, .95), quantile(score.door_width, .5),
                quantile(score.door_width, .95));
    std::printf("  breach place p50 %.3f p95 %.3f (%.2f)\n", quantile(score.breach_place, .5),
                quantile(score.breach_place, .95), quantile(score.breach_place_sigmas, .95));
    std::printf("  cycle ms p50 %.4f p99 %.4f\n", quantile(ms, .5), quantile(ms, .99));
    if (options.verbose) {
      for (const Mistake& m : score.mistakes())
        std::printf(
            "    false type %d at %.2f %.2f %.0f deg, length %.2f width %.2f conf %.2f n "
            "%zu cycle %llu side %d sigmas %.3f %.3f %.2f\n",
            static_cast<int>(m.percept.type), m.pose_in_world.x, m.pose_in_world.y,
            degrees(m.pose_in_world.th), m.percept.length, m.percept.width, m.percept.confidence,
            m.percept.readings.size(), static_cast<unsigned long long>(m.cycle),
            static_cast<int>(m.percept.side), m.percept.sigma_along, m.percept.sigma_across,
            degrees(m.percept.sigma_heading));
      for (const auto& [id, cycle] : score.missed())
        std::printf("    missed %u at cycle %llu\n", id, static_cast<unsigned long long>(cycle));
    }
  }
  return 0;
}

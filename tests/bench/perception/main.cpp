#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "perception/score.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/quantile.hpp"

// saphira-bench-perception: percepts and grids against the ground truth, and the cost of a cycle.

namespace {

using namespace saphira;
using namespace saphira::test;

struct Options {
  bool json = false;
  bool verbose = false;
  int seeds = 5;
  double errors = 2.0;
  double seconds = 900.0;
  std::string world = "office-floor";
};

// CPU time of this thread, without other work on the machine.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / 1e9;
}

constexpr std::array<std::pair<lps::PointType, const char*>, 5> kKinds{
    {{lps::PointType::wall, "walls"},
     {lps::PointType::door, "doors"},
     {lps::PointType::junction, "junctions"},
     {lps::PointType::breach, "single_ends"},
     {lps::PointType::corridor, "corridors"}}};

struct Result {
  std::array<Count, kKinds.size()> counts;
  int passed = 0;
  int found = 0;
  int contacts = 0;
  std::vector<double> ms;
  std::uint64_t cells = 0;
  std::vector<double> wall_offset, wall_heading, wall_offset_sigmas, wall_heading_sigmas;
  std::vector<double> door_place, door_place_sigmas, door_width, end_place, end_place_sigmas;
  std::array<GridScore, 2> grids;  // see compare_grids
};

void append(std::vector<double>& all, const std::vector<double>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

DriveOptions drive_options(const Options& options, int seed, double errors) {
  DriveOptions drive;
  drive.world = options.world;
  drive.seed = static_cast<std::uint64_t>(seed);
  drive.errors = errors;
  return drive;
}

void percepts(const Options& options, int seed, Result& result) {
  DriveOptions with_interpretation = drive_options(options, seed, options.errors);
  with_interpretation.interpretation = true;
  with_interpretation.clock = cpu_seconds;
  Drive drive(with_interpretation);
  Score score(drive, map_of(options.world));
  Tour tour(patrol(options.world), true);
  while (static_cast<double>(drive.seen().cycle) < options.seconds * 10.0) {
    tour.act(drive, drive.seen().true_pose_in_world);
    drive.advance();
    result.ms.push_back(1e3 * drive.cores().interpretation_took());
    score.look(drive);
  }
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    const Count count = score.count(kKinds[i].first);
    result.counts[i].reported += count.reported;
    result.counts[i].real += count.real;
  }
  result.passed += score.doors_passed();
  result.found += score.doors_found();
  result.contacts += drive.contacts();
  result.cells += drive.cores().interpretation().grid().updates();
  append(result.wall_offset, score.wall_offset);
  append(result.wall_heading, score.wall_heading);
  append(result.wall_offset_sigmas, score.wall_offset_sigmas);
  append(result.wall_heading_sigmas, score.wall_heading_sigmas);
  append(result.door_place, score.door_place);
  append(result.door_place_sigmas, score.door_place_sigmas);
  append(result.door_width, score.door_width);
  append(result.end_place, score.breach_place);
  append(result.end_place_sigmas, score.breach_place_sigmas);
  if (!options.verbose)
    return;
  for (const Mistake& m : score.mistakes())
    std::fprintf(stderr,
                 "seed %d cycle %llu: no such thing, type %d at %.2f %.2f, %.0f degrees, length "
                 "%.2f width %.2f confidence %.2f\n",
                 seed, static_cast<unsigned long long>(m.cycle), static_cast<int>(m.percept.type),
                 m.pose_in_world.x, m.pose_in_world.y, degrees(m.pose_in_world.th),
                 m.percept.length, m.percept.width, m.percept.confidence);
  for (const Passage& passage : score.passages())
    if (!passage.found)
      std::fprintf(stderr, "seed %d cycle %llu: door %u passed and not found\n", seed,
                   static_cast<unsigned long long>(passage.cycle), passage.door);
}

void print(const Options& options, const Result& result) {
  const double ms = std::max(1e-9, quantile(result.ms, 0.5));
  double all = 0.0;
  for (const double one : result.ms)
    all += one;
  const double cells = static_cast<double>(result.cells) / (all / 1e3);
  const double recall =
      result.passed == 0 ? 0.0 : static_cast<double>(result.found) / result.passed;
  if (options.json) {
    std::printf(
        "{\"world\":\"%s\",\"seeds\":%d,\"seconds\":%g,\"errors\":%g,"
        "\"cycle_ms_p50\":%.4f,\"cycle_ms_p99\":%.4f,\"cells_per_second\":%.0f,",
        options.world.c_str(), options.seeds, options.seconds, options.errors, ms,
        quantile(result.ms, 0.99), cells);
    for (std::size_t i = 0; i < kKinds.size(); ++i)
      std::printf("\"%s_reported\":%d,\"%s_precision\":%.4f,", kKinds[i].second,
                  result.counts[i].reported, kKinds[i].second, result.counts[i].precision());
    std::printf(
        "\"doors_passed\":%d,\"doors_recall\":%.4f,\"wall_offset_p95_m\":%.4f,"
        "\"wall_heading_p95_deg\":%.3f,\"door_place_p95_m\":%.4f,\"door_width_p95_m\":%.4f,"
        "\"single_end_place_p95_m\":%.4f",
        result.passed, recall, quantile(result.wall_offset, 0.95),
        degrees(quantile(result.wall_heading, 0.95)), quantile(result.door_place, 0.95),
        quantile(result.door_width, 0.95), quantile(result.end_place, 0.95));
    for (std::size_t i = 0; i < 2; ++i) {
      const GridScore& grid = result.grids[i];
      const char* name = i == 0 ? "muriel" : "cone";
      std::printf(
          ",\"%s_walls_kept\":%.4f,\"%s_doorways_blocked\":%.4f,\"%s_free_wrong\":%.5f,"
          "\"%s_auc\":%.4f",
          name, grid.walls, name, grid.doorways.value_or(0.0), name, grid.free, name, grid.auc);
    }
    std::printf("}\n");
    return;
  }
  std::printf("%s, %d tours of %g s, errors of dead reckoning times %g, %d contacts\n\n",
              options.world.c_str(), options.seeds, options.seconds, options.errors,
              result.contacts);
  std::printf("%-12s %8s %8s %9s\n", "", "reported", "real", "precision");
  for (std::size_t i = 0; i < kKinds.size(); ++i)
    std::printf("%-12s %8d %8d %9.4f\n", kKinds[i].second, result.counts[i].reported,
                result.counts[i].real, result.counts[i].precision());
  std::printf("doors passed %d, found %d: recall %.4f\n\n", result.passed, result.found, recall);
  std::printf("%-28s %8s %8s %16s\n", "error", "p50", "p95", "p95 in its sigmas");
  const auto row = [](const char* name, const std::vector<double>& errors, double unit,
                      const std::vector<double>& sigmas) {
    std::printf("%-28s %8.3f %8.3f", name, unit * quantile(errors, 0.5),
                unit * quantile(errors, 0.95));
    if (sigmas.empty())
      std::printf("\n");
    else
      std::printf(" %16.2f\n", quantile(sigmas, 0.95));
  };
  row("wall, across [m]", result.wall_offset, 1.0, result.wall_offset_sigmas);
  row("wall, heading [degrees]", result.wall_heading, 180.0 / kPi, result.wall_heading_sigmas);
  row("door, along its wall [m]", result.door_place, 1.0, result.door_place_sigmas);
  row("door, width [m]", result.door_width, 1.0, {});
  row("single end [m]", result.end_place, 1.0, result.end_place_sigmas);
  std::printf("\n%-10s %12s %18s %14s %8s\n", "grid", "walls kept", "doorways blocked",
              "free is wrong", "AUC");
  for (std::size_t i = 0; i < 2; ++i)
    std::printf("%-10s %12.3f %18.3f %14.4f %8.3f\n", i == 0 ? "MURIEL" : "cone",
                result.grids[i].walls, result.grids[i].doorways.value_or(0.0), result.grids[i].free,
                result.grids[i].auc);
  std::printf("\ncycle_ms_p50 %.3f, cycle_ms_p99 %.3f (CPU), %.1f million cells a second of CPU\n",
              ms, quantile(result.ms, 0.99), cells / 1e6);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine app{
      "Tours of simulated worlds: percepts and grids against the truth, and the cost of a cycle"};
  app.add_flag("--json", options.json, "one line of JSON instead of text");
  app.add_option("--seeds", options.seeds, "tours, each with its own seed").in_range(1, 1000000);
  app.add_option("--seconds", options.seconds, "of the robot's time for each");
  app.add_option("--errors", options.errors, "factor on the errors of dead reckoning");
  app.add_option("--world", options.world, "the world of the tours")
      .one_of({"office-floor", "loop", "small-office", "visitors", "cluttered"});
  app.add_flag("--verbose", options.verbose, "lists what was wrong and what was missed");
  if (const auto code = app.parse(argc, argv))
    return *code;
  Result result;
  for (int seed = 1; seed <= options.seeds; ++seed)
    percepts(options, seed, result);
  result.grids = compare_grids(drive_options(options, 1, 1.0),
                               static_cast<std::uint64_t>(options.seconds * 10.0));
  print(options, result);
  return 0;
}

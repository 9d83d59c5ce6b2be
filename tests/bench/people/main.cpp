// Every robot with sonars crosses every world, past people who stand and walk in it.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "bench/study.hpp"
#include "crossing.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"

namespace saphira::test {
namespace {

using bench::Tally;

struct Run {
  CrossingOptions options;
  bool possible = false;
  bool has_way = true;
  double length = 0.0;
  CrossingResult result;
};

protocol::RobotParameters parameters_of(const std::string& robot) {
  return protocol::load_parameters(find_file(config_folder() + "/robots", robot, ".p"));
}

Crowd crowd_of(const std::string& name) {
  const auto* const found = std::find(std::begin(kCrowdNames), std::end(kCrowdNames), name);
  if (found == std::end(kCrowdNames))
    throw std::invalid_argument("--people " + name + ": nobody, usual, corridor, doorway, inside " +
                                "or beside");
  return static_cast<Crowd>(found - std::begin(kCrowdNames));
}

void drive(Run& run, const sim::SonarModel& sonar, bool trace) {
  const auto crossing = plan_crossing(run.options, parameters_of(run.options.robot));
  if (!crossing)
    return;
  run.possible = true;
  run.length = crossing->length;
  run.has_way = crossing->has_way;
  run.result = drive_crossing(*crossing, run.options, sonar, trace);
}

void print(const Run& run) {
  const CrossingResult& result = run.result;
  std::printf("%-12s %-12s %-8s seed %2llu: ", run.options.robot.c_str(), run.options.world.c_str(),
              kCrowdNames[static_cast<int>(run.options.crowd)],
              static_cast<unsigned long long>(run.options.seed));
  if (!run.possible)
    std::printf("no such way for this robot\n");
  else
    std::printf(
        "%s %4.1f m in %5.1f s, nearest to a person %5.2f m, touched %d who stood, %d who walked "
        "(%d unheard), %d walked into the robot, %d things; ended at (%.1f, %.1f)\n",
        result.arrived ? "arrived   "
        : run.has_way  ? "NOT THERE "
                       : "no way    ",
        run.length, result.seconds, result.closest, result.standing, result.walking, result.unheard,
        result.walked_into, result.things, result.end_in_world.x(), result.end_in_world.y());
}

/// Of the runs of one robot, or of one crowd: `seconds_alone` is the time of the same robot in the
/// same world without people.
void add(Tally& sum, const Run& run, double seconds_alone) {
  const CrossingResult& result = run.result;
  ++sum["runs"];
  sum["touched_standing"] += result.standing;
  sum["touched_walking"] += result.walking;
  sum["unheard"] += result.unheard;
  sum["things"] += result.things;
  sum["walked_into"] += result.walked_into;
  sum["with_way"] += run.has_way ? 1 : 0;
  if (!run.has_way || !result.arrived)
    return;
  ++sum["arrived"];
  if (seconds_alone > 0.0) {
    sum.values["seconds"].push_back(result.seconds);
    sum.values["alone"].push_back(seconds_alone);
  }
}

nlohmann::json figures_of(const Tally& sum) {
  nlohmann::json figures{
      {"runs", sum("runs")},
      {"arrived_percent", 100.0 * sum.share("arrived", "with_way")},
      {"slower", sum.sum("alone") > 0.0 ? sum.sum("seconds") / sum.sum("alone") : 0.0}};
  for (const char* const kind :
       {"touched_standing", "touched_walking", "unheard", "things", "walked_into"})
    figures[kind] = 100.0 * sum.share(kind, "runs");
  return figures;
}

}  // namespace
}  // namespace saphira::test

int main(int argc, char** argv) {
  using namespace saphira;
  using namespace saphira::test;
  CommandLine app{"Robots cross worlds in which people stand and walk"};
  std::vector<std::string> robots;
  std::vector<std::string> worlds;
  std::vector<std::string> crowds;
  int seeds = 10;
  std::uint64_t first = 1;
  CrossingOptions usual;
  int jobs = 2;
  sim::SonarModel sonar;
  bool trace = false;
  bool quiet = false;
  bool json = false;
  app.add_option("--robot", robots, "of config/robots; without it: all that have sonars");
  app.add_option("--world", worlds, "of config/worlds; without it: all");
  app.add_option("--seeds", seeds, "runs of each robot in each world").in_range(1, 1000);
  app.add_option("--first", first, "the first seed");
  app.add_option("--people", crowds,
                 "nobody, usual, corridor, doorway, inside, beside; without it: all");
  app.add_option("--most", usual.most, "[m] length of the way");
  app.add_option("--jobs", jobs, "runs at the same time").in_range(1, 64);
  app.add_option("--strength", sonar.strength, "[dB] of the sonars: real ones have 36 to 47");
  app.add_option("--cloth", sonar.cloth, "[dB] that people's clothes swallow: 2 to 10");
  app.add_flag("--trace", trace, "prints each contact (with --jobs 1 in order)");
  app.add_flag("--quiet", quiet, "only what went wrong, and the sum");
  app.add_flag("--json", json, "one JSON object on the last line");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] {
    if (robots.empty())
      for (const std::string& name : names_in(config_folder() + "/robots", ".p"))
        if (!parameters_of(name).sonars.empty())
          robots.push_back(name);
    if (worlds.empty())
      worlds = names_in(config_folder() + "/worlds", ".wld");
    if (crowds.empty())
      crowds.assign(std::begin(kCrowdNames), std::end(kCrowdNames));
    std::vector<Run> runs;
    for (const std::string& robot : robots)
      for (const std::string& world : worlds)
        for (const std::string& crowd : crowds)
          for (int i = 0; i < seeds; ++i) {
            Run run;
            run.options = usual;
            run.options.robot = robot;
            run.options.world = world;
            run.options.crowd = crowd_of(crowd);
            run.options.seed = first + static_cast<std::uint64_t>(i);
            // Every other person is wider than the shins that a sonar hears.
            run.options.body = run.options.seed % 2 == 0 ? 0.3 : 0.25;
            runs.push_back(run);
          }
    std::atomic<std::size_t> next{0};
    std::vector<std::future<void>> workers;
    for (int worker = 0; worker < jobs; ++worker)
      workers.push_back(std::async(std::launch::async, [&] {
        for (std::size_t i = next++; i < runs.size(); i = next++)
          drive(runs[i], sonar, trace);
      }));
    for (std::future<void>& worker : workers)
      worker.get();

    std::map<std::pair<std::string, std::string>, std::vector<double>> alone;  // [s]
    for (const Run& run : runs)
      if (run.options.crowd == Crowd::kNobody && run.result.arrived)
        alone[{run.options.robot, run.options.world}].push_back(run.result.seconds);
    Tally all;
    std::map<std::string, Tally> by_robot;
    std::map<std::string, Tally> by_crowd;
    double alone_s = 0.0;
    for (const Run& run : runs) {
      const CrossingResult& result = run.result;
      const bool bad = run.possible && ((run.has_way && !result.arrived) ||
                                        result.standing + result.walking + result.things > 0);
      if (!quiet || bad)
        print(run);
      if (!run.possible)
        continue;
      const std::vector<double>& times = alone[{run.options.robot, run.options.world}];
      const double seconds_alone = times.empty()
                                       ? 0.0
                                       : std::accumulate(times.begin(), times.end(), 0.0) /
                                             static_cast<double>(times.size());
      add(by_crowd[kCrowdNames[static_cast<int>(run.options.crowd)]], run, seconds_alone);
      if (run.options.crowd == Crowd::kNobody) {
        alone_s += result.seconds;
        continue;
      }
      add(all, run, seconds_alone);
      add(by_robot[run.options.robot], run, seconds_alone);
    }
    nlohmann::json figures = figures_of(all);
    for (const auto& [robot, sum] : by_robot)
      figures["robots"][robot] = figures_of(sum);
    for (const auto& [crowd, sum] : by_crowd)
      figures["people"][crowd] = figures_of(sum);
    figures["alone_s"] = alone_s;
    bench::print(figures, json);
    return figures["touched_standing"] <= 1.0 && figures["touched_walking"] <= 5.0 &&
                   figures["arrived_percent"] >= 90.0
               ? 0
               : 1;
  });
}

// Every robot with sonars crosses every world, past people who stand and walk in it.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "../result.hpp"
#include "crossing.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"

namespace saphira::test {
namespace {

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

/// The runs of one robot, or of one crowd.
struct Sum {
  int runs = 0;
  int with_way = 0;
  int arrived = 0;  ///< of those with a way
  int standing = 0;
  int walking = 0;
  int unheard = 0;
  int things = 0;
  int walked_into = 0;
  double seconds = 0.0;  ///< of those who arrived...
  double alone = 0.0;    ///< ...and of the same robots in the same worlds without people

  void add(const Run& run, double seconds_alone) {
    const CrossingResult& result = run.result;
    ++runs;
    standing += result.standing;
    walking += result.walking;
    unheard += result.unheard;
    things += result.things;
    walked_into += result.walked_into;
    if (!run.has_way)
      return;
    ++with_way;
    if (!result.arrived)
      return;
    ++arrived;
    if (seconds_alone > 0.0) {
      seconds += result.seconds;
      alone += seconds_alone;
    }
  }
  double slower() const { return alone > 0.0 ? seconds / alone : 0.0; }
  double in_100(int count) const { return runs == 0 ? 0.0 : 100.0 * count / runs; }
  double arrived_percent() const { return with_way == 0 ? 0.0 : 100.0 * arrived / with_way; }
  nlohmann::json json() const {
    return {{"runs", runs},
            {"arrived_percent", arrived_percent()},
            {"touched_standing", in_100(standing)},
            {"touched_walking", in_100(walking)},
            {"unheard", in_100(unheard)},
            {"things", in_100(things)},
            {"walked_into", in_100(walked_into)},
            {"slower", slower()}};
  }
};

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
    std::vector<std::thread> workers;
    std::vector<std::string> troubles(static_cast<std::size_t>(jobs));
    for (std::size_t worker = 0; worker < troubles.size(); ++worker)
      workers.emplace_back([&, worker] {
        try {
          for (std::size_t i = next++; i < runs.size(); i = next++)
            drive(runs[i], sonar, trace);
        } catch (const std::exception& error) {
          troubles[worker] = error.what();
        }
      });
    for (std::thread& worker : workers)
      worker.join();
    for (const std::string& trouble : troubles)
      if (!trouble.empty())
        throw std::runtime_error(trouble);

    // [s] and runs without people, by robot and world
    std::map<std::pair<std::string, std::string>, std::pair<double, int>> alone;
    for (const Run& run : runs)
      if (run.options.crowd == Crowd::kNobody && run.result.arrived) {
        auto& [seconds, count] = alone[{run.options.robot, run.options.world}];
        seconds += run.result.seconds;
        ++count;
      }
    Sum all;
    std::map<std::string, Sum> by_robot;
    std::array<Sum, std::size(kCrowdNames)> by_crowd;
    double alone_s = 0.0;
    for (const Run& run : runs) {
      const CrossingResult& result = run.result;
      const bool bad = run.possible && ((run.has_way && !result.arrived) ||
                                        result.standing + result.walking + result.things > 0);
      if (!quiet || bad)
        print(run);
      if (!run.possible)
        continue;
      const auto found = alone.find({run.options.robot, run.options.world});
      const double seconds_alone =
          found == alone.end() ? 0.0 : found->second.first / found->second.second;
      by_crowd[static_cast<std::size_t>(run.options.crowd)].add(run, seconds_alone);
      if (run.options.crowd == Crowd::kNobody) {
        alone_s += result.seconds;
        continue;
      }
      all.add(run, seconds_alone);
      by_robot[run.options.robot].add(run, seconds_alone);
    }
    nlohmann::json figures = all.json();
    for (const auto& [robot, sum] : by_robot)
      figures["robots"][robot] = sum.json();
    for (std::size_t i = 0; i < by_crowd.size(); ++i)
      if (by_crowd[i].runs > 0)
        figures["people"][kCrowdNames[i]] = by_crowd[i].json();
    figures["alone_s"] = alone_s;
    bench::print(figures, json);
    return all.in_100(all.standing) <= 1.0 && all.in_100(all.walking) <= 5.0 &&
                   all.arrived_percent() >= 90.0
               ? 0
               : 1;
  });
}

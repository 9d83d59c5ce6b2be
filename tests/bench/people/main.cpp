// Every robot with sonars crosses every world, with people standing and walking in it.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "crossing.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"
#include "support/quantile.hpp"

namespace saphira::test {
namespace {

struct Run {
  CrossingOptions options;
  bool possible = false;
  double length = 0.0;
  CrossingResult result;
};

protocol::RobotParameters parameters_of(const std::string& robot) {
  return protocol::load_parameters(find_file(config_folder() + "/robots", robot, ".p"));
}

void drive(Run& run, const sim::SonarModel& sonar, bool trace) {
  const auto crossing = plan_crossing(run.options, parameters_of(run.options.robot));
  if (!crossing)
    return;
  run.possible = true;
  run.length = crossing->length;
  run.result = drive_crossing(*crossing, run.options, sonar, trace);
}

void print(const Run& run) {
  const CrossingResult& result = run.result;
  std::printf("%-12s %-12s seed %2llu: ", run.options.robot.c_str(), run.options.world.c_str(),
              static_cast<unsigned long long>(run.options.seed));
  if (!run.possible)
    std::printf("no way for this robot\n");
  else
    std::printf(
        "%s %4.1f m in %5.1f s, nearest to a person %5.2f m, contacts: %d caused, %d walked into "
        "the robot, %d unseen, %d with things (%d caused); ended at (%.1f, %.1f)\n",
        result.arrived ? "arrived   " : "NOT THERE ", run.length, result.seconds, result.closest,
        result.caused, result.walked_into, result.unseen, result.things + result.other_things,
        result.things, result.end_in_world.x(), result.end_in_world.y());
}

}  // namespace
}  // namespace saphira::test

int main(int argc, char** argv) {
  using namespace saphira;
  using namespace saphira::test;
  CommandLine app{"Robots cross worlds in which people stand and walk"};
  std::vector<std::string> robots;
  std::vector<std::string> worlds;
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
  app.add_option("--standing", usual.standing, "people who stand on the way or beside it");
  app.add_option("--walking", usual.walking, "people who walk along the way");
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
    std::vector<Run> runs;
    for (const std::string& robot : robots)
      for (const std::string& world : worlds)
        for (int i = 0; i < seeds; ++i) {
          Run run;
          run.options = usual;
          run.options.robot = robot;
          run.options.world = world;
          run.options.seed = first + static_cast<std::uint64_t>(i);
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

    int possible = 0;
    int arrived = 0;
    CrossingResult sum;
    std::vector<double> closest;
    for (const Run& run : runs) {
      const CrossingResult& result = run.result;
      const bool bad =
          run.possible && (!result.arrived || result.caused + result.walked_into + result.unseen +
                                                      result.things + result.other_things >
                                                  0);
      if (!quiet || bad)
        print(run);
      if (!run.possible)
        continue;
      ++possible;
      arrived += result.arrived ? 1 : 0;
      sum.caused += result.caused;
      sum.walked_into += result.walked_into;
      sum.unseen += result.unseen;
      sum.things += result.things;
      sum.other_things += result.other_things;
      if (std::isfinite(result.closest))
        closest.push_back(result.closest);
    }
    const double closest_p50 = closest.empty() ? 0.0 : quantile(closest, 0.5);
    std::printf(
        "%d of %d arrived (%zu planned; the others have no way of 2 m for the robot). Contacts "
        "with people: %d caused by the robot, %d walked into it, %d unseen; with things: %d "
        "caused, %d others. Nearest to a person, median %.2f m\n",
        arrived, possible, runs.size(), sum.caused, sum.walked_into, sum.unseen, sum.things,
        sum.other_things, closest_p50);
    if (json)
      std::printf("%s\n", nlohmann::json{{"runs", possible},
                                         {"arrived", arrived},
                                         {"contacts_caused", sum.caused + sum.things},
                                         {"contacts_other",
                                          sum.walked_into + sum.unseen + sum.other_things},
                                         {"people_caused", sum.caused},
                                         {"people_walked_into", sum.walked_into},
                                         {"people_unseen", sum.unseen},
                                         {"things_caused", sum.things},
                                         {"things_other", sum.other_things},
                                         {"closest_m_p50", closest_p50}}
                              .dump()
                              .c_str());
    return sum.caused == 0 && sum.things == 0 && arrived == possible ? 0 : 1;
  });
}

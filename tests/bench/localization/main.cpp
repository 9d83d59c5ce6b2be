// Ten simulated hours of patrol in the office floor with twice the Pioneer's errors, and the rates
// of finding the pose without a start and after being carried away.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>

#include "localization/patrol.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"
#include "support/quantile.hpp"

namespace {

using namespace saphira;
using registration::State;

struct Options {
  int seeds = 10;
  double hours = 1.0;
  double errors = 2.0;
  bool corridors = false;
  bool json = false;
};

/// CPU time of this process alone, without other work on the machine.
double seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

maps::Map map_of(const std::string& name) {
  return maps::load_map(find_file(config_folder() + "/maps", name, ".map"));
}

test::DriveOptions drive_of(const Options& options, int seed) {
  test::DriveOptions drive;
  drive.seed = static_cast<std::uint64_t>(seed);
  drive.errors = options.errors;
  return drive;
}

struct Found {
  double way = -1.0;      // [m] until it reported tracking; negative: never
  double off = 0.0;       // [m] error then
  double said_lost = -1;  // [m] until it reported to be lost
};

/// The tour is driven by the true pose, since a lost robot cannot drive to a place.
Found find(test::Drive& robot, std::vector<Vec2> points, int cycles) {
  Found found;
  test::Tour tour(std::move(points), true);
  Vec2 last = robot.truth().position();
  double way = 0.0;
  bool searched = false;
  for (int i = 0; i < cycles && found.way < 0.0; ++i) {
    tour.act(robot, robot.truth());
    robot.advance();
    const registration::Core::Outputs& output = robot.registered();
    way += (robot.truth().position() - last).norm();
    last = robot.truth().position();
    if (output.state != State::tracking && !searched) {
      searched = true;
      found.said_lost = way;
    }
    const double off = (output.pose_in_map.position() - last).norm();
    if (output.state == State::tracking && (searched || off < 0.5)) {
      found.way = way;
      found.off = off;
    }
  }
  return found;
}

int run(const Options& options) {
  const maps::Map map = map_of("office-floor");
  test::Offs all;
  test::Offs reckoned;
  std::vector<double> took;
  double way = 0.0;
  int not_tracking = 0;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    test::DriveOptions drive = drive_of(options, seed);
    drive.clock = seconds;
    test::Drive robot(test::registered_on(map, std::move(drive)));
    const test::PatrolResult result = test::patrol(robot, test::office_tour(!options.corridors),
                                                   static_cast<int>(options.hours * 36000.0));
    way += result.way;
    not_tracking += result.not_tracking;
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(all.position, result.registered.position);
    append(all.heading, result.registered.heading);
    append(reckoned.position, result.reckoned.position);
    append(took, result.took);
    if (!options.json)
      std::printf(
          "seed %2d: %5.0f m, registered p95 %.3f m %.2f deg, worst %.2f m; not tracking %d "
          "cycles; "
          "dead reckoning p95 %.1f m\n",
          seed, result.way, test::quantile(result.registered.position, 0.95),
          degrees(test::quantile(result.registered.heading, 0.95)),
          test::quantile(result.registered.position, 1.0), result.not_tracking,
          test::quantile(result.reckoned.position, 0.95));
  }
  // Without a pose, from different places; and carried from one corridor to another.
  int found = 0;
  int wrong = 0;
  std::vector<double> ways;
  int recovered = 0;
  int astray = 0;
  std::vector<double> lost_ways;
  std::vector<double> recovery_ways;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    test::DriveOptions drive = drive_of(options, seed);
    std::vector<Vec2> points = test::office_tour();
    std::rotate(points.begin(),
                points.begin() + static_cast<std::ptrdiff_t>(3) * seed %
                                     static_cast<std::ptrdiff_t>(points.size()),
                points.end());
    const Vec2 ahead = points[1] - points[0];
    drive.start_in_world = Pose{points[0].x(), points[0].y(), std::atan2(ahead.y(), ahead.x())};
    std::rotate(points.begin(), points.begin() + 1, points.end());
    test::Drive robot(test::registered_on(map, drive, false));
    const Found result = find(robot, points, 3000);
    if (result.way >= 0.0) {
      ++(result.off < 0.5 ? found : wrong);
      ways.push_back(result.way);
    }
    // The same robot continues for a while, and is carried to the east corridor.
    test::Tour tour(points, true);
    for (int i = 0; i < 600; ++i) {
      tour.act(robot, robot.truth());
      robot.advance();
    }
    if (!robot.robot().place({25.6, 12.0 + 0.7 * (seed % 5), kPi / 2}))
      continue;
    // From here on the reports of being lost, and the pose found afterwards, count.
    Found after;
    {
      test::Tour there({{25.6, 24.0},
                        {24.0, 25.0},
                        {17.5, 25.0},
                        {17.5, 9.0},
                        {19.0, 7.0},
                        {24.6, 7.0},
                        {25.6, 8.5}},
                       true);
      Vec2 last = robot.truth().position();
      double gone = 0.0;
      for (int i = 0; i < 3000; ++i) {
        there.act(robot, robot.truth());
        robot.advance();
        const registration::Core::Outputs& output = robot.registered();
        gone += (robot.truth().position() - last).norm();
        last = robot.truth().position();
        const double off = (output.pose_in_map.position() - last).norm();
        if (after.said_lost < 0.0 && output.state == State::lost)
          after.said_lost = gone;
        if (output.state == State::tracking && off < 0.5) {
          after.way = gone;
          break;
        }
        if (after.said_lost >= 0.0 && output.state == State::tracking) {
          ++astray;
          break;
        }
      }
    }
    if (after.way >= 0.0) {
      ++recovered;
      recovery_ways.push_back(after.way);
    }
    if (after.said_lost >= 0.0)
      lost_ways.push_back(after.said_lost);
  }
  const auto p95 = [](const std::vector<double>& values) { return test::quantile(values, 0.95); };
  if (options.json) {
    std::printf(
        "{\"seeds\": %d, \"hours\": %g, \"errors\": %g, \"way_m\": %.0f, "
        "\"position_p50_m\": %.4f, \"position_p95_m\": %.4f, \"heading_p95_deg\": %.3f, "
        "\"position_worst_m\": %.3f, \"not_tracking_cycles\": %d, \"reckoning_p95_m\": %.2f, "
        "\"cycle_ms_p50\": %.4f, \"cycle_ms_p99\": %.4f, \"found\": %d, \"found_wrong\": %d, "
        "\"found_way_p50_m\": %.1f, \"found_way_p95_m\": %.1f, \"kidnapped_recovered\": %d, "
        "\"kidnapped_wrong\": %d, \"lost_way_p95_m\": %.1f, \"recovered_way_p95_m\": %.1f}\n",
        options.seeds, options.hours, options.errors, way, test::quantile(all.position, 0.5),
        p95(all.position), degrees(p95(all.heading)), test::quantile(all.position, 1.0),
        not_tracking, p95(reckoned.position), test::quantile(took, 0.5) * 1e3,
        test::quantile(took, 0.99) * 1e3, found, wrong, test::quantile(ways, 0.5), p95(ways),
        recovered, astray, p95(lost_ways), p95(recovery_ways));
  } else {
    std::printf("all: %.0f m, p50 %.3f m, p95 %.3f m %.2f deg; not tracking %d cycles\n", way,
                test::quantile(all.position, 0.5), p95(all.position), degrees(p95(all.heading)),
                not_tracking);
    std::printf("interpretation and registration: %.3f ms a cycle, p99 %.3f ms\n",
                test::quantile(took, 0.5) * 1e3, test::quantile(took, 0.99) * 1e3);
    std::printf("without a pose: %d of %d found, %d wrong; after %.1f m, p95 %.1f m\n", found,
                options.seeds, wrong, test::quantile(ways, 0.5), p95(ways));
    std::printf(
        "carried away: %d of %d recovered, %d wrong; said lost after %.1f m, right again after "
        "%.1f m (p95)\n",
        recovered, options.seeds, astray, p95(lost_ways), p95(recovery_ways));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine app{"Patrols of the office floor by an estimated pose, and the rates of finding it"};
  app.add_option("--seeds", options.seeds, "patrols, each with its own seed");
  app.add_option("--hours", options.hours, "of each patrol");
  app.add_option("--errors", options.errors, "factor on the errors of dead reckoning");
  app.add_flag("--corridors", options.corridors, "not through the library");
  app.add_flag("--json", options.json, "one JSON object");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] { return run(options); });
}

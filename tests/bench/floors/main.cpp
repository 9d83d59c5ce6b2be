// The robot on floors of offices that it was not tuned on: its estimated pose, the detected doors,
// the built maps, and false reports of arrival.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/study.hpp"
#include "drive/building.hpp"
#include "floors/floor.hpp"
#include "localization/patrol.hpp"
#include "perception/score.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/maps/topology.hpp"
#include "support/guarded.hpp"

namespace {

using namespace saphira;
using bench::Tally;

struct Options {
  std::uint64_t first = 3001;
  int floors = 20;
  double minutes = 15.0;
  double building = 45.0;
  double errors = 1.0;
  std::string robot = "pioneer";
  std::string write_to;
  bool only_carried = false;
  bool only_drives = false;
  bool only_building = false;
  bool shipped = false;
  bool json = false;
};

/// A floor with the robot's maps.
struct Site {
  std::uint64_t seed;
  test::Floor floor;
  std::shared_ptr<const sim::World> world;
  std::shared_ptr<const maps::Map> map;
  maps::Map open_doors;
  maps::Map recessed_doors;
  maps::Map noticeable;
};

Site site(std::uint64_t seed) {
  Site made{seed, test::make_floor(seed), nullptr, nullptr, {}, {}, {}};
  const std::string name = "floor " + std::to_string(seed);
  made.world = std::make_shared<sim::World>(sim::parse_world(made.floor.world, name + ".wld"));
  made.map = std::make_shared<maps::Map>(maps::parse_map(made.floor.map, name + ".map"));
  made.open_doors = maps::parse_map(made.floor.open_doors, name + ", open doors");
  made.recessed_doors =
      maps::parse_map(made.floor.recessed_doors, name + ", doors that stand back");
  made.noticeable = maps::parse_map(made.floor.noticeable_doors, name + ", noticeable doors");
  return made;
}

/// A world of config/worlds with its map; `tour` as in Floor.
Site shipped(const std::string& name, std::vector<Vec2> tour) {
  Site made{1, {}, nullptr, nullptr, {}, {}, {}};
  made.floor.tour = std::move(tour);
  made.world = std::make_shared<sim::World>(
      sim::load_world(find_file(config_folder() + "/worlds", name, ".wld")));
  made.map = std::make_shared<maps::Map>(
      maps::load_map(find_file(config_folder() + "/maps", name, ".map")));
  made.open_doors = made.noticeable = *made.map;
  return made;
}

test::DriveOptions drive_of(const Options& options, const Site& site) {
  return test::DriveOptions{.made_world = site.world,
                            .robot = options.robot,
                            .seed = site.seed,
                            .errors = options.errors};
}

bool is_right(const Pose& believed, const Pose& truth) {
  return (believed.position() - truth.position()).norm() < 0.5 &&
         std::abs(norm2_angle(believed.th - truth.th)) < radians(20.0);
}

/// A patrol of all corridors.
void patrol(const Options& options, const Site& site, Tally& result) {
  constexpr double kGivenUp = 600.0;  // [cycles] for one point
  test::Drive robot(test::registered_on(*site.map, drive_of(options, site)));
  test::Score score(robot, site.noticeable);
  test::Score recessed(robot, site.recessed_doors);
  test::Score any(robot, *site.map);
  test::Tour tour(site.floor.tour, true);
  std::size_t reached = 0;
  int since = 0;
  bool tracked = false;
  result["cycles"] = std::lround(options.minutes * 600.0);
  for (int i = 0; i < result("cycles"); ++i) {
    tour.act(robot, i == 0 ? robot.truth() : robot.believed());
    since = tour.reached() == reached ? since + 1 : 0;
    reached = tour.reached();
    if (since > kGivenUp) {
      tour.skip();
      since = 0;
    }
    robot.advance();
    score.look(robot);
    recessed.look(robot);
    any.look(robot);
    const v1::Registration& told = robot.registered();
    const double off = (robot.believed().position() - robot.truth().position()).norm();
    const bool right = is_right(robot.believed(), robot.truth());
    const bool tracks = told.state == v1::REGISTRATION_TRACKING;
    if (tracked && !tracks && right) {
      ++result["false_lost"];  // within 0.5 m and 20 degrees of its place
      std::fprintf(stderr, "%llu: lost at the right place in cycle %d\n",
                   static_cast<unsigned long long>(site.seed), i);
    }
    tracked = tracks;
    if (tracks) {
      ++result["tracking"];
      result.values["off"].push_back(off);
    }
    if (told.confidence >= 0.9) {
      ++result["sure"];
      result["sure_right"] += off <= 0.5 ? 1 : 0;
    }
  }
  result["doors"] = score.doors_passed();
  result["noticed"] = score.doors_found();
  result["recessed"] = recessed.doors_passed();
  result["recessed_noticed"] = recessed.doors_found();
  result["reported"] = any.doors().reported;
  result["real"] = any.doors().real;  // of any door, also of one that is ajar
}

/// The open door of a corridor that is nearest to its middle.
const maps::Feature* door_of(const maps::Feature& corridor, const maps::Map& open_doors) {
  const maps::Feature* best = nullptr;
  double nearest = 0.0;
  for (const maps::Feature& door : open_doors.features) {
    const Pose in = relative(corridor.pose_in_map, door.pose_in_map);
    if (door.type != lps::PointType::door || std::abs(in.x) > corridor.length / 2 ||
        std::abs(std::abs(in.y) - corridor.width / 2) > 0.3)
      continue;
    if (best == nullptr || std::abs(in.x) < nearest) {
      best = &door;
      nearest = std::abs(in.x);
    }
  }
  return best;
}

/// One journey to a door; the robot is carried before it, or after `after` metres of it. `there`
/// has its new pose.
void carry_once(const Options& options, const Site& site, const Vec2& first,
                const maps::Feature& door, double after,
                const std::function<Pose(const Pose&)>& there, const std::string& name,
                Tally& result) {
  constexpr double kThere = 2.0;  // [m]
  constexpr int kStands = 30;     // [cycles] before and after
  constexpr int kGivenUp = 9000;  // [cycles]
  test::Whole whole({.drive = drive_of(options, site), .made_map = site.map});
  const auto stand = [&] { whole.advance_until([] { return false; }, kStands); };
  // It has driven, so that its pose is confirmed.
  whole.achieve("go-to-place", {point("place", {first.x(), first.y(), 0.0}, Frame::map)}, 3000);
  stand();
  bool carried = false;
  if (after == 0.0) {
    if (!whole.drive().robot().place(there(whole.truth())))
      return;
    carried = true;
    stand();
  }
  const v1::GoalId id = whole.ask("go-to-place", {text("place", std::to_string(door.id))});
  double sure = 0.0;
  double way = 0.0;
  std::optional<double> lost;
  Vec2 before = whole.truth().position();
  for (int cycle = 0; cycle < kGivenUp && !whole.ended(id); ++cycle) {
    if (!carried && way >= after) {
      const Pose pose = there(whole.truth());
      if (!whole.drive().robot().place(pose))
        return;
      carried = true;
      way = 0.0;
      before = pose.position();
    }
    whole.advance();
    const Vec2 now = whole.truth().position();
    way += (now - before).norm();
    if (carried) {
      const bool right = is_right(whole.believed(), whole.truth());
      if (whole.registered().confidence >= 0.9 && !right)
        sure += (now - before).norm();
      if (!lost && (right || whole.registered().state != v1::REGISTRATION_TRACKING))
        lost = way;
    }
    before = now;
  }
  if (!carried)
    return;
  // Its way until it says that it is lost, or knows its place; and with a wrong pose at a
  // confidence of 0.9.
  result.values["lost_way"].push_back(lost.value_or(way));
  result.values["sure_way"].push_back(sure);
  ++result["carried"];
  const bool succeeded = whole.status(id).state == v1::GOAL_SUCCEEDED;
  const bool arrived = (whole.truth().position() - door.pose_in_map.position()).norm() < kThere;
  result["arrived"] += succeeded && arrived ? 1 : 0;
  result["false_success"] += succeeded && !arrived ? 1 : 0;
  std::fprintf(stderr, "%llu %s: noticed after %.1f m%s, sure and wrong %.1f m, %s%s\n",
               static_cast<unsigned long long>(site.seed), name.c_str(), lost.value_or(way),
               lost ? "" : " (never)", sure, arrived ? "there" : "elsewhere",
               succeeded ? ", succeeded" : "");
}

/// Carried to other corridors and rooms, along its way, and turned.
void carry(const Options& options, const Site& site, Tally& result) {
  std::vector<maps::Feature> corridors;
  std::vector<maps::Feature> rooms;
  for (const maps::Feature& feature : site.map->features) {
    if (feature.type == lps::PointType::corridor)
      corridors.push_back(feature);
    if (feature.type == lps::PointType::office)
      rooms.push_back(feature);
  }
  const Vec2 first =
      transform(corridors.front().pose_in_map,
                {3.0 - (site.floor.world.empty() ? corridors.front().length / 2 : 0.0), 0.0});
  const auto carry_to = [&](std::size_t corridor, double after, const std::string& name,
                            const std::function<Pose(const Pose&)>& there) {
    if (const maps::Feature* const door =
            door_of(corridors[corridor % corridors.size()], site.open_doors))
      carry_once(options, site, first, *door, after, there, name, result);
  };
  const std::size_t last = corridors.size() - 1;
  for (const double after : {0.0, 2.0}) {
    const std::string when = after > 0.0 ? " on the way" : "";
    for (std::size_t i = 1; i < corridors.size(); ++i)
      carry_to(i + 1, after, "to corridor " + std::to_string(corridors[i].id) + when,
               [&](const Pose&) { return corridors[i].pose_in_map; });
    for (std::size_t i = 0; i < rooms.size(); i += (rooms.size() + 1) / 2)
      carry_to(last, after, "to room " + std::to_string(rooms[i].id) + when,
               [&](const Pose&) { return rooms[i].pose_in_map; });
    for (const char* const along : {"0.5", "2.0", "-2.0"})
      carry_to(last, after, std::string("ahead by ") + along + " m" + when, [&](const Pose& at) {
        return compose(at, {std::stod(along), 0.0, 0.0});
      });
    for (const char* const turn : {"30", "90", "180"})
      carry_to(last, after, std::string("turned by ") + turn + " degrees" + when,
               [&](const Pose& at) {
                 return compose(at, {0.0, 0.0, radians(std::stod(turn))});
               });
  }
}

/// Builds the map of a floor from nothing.
nlohmann::json build(const Options& options, const Site& site, Tally& result) {
  constexpr double kStep = 0.25;  // [m]
  test::Building building(drive_of(options, site));
  building.run(static_cast<std::uint64_t>(options.building * 600.0));
  const maps::Map map = building.aligned_map();
  std::vector<std::string> missing;  // corridors of which less than half is on the map
  for (const maps::Feature& corridor : site.map->features) {
    if (corridor.type != lps::PointType::corridor)
      continue;
    const long steps = result("steps");
    const long covered = result("covered");
    for (double x = kStep / 2 - corridor.length / 2; x < corridor.length / 2; x += kStep) {
      const Vec2 at = transform(corridor.pose_in_map, {x, 0.0});
      ++result["steps"];
      if (std::any_of(map.features.begin(), map.features.end(), [&](const maps::Feature& one) {
            return (one.type == lps::PointType::corridor || one.type == lps::PointType::junction) &&
                   maps::contains(one, at);
          }))
        ++result["covered"];
    }
    if (2 * (result("covered") - covered) < result("steps") - steps)
      missing.push_back(corridor.name);
  }
  result["untrue_ends"] = building.done() && !missing.empty();
  const test::MapScore score = test::score(map, site.noticeable);
  const test::MapScore recessed = test::score(map, site.recessed_doors);
  result["to_build"] = score.doors;
  result["doors_built"] = score.doors_found;
  result["doors_false"] = test::score(map, *site.map).doors_false;
  result["recessed_to_build"] = recessed.doors;
  result["recessed_built"] = recessed.doors_found;
  result["well"] = building.done() && result.share("covered", "steps", 1.0) >= 0.8 &&
                   result.share("doors_built", "to_build", 1.0) >= 0.8;
  building.draw("floor-" + std::to_string(site.seed));
  return {{"built", building.done()},
          {"reason", building.reason()},
          {"missing", missing},
          {"corridors_m", kStep * static_cast<double>(result("steps"))},
          {"minutes", static_cast<double>(building.whole.cycle()) / 600.0},
          {"contacts", building.whole.drive().contacts()}};
}

/// The figures of a floor, and of all.
nlohmann::json figures_of(const Tally& all) {
  return {{"p95_m", all.quantile("off", 0.95)},
          {"worst_m", all.quantile("off", 1.0)},
          {"tracking", all.share("tracking", "cycles", 1.0)},
          {"calibration_at_90", all.share("sure_right", "sure", 1.0)},
          {"doors_noticed", all.share("noticed", "doors", 1.0)},
          {"explored", all.share("covered", "steps", 1.0)},
          {"doors_built", all.share("doors_built", "to_build", 1.0)},
          {"false_success", all("false_success")}};
}

void write(const std::string& folder, const Site& site) {
  std::filesystem::create_directories(folder);
  const std::string file = folder + "/floor-" + std::to_string(site.seed);
  std::ofstream(file + ".wld") << site.floor.world;
  std::ofstream(file + ".map") << site.floor.map;
  std::printf("%s.wld and .map\n", file.c_str());
}

int run(const Options& options) {
  Tally all;
  nlohmann::json floors = nlohmann::json::array();
  std::vector<Site> sites;
  if (options.shipped) {
    sites.push_back(shipped("small-office", {{1.1, 4.4}, {9.9, 4.4}}));
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      sites.push_back(shipped("office-floor", test::office_tour()));
      sites.back().seed = seed;
    }
  }
  for (int i = 0; i < options.floors; ++i)
    sites.push_back(site(options.first + static_cast<std::uint64_t>(i)));
  for (const Site& here : sites) {
    if (!options.write_to.empty()) {
      write(options.write_to, here);
      continue;
    }
    Tally one;
    if (!options.only_drives && !options.only_building)
      carry(options, here, one);
    if (!options.only_carried && !options.only_building)
      patrol(options, here, one);
    nlohmann::json told = nlohmann::json::object();
    if (!options.only_carried && !options.only_drives)
      told = build(options, here, one);
    told.update(figures_of(one));
    told.update({{"seed", here.seed},
                 {"doors", one("doors")},
                 {"carried", one("carried")},
                 {"arrived", one("arrived")},
                 {"doors_false", one("doors_false")}});
    floors.push_back(told);
    std::fprintf(stderr, "%s\n", told.dump().c_str());
    all.add(one);
  }
  if (!options.write_to.empty())
    return 0;
  nlohmann::json result = figures_of(all);
  result.update(
      {{"robot", options.robot},
       {"errors", options.errors},
       {"false_lost", all("false_lost")},
       {"recessed_noticed", all.share("recessed_noticed", "recessed", 1.0)},
       {"doors_precision", all.share("real", "reported", 1.0)},
       {"recessed_built", all.share("recessed_built", "recessed_to_build", 1.0)},
       {"false_doors",
        options.floors > 0 ? static_cast<double>(all("doors_false")) / options.floors : 1.0},
       {"built_well", all("well")},
       {"untrue_ends", all("untrue_ends")},
       {"carried_goals", all("carried")},
       {"carried_arrived", all("arrived")},
       {"lost_after_m_p50", all.quantile("lost_way", 0.5)},
       {"lost_after_m_p95", all.quantile("lost_way", 0.95)},
       {"carried_sure_m_p50", all.quantile("sure_way", 0.5)},
       {"carried_sure_m_p90", all.quantile("sure_way", 0.9)},
       {"floors", floors}});
  bench::print(result, options.json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine app{"The robot on generated floors of offices that it was not tuned on"};
  app.add_option("--first", options.first, "the seed of the first floor");
  app.add_option("--floors", options.floors, "how many").in_range(0, 10000);
  app.add_option("--minutes", options.minutes, "of patrol on each").positive();
  app.add_option("--building", options.building, "minutes to build a map, at most").positive();
  app.add_option("--errors", options.errors, "factor on the errors of dead reckoning");
  app.add_option("--robot", options.robot, "a robot of config/robots");
  app.add_option("--write", options.write_to,
                 "only write the floors into this folder, as worlds and maps");
  app.add_flag("--only-carried", options.only_carried,
               "only the goals after the robot was carried; the other figures are void");
  app.add_flag("--only-drives", options.only_drives,
               "only the patrols; the other figures are void");
  app.add_flag("--only-building", options.only_building,
               "only the building of maps; the other figures are void");
  app.add_flag("--shipped", options.shipped, "also small-office, and office-floor with four seeds");
  app.add_flag("--json", options.json, "one JSON object; progress goes to stderr");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] { return run(options); });
}

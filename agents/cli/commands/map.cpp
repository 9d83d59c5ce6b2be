// The map and the robot's place on it: display, drawing, changes, and goals.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <set>

#include "commands.hpp"
#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/cli/map_words.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/maps/drawing.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/viewer/picture.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr double kMapPatience = 5.0;  ///< [s] for the map, and for an answer
constexpr double kAllHeard = 0.5;     ///< [s] until every program of this robot is discovered

/// The belief with the zones by advice, its value without the quotation marks.
v1::Belief hazards_in(const v1::BeliefSet& beliefs) {
  for (const v1::Belief& belief : beliefs.beliefs)
    if (const std::string& value = belief.value;
        belief.name == maps::kHazards && value.size() > 2 && value.front() == '"') {
      v1::Belief found = belief;
      found.value = value.substr(1, value.size() - 2);
      return found;
    }
  return {};
}

/// The map and the robot on it, from the bus.
class View {
 public:
  explicit View(const bus::NodeOptions& options)
      : node(options), processes(node), deployments(node, processes) {}

  /// True where a new sample of registration came.
  bool poll() {
    deployments.poll();
    grant.poll();
    description.poll();
    beliefs.poll();
    if (sample.poll())
      map = maps::from_bus(*sample);
    return registration.poll();
  }

  /// Waits for the map, and for the registration where requested.
  bool wait_for_map(const bus::Stop& stop, bool and_registration = true) {
    const auto began = Clock::now();
    if (wait_for(node, std::chrono::duration<double>(kMapPatience), stop, [&] {
          poll();
          return sample && (registration || !and_registration) && seconds_since(began) >= kAllHeard;
        })) {
      deployments.settle(stop);
      return true;
    }
    std::cerr << "saphira: no map: registration is not heard; " << who_is_there(processes) << '\n';
    return false;
  }

  /// The latches, in words.
  std::string holds() const { return grant ? latched(*grant) : ""; }
  bool tracking() const { return registration && registration->state == v1::REGISTRATION_TRACKING; }
  Vec2 position() const { return {registration->pose_in_map.x, registration->pose_in_map.y}; }

  std::set<std::uint32_t> closed_doors() const {
    const auto& doors = registration->closed_doors;
    return {doors.begin(), doors.end()};
  }

  bus::Node node;
  Processes processes;
  DeploymentWatch deployments;
  Newest<v1::Grant> grant{node, bus::topics::kGrant};
  Newest<v1::FloorMap> sample{node, bus::topics::kMap};
  maps::Map map;
  Newest<v1::Registration> registration{node, bus::topics::kRegistration};
  Newest<v1::BeliefSet> beliefs{node, bus::topics::kBeliefs};
  Newest<v1::RobotDescription> description{node, bus::topics::kRobotDescription};
  bus::RequestClient registration_client{node, bus::topics::kRegistrationRequest, "saphira map"};
};

int look(const bus::NodeOptions& options, const bus::Stop& stop, bool follow) {
  View view(options);
  if (!view.wait_for_map(stop))
    return bus::kExitFailed;
  std::printf("map %s%s: %s\n",
              view.sample->source.empty() ? "from nothing" : view.sample->source.c_str(),
              view.sample->changed ? ", changed" : "",
              counted(view.map.features.size(), "artifact").c_str());
  auto told = Clock::now() - std::chrono::seconds(1);
  do {
    if (view.registration && seconds_since(told) >= 1.0) {
      std::printf("%8.1f s  %s%s%s\n", seconds_of(view.registration->stamp.cycle),
                  describe(*view.registration, view.map).c_str(), view.holds().empty() ? "" : "; ",
                  view.holds().c_str());
      std::fflush(stdout);
      told = Clock::now();
    }
    if (follow)
      view.node.wait(milliseconds(100), &stop);
    view.poll();
  } while (follow && !stop.requested() && std::ferror(stdout) == 0);
  return bus::kExitOk;
}

/// The file, or standard output for "-".
int write_out(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::fputs(text.c_str(), stdout);
    return bus::kExitOk;
  }
  if (!replace_file(path, text, true))
    return failed(cannot_be(path, "written"));
  std::printf("written to %s\n", path.c_str());
  return bus::kExitOk;
}

int save(const std::string& path, const bus::NodeOptions& options, const bus::Stop& stop) {
  View view(options);
  if (!view.wait_for_map(stop, false))
    return bus::kExitFailed;
  if (view.map.features.empty() && path != "-")
    return failed("the map is empty: nothing is written");
  return write_out(path, maps::to_text(view.map));
}

/// The grid as a raster of the map.
std::optional<maps::Raster> raster_of(const viewer::Tiles& tiles,
                                      const v1::Registration& registration) {
  const std::optional<viewer::Cells> grid = tiles.whole();
  if (!grid || grid->odom != registration.odom)
    return std::nullopt;
  maps::Raster raster{.lower_left_in_map =
                          compose(lps::from_bus(registration.odom_in_map), {grid->x, grid->y, 0.0}),
                      .cell = grid->resolution,
                      .width = static_cast<int>(grid->columns),
                      .height = static_cast<int>(grid->rows),
                      .occupied = {}};
  for (const char cell : grid->cells) {
    const auto value = static_cast<std::uint8_t>(cell);
    raster.occupied.push_back(value <= 200 ? static_cast<float>(value) / 200.0F : -1.0F);
  }
  return raster;
}

/// Adds a drawing of a program (manual 6.8), at its present place on the map.
void add(const v1::Drawing& drawn, const v1::Registration& registration, maps::Drawing& drawing) {
  const Pose odom = lps::from_bus(registration.odom_in_map);
  const Pose frame = drawn.frame == v1::FRAME_ROBOT  ? lps::from_bus(registration.pose_in_map)
                     : drawn.frame == v1::FRAME_ODOM ? odom
                                                     : Pose{};
  const std::string color = format("#%02x%02x%02x", drawn.red, drawn.green, drawn.blue);
  std::vector<Vec2> points;
  for (const v1::DrawnPoint& point : drawn.points)
    if (std::isfinite(point.x) && std::isfinite(point.y))
      points.emplace_back(point.x, point.y);
  const bool in_legend = std::ranges::any_of(
      drawing.strokes, [&](const maps::Strokes& one) { return one.name == drawn.source; });
  const double width = std::isfinite(drawn.width) ? std::clamp(drawn.width, 0.04, 1.0) : 0.04;
  maps::Strokes strokes{in_legend ? std::string() : drawn.source, color, width, {}};
  const auto line = [&](const Vec2& from, const Vec2& to) {
    strokes.lines.push_back(transform(frame, from));
    strokes.lines.push_back(transform(frame, to));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2& a = points[i];
    if (drawn.shape == v1::DRAWING_POINTS) {
      constexpr double kArm = 0.06;  // [m]
      line(a - Vec2(kArm, 0.0), a + Vec2(kArm, 0.0));
      line(a - Vec2(0.0, kArm), a + Vec2(0.0, kArm));
    }
    if (i + 1 == points.size())
      break;
    const Vec2& b = points[i + 1];
    if (drawn.shape == v1::DRAWING_LINE) {
      line(a, b);
    } else if (drawn.shape == v1::DRAWING_RECTANGLE && i % 2 == 0) {
      const std::array<Vec2, 4> corners{a, Vec2(b.x(), a.y()), b, Vec2(a.x(), b.y())};
      for (std::size_t k = 0; k < corners.size(); ++k)
        line(corners[k], corners[(k + 1) % corners.size()]);
    } else if (drawn.shape == v1::DRAWING_ARROW && i % 2 == 0) {
      line(a, b);
      const double th = std::atan2(b.y() - a.y(), b.x() - a.x());
      for (const double wing : {0.5, -0.5})
        line(b - 0.2 * Vec2(std::cos(th + wing), std::sin(th + wing)), b);
    }
  }
  if (drawn.shape == v1::DRAWING_TEXT && !points.empty())
    drawing.words.push_back({transform(frame, points[0]), drawn.text, color});
  else
    drawing.strokes.push_back(std::move(strokes));
}

int show(const std::string& path, double seconds, const bus::NodeOptions& options,
         const bus::Stop& stop) {
  if (path != "-")
    expect_ending(path, ".svg");
  View view(options);
  auto grid = view.node.reader(bus::topics::kGrid);
  auto perceptions = view.node.reader(bus::topics::kPerception);
  if (!view.wait_for_map(stop))
    return bus::kExitFailed;
  auto drawings = view.node.reader(bus::topics::kDrawings);
  std::map<std::pair<std::uint64_t, std::uint64_t>, v1::Drawing> drawn;
  maps::Drawing drawing;
  maps::Trajectory way{"where the robot believes to be", {}};
  viewer::Tiles tiles(0.0);
  std::map<std::uint32_t, Pose> percepts;
  const auto began = Clock::now();
  do {
    for (const auto& sample : grid.take())
      tiles.note(sample.data, sample.info.disposed);
    keep_newest(drawings, drawn,
                [](const v1::Drawing& one) { return std::pair(one.instance, one.number); });
    if (const auto seen = perceptions.take_newest())
      for (const v1::Percept& percept : seen->percepts)
        percepts[percept.id] = lps::from_bus(percept.pose_in_odom);
    if (view.poll() && view.tracking()) {
      way.points_in_map.push_back(view.position());
      for (const v1::Match& match : view.registration->matches) {
        const auto percept = percepts.find(match.percept);
        const maps::Feature* const artifact =
            match.artifact == 0 ? nullptr : maps::find(view.map, match.artifact);
        // A corridor's middle is not the place of its match.
        if (percept != percepts.end() && artifact != nullptr &&
            artifact->type != lps::PointType::corridor)
          drawing.matches.push_back(
              {transform(lps::from_bus(view.registration->odom_in_map), percept->second.position()),
               artifact->pose_in_map.position(), match.accepted});
      }
    }
    view.node.wait(milliseconds(100), &stop);
  } while (!stop.requested() && seconds_since(began) < seconds);
  for (const auto& [key, one] : drawn)
    add(one, *view.registration, drawing);
  drawing.map = view.map;
  drawing.closed_doors = view.closed_doors();
  const maps::Feature* const in = maps::find(view.map, view.registration->environment);
  drawing.title =
      name_of(view.registration->state) + (in == nullptr ? std::string() : ", in " + describe(*in));
  drawing.raster = raster_of(tiles, *view.registration);
  if (!drawing.raster && !tiles.empty())
    std::cerr << "saphira: the occupancy grid is left out of the picture: it is too large, or of "
                 "another dead-reckoning frame than the pose\n";
  if (!way.points_in_map.empty())
    drawing.trajectories.push_back(std::move(way));
  const v1::Covariance2& c = view.registration->covariance;
  drawing.robot.emplace();
  drawing.robot->pose_in_map = lps::from_bus(view.registration->pose_in_map);
  if (view.description)
    drawing.robot->radius = view.description->radius;
  drawing.robot->xx = c.xx;
  drawing.robot->yy = c.yy;
  drawing.robot->xy = c.xy;
  return write_out(path, maps::to_svg(drawing));
}

/// Sends a request to registration and waits for its answer; reports the result.
bool ask(View& view, const Request& asked, const bus::Stop& stop) {
  const v1::Answer answer =
      view.registration_client.ask(to_bus(asked), kMapPatience, &stop, [&] { view.poll(); });
  if (answer.service.empty()) {
    std::cerr << "saphira: registration did not answer; " << who_is_there(view.processes) << '\n';
    return false;
  }
  if (!bus::well(answer.code))
    std::cerr << "saphira: " << answer.text << '\n';
  else if (const double id = number_of(from_bus(answer).results, "id"); id != 0.0)
    std::printf("artifact %.0f\n", id);
  return bus::well(answer.code);
}

int request(const std::vector<std::string>& words, const bus::NodeOptions& options,
            const bus::Stop& stop) {
  View view(options);
  // Place names belong to the present map.
  if (!view.wait_for_map(stop, false))
    return bus::kExitFailed;
  return ask(view, parse_map_request(words, view.map), stop) ? bus::kExitOk : bus::kExitFailed;
}

int route(const std::string& place, const bus::NodeOptions& options, const bus::Stop& stop) {
  View view(options);
  if (!view.wait_for_map(stop))
    return bus::kExitFailed;
  const maps::Topology topology(view.map);
  maps::RouteSettings settings;
  settings.closed = view.closed_doors();
  if (view.description)
    settings.needs_width = maps::needed_width(view.description->radius);
  const v1::Belief hazards = view.beliefs ? hazards_in(*view.beliefs) : v1::Belief{};
  settings.zones = maps::all_zones(view.map, topology, hazards.value, hazards.said_by);
  const maps::RouteResult found = maps::find_route(topology, view.position(), place, settings);
  if (!found.route)
    return failed(found.reason);
  std::printf("%.1f m: %s\n", found.route->length, maps::text(topology, *found.route).c_str());
  if (const std::string remark = found.remark(); !remark.empty())
    std::printf("it goes %s\n", remark.c_str());
  for (const maps::Leg& leg : found.route->legs)
    if (leg.link && settings.closed.contains(topology.links()[*leg.link].id))
      std::printf(
          "door %u was closed when the robot looked at it last; ways round it are longer, or "
          "none\n",
          topology.links()[*leg.link].id);
  return bus::kExitOk;
}

/// Lets the robot build the map (activity build-map); writes it when it is complete.
int build(const std::string& path, const bus::NodeOptions& options, const bus::Stop& stop) {
  if (path != "-" && !can_replace_file(path))
    throw std::invalid_argument(cannot_be(path, "written"));
  View view(options);
  if (!view.wait_for_map(stop))
    return bus::kExitFailed;
  bus::GoalClient goals(view.node, "saphira map build");
  v1::Goal wanted{.functor = "build-map"};
  const v1::GoalId goal = goals.ask(wanted);
  std::string told;
  std::size_t corridors = 0;
  std::size_t doors = 0;
  bool done = false;
  bool begun = false;  // it begins with an empty map
  while (!done && !stop.requested()) {
    view.node.wait(milliseconds(200), &stop);
    goals.poll();
    view.poll();
    begun = begun || view.map.features.empty();
    std::size_t now_corridors = 0;
    std::size_t now_doors = 0;
    for (const maps::Feature& feature : view.map.features) {
      now_corridors += feature.type == lps::PointType::corridor ? 1U : 0U;
      now_doors += feature.type == lps::PointType::door ? 1U : 0U;
    }
    const auto status = goals.status(goal);
    done = status && bus::ended(status->state);
    std::string news = status ? (done ? status->reason : status->step) : std::string();
    if (!done && !view.holds().empty())
      news += (news.empty() ? "" : "; ") + view.holds();
    if (now_corridors != corridors || now_doors != doors)
      news += (news.empty() ? "" : "; ") + counted(now_corridors, "corridor") + ", " +
              counted(now_doors, "door");
    corridors = now_corridors;
    doors = now_doors;
    if (news.empty() || news == told)
      continue;
    told = news;
    print("%8.1f s  %s\n", status ? status->elapsed : 0.0, news.c_str());
  }
  flush_output();
  const auto status = goals.status(goal);
  const bool whole = status && status->state == v1::GOAL_SUCCEEDED;
  if (status && status->state == v1::GOAL_REFUSED)
    return bus::kExitFailed;
  if (!done) {
    goals.cancel(goal);
    goals.delivered(1000);
  }
  if (!begun)
    return failed("the map was not begun, and nothing is written: the robot has the map of before");
  // Also after an interruption: the partial map counts, but replaces no other.
  if (!whole) {
    const bus::Stop end;
    if (!ask(view, {"add_features", {{"on", false}}}, end))
      return bus::kExitFailed;
  }
  view.poll();
  std::printf("%s, %s, %s%s\n", counted(corridors, "corridor").c_str(),
              counted(doors, "door").c_str(), counted(view.map.features.size(), "artifact").c_str(),
              whole ? "" : "; broken off, something may be left");
  if (!whole && view.map.features.empty())
    return failed("nothing is written");
  const bool beside = !whole && path != "-" && std::filesystem::exists(path);
  const int written = write_out(path + (beside ? ".part" : ""), maps::to_text(view.map));
  if (beside)
    std::printf("%s has the map of before\n", path.c_str());
  if (written != bus::kExitOk)
    complain("saphira: the map is still on the robot: saphira map save FILE writes it\n");
  return whole ? written : static_cast<int>(bus::kExitFailed);
}

int map(const std::vector<std::string>& words, double seconds, const bus::NodeOptions& options,
        const bus::Stop& stop) {
  const std::string verb = words.empty() ? "" : words.front();
  const std::string rest = words.size() == 2 ? words[1] : "";
  try {
    check_map_words(words);
    if (words.empty() || (verb == "follow" && words.size() == 1))
      return look(options, stop, verb == "follow");
    if (verb == "list" && words.size() == 1)
      return save("-", options, stop);
    if (verb == "save" && !rest.empty())
      return save(rest, options, stop);
    if (verb == "show" && !rest.empty())
      return show(rest, seconds, options, stop);
    if (verb == "build" && words.size() <= 2)
      return build(rest.empty() ? "built.map" : rest, options, stop);
    if (verb == "route" && !rest.empty())
      return route(rest, options, stop);
    return request(words, options, stop);
  } catch (const std::invalid_argument& error) {
    std::cerr << "saphira: map: " << error.what() << '\n';
    return bus::kExitUsage;
  } catch (const std::runtime_error& error) {
    std::cerr << "saphira: " << error.what() << '\n';
    return bus::kExitUsage;
  }
}

constexpr const char* kMapWords = R"(
  saphira map                    the map's source, and where the robot is on it
  saphira map follow             the same, a line a second
  saphira map list               the map as the text of a map file
  saphira map save FILE          the same into a file
  saphira map show FILE.svg      a picture of map, grid, matches, the way and what programs draw,
                                 of --seconds; closed doors are black, things that the robot put
                                 down orange
  saphira map build [FILE]       explores the floor, maps it from nothing, and writes the map
  saphira map load FILE          this map instead of the one that is there; or the name of a shipped one
  saphira map delete             no map
  saphira map put "DOOR (3) 3000, 1000, 90, 900"   adds an artifact, or changes the one of this id
  saphira map remove ID          removes it
  saphira map place X Y TH       the robot is there [m, rad, or 90deg]; or NAME of a POS of the map
  saphira map find               the robot may be anywhere: find it
  saphira map on | off           registration (manual 6.9.2)
  saphira map features on | off  whether what is seen and not on the map is added to it
  saphira map snap on | off      whether what is added is aligned on right angles
  saphira map route PLACE        the way to a room, a corridor or a POS, by name or id
                                 (saphira goal go PLACE drives there)
)";

}  // namespace

void add_map(CLI::App& app, Chosen& chosen) {
  auto words = std::make_shared<std::vector<std::string>>();
  auto seconds = std::make_shared<double>(2.0);
  CLI::App* command = app.add_subcommand("map", "The map: look at it, draw it, change it");
  command->add_option("words", *words, "what to do, as below");
  command->add_option("--seconds", *seconds, "show: how long the way is followed")
      ->check(between(0.0, 1e6))
      ->transform(number_in_unit("s"))
      ->capture_default_str();
  command->footer(kMapWords);
  chosen.when(command, [words, seconds](const bus::NodeOptions& node, const bus::Stop& stop) {
    return map(*words, *seconds, node, stop);
  });
}

}  // namespace saphira::cli

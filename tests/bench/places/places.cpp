#include "places/places.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>
#include <utility>

#include "drive/whole.hpp"
#include "saphira/base/random.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::test {
namespace {

constexpr double kRoom = 0.22 + 0.10;  // [m] the hull, and a hand's width
constexpr double kStill = 0.03;        // [m/s] slower is a stop

/// Watches for stops between a corridor and the door at its side.
class Passages {
 public:
  void look(const Whole& whole, double velocity, Arrival& arrival) {
    bool approaches = false;
    bool passes = false;
    for (const intentions::IntentionNode& node : whole.intentions().nodes) {
      approaches = approaches || node.schema == "corridor-to-door";
      passes = passes || node.schema == "FollowDoor";
    }
    if (approaches)
      from_corridor_ = true;
    if (!passes) {
      if (passing_) {
        ++arrival.passages;
        arrival.stopped += stopped_ ? 1 : 0;
      }
      passing_ = stopped_ = false;
      from_corridor_ = approaches;
      return;
    }
    passing_ = passing_ || from_corridor_;
    stopped_ = stopped_ || (passing_ && velocity < kStill);
  }

 private:
  bool from_corridor_ = false;
  bool passing_ = false;
  bool stopped_ = false;
};

/// The places that a robot with room around it can reach; a place within a desk is none of them.
class Reachable {
 public:
  Reachable(const sim::World& world, const Vec2& from) : world_(world) {
    std::vector<Cell> open{cell(from)};
    cells_.insert(open.front());
    while (!open.empty()) {
      const Cell at = open.back();
      open.pop_back();
      for (const Cell& next : {Cell{at.first + 1, at.second}, Cell{at.first - 1, at.second},
                               Cell{at.first, at.second + 1}, Cell{at.first, at.second - 1}})
        if (!cells_.contains(next) && sim::distance(world_.segments, middle(next)) > kRoom) {
          cells_.insert(next);
          open.push_back(next);
        }
    }
  }
  bool contains(const Vec2& point) const { return cells_.contains(cell(point)); }

 private:
  using Cell = std::pair<int, int>;
  static constexpr double kCell = 0.1;  // [m]
  static Cell cell(const Vec2& point) {
    return {static_cast<int>(std::floor(point.x() / kCell)),
            static_cast<int>(std::floor(point.y() / kCell))};
  }
  static Vec2 middle(const Cell& cell) {
    return {(cell.first + 0.5) * kCell, (cell.second + 0.5) * kCell};
  }

  const sim::World& world_;
  std::set<Cell> cells_;
};

std::optional<Pose> somewhere_in(const maps::Region& region, const Reachable& reachable,
                                 Random& random) {
  for (int i = 0; i < 1000; ++i) {
    const maps::Feature& area = region.area;
    const Vec2 at = transform(area.pose_in_map, {random.uniform(-0.5, 0.5) * area.length,
                                                 random.uniform(-0.5, 0.5) * area.width});
    const Pose pose{at.x(), at.y(), random.uniform(-kPi, kPi)};
    if (reachable.contains(at))
      return pose;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Journey> random_journeys(const maps::Map& map, const sim::World& world, int count,
                                     std::uint64_t seed) {
  const maps::Topology topology(map);
  Random random(seed);
  const Reachable reachable(world, world.start.value_or(Pose{}).position());
  std::vector<std::size_t> rooms;
  for (std::size_t i = 0; i < topology.regions().size(); ++i)
    if (topology.regions()[i].kind == maps::RegionKind::room)
      rooms.push_back(i);
  const auto draw = [&] {
    return rooms[static_cast<std::size_t>(random.uniform() * static_cast<double>(rooms.size()))];
  };
  std::vector<Journey> journeys;
  while (static_cast<int>(journeys.size()) < count) {
    const maps::Region& from = topology.regions()[draw()];
    const maps::Region& to = topology.regions()[draw()];
    if (from.area.name == to.area.name)
      continue;
    if (const auto start = somewhere_in(from, reachable, random))
      journeys.push_back({from.area.name, *start, to.area.name});
  }
  return journeys;
}

Arrival travel(const Journey& journey, std::uint64_t seed, int cycles, const std::string& world,
               bool talk) {
  WholeOptions options;
  options.map = "office-floor";
  options.drive.world = world;
  options.drive.seed = seed;
  options.drive.start_in_world = journey.start_in_world;
  Whole whole(options);
  Arrival arrival;
  Passages passages;
  const intentions::GoalId goal = whole.ask("go-to-place", {saphira::text("place", journey.to)});
  whole.advance_until(
      [&] {
        const Seen& seen = whole.drive().seen();
        passages.look(whole, seen.velocity, arrival);
        if (talk && seen.cycle % 10 == 0) {
          char text[160];
          std::snprintf(text, sizeof text, "%5d (%.2f, %.2f, %.0f) off %.2f, %.2f m/s %s",
                        static_cast<int>(seen.cycle), whole.truth().x, whole.truth().y,
                        degrees(whole.truth().th),
                        (whole.believed().position() - whole.truth().position()).norm(),
                        seen.velocity, whole.status(goal).step.c_str());
          arrival.talk.emplace_back(text);
        }
        return whole.ended(goal);
      },
      cycles);
  if (talk)
    arrival.talk.insert(arrival.talk.end(), whole.transitions().begin(), whole.transitions().end());
  const intentions::GoalStatus& status = whole.status(goal);
  arrival.ended = whole.ended(goal);
  arrival.succeeded = status.state == intentions::GoalState::kSucceeded;
  arrival.reason = status.reason;
  arrival.at_rest = whole.at_rest();
  arrival.contacts = whole.drive().contacts();
  arrival.cycles = whole.cycle();
  arrival.trouble = whole.trouble();
  const maps::Topology topology = whole.topology();
  const auto place = topology.place(journey.to);
  for (const std::size_t region : place->regions)
    arrival.there =
        arrival.there || maps::contains(topology.regions()[region].area, whole.truth().position());
  return arrival;
}

}  // namespace saphira::test

#include "crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saphira/base/places.hpp"
#include "saphira/base/random.hpp"
#include "saphira/base/shortest_ways.hpp"

namespace saphira::test {

constexpr double kCell = 0.1;         // [m]
constexpr double kRoom = 0.15;        // [m] beside the hull
constexpr double kComfort = 0.7;      // [m] more room has no further value
constexpr double kPersonRoom = 0.15;  // [m] in addition to that beside a wall
constexpr double kShortest = 2.0;     // [m] of a way worth driving
constexpr double kNever = std::numeric_limits<double>::infinity();
// A way without progress for this time is blocked, as in the robot's navigation.
constexpr double kPatience = 20.0;  // [s]
constexpr double kNearer = 0.05;    // [m]
constexpr double kBefore = 0.25;    // [m] distance of the robot from the obstacle
// The error of the robot's place on the map: p95 of registration.
constexpr Pose kPlaceError{0.06, -0.06, radians(1.0)};

/// Room round each cell of a world, and the cheapest ways from one cell.
class Ways {
 public:
  Ways(const sim::World& world, double needed)
      : needed_(needed),
        columns_(static_cast<int>(world.width / kCell)),
        rows_(static_cast<int>(world.height / kCell)),
        room_(static_cast<std::size_t>(columns_ * rows_)) {
    sim::Scene scene(world);
    for (int i = 0; i < columns_ * rows_; ++i)
      room_[static_cast<std::size_t>(i)] = scene.distance(centre(i));
  }

  Vec2 centre(int cell) const {
    return {(cell % columns_ + 0.5) * kCell, (cell / columns_ + 0.5) * kCell};
  }
  double room(int cell) const { return room_[static_cast<std::size_t>(cell)]; }
  double room(const Vec2& at) const {
    const auto cell = cell_at(at);
    return cell ? room(*cell) : 0.0;
  }

  /// The cell with enough room that is nearest to a place.
  std::optional<int> nearest(const Vec2& at) const {
    return nearest_of(at, [this](int cell) { return length_.empty() || length(cell) < kNever; });
  }

  /// A person of that radius stands here. Ways pass him like walls.
  void block(const Vec2& at, double body) {
    for (int i = 0; i < columns_ * rows_; ++i)
      room_[static_cast<std::size_t>(i)] = std::min(room(i), (centre(i) - at).norm() - body);
  }

  /// From here to all cells: cost, length [m] and the cell before.
  void spread(int from) {
    ways_ = ShortestWays(room_.size());
    ways_.reach(static_cast<std::size_t>(from), 0.0);
    length_.assign(room_.size(), kNever);
    length_[static_cast<std::size_t>(from)] = 0.0;
    while (const auto here = ways_.next()) {
      const int cell = static_cast<int>(*here);
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int column = cell % columns_ + dx;
          const int row = cell / columns_ + dy;
          if (column < 0 || row < 0 || column >= columns_ || row >= rows_)
            continue;
          const int next = row * columns_ + column;
          const auto n = static_cast<std::size_t>(next);
          if (room(next) < needed_)
            continue;
          const double step = kCell * std::hypot(dx, dy);
          const double tight = std::max(0.0, kComfort - room(next));
          if (ways_.reach(n, ways_.cost(*here) + step * (1.0 + 4.0 * tight), here))
            length_[n] = length_[*here] + step;
        }
    }
  }

  /// The farthest cell within that distance.
  int farthest(double most) const {
    int best = -1;
    for (int i = 0; i < columns_ * rows_; ++i)
      if (length(i) <= most && (best < 0 || length(i) > length(best)))
        best = i;
    return best;
  }
  double length(int cell) const { return length_[static_cast<std::size_t>(cell)]; }
  std::vector<Vec2> way_to(int cell) const {
    std::vector<Vec2> way;
    if (cell >= 0)
      for (const std::size_t at : ways_.way_to(static_cast<std::size_t>(cell)))
        way.push_back(centre(static_cast<int>(at)));
    return way;
  }
  /// A point that many cells along the way to the ways' start.
  Vec2 back_from(const Vec2& at, int cells) const {
    const auto here = cell_at(at);
    const std::vector<Vec2> way = way_to(here && length(*here) < kNever ? *here : *nearest(at));
    return way[way.size() - 1 - std::min(way.size() - 1, static_cast<std::size_t>(cells))];
  }
  /// [m] from here to the ways' start; infinite without a way.
  double left(const Vec2& at) const {
    auto here = cell_at(at);
    if (!here || room(*here) < needed_)
      here = nearest_of(at, [](int) { return true; });
    return here ? length(*here) : kNever;
  }
  std::optional<int> cell_at(const Vec2& at) const {
    const int column = static_cast<int>(at.x() / kCell);
    const int row = static_cast<int>(at.y() / kCell);
    if (at.x() < 0.0 || at.y() < 0.0 || column >= columns_ || row >= rows_)
      return std::nullopt;
    return row * columns_ + column;
  }

 private:
  template <class Fits>
  std::optional<int> nearest_of(const Vec2& at, Fits fits) const {
    std::optional<int> best;
    for (int i = 0; i < columns_ * rows_; ++i)
      if (room(i) >= needed_ && fits(i) &&
          (!best || (centre(i) - at).norm() < (centre(*best) - at).norm()))
        best = i;
    return best;
  }

  double needed_;
  int columns_;
  int rows_;
  std::vector<double> room_;
  std::vector<double> length_;
  ShortestWays ways_{0};
};

namespace {

sim::PersonPlan person_at(const Vec2& at, double body, const std::string& name) {
  sim::PersonPlan person;
  person.look.name = name;
  person.look.height = sim::kPersonHeight;
  person.at = at;
  person.radius = body;
  return person;
}

/// A unit vector along the way at a point of it.
Vec2 along(const std::vector<Vec2>& way, std::size_t at) {
  const std::size_t from = at < 3 ? 0 : at - 3;
  const std::size_t to = std::min(way.size() - 1, at + 3);
  return (way[to] - way[from]).normalized();
}

/// A person stands on the way or a little aside, so that a way remains.
void add_standing(Crossing& crossing, const CrossingOptions& options, double needed,
                  Random& random) {
  for (int tries = 0; tries < 10; ++tries) {
    const auto at = static_cast<std::size_t>(random.uniform(0.2, 0.85) *
                                             static_cast<double>(crossing.way.size() - 1));
    const Vec2 ahead = along(crossing.way, at);
    const double aside = random.uniform(-0.5, 0.5);
    const Vec2 place = crossing.way[at] + aside * Vec2(-ahead.y(), ahead.x());
    if ((place - crossing.start_in_world.position()).norm() < needed + 1.0 ||
        (place - crossing.way.back()).norm() < needed + 1.0 ||
        sim::Scene(crossing.world).distance(place) < options.body + 0.05)
      continue;
    sim::World with = crossing.world;
    with.movable.persons.push_back(
        person_at(place, options.body, "standing" + std::to_string(with.movable.persons.size())));
    // The distance to people is larger than to walls.
    sim::World wide = with;
    for (sim::PersonPlan& person : wide.movable.persons)
      person.radius += kPersonRoom;
    Ways ways(wide, needed);
    const auto start = ways.cell_at(crossing.start_in_world.position());
    const auto goal = ways.cell_at(crossing.way.back());
    ways.spread(*start);
    if (ways.length(*goal) > 2.0 * options.most)
      continue;
    crossing.world = std::move(with);
    return;
  }
}

/// A person walks to and fro along the way, to one side of it, where two can pass.
void add_walking(Crossing& crossing, const CrossingOptions& options, double needed,
                 Random& random) {
  const double body = options.body;
  const std::vector<Vec2>& way = crossing.way;
  const Ways ways(crossing.world, needed);
  for (int tries = 0; tries < 20; ++tries) {
    const auto from =
        static_cast<std::size_t>(random.uniform(0.1, 0.8) * static_cast<double>(way.size() - 1));
    const std::size_t to = std::min(way.size() - 1, from + 30);
    const Vec2 line = way[to] - way[from];
    if (line.norm() < 2.0)
      continue;
    const Vec2 ahead = line.normalized();
    const Vec2 aside(-ahead.y(), ahead.x());
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    // The least offset, up to 1.2 m, that leaves room for the person and for the robot.
    double off = 0.0;
    bool fits = false;
    for (off = 0.2; off <= 1.2 && !fits; off += 0.1) {
      fits = true;
      for (double s = 0.0; s <= line.norm() && fits; s += kCell) {
        const Vec2 mine = way[from] + s * ahead + side * off * aside;
        const Vec2 robots = way[from] + s * ahead;
        fits = ways.room(mine) >= body + 0.05 &&
               ways.room(Vec2(robots - side * std::max(0.0, needed + body + 0.3 - off) * aside)) >=
                   needed;
      }
    }
    if (!fits)
      continue;
    off -= 0.1;
    const Vec2 a = way[from] + side * off * aside;
    const Vec2 b = way[to] + side * off * aside;
    if ((a - crossing.start_in_world.position()).norm() < needed + 0.8 ||
        (b - crossing.start_in_world.position()).norm() < needed + 0.8 ||
        (a - way.back()).norm() < needed + 0.6 || (b - way.back()).norm() < needed + 0.6)
      continue;
    sim::PersonPlan person =
        person_at(a, body, "walking" + std::to_string(crossing.world.movable.persons.size()));
    const double speed = std::clamp(1.3 + 0.25 * random.normal(), 0.6, 1.9);
    const double pause = random.uniform(0.5, 4.0);
    person.script = {{b, speed, 0.0}, {b, 0.0, pause}, {a, speed, 0.0}, {a, 0.0, pause}};
    person.repeats = true;
    person.stubborn = true;  // the guard is measured, not people's courtesy
    crossing.world.movable.persons.push_back(std::move(person));
    return;
  }
}

/// One person stands at such a place of the way. False where it has none.
bool add_in_the_way(Crossing& crossing, const CrossingOptions& options, double needed,
                    Random& random) {
  constexpr std::size_t kEnds = 12;  // cells at both ends of the way without a person
  constexpr double kDoor = 0.6;      // [m] less room on both sides is a doorway
  const std::vector<Vec2>& way = crossing.way;
  const Ways ways(crossing.world, needed);
  std::vector<Vec2> places;
  for (std::size_t i = kEnds; i + kEnds < way.size(); ++i) {
    const Vec2 ahead = along(way, i);
    const Vec2 aside = Vec2(-ahead.y(), ahead.x()) * (random.chance(0.5) ? 1.0 : -1.0);
    const double room = ways.room(way[i]);
    const bool door = room < kDoor && room <= ways.room(way[i - 1]) && room < ways.room(way[i + 1]);
    if (options.crowd == Crowd::kCorridor && room > 0.8 && room < 1.3)
      places.push_back(way[i]);
    else if (options.crowd == Crowd::kDoorway && door)
      places.push_back(way[i]);
    else if (options.crowd == Crowd::kInside && door)
      places.push_back(way[i] + 0.6 * ahead);
    else if (options.crowd == Crowd::kBeside && door)
      places.push_back(way[i] - 0.5 * ahead + 0.7 * aside);
  }
  std::erase_if(places, [&](const Vec2& place) {
    return (place - crossing.start_in_world.position()).norm() < needed + 1.0 ||
           ways.room(place) < options.body + 0.02;
  });
  if (places.empty())
    return false;
  const Vec2 place = places[static_cast<std::size_t>(
      random.uniform(0.0, static_cast<double>(places.size()) - 1e-6))];
  crossing.world.movable.persons.push_back(person_at(place, options.body, "standing"));
  sim::World wide = crossing.world;
  wide.movable.persons.back().radius += kPersonRoom;
  Ways past(wide, needed);
  past.spread(*past.cell_at(crossing.start_in_world.position()));
  crossing.has_way = past.length(*past.cell_at(way.back())) <= 2.0 * options.most;
  return true;
}

/// The robot's way to the goal. Without progress a person stands in the way, and another way is
/// taken. People move on: only the newest such place counts, and none without a way around it.
class Navigator {
 public:
  Navigator(const Crossing& crossing, double radius, double body)
      : at_first_(*crossing.ways),
        ways_(at_first_),
        goal_(crossing.way.back()),
        radius_(radius),
        body_(body) {}

  /// The present target.
  Vec2 carrot(const Vec2& robot, double seconds) {
    const double left = ways_.left(robot);
    if (left < nearest_ - kNearer) {
      nearest_ = left;
      since_ = seconds;
    } else if (seconds - since_ > kPatience) {
      close(robot);
      since_ = seconds;
      nearest_ = ways_.left(robot);
    }
    return ways_.back_from(robot, kAhead);
  }

 private:
  static constexpr int kAhead = 12;  // cells

  void close(const Vec2& robot) {
    const Vec2 way = ways_.back_from(robot, kAhead) - robot;
    ways_ = at_first_;
    ways_.block(robot + way.normalized() * (radius_ + kBefore + body_), body_);
    const int goal = *ways_.nearest(goal_);
    ways_.spread(goal);
    if (ways_.centre(goal) != goal_ || ways_.left(robot) == kNever)
      ways_ = at_first_;
  }

  const Ways& at_first_;
  Ways ways_;
  Vec2 goal_;
  double radius_;
  double body_;
  double nearest_ = kNever;  // [m] least remaining way so far
  double since_ = 0.0;       // [s] of that
};

/// A line for each new contact, with the robot's estimates.
void tell(const sim::ContactWatch& watch, std::size_t& told, const Drive& drive, double seconds) {
  constexpr const char* kBlames[] = {"caused", "walked into", "unseen"};
  for (; told < watch.contacts().size(); ++told) {
    const sim::Contact& contact = watch.contacts()[told];
    const Pose robot = drive.seen().true_pose_in_world;
    const Vec2 at = to_frame(robot, contact.at_in_world);
    std::printf(
        "  at %.1f s: %s, %s; robot at (%.2f, %.2f) %.0f degrees, contact at (%.2f, %.2f) from it, "
        "%.3f m/s towards it, heard for %.1f of %.1f s; behaviors want %.2f m/s, guard %.2f %s\n",
        seconds, kBlames[static_cast<int>(contact.blame)],
        contact.name.empty() ? "a wall" : contact.name.c_str(), robot.x, robot.y, degrees(robot.th),
        at.x(), at.y(), contact.towards, contact.heard, contact.needed, drive.commanded().velocity,
        drive.guarded().velocity, drive.guarded().reason.c_str());
  }
}

}  // namespace

std::optional<Crossing> plan_crossing(const CrossingOptions& options,
                                      const protocol::RobotParameters& robot) {
  Crossing crossing;
  crossing.world = sim::load_world(find_file(config_folder() + "/worlds", options.world, ".wld"));
  const double needed = robot.radius + kRoom;
  Ways ways(crossing.world, needed);
  const auto start = ways.nearest(crossing.world.start.value_or(Pose{}).position());
  if (!start)
    return std::nullopt;
  ways.spread(*start);
  crossing.way = ways.way_to(ways.farthest(options.most));
  crossing.length = static_cast<double>(crossing.way.size()) * kCell;
  ways.spread(*ways.nearest(crossing.way.back()));
  crossing.ways = std::make_shared<const Ways>(ways);
  if (crossing.length < kShortest)
    return std::nullopt;
  const Vec2 ahead = along(crossing.way, 3);
  crossing.start_in_world = {crossing.way.front().x(), crossing.way.front().y(),
                             std::atan2(ahead.y(), ahead.x())};
  Random random(options.seed, 71);
  if (options.crowd == Crowd::kUsual) {
    for (int i = 0; i < 2; ++i)
      add_standing(crossing, options, needed, random);
    for (int i = 0; i < 2; ++i)
      add_walking(crossing, options, needed, random);
  } else if (options.crowd != Crowd::kNobody &&
             !add_in_the_way(crossing, options, needed, random)) {
    return std::nullopt;
  }
  return crossing;
}

CrossingResult drive_crossing(const Crossing& crossing, const CrossingOptions& options,
                              const sim::SonarModel& sonar, bool trace) {
  Drive drive({.made_world = std::make_shared<const sim::World>(crossing.world),
               .robot = options.robot,
               .seed = options.seed,
               .start_in_world = crossing.start_in_world,
               .sonar = sonar,
               .guard = true,
               .knows_walls = kPlaceError});
  const double radius = drive.parameters().radius;
  const sim::ContactWatch& watch = drive.watch();
  Navigator navigator(crossing, radius, options.body);
  std::size_t told = 0;
  CrossingResult result;
  // A Khepera creeps, since its sonars have a short range.
  const double slow = std::min(1.0, drive.parameters().sonar_max_range / 1.0);
  const double limit =
      crossing.has_way ? 120.0 + 20.0 * crossing.length / std::max(0.2, slow) : 120.0;
  const double near = std::max(0.15, 0.5 * radius);
  while (result.seconds < limit) {
    const Pose pose = drive.seen().true_pose_in_world;
    const Vec2 ahead = navigator.carrot(pose.position(), result.seconds);
    if ((crossing.way.back() - pose.position()).norm() < near) {
      result.arrived = true;
      break;
    }
    drive.go_to(transform(drive.seen().pose_in_odom, to_frame(pose, ahead)), 0.4, near);
    drive.advance();
    result.seconds += 0.1;
    if (trace)
      tell(watch, told, drive, result.seconds);
  }
  result.closest = watch.closest_person();
  for (const sim::Contact& contact : watch.contacts()) {
    const bool person = contact.kind == sim::ThingKind::kPerson;
    if (contact.blame == sim::Blame::kWalkedInto)
      result.walked_into += person ? 1 : 0;
    else if (!person)
      ++result.things;
    else
      ++(contact.walks ? result.walking : result.standing);
    result.unheard += person && contact.blame == sim::Blame::kUnseen ? 1 : 0;
  }
  result.end_in_world = drive.seen().true_pose_in_world.position();
  return result;
}

}  // namespace saphira::test

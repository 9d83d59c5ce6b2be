#include "saphira/explore/free_floor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/base/shortest_ways.hpp"

namespace saphira::explore {

namespace {

constexpr int kMost = 12;         // evidence of a cell, either way
constexpr int kEcho = 3;          // evidence of an echo; that of a free beam is 1
constexpr int kSure = 2;          // evidence for a free or an occupied cell
constexpr double kBeam = 2.5;     // [m] of a beam; an echo from farther away is from a wide arc
constexpr double kBefore = 0.15;  // [m] before an echo, a beam is free no more
constexpr double kFreeBeam = radians(10.0);
constexpr double kNearEcho = 1.2;  // [m] the arc of a farther echo is too wide to be something
constexpr double kEchoBeam = radians(6.0);
constexpr double kBody = 0.25;    // [m] around the robot's middle the floor is free
constexpr double kDriven = 0.12;  // [m] from its middle: it can drive there
constexpr double kNarrow = 0.22;  // [m] from the robot's middle to an obstacle, at the least
constexpr double kWide = 0.7;     // [m] enough of it
constexpr double kAround = 0.5;   // [m] around a place; with this many unseen cells it is an edge
constexpr std::size_t kUnseen = 12;
constexpr double kBeside = 0.5;    // [m] a robot that passes something farther away...
constexpr double kPassed = 1.0;    // [m] ...and not as far as this, sees its side
constexpr double kTried = 0.7;     // [m] around a tried place
constexpr double kNearLane = 2.0;  // [m]
constexpr double kLeast = 0.5;     // [m] a shorter lane is none
constexpr std::size_t kEach = 4;   // of the cells on a lane
constexpr double kNarrowLane = 0.7;
constexpr double kWideLane = 1.6;

}  // namespace

FreeFloor::FreeFloor(std::vector<lps::SonarMount> sonars)
    : sonars_(std::move(sonars)),
      evidence_(kCells, 0),
      seen_(kCells, false),
      driven_(kCells, false),
      passed_(kCells, false) {}

std::optional<std::size_t> FreeFloor::cell(const Vec2& at) const {
  if (!corner_)
    return std::nullopt;
  const Vec2 in = (at - *corner_) / kCell;
  const auto most = static_cast<double>(kSide);
  if (!(in.minCoeff() >= 0.0 && in.maxCoeff() < most))
    return std::nullopt;
  return static_cast<std::size_t>(static_cast<long>(in.y()) * kSide + static_cast<long>(in.x()));
}

Vec2 FreeFloor::middle(std::size_t cell) const {
  const long index = static_cast<long>(cell);
  return *corner_ + kCell * Vec2(static_cast<double>(index % kSide) + 0.5,
                                 static_cast<double>(index / kSide) + 0.5);
}

bool FreeFloor::is_free(std::size_t cell) const {
  return evidence_[cell] <= -kSure;
}

bool FreeFloor::is_free(const Vec2& at) const {
  const auto index = cell(at);
  return index && is_free(*index);
}

void FreeFloor::add(const Pose& robot, const std::vector<lps::SonarReading>& readings) {
  if (!corner_)
    corner_ = robot.position() - Vec2(kReach, kReach);
  const auto around = [&](const Vec2& at, double far, const auto& visit) {
    for (double y = at.y() - far; y <= at.y() + far; y += kCell)
      for (double x = at.x() - far; x <= at.x() + far; x += kCell)
        if (const auto index = cell({x, y}))
          visit(*index);
  };
  const auto weigh = [&](std::size_t index, int evidence) {
    evidence_[index] =
        static_cast<std::int8_t>(std::clamp(evidence_[index] + evidence, -kMost, kMost));
    seen_[index] = true;
  };
  around(robot.position(), kBody, [&](std::size_t index) {
    const double off = (middle(index) - robot.position()).norm();
    if (off < kBody)
      weigh(index, -kMost);
    driven_[index] = driven_[index] || off < kDriven;
  });
  around(robot.position(), kPassed, [&](std::size_t index) {
    passed_[index] = passed_[index] || (middle(index) - robot.position()).norm() < kPassed;
  });
  for (const lps::SonarReading& reading : readings) {
    if (!reading.echo)
      continue;  // a wall that is met aslant is silent
    for (const lps::SonarMount& mount : sonars_) {
      if (mount.sonar != reading.sonar)
        continue;
      const Pose sonar = compose(robot, mount.in_robot);
      around(sonar.position(), std::min(kBeam, reading.range + kCell), [&](std::size_t index) {
        const Vec2 in = to_frame(sonar, middle(index));
        const double far = in.norm();
        const double bearing = std::abs(std::atan2(in.y(), in.x()));
        if (far < std::min(kBeam, reading.range - kBefore)) {
          if (bearing < kFreeBeam)
            weigh(index, -1);
        } else if (reading.range < kNearEcho && std::abs(far - reading.range) < kCell &&
                   bearing < kEchoBeam) {
          weigh(index, kEcho);
        }
      });
    }
  }
}

// Two sweeps over the cells (Borgefors 1986).
std::vector<float> FreeFloor::clearance() const {
  std::vector<float> far(kCells, static_cast<float>(kWide + kCell));
  const auto sweep = [&](std::size_t at, bool forward) {
    const long column = static_cast<long>(at) % kSide;
    float least = evidence_[at] >= kSure ? 0.0F : far[at];
    for (const auto& [dx, dy] : {std::pair{1L, 0L}, {1L, 1L}, {0L, 1L}, {-1L, 1L}}) {
      const long x = column + (forward ? -dx : dx);
      const long before = static_cast<long>(at) + (forward ? -1 : 1) * (dy * kSide + dx);
      if (x < 0 || x >= kSide || before < 0 || before >= static_cast<long>(kCells))
        continue;
      constexpr auto kStraight = static_cast<float>(kCell);
      constexpr auto kAslant = static_cast<float>(kCell * 1.41421356);
      least = std::min(least, far[static_cast<std::size_t>(before)] +
                                  (dx != 0 && dy != 0 ? kAslant : kStraight));
    }
    far[at] = least;
  };
  for (std::size_t at = 0; at < kCells; ++at)
    sweep(at, true);
  for (std::size_t at = kCells; at-- > 0;)
    sweep(at, false);
  return far;
}

/// The cheapest way from one of the cells to the first that is accepted, rather in the middle of
/// the free floor than along its walls.
std::vector<std::size_t> FreeFloor::search(const std::vector<float>& clearance,
                                           const std::vector<std::size_t>& from,
                                           const Accept& accept) const {
  ShortestWays ways(kCells);
  for (const std::size_t start : from)
    ways.reach(start, 0.0);
  while (const auto next = ways.next()) {
    if (accept(*next))
      return ways.way_to(*next);
    const long at = static_cast<long>(*next);
    for (const auto& [dx, dy] : {std::pair{1L, 0L},
                                 {-1L, 0L},
                                 {0L, 1L},
                                 {0L, -1L},
                                 {1L, 1L},
                                 {1L, -1L},
                                 {-1L, 1L},
                                 {-1L, -1L}}) {
      const long column = at % kSide + dx;
      const long row = at / kSide + dy;
      if (column < 0 || row < 0 || column >= kSide || row >= kSide)
        continue;
      const auto there = static_cast<std::size_t>(row * kSide + column);
      // A robot that stands too near to something gets away from it.
      if (ways.settled(there) ||
          !(driven_[there] ||
            (is_free(there) &&
             clearance[there] >= std::min(clearance[*next], static_cast<float>(kNarrow)))))
        continue;
      const double narrow = std::max(0.0, kWide - static_cast<double>(clearance[there])) / kWide;
      ways.reach(
          there,
          ways.cost(*next) + kCell * (dx != 0 && dy != 0 ? 1.41421356 : 1.0) * (1.0 + 4.0 * narrow),
          *next);
    }
  }
  return {};
}

/// [m] The least clearance on a straight line; 0 where it is not free.
double FreeFloor::narrowest(const std::vector<float>& clearance, const Vec2& from,
                            const Vec2& to) const {
  double least = kWide;
  const double length = (to - from).norm();
  const int steps = static_cast<int>(length / (kCell / 2)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const auto at = cell(from + (to - from) * (static_cast<double>(i) / steps));
    if (!at || !(is_free(*at) || driven_[*at]))
      return 0.0;
    least = std::min(least, static_cast<double>(clearance[*at]));
  }
  return least;
}

/// The corners of a way, which is straight between them and passes no nearer to obstacles.
std::vector<Vec2> FreeFloor::corners(const std::vector<float>& clearance,
                                     const std::vector<std::size_t>& way) const {
  std::vector<Vec2> out;
  for (std::size_t at = 0; at + 1 < way.size();) {
    std::size_t next = at + 1;
    double least = clearance[way[at]];
    for (std::size_t i = at + 1; i < way.size(); ++i) {
      least = std::min(least, static_cast<double>(clearance[way[i]]));
      if (narrowest(clearance, middle(way[at]), middle(way[i])) < std::min(least, 0.5))
        break;
      next = i;
    }
    out.push_back(middle(way[next]));
    at = next;
  }
  return out;
}

bool FreeFloor::is_edge(const Vec2& at) const {
  std::size_t unseen = 0;
  for (double y = -kAround; y <= kAround; y += kCell)
    for (double x = -kAround; x <= kAround; x += kCell)
      if (const auto near = cell(at + Vec2(x, y));
          near && !seen_[*near] && std::hypot(x, y) < kAround)
        ++unseen;
  return unseen >= kUnseen;
}

std::vector<Vec2> FreeFloor::way_to_look(const Vec2& from, const std::vector<Vec2>& tried,
                                         bool sides) const {
  const auto start = cell(from);
  if (!start)
    return {};
  const std::vector<float> clear = clearance();
  const auto is_near = [](const Vec2& at) {
    return [at](const Vec2& one) { return (one - at).norm() < kTried; };
  };
  return corners(clear, search(clear, {*start}, [&](std::size_t at) {
                   const bool beside =
                       sides && !passed_[at] && clear[at] >= kBeside && clear[at] <= kWide;
                   return clear[at] >= kNarrow && (beside || is_edge(middle(at))) &&
                          std::none_of(tried.begin(), tried.end(), is_near(middle(at)));
                 }));
}

std::vector<Vec2> FreeFloor::way_to(const Vec2& from, const Vec2& to) const {
  const auto start = cell(from);
  const auto end = cell(to);
  if (!start || !end)
    return {};
  const std::vector<float> clear = clearance();
  return corners(clear, search(clear, {*start}, [&](std::size_t at) { return at == *end; }));
}

double FreeFloor::area() const {
  std::size_t cells = 0;
  for (std::size_t at = 0; at < kCells; ++at)
    cells += is_free(at) ? 1U : 0U;
  return static_cast<double>(cells) * kCell * kCell;
}

bool FreeFloor::goes_on() const {
  const auto is_border = [](long at) { return std::min(at, kSide - 1 - at) < 3; };
  for (std::size_t at = 0; at < kCells; ++at)
    if (is_free(at) &&
        (is_border(static_cast<long>(at) % kSide) || is_border(static_cast<long>(at) / kSide)))
      return true;
  return false;
}

std::vector<Lane> FreeFloor::next_lanes(const Vec2& from, const std::vector<Lane>& lanes) const {
  const std::vector<float> clear = clearance();
  const auto start = cell(from);
  if (!start)
    return {};
  std::vector<std::size_t> on{*start};
  for (const Lane& lane : lanes)
    for (double along = 0.0; along < 1.0; along += kCell / (lane.to - lane.from).norm())
      if (const auto at = cell(lane.from + along * (lane.to - lane.from)))
        on.push_back(*at);
  std::optional<std::size_t> widest;
  search(clear, {*start}, [&](std::size_t at) {
    if (clear[at] < kNarrow || (widest && clear[at] <= clear[*widest]))
      return false;
    const Vec2 there = middle(at);
    bool near = false;
    for (std::size_t i = 0; i < on.size() && !near; i += kEach)
      near = (middle(on[i]) - there).norm() < kNearLane &&
             narrowest(clear, middle(on[i]), there) > 0.0;
    if (!near)
      widest = at;
    return false;
  });
  if (!widest)
    return {};
  const std::vector<std::size_t> way =
      search(clear, on, [&](std::size_t at) { return at == *widest; });
  if (way.empty())
    return {};
  std::vector<Lane> out;
  Vec2 at = middle(way.front());
  for (const Vec2& next : corners(clear, way)) {
    if ((next - at).norm() < kLeast && next != middle(way.back()))
      continue;
    out.push_back({at, next, std::clamp(2.0 * narrowest(clear, at, next), kNarrowLane, kWideLane)});
    at = next;
  }
  return out;
}

}  // namespace saphira::explore

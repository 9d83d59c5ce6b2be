#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

#include "../free_path.hpp"
#include "program.hpp"
#include "saphira/behaviors/language.hpp"
#include "saphira/lps/point.hpp"

namespace saphira::behaviors::language {
namespace {

constexpr double kMetres = 0.001;
constexpr double kMillimetres = 1000.0;

Pose point(const double* p) {
  return {p[0], p[1], p[2]};
}
void put(const Pose& pose, double* out) {
  out[0] = pose.x;
  out[1] = pose.y;
  out[2] = pose.th;
}

// The numbers behind the names of manual 6.6.2 and 7.8.
constexpr double kFront = 0.0;
constexpr double kSides = 1.0;
constexpr double kAll = 2.0;
constexpr double kBack = 3.0;
constexpr double kLeft = 4.0;
constexpr double kRight = 5.0;

enum class Beside { left, right };

lps::Source source(double value) {
  if (value == kFront)
    return lps::Source::front;
  return value == kSides ? lps::Source::sides : lps::Source::all;
}

constexpr std::size_t kMostAreas = 16;  // of a behavior

void note(Call& call, const Area& area) {
  if (call.evaluation != nullptr && call.evaluation->areas.size() < kMostAreas)
    call.evaluation->areas.push_back(area);
}

void occ_box(Call& call, const double* a, double* out) {
  const lps::Axis axis = a[0] == kSides ? lps::Axis::sides : lps::Axis::front;
  const double cx = a[1] * kMetres;
  const double cy = a[2] * kMetres;
  const double h = a[3] * kMetres;
  const double w = a[4] * kMetres;
  const lps::Occupancy found = call.context->lps.box(axis, cx, cy, h, w);
  *out = kMillimetres * found.distance;
  if (found.point)
    note(call, {cx - h / 2.0, cx + h / 2.0, cy - w / 2.0, cy + w / 2.0});
}

void occ_plane(Call& call, const double* a, double* out) {
  const lps::Direction direction = a[0] == kBack    ? lps::Direction::back
                                   : a[0] == kLeft  ? lps::Direction::left
                                   : a[0] == kRight ? lps::Direction::right
                                                    : lps::Direction::front;
  *out = kMillimetres *
         call.context->lps
             .plane(direction, source(a[1]), a[2] * kMetres, a[3] * kMetres, a[4] * kMetres)
             .distance;
}

/// Obstacles that a disc can meet within `within` [m].
const std::vector<Vec2>& near(Call& call, double within) {
  if (call.near_within < within) {
    call.near.clear();
    call.near.reserve(call.context->lps.obstacles().size());
    for (const Vec2& p : call.context->lps.obstacles())
      if (p.squaredNorm() < within * within)
        call.near.push_back(p);
    call.near_within = within;
  }
  return call.near;
}

/// sfFreePath(direction, radius, limit)
void path(Call& call, const double* a, double* out) {
  const double radius = a[1] * kMetres;
  const double limit = std::clamp(a[2] * kMetres, 0.0, 10.0);
  const double free = free_path(near(call, limit + radius), a[0], radius, limit);
  *out = kMillimetres * free;
  if (free < limit && a[0] == 0.0)
    note(call, {0.0, limit + radius, -radius, radius});
}

/// As sfFreePath straight ahead, with the obstacles of one side alone.
template <Beside kSide>
void path_beside(Call& call, const double* a, double* out) {
  const double radius = a[0] * kMetres;
  const double limit = std::clamp(a[1] * kMetres, 0.0, 10.0);
  double free = limit;
  for (const Vec2& p : near(call, limit + radius)) {
    const bool left = p.y() >= 0.0;
    if (left != (kSide == Beside::left) || p.x() <= 0.0 || std::abs(p.y()) >= radius)
      continue;
    free = std::min(free, p.x() - std::sqrt(radius * radius - p.y() * p.y()));
  }
  *out = kMillimetres * std::max(free, 0.0);
  if (free < limit)
    note(call, kSide == Beside::left ? Area{0.0, limit + radius, 0.0, radius}
                                     : Area{0.0, limit + radius, -radius, 0.0});
}

/// sfNearestLeft(from, to, limit): among the obstacles from `from` to `to` along X.
template <Beside kSide>
void nearest_beside(Call& call, const double* a, double* out) {
  const double from = a[0] * kMetres;
  const double to = a[1] * kMetres;
  const double limit = std::clamp(a[2] * kMetres, 0.0, 10.0);
  double distance = limit;
  for (const Vec2& p : near(call, limit))
    if ((p.y() >= 0.0) == (kSide == Beside::left) && p.x() > from && p.x() < to)
      distance = std::min(distance, p.norm());
  *out = kMillimetres * distance;
  if (distance < limit)
    note(call, kSide == Beside::left ? Area{from, to, 0.0, limit} : Area{from, to, -limit, 0.0});
}

/// sfLaneOffset(lane, berth, reach): beside the obstacles that the hull passes within `reach`.
void lane_offset(Call& call, const double* a, double* out) {
  const ToFrame to_lane({a[0] * kMetres, a[1] * kMetres, a[2]});
  const double berth = a[3] * kMetres;
  const double reach = std::clamp(a[4] * kMetres, 0.0, 10.0);
  const Vec2 robot = to_lane(Vec2{0.0, 0.0});
  double right = -2.0 * berth;
  double left = 2.0 * berth;
  for (const Vec2& point : near(call, reach + 2.0 * berth)) {
    const Vec2 p = to_lane(point);
    if (const double ahead = p.x() - robot.x();
        ahead < -call.context->model.radius || ahead > reach)
      continue;
    (p.y() < 0.0 ? right : left) = p.y() < 0.0 ? std::max(right, p.y()) : std::min(left, p.y());
  }
  const double least = right + berth;
  const double most = left - berth;
  *out = kMillimetres * (least > most ? (right + left) / 2.0 : std::clamp(0.0, least, most));
}

constexpr double kFree = 0.8;                 ///< share of the reach that counts as a free way
constexpr double kRoom = 0.12;                ///< [m] beside the hull on a wide way
constexpr double kTight = 0.08;               ///< [m] beside the hull, at least
constexpr double kTightCost = radians(40.0);  ///< the cost of a tight way, as a turn
constexpr double kWidest = radians(100.0);
constexpr double kStep = radians(2.5);

/// The cheapest direction on that side of `wish`: the deviation plus the turn, and more where the
/// way is tight. A blocked direction costs more than any free one.
const Way& way(Call& call, const double* a) {
  for (const Call::Known& known : call.ways)
    if (known.side == a[0] && known.wish == a[1] && known.reach == a[2])
      return known.way;
  const double radius = call.context->model.radius;
  const double wish = std::isnan(a[1]) ? 0.0 : std::clamp(a[1], -kWidest, kWidest);
  const double reach = std::clamp(a[2] * kMetres, 0.01, 10.0);
  const std::vector<Vec2>& points = near(call, reach + radius + kRoom);
  Way best{wish, 1e9};
  for (int i = 0; i <= static_cast<int>(2.0 * kWidest / kStep); ++i) {
    const double direction = wish + (a[0] == kLeft ? i : -i) * kStep;
    if (std::abs(direction) > kWidest + 1e-9)
      break;
    double cost = std::abs(direction - wish) + 0.5 * std::abs(direction);
    if (cost >= best.cost)
      continue;
    const double tight = free_path(points, direction, radius + kTight, reach);
    if (tight < kFree * reach)
      cost += 2.0 * kPi * (2.0 - tight / reach);
    else if (free_path(points, direction, radius + kRoom, reach) < kFree * reach)
      cost += kTightCost;
    if (cost < best.cost)
      best = {direction, cost};
  }
  call.ways.push_back({a[0], a[1], a[2], best});
  return call.ways.back().way;
}

constexpr double kAside = radians(60.0);  ///< largest deviation from the wanted direction
constexpr double kMatters = 0.02;         ///< [m] smaller gains of room are ignored

/// sfWideWay(direction, radius, reach)
void wide_way(Call& call, const double* a, double* out) {
  const double radius = a[1] * kMetres;
  const double reach = std::clamp(a[2] * kMetres, 0.0, 10.0);
  const std::vector<Vec2>& points = near(call, reach + radius);
  *out = a[0];
  double best = clearance(points, a[0], reach, radius);
  for (int i = 1; i <= static_cast<int>(kAside / kStep) && best < radius; ++i)
    for (const double side : {1.0, -1.0}) {
      const double direction = a[0] + side * i * kStep;
      const double away = clearance(points, direction, reach, radius);
      if (away > best + kMatters) {
        best = away;
        *out = direction;
      }
    }
}

void set_goal(Call& call, const double* a, double* /*out*/) {
  if (std::isfinite(a[0]) && std::isfinite(a[1])) {
    call.context->shared.goal_bearing = a[0];
    call.context->shared.goal_distance = std::max(0.0, a[1] * kMetres);
  }
}

void set_preferred(Call& call, const double* a, double* /*out*/) {
  call.context->shared.preferred_turn =
      a[0] == 1.0 ? Side::left : (a[0] == 2.0 ? Side::right : Side::none);
}

void draw_lane(Call& call, const double* a, double* /*out*/) {
  if (std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]))
    call.evaluation->lane =
        Lane{{a[0] * kMetres, a[1] * kMetres, a[2]}, a[3] * kMetres, a[4] * kMetres};
}

constexpr Type kR = Type::real;
constexpr Type kI = Type::integer;
constexpr Type kP = Type::point;
constexpr Type kN = Type::nothing;

/// The language's type for a C++ type.
template <class T>
constexpr Type kTypeOf = std::is_same_v<T, Pose> ? Type::point
                         : std::is_integral_v<T> ? Type::integer
                                                 : Type::real;

template <class T>
T take(const double*& arguments) {
  if constexpr (std::is_same_v<T, Pose>)
    return point(std::exchange(arguments, arguments + 3));
  else
    return *arguments++;
}
void put(double value, double* out) {
  *out = value;
}

template <class F, class R, class... A>
Function entry(const char* name, R (F::*)(A...) const) {
  return {
      name, kTypeOf<R>, {kTypeOf<A>...}, [](Call&, [[maybe_unused]] const double* a, double* out) {
        // Braces take the arguments in order.
        put(std::apply(F{}, std::tuple<A...>{take<A>(a)...}), out);
      }};
}
template <class F, class R>
Function entry(const char* name, R (F::*)(const Context&) const) {
  return {name, kTypeOf<R>, {}, [](Call& call, const double*, double* out) {
            put(F{}(*call.context), out);
          }};
}
/// A function of points and numbers, or of the context. Its types are those of the language.
template <class F>
Function entry(const char* name, F /*function*/) {
  return entry(name, &F::operator());
}

}  // namespace

const std::vector<Function>& functions() {
  using D = const double*;
  static const std::vector<Function> all_functions{
      // Points and lines (manual 6.6.3.1).
      entry("sfPointPhi", [](Pose p) { return lps::phi(p); }),
      entry("sfPointDist", [](Pose p) { return lps::distance(p); }),
      entry("sfPointNormalDist", [](Pose p) { return lps::normal_distance(p); }),
      entry("sfPointDistPoint", [](Pose p, Pose q) { return lps::distance(p, q); }),
      entry("sfPointNormalDistPoint", [](Pose p, Pose q) { return lps::normal_distance(p, q); }),
      entry("sfPointXo", [](Pose p) { return lps::xo(p); }),
      entry("sfPointYo", [](Pose p) { return lps::yo(p); }),
      entry("sfPointXoPoint", [](Pose p, Pose q) { return lps::xo(p, q); }),
      entry("sfPointYoPoint", [](Pose p, Pose q) { return lps::yo(p, q); }),
      entry("sfPointBaricenter", [](Pose p, Pose q) { return lps::baricenter(p, q); }),
      entry("sfPointMove", [](Pose p, double x, double y) { return lps::move(p, x, y); }),
      entry("sfPointTurn",
            [](Pose p, double x) {
              return Pose{p.x, p.y, norm2_angle(p.th + x)};
            }),
      entry("sfPoint",
            [](double x, double y, double z) {
              return Pose{x, y, z};
            }),
      entry("sfChangeVP", [](Pose p, Pose q) { return lps::change_vp(p, q); }),
      entry("sfUnchangeVP", [](Pose p, Pose q) { return lps::unchange_vp(p, q); }),
      entry("sfGiven", [](Pose p) { return !(std::isnan(p.x) || std::isnan(p.y)); }),
      // Angles.
      entry("sfNormAngle", [](double x) { return norm_angle(x); }),
      entry("sfNorm2Angle", [](double x) { return norm2_angle(x); }),
      entry("sfNorm3Angle", [](double x) { return norm3_angle(x); }),
      entry("sfAddAngle", [](double x, double y) { return add_angle(x, y); }),
      entry("sfSubAngle", [](double x, double y) { return sub_angle(x, y); }),
      entry("sfAdd2Angle", [](double x, double y) { return add2_angle(x, y); }),
      entry("sfSub2Angle", [](double x, double y) { return sub2_angle(x, y); }),
      // Sonars (manual 6.6.2) and the obstacle memory.
      {"sfOccBox", kR, {kI, kR, kR, kR, kR}, occ_box},
      {"sfOccPlane", kR, {kI, kI, kR, kR, kR}, occ_plane},
      {"sfFreePath", kR, {kR, kR, kR}, path},
      {"sfFreePathLeft", kR, {kR, kR}, path_beside<Beside::left>},
      {"sfFreePathRight", kR, {kR, kR}, path_beside<Beside::right>},
      {"sfNearestLeft", kR, {kR, kR, kR}, nearest_beside<Beside::left>},
      {"sfNearestRight", kR, {kR, kR, kR}, nearest_beside<Beside::right>},
      {"sfLaneOffset", kR, {kP, kR, kR}, lane_offset},
      {"sfWay", kR, {kI, kR, kR}, [](Call& c, D a, double* o) { *o = way(c, a).direction; }},
      {"sfWayCost", kR, {kI, kR, kR}, [](Call& c, D a, double* o) { *o = way(c, a).cost; }},
      {"sfWideWay", kR, {kR, kR, kR}, wide_way},
      // The robot.
      entry("sfRobotRadius", [](const Context& c) { return c.model.radius * kMillimetres; }),
      entry("sfRobotDecel", [](const Context& c) { return c.model.deceleration * kMillimetres; }),
      entry("sfRobot.tv", [](const Context& c) { return c.robot.velocity * kMillimetres; }),
      entry("sfRobot.rv", [](const Context& c) { return degrees(c.robot.rotation_velocity); }),
      entry("sfRobot.mtv", [](const Context& c) { return c.model.max_velocity * kMillimetres; }),
      entry("sfRobot.mrv", [](const Context& c) { return degrees(c.model.max_rotation_velocity); }),
      entry("sfRobot.ax", [](const Context& c) { return c.robot.pose_in_odom.x * kMillimetres; }),
      entry("sfRobot.ay", [](const Context& c) { return c.robot.pose_in_odom.y * kMillimetres; }),
      entry("sfRobot.ath", [](const Context& c) { return c.robot.pose_in_odom.th; }),
      entry("sfCycle", [](const Context& c) { return static_cast<double>(c.cycle); }),
      // Values that behaviors pass to those of higher priority.
      entry("sfGoalKnown", [](const Context& c) { return c.shared.goal_bearing.has_value(); }),
      entry("sfGoalPhi", [](const Context& c) { return c.shared.goal_bearing.value_or(0.0); }),
      entry("sfGoalDist",
            [](const Context& c) {
              return c.shared.goal_bearing ? c.shared.goal_distance * kMillimetres : 1e9;
            }),
      {"sfSetGoal", kN, {kR, kR}, set_goal},
      entry("sfPreferredTurn",
            [](const Context& c) { return static_cast<int>(c.shared.preferred_turn); }),
      {"sfSetPreferredTurn", kN, {kI}, set_preferred},
      {"sfDrawLane", kN, {kP, kR, kR}, draw_lane},
      // Numbers.
      entry("sqrt", [](double x) { return std::sqrt(x); }),
      entry("sin", [](double x) { return std::sin(x); }),
      entry("cos", [](double x) { return std::cos(x); }),
      entry("tan", [](double x) { return std::tan(x); }),
      entry("atan2", [](double x, double y) { return std::atan2(x, y); }),
      entry("hypot", [](double x, double y) { return std::hypot(x, y); }),
      entry("floor", [](double x) { return std::floor(x); }),
      entry("ceil", [](double x) { return std::ceil(x); }),
  };
  return all_functions;
}

const std::vector<Constant>& constants() {
  static const std::vector<Constant> all_constants{
      {"sfFRONT", kFront}, {"sfSIDES", kSides},  {"sfALL", kAll},
      {"sfBACK", kBack},   {"sfLEFT", kLeft},    {"sfRIGHT", kRight},
      {"sfLEFTTURN", 1.0}, {"sfRIGHTTURN", 2.0}, {"sfNOTURN", 0.0},
      {"sfIN", 0.0},       {"sfOUT", 1.0},       {"TRUE", 1.0},
      {"FALSE", 0.0},      {"PI", kPi},          {"ANG_TO_RAD", kPi / 180.0}};
  return all_constants;
}

}  // namespace saphira::behaviors::language

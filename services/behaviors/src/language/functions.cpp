#include <algorithm>
#include <cmath>

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

}  // namespace

const std::vector<Function>& functions() {
  using D = const double*;
  static const std::vector<Function> all_functions{
      // Points and lines (manual 6.6.3.1).
      {"sfPointPhi",
       kR,
       {kP},
       [](Call&, D a, double* o) { *o = lps::phi(point(a)); },
       "bearing of a point from the robot, left is positive"},
      {"sfPointDist",
       kR,
       {kP},
       [](Call&, D a, double* o) { *o = lps::distance(point(a)); },
       "distance of a point from the robot"},
      {"sfPointNormalDist",
       kR,
       {kP},
       [](Call&, D a, double* o) { *o = lps::normal_distance(point(a)); },
       "distance of the robot from the line through a point, along its direction"},
      {"sfPointDistPoint",
       kR,
       {kP, kP},
       [](Call&, D a, double* o) { *o = lps::distance(point(a), point(a + 3)); },
       "distance between two points"},
      {"sfPointNormalDistPoint",
       kR,
       {kP, kP},
       [](Call&, D a, double* o) { *o = lps::normal_distance(point(a), point(a + 3)); },
       "distance of the second point from the line through the first"},
      {"sfPointXo",
       kR,
       {kP},
       [](Call&, D a, double* o) { *o = lps::xo(point(a)); },
       "x of the robot in the coordinates of a point"},
      {"sfPointYo",
       kR,
       {kP},
       [](Call&, D a, double* o) { *o = lps::yo(point(a)); },
       "y of the robot in the coordinates of a point"},
      {"sfPointXoPoint",
       kR,
       {kP, kP},
       [](Call&, D a, double* o) { *o = lps::xo(point(a), point(a + 3)); },
       "x of the second point in the coordinates of the first"},
      {"sfPointYoPoint",
       kR,
       {kP, kP},
       [](Call&, D a, double* o) { *o = lps::yo(point(a), point(a + 3)); },
       "y of the second point in the coordinates of the first"},
      {"sfPointBaricenter",
       kP,
       {kP, kP},
       [](Call&, D a, double* o) { put(lps::baricenter(point(a), point(a + 3)), o); },
       "the point midway between two"},
      {"sfPointMove",
       kP,
       {kP, kR, kR},
       [](Call&, D a, double* o) { put(lps::move(point(a), a[3], a[4]), o); },
       "a point moved by dx and dy in its own coordinates"},
      {"sfPointTurn",
       kP,
       {kP, kR},
       [](Call&, D a, double* o) {
         put({a[0], a[1], norm2_angle(a[2] + a[3])}, o);
       },
       "a point with its direction turned by an angle"},
      {"sfPoint",
       kP,
       {kR, kR, kR},
       [](Call&, D a, double* o) { put(point(a), o); },
       "a point from x, y and th, before the robot"},
      {"sfChangeVP",
       kP,
       {kP, kP},
       [](Call&, D a, double* o) { put(lps::change_vp(point(a), point(a + 3)), o); },
       "the second point in the coordinates of the first"},
      {"sfUnchangeVP",
       kP,
       {kP, kP},
       [](Call&, D a, double* o) { put(lps::unchange_vp(point(a), point(a + 3)), o); },
       "the second point, given in the coordinates of the first, before the robot"},
      {"sfGiven",
       kI,
       {kP},
       [](Call&, D a, double* o) { *o = std::isnan(a[0]) || std::isnan(a[1]) ? 0.0 : 1.0; },
       "1 where an optional point was given, else 0"},
      // Angles.
      {"sfNormAngle",
       kR,
       {kR},
       [](Call&, D a, double* o) { *o = norm_angle(a[0]); },
       "the angle in [0, 2 pi)"},
      {"sfNorm2Angle",
       kR,
       {kR},
       [](Call&, D a, double* o) { *o = norm2_angle(a[0]); },
       "the angle in (-pi, pi]"},
      {"sfNorm3Angle",
       kR,
       {kR},
       [](Call&, D a, double* o) { *o = norm3_angle(a[0]); },
       "the angle in [-pi/2, pi/2]"},
      {"sfAddAngle",
       kR,
       {kR, kR},
       [](Call&, D a, double* o) { *o = add_angle(a[0], a[1]); },
       "the sum in [0, 2 pi)"},
      {"sfSubAngle",
       kR,
       {kR, kR},
       [](Call&, D a, double* o) { *o = sub_angle(a[0], a[1]); },
       "the difference in [0, 2 pi)"},
      {"sfAdd2Angle",
       kR,
       {kR, kR},
       [](Call&, D a, double* o) { *o = add2_angle(a[0], a[1]); },
       "the sum in (-pi, pi]"},
      {"sfSub2Angle",
       kR,
       {kR, kR},
       [](Call&, D a, double* o) { *o = sub2_angle(a[0], a[1]); },
       "the difference in (-pi, pi]"},
      // Sonars (manual 6.6.2) and the obstacle memory.
      {"sfOccBox",
       kR,
       {kI, kR, kR, kR, kR},
       occ_box,
       "distance along sfFRONT or sfSIDES to the nearest reading in a box: axis, cx, cy, h, w"},
      {"sfOccPlane",
       kR,
       {kI, kI, kR, kR, kR},
       occ_plane,
       "distance to the nearest reading in a strip: direction, source, d, s1, s2"},
      {"sfFreePath", kR, {kR, kR, kR}, path, "how far a disc can go: direction, its radius, limit"},
      {"sfFreePathLeft",
       kR,
       {kR, kR},
       path_beside<Beside::left>,
       "how far a disc can go straight ahead for what is on the left: radius, limit"},
      {"sfFreePathRight",
       kR,
       {kR, kR},
       path_beside<Beside::right>,
       "how far a disc can go straight ahead for what is on the right: radius, limit"},
      {"sfNearestLeft",
       kR,
       {kR, kR, kR},
       nearest_beside<Beside::left>,
       "distance of the nearest obstacle on the left, with x from, to; limit"},
      {"sfNearestRight",
       kR,
       {kR, kR, kR},
       nearest_beside<Beside::right>,
       "distance of the nearest obstacle on the right, with x from, to; limit"},
      {"sfWay",
       kR,
       {kI, kR, kR},
       [](Call& c, D a, double* o) { *o = way(c, a).direction; },
       "the direction to go around what is in the way: sfLEFT or sfRIGHT, direction wished, reach"},
      {"sfWayCost",
       kR,
       {kI, kR, kR},
       [](Call& c, D a, double* o) { *o = way(c, a).cost; },
       "what sfWay's direction costs, as an angle: the more it turns and the tighter it is"},
      {"sfWideWay",
       kR,
       {kR, kR, kR},
       wide_way,
       "the nearest direction, up to 60 degrees away, that leads so far past everything, or as far "
       "as "
       "can be: direction, distance, reach"},
      // The robot.
      {"sfRobotRadius",
       kR,
       {},
       [](Call& c, D, double* o) { *o = c.context->model.radius * kMillimetres; },
       "of the hull"},
      {"sfRobotDecel",
       kR,
       {},
       [](Call& c, D, double* o) { *o = c.context->model.deceleration * kMillimetres; },
       "mm/s2 of a stop"},
      {"sfRobot.tv",
       kR,
       {},
       [](Call& c, D, double* o) { *o = c.context->robot.velocity * kMillimetres; },
       "velocity"},
      {"sfRobot.rv",
       kR,
       {},
       [](Call& c, D, double* o) { *o = degrees(c.context->robot.rotation_velocity); },
       "deg/s of rotation, counter-clockwise"},
      {"sfRobot.mtv",
       kR,
       {},
       [](Call& c, D, double* o) { *o = c.context->model.max_velocity * kMillimetres; },
       "the highest velocity"},
      {"sfRobot.mrv",
       kR,
       {},
       [](Call& c, D, double* o) { *o = degrees(c.context->model.max_rotation_velocity); },
       "deg/s, the highest velocity of rotation"},
      {"sfRobot.ax",
       kR,
       {},
       [](Call& c, D, double* o) { *o = c.context->robot.pose_in_odom.x * kMillimetres; },
       "x by dead reckoning"},
      {"sfRobot.ay",
       kR,
       {},
       [](Call& c, D, double* o) { *o = c.context->robot.pose_in_odom.y * kMillimetres; },
       "y by dead reckoning"},
      {"sfRobot.ath",
       kR,
       {},
       [](Call& c, D, double* o) { *o = c.context->robot.pose_in_odom.th; },
       "heading by dead reckoning"},
      {"sfCycle",
       kR,
       {},
       [](Call& c, D, double* o) { *o = static_cast<double>(c.context->cycle); },
       "number of the cycle; ten are a second"},
      // Values that behaviors pass to those of higher priority.
      {"sfGoalKnown",
       kI,
       {},
       [](Call& c, D, double* o) { *o = c.context->shared.goal_bearing ? 1.0 : 0.0; },
       "1 where a behavior below has said where it goes, else 0"},
      {"sfGoalPhi",
       kR,
       {},
       [](Call& c, D, double* o) { *o = c.context->shared.goal_bearing.value_or(0.0); },
       "where a behavior below goes: bearing; 0 where none has said it"},
      {"sfGoalDist",
       kR,
       {},
       [](Call& c, D, double* o) {
         *o = c.context->shared.goal_bearing ? c.context->shared.goal_distance * kMillimetres : 1e9;
       },
       "where a behavior below goes: how far; 1e9 where none has said it"},
      {"sfSetGoal", kN, {kR, kR}, set_goal, "says where this behavior goes: bearing and distance"},
      {"sfPreferredTurn",
       kI,
       {},
       [](Call& c, D, double* o) { *o = static_cast<double>(c.context->shared.preferred_turn); },
       "the value of sfPreferredTurnDir"},
      {"sfSetPreferredTurn", kN, {kI}, set_preferred, "sets sfPreferredTurnDir"},
      {"sfDrawLane",
       kN,
       {kP, kR, kR},
       draw_lane,
       "shows the lane: a point on it, directed along it; to its left edge, to its right edge"},
      // Numbers.
      {"sqrt", kR, {kR}, [](Call&, D a, double* o) { *o = std::sqrt(a[0]); }, "square root"},
      {"sin", kR, {kR}, [](Call&, D a, double* o) { *o = std::sin(a[0]); }, "sine"},
      {"cos", kR, {kR}, [](Call&, D a, double* o) { *o = std::cos(a[0]); }, "cosine"},
      {"tan", kR, {kR}, [](Call&, D a, double* o) { *o = std::tan(a[0]); }, "tangent"},
      {"atan2",
       kR,
       {kR, kR},
       [](Call&, D a, double* o) { *o = std::atan2(a[0], a[1]); },
       "the angle of (x, y) from y and x"},
      {"hypot",
       kR,
       {kR, kR},
       [](Call&, D a, double* o) { *o = std::hypot(a[0], a[1]); },
       "the length of (x, y)"},
      {"floor", kR, {kR}, [](Call&, D a, double* o) { *o = std::floor(a[0]); }, "rounded down"},
      {"ceil", kR, {kR}, [](Call&, D a, double* o) { *o = std::ceil(a[0]); }, "rounded up"},
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

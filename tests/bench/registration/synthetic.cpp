#include "synthetic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "saphira/base/random.hpp"

namespace saphira::bench {

using namespace logs;

namespace {

// Rooms are cut out of a solid, with sides along the axes.
class Solid {
 public:
  Solid(double width, double height)
      : columns_(cells(width)), rows_(cells(height)), free_(columns_ * rows_, 0) {}

  void cut(double x0, double y0, double x1, double y1) { fill(x0, y0, x1, y1, 1); }
  void stand(double x0, double y0, double x1, double y1) { fill(x0, y0, x1, y1, 0); }

  std::vector<sim::Segment> walls() const {
    std::vector<sim::Segment> out;
    const auto at = [&](std::size_t c, std::size_t r) {
      return c < columns_ && r < rows_ && free_[r * columns_ + c] != 0;
    };
    for (const bool across : {false, true}) {
      const std::size_t lines = across ? columns_ : rows_;
      const std::size_t length = across ? rows_ : columns_;
      for (std::size_t line = 1; line < lines; ++line) {
        std::size_t begin = 0;
        int last = 0;
        for (std::size_t i = 0; i <= length; ++i) {
          const bool a = across ? at(line - 1, i) : at(i, line - 1);
          const bool b = across ? at(line, i) : at(i, line);
          const int side = i == length || a == b ? 0 : a ? 1 : 2;
          if (side == last)
            continue;
          if (last != 0) {
            const double at_line = kCell * static_cast<double>(line);
            const double from = kCell * static_cast<double>(begin);
            const double to = kCell * static_cast<double>(i);
            out.push_back(across ? sim::Segment{{at_line, from}, {at_line, to}}
                                 : sim::Segment{{from, at_line}, {to, at_line}});
          }
          begin = i;
          last = side;
        }
      }
    }
    return out;
  }

 private:
  static constexpr double kCell = 0.05;  // [m]
  static std::size_t cells(double length) {
    return static_cast<std::size_t>(std::max(0.0, std::round(length / kCell)));
  }
  void fill(double x0, double y0, double x1, double y1, char value) {
    for (std::size_t r = cells(y0); r < std::min(cells(y1), rows_ - 1); ++r)
      for (std::size_t c = cells(x0); c < std::min(cells(x1), columns_ - 1); ++c)
        free_[r * columns_ + c] = value;
  }

  std::size_t columns_;
  std::size_t rows_;
  std::vector<char> free_;
};

// A rotated box.
void put_box(Floor& floor, const Vec2& middle, double length, double width, double turn) {
  const Pose pose{middle.x(), middle.y(), turn};
  const std::array<Vec2, 4> corners{transform(pose, Vec2(length / 2, width / 2)),
                                    transform(pose, Vec2(-length / 2, width / 2)),
                                    transform(pose, Vec2(-length / 2, -width / 2)),
                                    transform(pose, Vec2(length / 2, -width / 2))};
  for (std::size_t i = 0; i < 4; ++i)
    floor.walls.push_back({corners[i], corners[(i + 1) % 4]});
}

// The segments by the squares that they pass.
class Caster {
 public:
  explicit Caster(const std::vector<sim::Segment>& walls) : walls_(walls) {
    Vec2 high = Vec2::Constant(-1e9);
    for (const sim::Segment& wall : walls)
      for (const Vec2& p : {wall.from, wall.to}) {
        low_ = low_.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    low_ -= Vec2::Constant(kSquare);
    columns_ = index(high.x() - low_.x()) + 2;
    rows_ = index(high.y() - low_.y()) + 2;
    squares_.resize(static_cast<std::size_t>(columns_ * rows_));
    for (std::size_t k = 0; k < walls.size(); ++k) {
      const Vec2 along = walls[k].to - walls[k].from;
      const int steps = 1 + static_cast<int>(along.norm() / (0.25 * kSquare));
      for (int i = 0; i <= steps; ++i) {
        const Vec2 p = walls[k].from + along * (static_cast<double>(i) / steps) - low_;
        // A corner may be cut between two samples: the neighbouring squares have it as well.
        for (const double dx : {-0.25 * kSquare, 0.25 * kSquare})
          for (const double dy : {-0.25 * kSquare, 0.25 * kSquare}) {
            auto& square = squares_[static_cast<std::size_t>(index(p.y() + dy) * columns_ +
                                                             index(p.x() + dx))];
            if (std::find(square.begin(), square.end(), k) == square.end())
              square.push_back(k);
          }
      }
    }
  }

  double range(const Vec2& origin, double angle, double reach) const {
    const Vec2 ahead(std::cos(angle), std::sin(angle));
    double best = reach;
    int column = index(origin.x() - low_.x());
    int row = index(origin.y() - low_.y());
    const auto until = [&](double at, double by, int cell) {
      const double edge = kSquare * (by > 0.0 ? cell + 1 : cell);
      return std::abs(by) < 1e-12 ? 1e18 : (edge - at) / by;
    };
    double gone = 0.0;
    while (gone < best && column >= 0 && row >= 0 && column < columns_ && row < rows_) {
      for (const std::size_t k : squares_[static_cast<std::size_t>(row * columns_ + column)])
        best = std::min(best, meets(walls_[k], origin, ahead));
      const double to_x = until(origin.x() - low_.x(), ahead.x(), column);
      const double to_y = until(origin.y() - low_.y(), ahead.y(), row);
      gone = std::min(to_x, to_y);
      if (to_x < to_y)
        column += ahead.x() > 0.0 ? 1 : -1;
      else
        row += ahead.y() > 0.0 ? 1 : -1;
    }
    return best;
  }

 private:
  static constexpr double kSquare = 1.0;  // [m]
  static int index(double at) { return static_cast<int>(std::floor(at / kSquare)); }
  static double meets(const sim::Segment& wall, const Vec2& origin, const Vec2& ahead) {
    const Vec2 along = wall.to - wall.from;
    const double cross = ahead.x() * along.y() - ahead.y() * along.x();
    if (std::abs(cross) < 1e-12)
      return std::numeric_limits<double>::infinity();
    const Vec2 off = wall.from - origin;
    const double range = (off.x() * along.y() - off.y() * along.x()) / cross;
    const double share = (off.x() * ahead.y() - off.y() * ahead.x()) / cross;
    return range > 0.0 && share >= 0.0 && share <= 1.0 ? range
                                                       : std::numeric_limits<double>::infinity();
  }

  const std::vector<sim::Segment>& walls_;
  Vec2 low_ = Vec2::Constant(1e9);
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<std::size_t>> squares_;
};

// The place at that distance along a route.
Vec2 place_on(const std::vector<Vec2>& route, double way) {
  way = std::max(0.0, way);
  for (std::size_t i = 1; i < route.size(); ++i) {
    const double length = (route[i] - route[i - 1]).norm();
    if (way <= length)
      return route[i - 1] + (route[i] - route[i - 1]) * (way / std::max(length, 1e-9));
    way -= length;
  }
  return route.back();
}

}  // namespace

Floor office_floor(std::uint64_t seed) {
  Random random(seed, 21);
  Solid solid(34.0, 30.0);
  // The corridors, on lines x = 8, 26 and y = 8, 22.
  solid.cut(7.0, 7.0, 27.0, 9.0);
  solid.cut(7.0, 21.0, 27.0, 23.0);
  solid.cut(7.0, 7.0, 9.0, 23.0);
  solid.cut(25.0, 7.0, 27.0, 23.0);
  Floor floor;
  // Rooms along each side, within and without.
  struct Room {
    Vec2 middle;
    Vec2 door;  // in the corridor before it
  };
  std::vector<Room> rooms;
  const auto row = [&](double from, double to, double wall, double depth, bool across) {
    for (double at = from; at < to - 2.4;) {
      const double width = std::min(random.uniform(2.5, 5.0), to - at);
      const double deep = std::abs(depth) * random.uniform(0.7, 1.0);
      const double near = depth > 0.0 ? wall + 0.15 : wall - 0.15;
      const double far = depth > 0.0 ? wall + deep : wall - deep;
      const double door = at + random.uniform(0.4, width - 1.4);
      const auto cut = [&](double a0, double b0, double a1, double b1) {
        if (b0 > b1)
          std::swap(b0, b1);
        if (across)
          solid.cut(b0, a0, b1, a1);
        else
          solid.cut(a0, b0, a1, b1);
      };
      if (random.chance(0.2)) {  // shut: only the niche of its door is visible
        cut(door, wall, door + 0.9, depth > 0.0 ? wall + 0.1 : wall - 0.1);
      } else {
        cut(at, near, at + width - 0.15, far);
        cut(door, depth > 0.0 ? wall - 0.1 : wall + 0.1, door + 0.9,
            depth > 0.0 ? near + 0.1 : near - 0.1);
        const double mid = 0.5 * (near + far);
        const double out = depth > 0.0 ? wall - 1.0 : wall + 1.0;
        const double at_door = door + 0.45;
        rooms.push_back(across ? Room{{mid, at_door}, {out, at_door}}
                               : Room{{at_door, mid}, {at_door, out}});
      }
      at += width;
    }
  };
  row(7.0, 27.0, 7.0, -5.0, false);
  row(10.0, 24.0, 9.0, 5.0, false);
  row(10.0, 24.0, 21.0, -5.0, false);
  row(7.0, 27.0, 23.0, 5.0, false);
  row(9.5, 20.5, 7.0, -5.0, true);
  row(9.5, 20.5, 27.0, 5.0, true);
  floor.walls = solid.walls();
  // Furniture beside the way into the room.
  for (const Room& room : rooms)
    for (int i = 0; i < 3; ++i) {
      const Vec2 in = (room.middle - room.door).normalized();
      const Vec2 aside(-in.y(), in.x());
      const double off = random.uniform(0.8, 1.8) * (random.chance(0.5) ? 1.0 : -1.0);
      put_box(floor, room.middle + off * aside + random.uniform(-0.6, 0.8) * in,
              random.uniform(0.3, 0.9), random.uniform(0.2, 0.5), random.uniform(0.0, kPi));
    }
  // Twice around, the second time into other rooms.
  const std::array<Vec2, 4> corners{Vec2(8.0, 8.0), Vec2(26.0, 8.0), Vec2(26.0, 22.0),
                                    Vec2(8.0, 22.0)};
  floor.route.push_back(corners[0]);
  for (int round = 0; round < 3; ++round)
    for (std::size_t side = 0; side < 4; ++side) {
      const Vec2 from = corners[side];
      const Vec2 to = corners[(side + 1) % 4];
      const Vec2 along = (to - from).normalized();
      std::vector<std::pair<double, const Room*>> visits;
      for (const Room& room : rooms) {
        const Vec2 off = room.door - from;
        const double at = off.dot(along);
        const double aside = std::abs(off.x() * along.y() - off.y() * along.x());
        if (aside < 0.1 && at > 0.5 && at < (to - from).norm() - 0.5 && random.chance(0.4))
          visits.emplace_back(at, &room);
      }
      std::sort(visits.begin(), visits.end());
      for (const auto& [at, room] : visits) {
        floor.route.push_back(room->door);
        floor.route.push_back(room->middle);
        floor.route.push_back(room->door);
      }
      floor.route.push_back(to);
    }
  return floor;
}

Floor rows_of_rooms(std::uint64_t seed) {
  Random random(seed, 22);
  constexpr double kLength = 60.0;
  Solid solid(kLength + 6.0, 36.0);
  const std::array<double, 2> middles{9.0, 27.0};
  for (const double y : middles)
    solid.cut(3.0, y - 1.0, kLength + 3.0, y + 1.0);
  solid.cut(3.0, 9.0, 5.0, 27.0);
  solid.cut(kLength + 1.0, 9.0, kLength + 3.0, 27.0);
  Floor floor;
  std::vector<Vec2> desks;
  for (const double y : middles)
    for (const double side : {-1.0, 1.0})
      for (double x = 6.0; x < kLength - 5.0; x += 5.0) {
        const double near = y + side * 1.15;
        const double far = y + side * 6.0;
        solid.cut(x, std::min(near, far), x + 4.85, std::max(near, far));
        solid.cut(x + 1.0, std::min(y, near) - 0.05, x + 2.0, std::max(y, near) + 0.05);
        desks.emplace_back(x + 3.6, y + side * 4.0);
      }
  floor.walls = solid.walls();
  for (const Vec2& desk : desks)
    put_box(floor, desk, 0.8, 1.6, 0.0);
  const double left = 4.0;
  const double right = kLength + 2.0;
  const auto along = [&](double y, bool up) {
    floor.route.emplace_back(up ? left : right, y);
    for (int i = 0; i < 10; ++i) {
      const double x = up ? 7.5 + 5.0 * i : 52.5 - 5.0 * i;
      if (!random.chance(0.35))
        continue;
      const double side = random.chance(0.5) ? 1.0 : -1.0;
      floor.route.emplace_back(x, y);
      floor.route.emplace_back(x, y + side * 3.0);
      floor.route.emplace_back(x, y);
    }
    floor.route.emplace_back(up ? right : left, y);
  };
  for (int round = 0; round < 2; ++round) {
    along(middles[0], true);
    along(middles[1], false);
  }
  floor.route.emplace_back(left, middles[0]);
  floor.route.emplace_back(30.0, middles[0]);
  return floor;
}

Floor blocks(std::uint64_t seed, int rounds) {
  Random random(seed, 23);
  const std::array<double, 4> xs{5.0, 55.0, 95.0, 165.0};
  const std::array<double, 3> ys{5.0, 45.0, 85.0};
  Solid solid(175.0, 95.0);
  for (const double y : ys)
    solid.cut(xs.front() - 1.2, y - 1.2, xs.back() + 1.2, y + 1.2);
  for (const double x : xs)
    solid.cut(x - 1.2, ys.front() - 1.2, x + 1.2, ys.back() + 1.2);
  // Doors that are shut, and some things along the walls.
  for (const double y : ys)
    for (const double side : {-1.0, 1.0})
      for (double x = xs.front() + 3.0; x < xs.back() - 3.0; x += random.uniform(2.5, 12.0)) {
        const double wall = y + side * 1.2;
        if (random.chance(0.8))
          solid.cut(x, std::min(wall, wall + side * 0.15), x + 0.9,
                    std::max(wall, wall + side * 0.15));
        else
          solid.stand(x, std::min(wall, wall - side * 0.3), x + 0.8,
                      std::max(wall, wall - side * 0.3));
      }
  for (const double x : xs)
    for (const double side : {-1.0, 1.0})
      for (double y = ys.front() + 3.0; y < ys.back() - 3.0; y += random.uniform(2.5, 12.0)) {
        const double wall = x + side * 1.2;
        if (random.chance(0.8))
          solid.cut(std::min(wall, wall + side * 0.15), y, std::max(wall, wall + side * 0.15),
                    y + 0.9);
        else
          solid.stand(std::min(wall, wall - side * 0.3), y, std::max(wall, wall - side * 0.3),
                      y + 0.8);
      }
  Floor floor;
  floor.walls = solid.walls();
  // From crossing to crossing: right around the left block, then on without turning back.
  std::size_t c = 0;
  std::size_t r = 0;
  int heading = 0;  // right, up, left, down
  floor.route.emplace_back(xs[0], ys[0]);
  const auto may = [&](int way) {
    return (way == 0 && c + 1 < xs.size()) || (way == 1 && r + 1 < ys.size()) ||
           (way == 2 && c > 0) || (way == 3 && r > 0);
  };
  for (int k = 0; k < rounds; ++k) {
    std::vector<int> ways;
    for (const int turn : {0, 1, 3})
      if (may((heading + turn) % 4))
        ways.push_back((heading + turn) % 4);
    heading = k < 2 ? 0 : ways[random.next() % ways.size()];
    c += heading == 0 ? 1U : heading == 2 ? static_cast<std::size_t>(-1) : 0U;
    r += heading == 1 ? 1U : heading == 3 ? static_cast<std::size_t>(-1) : 0U;
    floor.route.emplace_back(xs[c], ys[r]);
  }
  return floor;
}

Floor bare_loop() {
  Solid solid(92.0, 52.0);
  solid.cut(4.0, 4.0, 88.0, 6.5);
  solid.cut(4.0, 45.5, 88.0, 48.0);
  solid.cut(4.0, 4.0, 6.5, 48.0);
  solid.cut(85.5, 4.0, 88.0, 48.0);
  Floor floor;
  floor.walls = solid.walls();
  for (int round = 0; round < 2; ++round)
    for (const Vec2& p : {Vec2(5.2, 5.2), Vec2(86.8, 5.2), Vec2(86.8, 46.8), Vec2(5.2, 46.8)})
      floor.route.push_back(p);
  floor.route.emplace_back(5.2, 5.2);
  floor.route.emplace_back(40.0, 5.2);
  return floor;
}

Floor hall() {
  Solid solid(70.0, 56.0);
  solid.cut(4.0, 4.0, 64.0, 44.0);
  for (const double x : {16.0, 30.0, 52.0})
    for (const double y : {14.0, 33.0})
      solid.stand(x, y, x + 0.6, y + 0.6);
  solid.stand(40.0, 4.0, 46.0, 7.0);
  solid.stand(4.0, 20.0, 6.5, 24.0);
  // A corridor behind it, by two doors.
  solid.cut(6.0, 46.0, 62.0, 48.0);
  solid.cut(8.0, 43.0, 9.5, 47.0);
  solid.cut(58.0, 43.0, 59.5, 47.0);
  solid.stand(30.0, 46.0, 31.0, 46.4);
  Floor floor;
  floor.walls = solid.walls();
  for (int round = 0; round < 2; ++round)
    for (const Vec2& p :
         {Vec2(8.7, 10.0), Vec2(36.0, 9.0), Vec2(60.0, 8.0), Vec2(58.7, 30.0), Vec2(58.7, 47.0),
          Vec2(8.7, 47.0), Vec2(8.7, 38.0), Vec2(34.0, 24.0), Vec2(58.7, 38.0), Vec2(30.0, 40.0)})
      floor.route.push_back(p);
  return floor;
}

DataSet drive_synthetic(const std::string& name, const Floor& floor, const LaserKind& laser,
                        const Wheels& wheels, int people, std::uint64_t seed) {
  constexpr double kTick = 0.1;           // [s]
  constexpr double kSpeed = 0.5;          // [m/s]
  constexpr double kTurnRate = 1.0;       // [rad/s]
  constexpr double kEncodeJitter = 0.01;  // manual Table 3-1
  constexpr double kAngleJitter = 0.02;
  constexpr double kAngleDrift = 0.003;
  const Caster caster(floor.walls);
  Random motion(seed, 31);
  Random beams(seed, 32);
  std::vector<std::pair<double, double>> walkers;  // phase, aside
  for (int i = 0; i < people; ++i)
    walkers.emplace_back(motion.uniform(0.0, 2.0 * kPi), motion.uniform(-0.7, 0.7));

  CarmenLog log;
  log.file = name;
  std::vector<StampedPose> truth;
  const Vec2 first = floor.route[1] - floor.route[0];
  Pose pose{floor.route[0].x(), floor.route[0].y(), std::atan2(first.y(), first.x())};
  Pose odom;
  double way = 0.0;
  double since_scan = 1e9;
  double since_time = 1e9;
  double since_slip = 0.0;
  std::size_t target = 1;
  for (int tick = 0; target < floor.route.size(); ++tick) {
    const double time = kTick * tick;
    const bool due =
        laser.every > 0.0 ? since_scan >= laser.every : since_time >= laser.period - 1e-9;
    if (due) {
      since_scan = since_time = 0.0;
      std::vector<sim::Disc> legs;
      for (const auto& [phase, aside] : walkers) {
        const double at = way + 6.0 * std::sin(0.12 * time + phase) + 3.0 * std::sin(phase * 7.0);
        const Vec2 here = place_on(floor.route, at);
        Vec2 along = place_on(floor.route, at + 0.1) - here;
        along = along.norm() > 1e-6 ? Vec2(along.normalized()) : Vec2(1.0, 0.0);
        const Vec2 left(-along.y(), along.x());
        for (const double foot : {-0.12, 0.12})
          if ((here + aside * left - pose.position()).norm() > 0.6)
            legs.push_back({here + (aside + foot) * left + 0.2 * foot * along, 0.09});
      }
      LaserScan scan;
      scan.time = {time, time};
      scan.host = "sim";
      scan.pose = odom;
      scan.laser_in_robot = laser.in_robot;
      scan.step = laser.step;
      scan.first_angle = -0.5 * laser.step * (laser.beams - 1);
      scan.no_return = laser.reach - 0.01;
      const Pose eye = compose(pose, laser.in_robot);
      const sim::Things moving{{}, legs};
      for (int i = 0; i < laser.beams; ++i) {
        const double at = eye.th + scan.first_angle + i * laser.step;
        double range = caster.range(eye.position(), at, laser.reach);
        if (!legs.empty())
          if (const auto hit =
                  sim::cast_ray(moving, eye.position(), {std::cos(at), std::sin(at)}, laser.reach))
            range = std::min(range, hit->range);
        if (range < laser.reach)
          range += beams.normal(0.0, laser.noise);
        scan.ranges.push_back(std::clamp(range, 0.0, laser.reach));
      }
      log.scans.push_back(std::move(scan));
      truth.push_back({time, pose});
    }
    log.odometry.push_back({{time, time}, odom, log.scans.size()});

    const Vec2 to = floor.route[target] - pose.position();
    if (to.norm() < 0.25) {
      ++target;
      continue;
    }
    const double off =
        norm2_angle(std::atan2(to.y(), to.x()) - pose.th + 0.15 * std::sin(0.3 * way));
    const double turn = std::clamp(off, -kTurnRate * kTick, kTurnRate * kTick);
    const double step = std::abs(off) > 0.6 ? 0.0 : kSpeed * kTick;
    pose = compose(pose, {step, 0.0, turn});
    way += step;
    since_scan += step + 0.5 * std::abs(turn);
    since_time += kTick;
    since_slip += step;
    double measured = turn + (wheels.errors * kAngleDrift + wheels.bias) * step +
                      motion.normal(0.0, wheels.errors * kAngleJitter * std::sqrt(std::abs(turn)));
    if (wheels.slip_every > 0.0 && since_slip > wheels.slip_every) {
      since_slip = 0.0;
      measured += motion.uniform(0.4, 1.0) * wheels.slip * (motion.chance(0.5) ? 1.0 : -1.0);
    }
    odom =
        compose(odom, {step + motion.normal(0.0, wheels.errors * kEncodeJitter * std::sqrt(step)),
                       0.0, measured});
  }
  DataSet set = data_set_of(name, log, Clock::ipc);
  set.reference.emplace(std::move(truth));
  set.ranges_only = true;
  return set;
}

namespace {

struct Kind {
  const char* name;
  std::function<DataSet(const std::string&, std::uint64_t)> make;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kKinds = [] {
    const LaserKind sick{};
    LaserKind eight;
    eight.beams = 180;
    eight.reach = 8.0;
    LaserKind wide;
    wide.beams = 541;
    wide.step = radians(0.5);
    wide.reach = 30.0;
    wide.noise = 0.03;
    LaserKind backwards = wide;
    backwards.in_robot = {-0.2, 0.1, kPi};
    LaserKind slow = sick;
    slow.period = 1.0;
    LaserKind thinned = sick;
    thinned.every = 0.8;
    LaserKind fine = sick;
    fine.beams = 361;
    fine.step = radians(0.5);
    fine.reach = 50.0;
    LaserKind often = sick;
    often.beams = 180;
    const Wheels once{1.0, 0.0, 0.0, 0.0};
    const Wheels twice{2.0, 0.0, 0.0, 0.0};
    const Wheels four{4.0, 0.0, 0.0, 0.0};
    const Wheels biased{2.0, radians(2.0), 0.0, 0.0};
    const Wheels slipping{2.0, 0.0, 30.0, radians(30.0)};
    const auto on = [](const std::function<Floor(std::uint64_t)>& floor, const LaserKind& laser,
                       const Wheels& wheels, int people = 0) {
      return [=](const std::string& name, std::uint64_t seed) {
        return drive_synthetic(name, floor(seed), laser, wheels, people, seed);
      };
    };
    const auto one_bare = [](std::uint64_t) { return bare_loop(); };
    const auto one_hall = [](std::uint64_t) { return hall(); };
    const auto some_blocks = [](std::uint64_t seed) { return blocks(seed, 16); };
    return std::vector<Kind>{
        {"office", on(office_floor, sick, once)},
        {"office-8m", on(office_floor, eight, twice)},
        {"office-backwards-270", on(office_floor, backwards, four)},
        {"office-1hz", on(office_floor, slow, twice)},
        {"office-thinned", on(office_floor, thinned, twice)},
        {"office-biased", on(office_floor, sick, biased)},
        {"office-slipping", on(office_floor, sick, slipping)},
        {"office-people", on(office_floor, sick, twice, 12)},
        {"rows", on(rows_of_rooms, sick, twice)},
        {"rows-8m-biased", on(rows_of_rooms, eight, biased)},
        {"rows-thinned-slipping", on(rows_of_rooms, thinned, slipping)},
        {"blocks", on(some_blocks, fine, twice)},
        {"blocks-8m", on(some_blocks, eight, twice)},
        {"blocks-biased", on(some_blocks, sick, biased)},
        {"blocks-people-slipping", on(some_blocks, sick, slipping, 8)},
        {"bare", on(one_bare, sick, once)},
        {"bare-8m", on(one_bare, eight, once)},
        {"hall", on(one_hall, wide, twice)},
        {"hall-8m", on(one_hall, eight, once)},
        {"killian-sized", on([](std::uint64_t seed) { return blocks(seed, 37); }, often, twice)},
    };
  }();
  return kKinds;
}

}  // namespace

std::vector<std::string> synthetic_names() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds())
    names.emplace_back(kind.name);
  return names;
}

DataSet synthetic_data_set(const std::string& name, std::uint64_t seed) {
  for (const Kind& kind : kinds())
    if (name == kind.name)
      return kind.make(name, seed);
  throw std::invalid_argument("no synthetic drive is named " + name);
}

}  // namespace saphira::bench

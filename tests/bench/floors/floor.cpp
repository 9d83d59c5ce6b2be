#include "floors/floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <limits>
#include <sstream>

#include "saphira/base/random.hpp"

namespace saphira::test {
namespace {

/// A rectangle: its pose is in the middle of its near side, directed along its length.
struct Area {
  Pose in_world;
  double length = 0.0;
  double width = 0.0;

  Vec2 at(double along, double across) const { return transform(in_world, {along, across}); }
  Pose middle() const { return compose(in_world, {length / 2, 0.0, 0.0}); }
  std::array<Vec2, 4> corners() const {
    return {at(0, -width / 2), at(length, -width / 2), at(length, width / 2), at(0, width / 2)};
  }
};

struct Corridor {
  Area area;
  double from = 0.0;  ///< along it: the place of its branch from another corridor
  std::vector<Area> crossings = {};
};

struct Line {
  Vec2 from;
  Vec2 to;
};

/// The crossing of two corridors at a place.
Area crossing(const Pose& at, double length, double width) {
  return {compose(at, {-length / 2, 0.0, 0.0}), length, width};
}

/// Of a side of a corridor.
struct Interval {
  double from;
  double to;
};

/// True where two areas overlap by more than `slack`, by the axis that separates them.
bool overlap(const Area& one, const Area& other, double slack) {
  for (const Area* each : {&one, &other})
    for (const double turn : {0.0, kPi / 2}) {
      const Vec2 axis = transform(Pose{0.0, 0.0, each->in_world.th + turn}, {1.0, 0.0});
      const auto shadow = [&](const Area& area) {
        double least = std::numeric_limits<double>::infinity();
        double most = -least;
        for (const Vec2& corner : area.corners()) {
          least = std::min(least, corner.dot(axis));
          most = std::max(most, corner.dot(axis));
        }
        return Interval{least, most};
      };
      const Interval a = shadow(one);
      const Interval b = shadow(other);
      if (a.to < b.from + slack || b.to < a.from + slack)
        return false;
    }
  return true;
}

/// The part of a line within an area, as shares of its length; none: from > to.
Interval inside(const Line& line, const Area& area) {
  constexpr double kEdge = 1e-6;  // a line on the edge is not inside
  const Pose from = relative(area.in_world, {line.from.x(), line.from.y(), 0.0});
  const Pose to = relative(area.in_world, {line.to.x(), line.to.y(), 0.0});
  Interval part{0.0, 1.0};
  const auto cut = [&](double a, double b, double least, double most) {
    const double d = b - a;
    if (std::abs(d) < 1e-9) {
      if (a < least + kEdge || a > most - kEdge)
        part = {1.0, 0.0};
      return;
    }
    part.from = std::max(part.from, std::min((least - a) / d, (most - a) / d));
    part.to = std::min(part.to, std::max((least - a) / d, (most - a) / d));
  };
  cut(from.x, to.x, 0.0, area.length);
  cut(from.y, to.y, -area.width / 2, area.width / 2);
  return part;
}

class Builder {
 public:
  explicit Builder(std::uint64_t seed) : random_(seed), frames_(seed + 1'000'000) {}

  Floor make();

 private:
  double between(double least, double most) { return random_.uniform(least, most); }
  bool chance(double probability) { return random_.chance(probability); }
  template <std::size_t n>
  double one_of(const std::array<double, n>& values) {
    return values[std::min(n - 1, static_cast<std::size_t>(random_.uniform() * n))];
  }
  double corridor_width() {
    return one_of(std::array{1.2, 1.5, 1.5, 2.0, 2.0, 2.4}) + between(-0.1, 0.1);
  }

  void lay_corridors();
  void branch(double along, double side);
  void lay_loop();
  void lay_hall();
  void lay_rooms(const Corridor& corridor, double side);
  bool is_free(const Area& room) const;
  void lay_door(const Corridor& corridor, double side, const Area& room, const std::string& name);
  void lay_things(const Corridor& corridor);
  void lay_walls();
  void box(const Pose& near_side, double length, double width);
  void wall(const Vec2& from, const Vec2& to) { lines_.push_back({from, to}); }
  std::string world(const Vec2& size, const Pose& start) const;
  void feature(const std::string& type, std::uint32_t id, const Pose& pose, double length,
               double width, const std::string& name, bool is_open = true,
               bool is_recessed = false);

  Random random_;
  Random frames_;  // of its own: the rest of a floor does not depend on its doors' frames
  std::vector<Corridor> corridors_;
  std::vector<Area> halls_;
  std::vector<Area> rooms_;
  std::vector<Line> openings_;  ///< doors, in the sides of corridors
  std::vector<Line> lines_;
  std::vector<Vec2> tour_;
  std::ostringstream map_;
  std::ostringstream open_doors_;
  std::ostringstream recessed_doors_;
  std::ostringstream noticeable_doors_;
};

void Builder::feature(const std::string& type, std::uint32_t id, const Pose& pose, double length,
                      double width, const std::string& name, bool is_open, bool is_recessed) {
  std::ostringstream line;
  line << std::fixed << std::setprecision(1) << type;
  if (id != 0)
    line << " (" << id << ")";
  line << ' ' << 1000 * pose.x << ", " << 1000 * pose.y << ", " << degrees(norm2_angle(pose.th));
  for (const double size : {length, width})
    if (size > 0.0)
      line << ", " << 1000 * size;
  if (!name.empty())
    line << " \"" << name << '"';
  line << '\n';
  map_ << line.str();
  if (is_open)
    open_doors_ << line.str();
  if (is_recessed)
    recessed_doors_ << line.str();
  if (is_open || is_recessed)
    noticeable_doors_ << line.str();
}

void Builder::branch(double along, double side) {
  const Area spine = corridors_.front().area;
  // Nine of ten walls of offices are at right angles.
  const double angle = chance(0.2) ? radians(one_of(std::array{45.0, 60.0, 70.0})) : kPi / 2;
  Corridor corridor;
  corridor.area.in_world = compose(spine.in_world, {along, 0.0, side * angle});
  corridor.area.width = corridor_width();
  corridor.area.length = between(9.0, 17.0);
  corridor.from = spine.width / 2 / std::sin(angle);
  corridor.crossings = {
      crossing(compose(spine.in_world, {along, 0.0, 0.0}), corridor.area.width, spine.width)};
  corridors_.push_back(corridor);
  const Vec2 at = spine.at(along, 0.0);
  tour_.push_back(at);
  tour_.push_back(corridor.area.at(corridor.area.length - 0.9, 0.0));
  tour_.push_back(at);
}

/// Two branches of the same length, joined at their ends.
void Builder::lay_loop() {
  const Area spine = corridors_.front().area;
  const double side = chance(0.5) ? 1.0 : -1.0;
  const double width = corridor_width();
  const double depth = between(10.0, 14.0);
  const double first = between(1.5, 4.0);
  const double second = spine.length - between(1.5, 4.0);
  for (const double along : {first, second})
    corridors_.push_back(
        {{compose(spine.in_world, {along, 0.0, side * kPi / 2}), depth + width / 2, width},
         spine.width / 2,
         {crossing(compose(spine.in_world, {along, 0.0, 0.0}), width, spine.width)}});
  const double join = corridor_width();
  corridors_.push_back({{compose(spine.in_world, {first - width / 2, side * depth, 0.0}),
                         second - first + width, join}});
  for (const double along : {first, second})
    corridors_.back().crossings.push_back(
        crossing(compose(spine.in_world, {along, side * depth, 0.0}), width, join));
  for (const Vec2& at :
       {Vec2(first, 0.0), Vec2(first, side * depth), Vec2(second, side * depth), Vec2(second, 0.0)})
    tour_.push_back(spine.at(at.x(), at.y()));
}

void Builder::lay_hall() {
  const Area spine = corridors_.front().area;
  Area hall{.in_world = compose(spine.in_world, {spine.length, between(-1.0, 1.0), 0.0}),
            .length = between(5.0, 8.0),
            .width = between(6.0, 9.0)};
  for (const Corridor& corridor : corridors_)
    if (overlap(hall, corridor.area, 0.01))
      return;
  halls_.push_back(hall);
  tour_.push_back(hall.at(1.5, 0.0));
}

void Builder::lay_corridors() {
  const bool loop = chance(0.33);
  Corridor spine;
  spine.area.in_world = {0.0, 0.0, 0.0};
  spine.area.length = between(loop ? 20.0 : 15.0, 30.0);
  spine.area.width = corridor_width();
  corridors_.push_back(spine);
  tour_.push_back(spine.area.at(1.0, 0.0));
  if (loop) {
    lay_loop();
  } else {
    double side = chance(0.5) ? 1.0 : -1.0;
    for (double along = between(2.0, 8.0); along < spine.area.length - 1.5;
         along += between(7.0, 14.0)) {
      branch(along, side);
      side = -side;
    }
  }
  tour_.push_back(spine.area.at(spine.area.length - 0.9, 0.0));
  if (chance(0.5))
    lay_hall();
}

bool Builder::is_free(const Area& room) const {
  constexpr double kWall = 0.02;
  const auto meets = [&](const Area& area) { return overlap(room, area, kWall); };
  return std::none_of(corridors_.begin(), corridors_.end(),
                      [&](const Corridor& corridor) { return meets(corridor.area); }) &&
         std::none_of(halls_.begin(), halls_.end(), meets) &&
         std::none_of(rooms_.begin(), rooms_.end(), meets);
}

void Builder::lay_rooms(const Corridor& corridor, double side) {
  const Area& area = corridor.area;
  for (double along = corridor.from + 0.3; along < area.length - 2.4;) {
    if (chance(0.1)) {
      along += between(0.5, 2.5);
      continue;
    }
    const double width = std::min(between(2.6, 6.5), area.length - along);
    double depth = between(3.0, 6.0);
    Area room;
    const auto make = [&] {
      room.in_world =
          compose(area.in_world, {along + width / 2, side * area.width / 2, side * kPi / 2});
      room.length = depth;
      room.width = width - 0.12;  // without half of the walls to its neighbours
    };
    make();
    while (!is_free(room) && depth > 2.2) {
      depth -= 0.5;
      make();
    }
    if (depth <= 2.2 || width < 2.4) {
      along += 0.5;
      continue;
    }
    rooms_.push_back(room);
    const std::uint32_t id = 100 + static_cast<std::uint32_t>(rooms_.size());
    const std::string name = "R" + std::to_string(id);
    feature("OFFICE", id, room.middle(), room.length, room.width, name);
    lay_door(corridor, side, room, name);
    along += width;
  }
}

/// The front of a room: the reveal between the corridor's side and the room, its frame or niche,
/// and the leaf.
void Builder::lay_door(const Corridor& corridor, double side, const Area& room,
                       const std::string& name) {
  const double opening = one_of(std::array{0.8, 0.9, 0.9, 0.9, 0.9, 1.0, 1.2});
  const double reveal = chance(0.3) ? 0.0 : chance(0.7) ? between(0.05, 0.2) : between(0.2, 0.35);
  const bool has_frame = reveal >= 0.05 && frames_.chance(0.5);
  const double gap = opening + (!has_frame            ? 0.0
                                : frames_.chance(0.5) ? 0.1
                                                      : frames_.uniform(0.1, 0.4));
  const double wall_depth =
      has_frame ? reveal + frames_.uniform(0.10, 0.15) : std::max(reveal, 0.1);
  const double hinge = chance(0.5) ? 1.0 : -1.0;
  const double state = random_.uniform();
  const double leaf = radians(state < 0.25   ? 0.0
                              : state < 0.35 ? between(5.0, 30.0)
                              : state < 0.9  ? 90.0
                                             : 170.0);
  const double across = between(-1.0, 1.0) * (room.width / 2 - opening / 2 - 0.25);
  const auto at = [&](double deep, double beside) { return room.at(deep, across + beside); };
  // The walls of the room.
  wall(room.at(wall_depth, -room.width / 2), at(wall_depth, -opening / 2));
  wall(at(wall_depth, opening / 2), room.at(wall_depth, room.width / 2));
  for (const double end : {-room.width / 2, room.width / 2})
    wall(room.at(wall_depth, end), room.at(room.length, end));
  wall(room.at(room.length, -room.width / 2), room.at(room.length, room.width / 2));
  for (const double jamb : {-1.0, 1.0}) {
    const double narrows_at = has_frame ? reveal : 0.0;
    if (has_frame) {
      wall(at(0.0, jamb * gap / 2), at(reveal, jamb * gap / 2));
      wall(at(reveal, jamb * gap / 2), at(reveal, jamb * opening / 2));
    }
    wall(at(narrows_at, jamb * opening / 2), at(wall_depth, jamb * opening / 2));
  }
  // The leaf opens into the room.
  const bool is_open = leaf > radians(80.0);
  const double turns_at = has_frame && is_open ? wall_depth : reveal;
  const double along = -hinge * std::cos(leaf) * opening;
  wall(at(turns_at, hinge * opening / 2),
       at(turns_at + std::sin(leaf) * opening, hinge * opening / 2 + along));
  openings_.push_back({at(0.0, -gap / 2), at(0.0, gap / 2)});
  const Vec2 middle = at(0.0, 0.0);
  feature("DOOR", 1000 + static_cast<std::uint32_t>(rooms_.size()),
          {middle.x(), middle.y(), corridor.area.in_world.th - side * kPi / 2}, 0.0, opening, name,
          is_open, reveal >= 0.15 && (is_open || leaf == 0.0));
  // A desk at the far wall.
  if (room.length > 3.5 && room.width > 2.6)
    box(compose(room.in_world, {room.length - 0.9, between(-0.3, 0.3), 0.0}), 0.8, 1.6);
}

void Builder::box(const Pose& near_side, double length, double width) {
  const Area area{near_side, length, width};
  const auto corners = area.corners();
  for (std::size_t i = 0; i < corners.size(); ++i)
    wall(corners[i], corners[(i + 1) % corners.size()]);
}

/// Cupboards and pillars along the sides, where the corridor stays wide enough.
void Builder::lay_things(const Corridor& corridor) {
  const Area& area = corridor.area;
  for (double along = corridor.from + 2.0; along < area.length - 2.0; along += between(4.0, 12.0)) {
    const double deep = one_of(std::array{0.2, 0.3, 0.4, 0.45});
    const double length = deep < 0.25 ? deep : between(0.4, 1.0);
    const double side = chance(0.5) ? 1.0 : -1.0;
    if (area.width - deep < 1.1)
      continue;
    const Area thing{compose(area.in_world, {along, side * (area.width / 2 - deep / 2), 0.0}),
                     length, deep};
    Area kept_free = thing;
    kept_free.in_world = compose(thing.in_world, {-0.8, 0.0, 0.0});
    kept_free.length += 1.6;
    kept_free.width += 0.1;
    const bool before_a_door =
        std::any_of(openings_.begin(), openings_.end(), [&](const Line& line) {
          const Interval part = inside(line, kept_free);
          return part.from < part.to;
        });
    const bool on_a_crossing =
        std::any_of(corridors_.begin(), corridors_.end(), [&](const Corridor& other) {
          return &other != &corridor && overlap(kept_free, other.area, 0.0);
        });
    if (!before_a_door && !on_a_crossing)
      box(thing.in_world, thing.length, thing.width);
  }
}

/// The sides of corridors and halls, without parts inside of others and without doors.
void Builder::lay_walls() {
  std::vector<Area> areas = halls_;
  for (const Corridor& corridor : corridors_)
    areas.push_back(corridor.area);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const auto corners = areas[i].corners();
    for (std::size_t side = 0; side < corners.size(); ++side) {
      const Line line{corners[side], corners[(side + 1) % corners.size()]};
      std::vector<Interval> gaps;
      for (std::size_t j = 0; j < areas.size(); ++j)
        if (j != i)
          gaps.push_back(inside(line, areas[j]));
      // A hall and its corridor meet in a line: the hall's side opens as far as the corridor.
      const Vec2 way = line.to - line.from;
      const auto share = [&](const Vec2& at) { return (at - line.from).dot(way) / way.dot(way); };
      const auto is_on = [&](const Vec2& at) {
        const Vec2 off = at - line.from;
        return std::abs(off.x() * way.y() - off.y() * way.x()) < 1e-6 * way.norm();
      };
      const auto open = [&](const Line& gap) {
        if (is_on(gap.from) && is_on(gap.to))
          gaps.push_back({std::max(0.0, std::min(share(gap.from), share(gap.to))),
                          std::min(1.0, std::max(share(gap.from), share(gap.to)))});
      };
      for (const Line& door : openings_)
        open(door);
      if (const Area& spine = corridors_.front().area; !halls_.empty())
        open({spine.at(spine.length, -spine.width / 2), spine.at(spine.length, spine.width / 2)});
      std::erase_if(gaps, [](const Interval& gap) { return gap.to <= gap.from; });
      std::sort(gaps.begin(), gaps.end(),
                [](const Interval& a, const Interval& b) { return a.from < b.from; });
      double done = 0.0;
      for (const Interval& gap : gaps) {
        if (gap.from > done + 1e-6)
          wall(line.from + done * way, line.from + gap.from * way);
        done = std::max(done, gap.to);
      }
      if (done < 1.0 - 1e-6)
        wall(line.from + done * way, line.to);
    }
  }
}

std::string Builder::world(const Vec2& size, const Pose& start) const {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "width " << 1000 * size.x() << " height "
       << 1000 * size.y() << '\n';
  for (const Line& line : lines_)
    text << 1000 * line.from.x() << ' ' << 1000 * line.from.y() << ' ' << 1000 * line.to.x() << ' '
         << 1000 * line.to.y() << '\n';
  text << "position " << 1000 * start.x << ' ' << 1000 * start.y << ' ' << degrees(start.th)
       << '\n';
  return text.str();
}

Floor Builder::make() {
  lay_corridors();
  // A metre of margin to the edge of the world, for any rooms.
  constexpr double kRoom = 7.0;
  Vec2 least{0.0, 0.0};
  Vec2 most{0.0, 0.0};
  std::vector<Area*> areas;
  for (Corridor& corridor : corridors_)
    areas.push_back(&corridor.area);
  for (Area& hall : halls_)
    areas.push_back(&hall);
  for (const Area* area : areas)
    for (const Vec2& corner : area->corners()) {
      least = least.cwiseMin(corner);
      most = most.cwiseMax(corner);
    }
  const Vec2 moved = Vec2(kRoom, kRoom) - least;
  for (Corridor& corridor : corridors_)
    for (Area& each : corridor.crossings)
      areas.push_back(&each);
  for (Area* area : areas) {
    area->in_world.x += moved.x();
    area->in_world.y += moved.y();
  }
  for (Vec2& point : tour_)
    point += moved;

  std::uint32_t id = 0;
  std::uint32_t junction = 50;
  for (const Corridor& corridor : corridors_) {
    ++id;
    const Area& area = corridor.area;
    const Area mapped{compose(area.in_world, {corridor.from, 0.0, 0.0}),
                      area.length - corridor.from, area.width};
    feature("CORRIDOR", id, mapped.middle(), mapped.length, mapped.width, "C" + std::to_string(id));
    for (const Area& each : corridor.crossings)
      feature("JUNCTION", ++junction, each.middle(), each.length, each.width, "");
  }
  for (const Area& hall : halls_) {
    const Area& spine = corridors_.front().area;
    feature("OFFICE", 80, hall.middle(), hall.length, hall.width, "hall");
    feature("BREAK", 81, compose(spine.in_world, {spine.length, 0.0, kPi}), 0.0, spine.width,
            "hall");
    feature("WALL", 0, compose(hall.in_world, {hall.length, 0.0, kPi / 2}), hall.width, 0.0, "");
    for (const double side : {-1.0, 1.0})
      feature("WALL", 0, compose(hall.in_world, {hall.length / 2, side * hall.width / 2, 0.0}),
              hall.length, 0.0, "");
  }
  for (const Corridor& corridor : corridors_)
    for (const double side : {1.0, -1.0})
      lay_rooms(corridor, side);
  for (const Corridor& corridor : corridors_)
    lay_things(corridor);
  lay_walls();
  const Pose start{tour_.front().x(), tour_.front().y(), 0.0};
  feature("POS", 90, start, 0.0, 0.0, "start");
  const Vec2 size = most + moved + Vec2(kRoom, kRoom);
  return {world(size, start),      map_.str(), open_doors_.str(), recessed_doors_.str(),
          noticeable_doors_.str(), tour_};
}

}  // namespace

Floor make_floor(std::uint64_t seed) {
  return Builder(seed).make();
}

}  // namespace saphira::test

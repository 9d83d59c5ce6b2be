#include "saphira/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "saphira/base/text.hpp"
#include "world_check.hpp"

namespace saphira::sim {

namespace {

constexpr std::size_t kMaxNesting = 100;

// The motion of the point after which the neighbourhood is collected again.
constexpr double kSlack = 1.0;  // [m]

class Parser {
 public:
  /// The text has to outlive the parser.
  void read(std::string_view text, const std::string& file) {
    file_ = file;
    expect_own_format(text, file,
                      "a world of this simulator, which says \"width MM\", \"height "
                      "MM\" and then a line \"X Y X Y\" for each wall, in mm (as the lines "
                      "behind LINES in a 2D-Map do)");
    if (world_.file.empty())
      world_.file = file;
    int last = 1;
    for (const Line& line : split_lines(text)) {
      LineReader in(file, line);
      while (!in.at_end())
        directive(in, line);
      last = line.number;
    }
    if (!has_width_ || !has_height_)
      throw FileError(file, last, 1, has_width_ ? "expected height" : "expected width");
    // As in the manual's own sample. The file may as well be cut off.
    for (const Place& push : pushes_)
      world_.warnings.push_back(file + ":" + std::to_string(push.line) +
                                ": this push has no pop: it holds up to the end of the file");
    pushes_.clear();
    frames_.resize(1);
  }

  World finish() {
    world_.corners = find_corners(world_.segments);
    world_.movable = movable_.plans();
    for (const Claim& claim : claims_)
      if (const auto trouble = claim.trouble(world_))
        throw FileError(claim.file, claim.place.line, claim.place.column, *trouble, claim.line);
    return std::move(world_);
  }

 private:
  using Trouble = std::function<std::optional<std::string>(const World&)>;
  // The checks of a line that need all walls.
  struct Claim {
    std::string file;
    Place place;
    std::string_view line;
    Trouble trouble;
  };

  void directive(LineReader& in, const Line& line) {
    LineReader number(in);  // to read the same word as a number
    const std::string_view word = in.word("a directive");
    const Place place{line.number, static_cast<int>(word.data() - line.text.data()) + 1};
    if (word == "width" || word == "height") {
      bool& has = word == "width" ? has_width_ : has_height_;
      if (has)
        in.fail("expected " + std::string(word) + " once");
      has = true;
      (word == "width" ? world_.width : world_.height) =
          in.number(std::string(word) + " of the world in mm", 1.0, kMax) * kMillimetre;
      return;
    }
    if (!has_width_ || !has_height_)
      in.fail("expected width and height of the world before anything else");
    if (word == "push") {
      if (frames_.size() > kMaxNesting)
        in.fail("expected no more than 100 push inside each other");
      pushes_.push_back(place);
      frames_.push_back(compose(frames_.back(), pose(in)));
    } else if (word == "pop") {
      if (frames_.size() == 1)
        in.fail("expected a push before this pop");
      frames_.pop_back();
      pushes_.pop_back();
    } else if (word == "position") {
      if (world_.start)
        in.fail("expected position once");
      world_.start = pose(in);
      world_.start_place = place;
      claims_.push_back({file_, place, line.text,
                         [](const World& world) { return trouble_of_start(world, *world.start); }});
    } else if (word == "sonar") {
      sonar(in);
    } else if (word[0] == '-' || word[0] == '+' || word[0] == '.' ||
               (word[0] >= '0' && word[0] <= '9')) {
      in = number;
      segment(in);
    } else if (movable_.read(word, in, frames_.back())) {
      if (const Trouble trouble = trouble_of(word))
        claims_.push_back({file_, place, line.text, trouble});
      if (word == "robot")
        world_.robot_places.push_back(place);
    } else {
      in.fail(
          "expected a segment (x y x y), width, height, push, pop, position, sonar, robot, person, "
          "walk, lead, wait, point, repeat, door, open, close, period, box, post, color, tall, "
          "wide "
          "or cloth, found \"" +
          std::string(word) + "\"");
    }
  }

  // The check for the last directive; nothing where it needs none.
  Trouble trouble_of(std::string_view word) const {
    const MovablePlans& plans = movable_.plans();
    if (word == "robot")
      return [i = plans.robots.size() - 1](const World& world) {
        return trouble_of_start(world, world.movable.robots[i]);
      };
    if (word == "person")
      return [i = plans.persons.size() - 1](const World& world) {
        return trouble_of_person(world, i);
      };
    if (word == "walk" || word == "lead")
      return [i = plans.persons.size() - 1, leg = plans.persons.back().script.size() - 1](
                 const World& world) { return trouble_of_leg(world, i, leg); };
    if (word == "repeat")
      return [i = plans.persons.size() - 1](const World& world) {
        return trouble_of_repeat(world, i);
      };
    if (word == "door")
      return [i = plans.doors.size() - 1](const World& world) { return trouble_of_door(world, i); };
    if (word == "box")
      return [i = plans.boxes.size() - 1](const World& world) { return trouble_of_box(world, i); };
    if (word == "post")
      return [i = plans.posts.size() - 1](const World& world) { return trouble_of_post(world, i); };
    return {};
  }

  static Pose pose(LineReader& in) {
    const double x = in.number("x in mm", -kMax, kMax) * kMillimetre;
    const double y = in.number("y in mm", -kMax, kMax) * kMillimetre;
    const double th = radians(in.number("theta in degrees", -3600, 3600));
    return {x, y, norm2_angle(th)};
  }

  void sonar(LineReader& in) {
    const std::string_view what = in.word("strength, cloth or spread");
    if (what == "strength")
      world_.sonar.strength = in.number("strength of an echo in dB", 0.0, 100.0);
    else if (what == "cloth")
      world_.sonar.cloth = in.number("loss by people's clothes in dB", 0.0, 60.0);
    else if (what == "spread")
      world_.sonar.spread = in.number("spread of an echo's strength in dB", 0.0, 20.0);
    else
      in.fail("expected strength, cloth or spread, found \"" + std::string(what) + "\"");
  }

  void segment(LineReader& in) {
    const double x1 = in.number("x of the first point in mm", -kMax, kMax) * kMillimetre;
    const double y1 = in.number("y of the first point in mm", -kMax, kMax) * kMillimetre;
    const double x2 = in.number("x of the second point in mm", -kMax, kMax) * kMillimetre;
    const double y2 = in.number("y of the second point in mm", -kMax, kMax) * kMillimetre;
    if (std::hypot(x2 - x1, y2 - y1) < 0.5 * kMillimetre) {
      world_.warnings.push_back(file_ + ":" + std::to_string(in.line()) +
                                ": a segment between a point and itself is left out");
      return;
    }
    world_.segments.push_back(
        {transform(frames_.back(), {x1, y1}), transform(frames_.back(), {x2, y2})});
  }

  std::string file_;  // the present file
  World world_;
  MovableReader movable_;
  std::vector<Claim> claims_;         // in the order of their lines
  std::vector<Place> pushes_;         // without their pop yet
  std::vector<Pose> frames_{Pose{}};  // frame_in_world; the last one is in force
  bool has_width_ = false;
  bool has_height_ = false;
};

}  // namespace

World parse_world(std::string_view text, const std::string& file) {
  Parser parser;
  parser.read(text, file);
  return parser.finish();
}

World load_world(const std::string& path, const std::string& things) {
  Parser parser;
  const std::string text = read_file(path);
  expect_last_line_break(text, path);
  parser.read(text, path);
  std::string more;
  if (!things.empty()) {
    more = read_file(things);
    expect_last_line_break(more, things);
    parser.read(more, things);
  }
  return parser.finish();
}

Vec2 nearest_point(const Segment& segment, const Vec2& point) {
  const Vec2 along = segment.to - segment.from;
  const double t = (point - segment.from).dot(along) / along.squaredNorm();
  return segment.from + std::clamp(t, 0.0, 1.0) * along;
}

std::optional<Vec2> nearest_point(const std::vector<Segment>& segments, const Vec2& point) {
  std::optional<Vec2> best;
  double best_squared = std::numeric_limits<double>::infinity();
  for (const Segment& segment : segments) {
    const Vec2 near = nearest_point(segment, point);
    const double squared = (near - point).squaredNorm();
    if (squared < best_squared) {
      best_squared = squared;
      best = near;
    }
  }
  return best;
}

double distance(const std::vector<Segment>& segments, const Vec2& point) {
  double best = std::numeric_limits<double>::infinity();
  for (const Segment& segment : segments)
    best = std::min(best, (nearest_point(segment, point) - point).squaredNorm());
  return std::sqrt(best);
}

std::optional<Vec2> nearest_point(const Things& things, const Vec2& point) {
  auto best = nearest_point(things.segments, point);
  double best_distance = best ? (*best - point).norm() : std::numeric_limits<double>::infinity();
  for (const Disc& disc : things.discs) {
    const Vec2 from_centre = point - disc.centre;
    const double length = from_centre.norm();
    if (length - disc.radius >= best_distance)
      continue;
    best_distance = length - disc.radius;
    best = disc.centre + (length > 0.0 ? Vec2(from_centre / length) : Vec2(1.0, 0.0)) * disc.radius;
  }
  return best;
}

double distance(const Things& things, const Vec2& point) {
  double best = distance(things.segments, point);
  for (const Disc& disc : things.discs)
    best = std::min(best, (disc.centre - point).norm() - disc.radius);
  return best;
}

bool intersect(const Segment& a, const Segment& b) {
  const Vec2 along_a = a.to - a.from;
  const Vec2 along_b = b.to - b.from;
  const double b_from = cross(along_a, b.from - a.from);
  const double b_to = cross(along_a, b.to - a.from);
  const double a_from = cross(along_b, a.from - b.from);
  const double a_to = cross(along_b, a.to - b.from);
  return b_from * b_to <= 0.0 && a_from * a_to <= 0.0 && (b_from != b_to || a_from != a_to);
}

std::optional<double> cast_ray(const std::vector<Segment>& segments, const Vec2& origin,
                               const Vec2& direction, double range) {
  double best = range;
  bool hit = false;
  for (const Segment& segment : segments) {
    const Vec2 along = segment.to - segment.from;
    const Vec2 to_from = segment.from - origin;
    const double cross = direction.x() * along.y() - direction.y() * along.x();
    // The place on the segment (0 to 1 times cross) and on the ray, both still times cross: most
    // segments are excluded before the division.
    const double on_segment = to_from.x() * direction.y() - to_from.y() * direction.x();
    const double on_ray = to_from.x() * along.y() - to_from.y() * along.x();
    if (cross > 0.0) {
      if (on_segment < 0.0 || on_segment > cross || on_ray < 0.0 || on_ray > best * cross)
        continue;
    } else if (cross < 0.0) {
      if (on_segment > 0.0 || on_segment < cross || on_ray > 0.0 || on_ray < best * cross)
        continue;
    } else {
      continue;  // parallel: its ends belong to other segments, or are too thin to see
    }
    best = on_ray / cross;
    hit = true;
  }
  return hit ? std::optional<double>(best) : std::nullopt;
}

std::optional<double> cast_ray(const Things& things, const Vec2& origin, const Vec2& direction,
                               double range) {
  auto best = cast_ray(things.segments, origin, direction, range);
  for (const Disc& disc : things.discs) {
    const Vec2 to_centre = disc.centre - origin;
    const double along = to_centre.dot(direction);
    const double aside = to_centre.x() * direction.y() - to_centre.y() * direction.x();
    const double inside = disc.radius * disc.radius - aside * aside;
    if (along < 0.0 || inside <= 0.0)
      continue;
    const double hit = along - std::sqrt(inside);
    if (hit >= 0.0 && hit < best.value_or(range))
      best = hit;
  }
  return best;
}

const std::vector<Segment>& Neighbourhood::around(const Vec2& point) {
  gather(point);
  return segments_;
}

const std::vector<const Corner*>& Neighbourhood::corners_around(const Vec2& point) {
  gather(point);
  return corners_;
}

void Neighbourhood::gather(const Vec2& point) {
  if (known_ && (point - centre_).squaredNorm() <= kSlack * kSlack)
    return;
  known_ = true;
  centre_ = point;
  segments_.clear();
  corners_.clear();
  const double squared = (reach_ + kSlack) * (reach_ + kSlack);
  for (const Segment& segment : world_->segments)
    if ((nearest_point(segment, point) - point).squaredNorm() <= squared)
      segments_.push_back(segment);
  for (const Corner& corner : world_->corners)
    if ((corner.point - point).squaredNorm() <= squared)
      corners_.push_back(&corner);
}

}  // namespace saphira::sim

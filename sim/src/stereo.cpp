#include "saphira/sim/stereo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "pixels.hpp"
#include "saphira/base/format.hpp"

namespace saphira::sim {

namespace {

// On a grey scale of 0 to 255. Real walls are plainer; a census window needs texture, which real
// rooms have from plaster, posters and shelves.
constexpr double kWallGrey = 170.0;
constexpr double kFloor = 110.0;
constexpr double kCeiling = 215.0;
constexpr double kTexture = 45.0;
constexpr double kFar = 128.0;
constexpr double kRobotHeight = 0.3;  // [m] no robot of ours is much higher
// Of a person: the beginning of the head, as a share of the height; its radius, as a share of the
// body's; the end of the trousers.
constexpr double kShoulder = 0.83;
constexpr double kHead = 0.42;
constexpr double kBelt = 0.52;
constexpr double kArmpit = 0.77;  // below an outstretched arm; the shoulder is above it

// The color of a surface: the shares of red, green and blue in its light [1/255].
struct Tint {
  std::uint8_t red = 255;
  std::uint8_t green = 255;
  std::uint8_t blue = 255;
};
constexpr Tint kWallPaint{255, 246, 228};
constexpr Tint kCarpet{214, 222, 255};
constexpr Tint kWood{255, 196, 128};
constexpr Tint kCardboard{255, 214, 158};
constexpr Tint kSkin{255, 206, 176};
constexpr Tint kShell{255, 90, 70};  // of robots
constexpr Tint kTrousers{150, 170, 255};
constexpr std::array<Tint, 6> kClothes{{{255, 120, 110},
                                        {110, 190, 255},
                                        {140, 240, 150},
                                        {255, 220, 110},
                                        {220, 150, 255},
                                        {120, 240, 240}}};
constexpr std::array<std::pair<std::string_view, Tint>, 7> kNamed{{{"red", {255, 60, 50}},
                                                                   {"orange", {255, 150, 40}},
                                                                   {"yellow", {255, 235, 60}},
                                                                   {"green", {70, 255, 90}},
                                                                   {"blue", {70, 110, 255}},
                                                                   {"pink", {255, 120, 200}},
                                                                   {"black", {70, 70, 70}}}};

Tint tint_of(const Look& look, const Tint& otherwise) {
  for (const auto& [name, tint] : kNamed)
    if (name == look.color)
      return tint;
  return otherwise;
}

// An upright face of an object, from low to high.
struct Face {
  bool round = false;
  Segment segment;
  Disc disc;
  double low = 0.0;   // [m]
  double high = 0.0;  // [m]
  double grey = 0.0;  // 0 to 255
  double belt = 0.0;  // [m] below it the face is darker
  std::uint32_t seed = 0;
  int thing = 0;        // number of the object that the face surrounds
  double turned = 0.0;  // [rad] rotation of a round one
  Tint tint;
};

// The intersection of a column's plane with a face.
struct Meeting {
  double depth = 0.0;  // [m] along the axis
  double u = 0.0;      // [m] along the face
  double light = 0.0;  // from a window far away
  Detail detail;
  const Face* face = nullptr;
  bool leaves = false;  // the object ends here: below its top the lid is visible
};

class Faces {
 public:
  Faces(const Scene& scene, RobotNumber self, const Pose& eye, const PinholeCamera& camera)
      : eye_(eye.position()),
        ahead_(eye.direction()),
        edge_(0.5 * camera.columns / camera.focal() + 1e-6),
        range_(camera.range),
        pixel_(1.0 / camera.focal()) {
    std::uint32_t seed = 1;
    for (const Segment& segment : scene.world().segments)
      add(segment, 0.0, kWallHeight, kWallGrey, seed++, ++things_, kWallPaint);
    for (const Door& door : scene.doors())
      add(scene.leaf(door), 0.0, door.plan->look.height, 120.0, seed++, ++things_,
          tint_of(door.plan->look, kWood));
    for (const Box& box : scene.boxes()) {
      ++things_;
      for (const Segment& side : scene.sides(box))
        add(side, 0.0, box.plan->look.height, grey(seed), seed, things_,
            tint_of(box.plan->look, kCardboard));
      ++seed;
    }
    for (const Person& person : scene.persons()) {
      const double height = person.plan->look.height;
      const double radius = person.plan->radius;
      const Tint clothes =
          tint_of(person.plan->look, kClothes[hash(seed, 5, 11) % kClothes.size()]);
      add({person.at, radius}, 0.0, kShoulder * height, grey(seed), seed, 0.0, kBelt * height,
          clothes);
      if (const auto line = arm(person))
        add(*line, kArmpit * height, kShoulder * height, grey(seed), seed, ++things_, clothes);
      ++seed;
      add({person.at, kHead * radius}, kShoulder * height, height, 150.0, seed++, 0.0, 0.0, kSkin);
    }
    for (const PostPlan& post : scene.world().movable.posts) {
      add({post.at, post.radius}, 0.0, post.look.height, grey(seed), seed, 0.0, 0.0,
          tint_of(post.look, kWallPaint));
      ++seed;
    }
    for (RobotNumber i = 0; i < scene.robots(); ++i) {
      const Pose at = scene.robot(i).pose_in_world();
      if (i != self)
        add({at.position(), scene.robot(i).radius()}, 0.0, kRobotHeight, 90.0, seed, at.th, 0.0,
            kShell);
      ++seed;
    }
  }

  // All intersections of a column, the nearest first. `way` has depth 1.
  void meet(const Vec2& way, std::vector<Meeting>& meetings) const {
    meetings.clear();
    for (const Face& face : faces_)
      face.round ? meet_disc(face, way, meetings) : meet_segment(face, way, meetings);
    std::ranges::sort(meetings, [](const Meeting& a, const Meeting& b) {
      return a.depth != b.depth ? a.depth < b.depth : a.face < b.face;
    });
    for (std::size_t i = 0; i < meetings.size(); ++i) {
      meetings[i].detail = Detail::of(meetings[i].depth * pixel_);
      for (std::size_t k = 0; k < i; ++k)
        meetings[i].leaves =
            meetings[i].leaves || meetings[k].face->thing == meetings[i].face->thing;
    }
  }

  const Vec2& eye() const { return eye_; }

 private:
  static constexpr double kNear = 0.02;  // [m]

  static double grey(std::uint32_t seed) { return 80.0 + hash(seed, 3, 7) % 110U; }
  static double light(const Vec2& normal) { return 18.0 * (0.8 * normal.x() + 0.6 * normal.y()); }

  /// Both points are this far outside of the same side of the view, or behind it: no column meets
  /// what is between them.
  bool is_outside(const Vec2& from, const Vec2& to, double margin) const {
    const auto all = [&](double ahead, double aside, double length) {
      const auto beyond = [&](const Vec2& point) {
        const Vec2 way = point - eye_;
        return ahead * way.dot(ahead_) + aside * way.dot(Vec2(-ahead_.y(), ahead_.x())) >
               margin * length;
      };
      return beyond(from) && beyond(to);
    };
    const double slant = std::hypot(1.0, edge_);
    return all(-1.0, 0.0, 1.0) || all(-edge_, 1.0, slant) || all(-edge_, -1.0, slant);
  }

  void add(const Segment& segment, double low, double high, double grey, std::uint32_t seed,
           int thing, const Tint& tint) {
    if ((nearest_point(segment, eye_) - eye_).norm() > range_ ||
        is_outside(segment.from, segment.to, 0.0))
      return;
    faces_.push_back({false, segment, {}, low, high, grey, 0.0, seed, thing, 0.0, tint});
  }
  void add(const Disc& disc, double low, double high, double grey, std::uint32_t seed,
           double turned, double belt, const Tint& tint) {
    ++things_;
    if ((disc.centre - eye_).norm() > range_ + disc.radius ||
        is_outside(disc.centre, disc.centre, disc.radius))
      return;
    faces_.push_back({true, {}, disc, low, high, grey, belt, seed, things_, turned, tint});
  }

  void meet_segment(const Face& face, const Vec2& way, std::vector<Meeting>& meetings) const {
    const Vec2 along = face.segment.to - face.segment.from;
    const Vec2 from = face.segment.from - eye_;
    const double cross = way.x() * along.y() - way.y() * along.x();
    const double length = along.norm();
    if (std::abs(cross) < 1e-12 || length < 1e-9)
      return;
    const double depth = (from.x() * along.y() - from.y() * along.x()) / cross;
    const double share = (from.x() * way.y() - from.y() * way.x()) / cross;
    if (depth < kNear || share < 0.0 || share > 1.0)
      return;
    Vec2 normal(-along.y() / length, along.x() / length);
    if (normal.dot(way) > 0.0)
      normal = -normal;
    meetings.push_back({depth, share * length, light(normal), {}, &face, false});
  }

  void meet_disc(const Face& face, const Vec2& way, std::vector<Meeting>& meetings) const {
    const Vec2 to = face.disc.centre - eye_;
    const double a = way.squaredNorm();
    const double b = to.dot(way);
    const double under = b * b - a * (to.squaredNorm() - face.disc.radius * face.disc.radius);
    if (under <= 0.0)
      return;
    for (const double sign : {-1.0, 1.0}) {
      const double depth = (b + sign * std::sqrt(under)) / a;
      if (depth < kNear)
        return;
      const Vec2 normal = (way * depth - to) / face.disc.radius;
      const double angle = std::atan2(normal.y(), normal.x()) - face.turned;
      meetings.push_back({depth, angle * face.disc.radius, light(normal), {}, &face, false});
    }
  }

  Vec2 eye_;
  Vec2 ahead_;
  double edge_;  // half the width of the view at a depth of 1 m
  double range_;
  double pixel_;  // [m] width of a pixel at a depth of 1 m
  std::vector<Face> faces_;
  int things_ = 0;
};

// The part of a row common to all columns: its intersection with the floor or the ceiling.
struct Row {
  double slope = 0.0;  // [m] upward for each of depth
  double depth = 0.0;  // [m]
  Detail detail;
};

std::vector<Row> rows_of(const PinholeCamera& rig) {
  std::vector<Row> rows(static_cast<std::size_t>(rig.rows));
  for (int i = 0; i < rig.rows; ++i) {
    Row& row = rows[static_cast<std::size_t>(i)];
    row.slope = (0.5 * rig.rows - i - 0.5) / rig.focal();
    row.depth = row.slope < 0.0   ? rig.height / -row.slope
                : row.slope > 0.0 ? (kWallHeight - rig.height) / row.slope
                                  : rig.range;
    row.detail = Detail::of(row.depth / rig.focal());
  }
  return rows;
}

// Sets a pixel, and returns its color.
Tint look(const PinholeCamera& camera, const std::vector<Meeting>& meetings, const Vec2& eye,
          const Vec2& way, const Row& row, std::size_t at, Pixels& pixels) {
  const double end = std::min(row.depth, camera.range);
  const double texture = kTexture * camera.texture;
  for (const Meeting& meeting : meetings) {
    if (meeting.depth >= end)
      break;
    const Face& face = *meeting.face;
    const double height = camera.height + row.slope * meeting.depth;
    if (height < face.low || height > face.high)
      continue;
    if (meeting.leaves) {
      const Vec2 lid = eye + way * ((face.high - camera.height) / row.slope);
      pixels.set(at, face.grey + 20.0, texture, lid.x(), lid.y(), face.seed + 7000U,
                 meeting.detail);
      return face.tint;
    }
    const bool is_below = height < face.belt;
    pixels.set(at, (is_below ? 0.5 * face.grey : face.grey) + meeting.light, texture, meeting.u,
               height, face.seed, meeting.detail);
    return is_below ? kTrousers : face.tint;
  }
  if (end >= camera.range) {
    pixels.set(at, kFar);
    return {};
  }
  const Vec2 point = eye + way * end;
  const bool floor = row.slope < 0.0;
  pixels.set(at, floor ? kFloor : kCeiling, texture, point.x(), point.y(),
             floor ? 100001U : 100003U, row.detail);
  return floor ? kCarpet : Tint{};
}

// Calls put(index, grey, tint) for each pixel, by its index in rows from the top.
template <class Put>
void render(const Scene& scene, RobotNumber robot, const PinholeCamera& camera, double left,
            double gain, Random& random, Put put) {
  const Pose middle = compose(scene.robot(robot).pose_in_world(), camera.pose_in_robot);
  const Vec2 ahead(std::cos(middle.th), std::sin(middle.th));
  const Vec2 aside(-ahead.y(), ahead.x());
  const Faces faces(scene, robot, compose(middle, {0.0, left, 0.0}), camera);
  const std::vector<Row> rows = rows_of(camera);
  const double focal = camera.focal();
  const double noise = camera.noise * std::sqrt(6.0);
  const auto columns = static_cast<std::size_t>(camera.columns);
  std::vector<Meeting> meetings;
  std::vector<Tint> tints(rows.size());
  Pixels pixels(rows.size());
  for (std::size_t column = 0; column < columns; ++column) {
    const double across = (static_cast<double>(column) + 0.5 - 0.5 * camera.columns) / focal;
    const Vec2 way = ahead - aside * across;
    faces.meet(way, meetings);
    for (std::size_t row = 0; row < rows.size(); ++row)
      tints[row] = look(camera, meetings, faces.eye(), way, rows[row], row, pixels);
    const std::vector<std::uint8_t>& values = pixels.expose(gain, noise, random);
    for (std::size_t row = 0; row < rows.size(); ++row)
      put(row * columns + column, values[row], tints[row]);
  }
}

GreyImage render_grey(const Scene& scene, RobotNumber robot, const PinholeCamera& camera,
                      double left, double gain, Random& random) {
  GreyImage image{camera.columns, camera.rows, {}};
  image.pixels.resize(static_cast<std::size_t>(camera.columns) *
                      static_cast<std::size_t>(camera.rows));
  render(scene, robot, camera, left, gain, random,
         [&](std::size_t at, std::uint8_t grey, const Tint& /*tint*/) { image.pixels[at] = grey; });
  return image;
}

}  // namespace

double PinholeCamera::focal() const {
  return 0.5 * columns / std::tan(0.5 * field_of_view);
}

StereoPair render_stereo(const Scene& scene, RobotNumber robot, const StereoRig& rig,
                         Random& random) {
  StereoPair pair;
  pair.left = render_grey(scene, robot, rig, 0.5 * rig.baseline, 1.0, random);
  pair.right =
      render_grey(scene, robot, rig, -0.5 * rig.baseline, 1.0 + rig.gain_difference, random);
  return pair;
}

ColorImage render_picture(const Scene& scene, RobotNumber robot, const PinholeCamera& camera,
                          Random& random) {
  ColorImage image{camera.columns, camera.rows, {}};
  image.pixels.resize(3 * static_cast<std::size_t>(camera.columns) *
                      static_cast<std::size_t>(camera.rows));
  render(scene, robot, camera, 0.0, 1.0, random,
         [&](std::size_t at, std::uint8_t grey, const Tint& tint) {
           const auto part = [&](unsigned share) {
             return static_cast<std::uint8_t>(grey * share / 255U);
           };
           image.pixels[3 * at] = part(tint.red);
           image.pixels[3 * at + 1] = part(tint.green);
           image.pixels[3 * at + 2] = part(tint.blue);
         });
  return image;
}

std::string to_pgm(const StereoPair& pair, const StereoRig& rig, std::uint64_t cycle) {
  std::string out = format(
      "P5\n# saphira stereo cycle=%llu focal=%.9g baseline=%.9g height=%.9g forward=%.9g "
      "pan=%.9g\n"
      "%d %d\n255\n",
      static_cast<unsigned long long>(cycle), rig.focal(), rig.baseline, rig.height,
      rig.pose_in_robot.x, rig.pose_in_robot.th, 2 * pair.left.columns, pair.left.rows);
  for (int row = 0; row < pair.left.rows; ++row)
    for (const GreyImage* image : {&pair.left, &pair.right}) {
      const auto begin = image->pixels.begin() + static_cast<std::ptrdiff_t>(row) * image->columns;
      out.append(begin, begin + image->columns);
    }
  return out;
}

std::string to_ppm(const ColorImage& image, const PinholeCamera& camera, std::uint64_t cycle) {
  std::string out = format(
      "P6\n# saphira picture cycle=%llu field=%.9g height=%.9g forward=%.9g pan=%.9g\n"
      "%d %d\n255\n",
      static_cast<unsigned long long>(cycle), camera.field_of_view, camera.height,
      camera.pose_in_robot.x, camera.pose_in_robot.th, image.columns, image.rows);
  return out.append(image.pixels.begin(), image.pixels.end());
}

}  // namespace saphira::sim

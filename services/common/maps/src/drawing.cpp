#include "saphira/maps/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "saphira/base/numbers.hpp"
#include "saphira/geometry/axes.hpp"
#include "saphira/maps/topology.hpp"

namespace saphira::maps {

namespace {

using lps::PointType;

constexpr double kMargin = 1.0;     // [m] around the drawing
constexpr double kLegendRow = 0.8;  // [m]
// Okabe and Ito 2008: safe for colour-blind people.
constexpr std::array<std::string_view, 5> kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                  "#56b4e9"};

std::string number(double value) {
  return decimal(value, 3);
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

class Picture {
 public:
  explicit Picture(const Drawing& drawing) : drawing_(drawing) {}
  std::string draw();

 private:
  void include(const Vec2& p) {
    if (!std::isfinite(p.x()) || !std::isfinite(p.y()))
      return;
    low_ = any_ ? Vec2(low_.cwiseMin(p)) : p;
    high_ = any_ ? Vec2(high_.cwiseMax(p)) : p;
    any_ = true;
  }
  void bounds();
  void raster();
  void features();
  void rectangle(const Feature& feature, std::string_view style);
  void line(const Vec2& from, const Vec2& to, std::string_view style);
  void label(const Vec2& at, std::string_view text, double size, std::string_view color = "#444");
  void gate(const Feature& feature);
  void zone(const Feature& feature);
  void ways();
  void strokes();
  void robot();
  struct Named {
    std::string_view name;
    std::string_view color;
    int row = 0;
    double x = 0.0;  // from the left
  };
  int arrange_legend();
  void legend();
  // SVG has y downwards.
  static std::string at(const Vec2& p) { return number(p.x()) + "," + number(-p.y()); }

  const Drawing& drawing_;
  bool any_ = false;
  Vec2 low_{0.0, 0.0};
  Vec2 high_{1.0, 1.0};
  std::vector<Named> named_;
  std::string out_;
};

void Picture::bounds() {
  for (const Feature& feature : drawing_.map.features)
    for (const Vec2& corner : corners(feature))
      include(corner);
  for (const Vec2& point : drawing_.lines)
    include(point);
  for (const Trajectory& trajectory : drawing_.trajectories)
    for (const Vec2& point : trajectory.points_in_map)
      include(point);
  for (const Strokes& strokes : drawing_.strokes)
    for (const Vec2& point : strokes.lines)
      include(point);
  for (const Words& words : drawing_.words)
    include(words.at_in_map);
  if (drawing_.robot)
    include(drawing_.robot->pose_in_map.position());
  if (drawing_.raster) {
    const Raster& raster = *drawing_.raster;
    for (int y = 0; y < raster.height; ++y)
      for (int x = 0; x < raster.width; ++x)
        if (raster.occupied[static_cast<std::size_t>(y * raster.width + x)] >= 0.0F)
          include(transform(raster.lower_left_in_map,
                            {(x + 0.5) * raster.cell, (y + 0.5) * raster.cell}));
  }
}

// Runs of cells of one of sixteen shades are one rectangle each.
void Picture::raster() {
  if (!drawing_.raster)
    return;
  const Raster& raster = *drawing_.raster;
  const Pose& frame = raster.lower_left_in_map;
  out_ += "<g shape-rendering=\"crispEdges\" transform=\"translate(" + at(frame.position()) +
          ") rotate(" + number(-degrees(frame.th)) + ") scale(" + number(raster.cell) + "," +
          number(-raster.cell) + ")\">\n";
  const auto shade = [&](int x, int y) {
    const float p = raster.occupied[static_cast<std::size_t>(y * raster.width + x)];
    return p < 0.0F ? -1 : static_cast<int>(std::lround(std::clamp(p, 0.0F, 1.0F) * 15.0F));
  };
  for (int y = 0; y < raster.height; ++y)
    for (int x = 0; x < raster.width;) {
      const int value = shade(x, y);
      int end = x + 1;
      while (end < raster.width && shade(end, y) == value)
        ++end;
      if (value >= 0) {
        // White where free, dark where occupied, on a grey ground.
        const std::string grey = std::to_string(255 - value * 13);
        out_ += "<rect x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) + "\" width=\"" +
                std::to_string(end - x) + "\" height=\"1\" fill=\"rgb(" + grey + "," + grey + "," +
                grey + ")\"/>\n";
      }
      x = end;
    }
  out_ += "</g>\n";
}

void Picture::rectangle(const Feature& feature, std::string_view style) {
  out_ += "<polygon points=\"";
  for (const Vec2& corner : corners(feature))
    out_ += at(corner) + " ";
  out_.back() = '"';
  out_.append(" ").append(style).append("/>\n");
}

void Picture::line(const Vec2& from, const Vec2& to, std::string_view style) {
  out_ += "<path d=\"M" + at(from) + " L" + at(to) + "\" fill=\"none\" ";
  out_.append(style).append("/>\n");
}

void Picture::label(const Vec2& where, std::string_view text, double size, std::string_view color) {
  out_ += "<text x=\"" + number(where.x()) + "\" y=\"" + number(-where.y()) + "\" font-size=\"" +
          number(size) + "\" text-anchor=\"middle\" fill=\"";
  out_.append(color).append("\">") += escaped(text) + "</text>\n";
}

// A door: its opening, and a stroke towards its normal; black where it is closed.
void Picture::gate(const Feature& feature) {
  const bool door = feature.type == PointType::door;
  const bool closed = drawing_.closed_doors.contains(feature.id);
  const std::string color = closed ? "#000" : door ? "#d55e00" : "#009e73";
  const Vec2 left = transform(feature.pose_in_map, {0.0, feature.width / 2});
  const Vec2 right = transform(feature.pose_in_map, {0.0, -feature.width / 2});
  line(left, right, "stroke=\"" + color + "\" stroke-width=\"0.12\"");
  line(feature.pose_in_map.position(), transform(feature.pose_in_map, {0.3, 0.0}),
       "stroke=\"" + color + "\" stroke-width=\"0.05\"");
  label(transform(feature.pose_in_map, {-0.45, 0.0}), std::to_string(feature.id), 0.3, color);
}

// In the colour of its rule; a one-way zone with an arrow along its heading.
void Picture::zone(const Feature& feature) {
  const char* color = "#0072b2";
  if (feature.rule == ZoneRule::keep_out)
    color = "#cc0000";
  else if (feature.rule == ZoneRule::slow)
    color = "#e69f00";
  else if (feature.rule == ZoneRule::preferred)
    color = "#009e73";
  rectangle(feature, std::string("fill=\"") + color + "\" fill-opacity=\"0.2\" stroke=\"" + color +
                         "\" stroke-width=\"0.05\" stroke-dasharray=\"0.2\"");
  if (feature.rule == ZoneRule::one_way) {
    const double half = std::min(1.0, feature.length / 2);
    const Vec2 tip = transform(feature.pose_in_map, {half, 0.0});
    const std::string style = std::string("stroke=\"") + color + "\" stroke-width=\"0.08\"";
    line(transform(feature.pose_in_map, {-half, 0.0}), tip, style);
    for (const double wing : {0.3, -0.3})
      line(transform(feature.pose_in_map, {half - 0.3, wing}), tip, style);
  }
  label(feature.pose_in_map.position(),
        std::string(word(feature.rule)) + " " +
            (feature.name.empty() ? std::to_string(feature.id) : feature.name),
        0.35, color);
}

void Picture::features() {
  std::set<int> layers;
  for (const ArtifactTraits& each : kArtifactTraits)
    layers.insert(each.layer);
  for (const int layer : layers)
    for (const Feature& f : drawing_.map.features)
      if (const ArtifactTraits& of_type = traits(f.type);
          of_type.layer == layer && !of_type.area.empty())
        rectangle(f, of_type.area);
  for (const Feature& f : drawing_.map.features) {
    const Vec2 middle = f.pose_in_map.position();
    switch (f.type) {
      case PointType::wall:
        line(begin_of(f), end_of(f), R"(stroke="#222" stroke-width="0.1")");
        break;
      case PointType::object:
        rectangle(f, f.learned
                         ? R"(fill="#e69f00" fill-opacity="0.8" stroke="#555" stroke-width="0.04")"
                         : R"(fill="#999" fill-opacity="0.7" stroke="#555" stroke-width="0.04")");
        break;
      case PointType::zone:
        zone(f);
        break;
      case PointType::door:
      case PointType::breach:
        gate(f);
        break;
      case PointType::position:
        out_ += "<circle cx=\"" + number(middle.x()) + "\" cy=\"" + number(-middle.y()) +
                "\" r=\"0.12\" fill=\"#cc79a7\"/>\n";
        line(middle, transform(f.pose_in_map, {0.5, 0.0}),
             R"(stroke="#cc79a7" stroke-width="0.06")");
        label(transform(f.pose_in_map, {-0.4, 0.0}), f.name, 0.35, "#a0527d");
        break;
      case PointType::office:
        label(middle, f.name.empty() ? std::to_string(f.id) : f.name, 0.45, "#8a7a45");
        break;
      case PointType::corridor:
      case PointType::lane:
        label(middle, std::to_string(f.id) + (f.name.empty() ? "" : " " + f.name), 0.5, "#00507c");
        break;
      default:
        break;
    }
  }
}

void Picture::ways() {
  std::size_t color = 0;
  for (const Trajectory& trajectory : drawing_.trajectories) {
    if (!trajectory.points_in_map.empty()) {
      out_ += "<path d=\"";
      Vec2 last(0.0, 0.0);
      bool first = true;
      for (const Vec2& point : trajectory.points_in_map) {
        if (!first && (point - last).norm() < 0.02)
          continue;  // too near to be seen
        out_ += (first ? "M" : " L") + at(point);
        last = point;
        first = false;
      }
      out_ += "\" fill=\"none\" stroke=\"";
      out_.append(kColors[color]) += "\" stroke-width=\"0.06\" stroke-linejoin=\"round\"/>\n";
    }
    color = (color + 1) % kColors.size();
  }
  for (const DrawnMatch& match : drawing_.matches)
    line(match.seen_in_map, match.artifact_in_map,
         match.accepted ? R"(stroke="#009e73" stroke-width="0.05")"
                        : R"(stroke="#c00" stroke-width="0.05" stroke-dasharray="0.15")");
}

void Picture::strokes() {
  for (const Strokes& strokes : drawing_.strokes) {
    if (strokes.lines.empty())
      continue;
    out_ += "<path d=\"";
    for (std::size_t i = 0; i + 1 < strokes.lines.size(); i += 2)
      out_ += "M" + at(strokes.lines[i]) + " L" + at(strokes.lines[i + 1]);
    out_ += "\" fill=\"none\" stroke=\"" + escaped(strokes.color) + "\" stroke-width=\"" +
            number(strokes.width) + "\"/>\n";
  }
  for (const Words& words : drawing_.words)
    label(words.at_in_map, words.text, 0.35, escaped(words.color));
}

void Picture::robot() {
  if (!drawing_.robot)
    return;
  const DrawnRobot& robot = *drawing_.robot;
  const Vec2 middle = robot.pose_in_map.position();
  out_ += "<circle cx=\"" + number(middle.x()) + "\" cy=\"" + number(-middle.y()) + "\" r=\"" +
          number(robot.radius) + "\" fill=\"#d55e00\" fill-opacity=\"0.8\"/>\n";
  line(middle, transform(robot.pose_in_map, {2 * robot.radius, 0.0}),
       R"(stroke="#000" stroke-width="0.07")");
  Eigen::Matrix2d covariance;
  covariance << robot.xx, robot.xy, robot.xy, robot.yy;
  const auto solver = principal_axes(covariance);
  const Eigen::Vector2d axes = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt() * 2.0;
  const Eigen::Vector2d along = solver.eigenvectors().col(1);
  out_ += "<ellipse cx=\"0\" cy=\"0\" rx=\"" + number(axes(1)) + "\" ry=\"" + number(axes(0)) +
          "\" transform=\"translate(" + at(middle) + ") rotate(" +
          number(-degrees(std::atan2(along.y(), along.x()))) +
          ")\" fill=\"none\" stroke=\"#d55e00\" stroke-width=\"0.04\"/>\n";
}

// Beside the scale, or below it where the picture is too narrow. Returns the additional rows.
int Picture::arrange_legend() {
  std::size_t color = 0;
  for (const Trajectory& trajectory : drawing_.trajectories)
    named_.push_back({trajectory.name, kColors[color++ % kColors.size()]});
  for (const Strokes& strokes : drawing_.strokes)
    if (!strokes.name.empty())
      named_.push_back({strokes.name, strokes.color});
  const double width = high_.x() - low_.x();
  double x = 6.5;
  int row = 0;
  for (Named& named : named_) {
    const double needs = 2.0 + 0.3 * static_cast<double>(named.name.size());
    if (x + needs > width && x > 6.5) {
      x = 6.5;
      ++row;
    }
    named.row = row;
    named.x = x;
    x += needs;
  }
  return row;
}

void Picture::legend() {
  // A scale of five metres at the lower left; above it the legend of colours.
  const int rows = named_.empty() ? 0 : named_.back().row;
  const Vec2 corner(low_.x() + 0.3, low_.y() + 0.4 + kLegendRow * rows);
  line(corner, corner + Vec2(5.0, 0.0), R"(stroke="#000" stroke-width="0.08")");
  label(corner + Vec2(2.5, 0.2), "5 m", 0.5, "#000");
  for (const Named& named : named_) {
    const Vec2 from = corner + Vec2(named.x, -kLegendRow * named.row);
    line(from, from + Vec2(1.0, 0.0),
         "stroke=\"" + escaped(named.color) + "\" stroke-width=\"0.12\"");
    out_ += "<text x=\"" + number(from.x() + 1.2) + "\" y=\"" + number(-from.y() + 0.15) +
            "\" font-size=\"0.5\">" + escaped(named.name) + "</text>\n";
  }
  if (!drawing_.title.empty())
    out_ += "<text x=\"" + number(low_.x() + 0.3) + "\" y=\"" + number(-high_.y() + 0.6) +
            "\" font-size=\"0.6\" font-weight=\"bold\">" + escaped(drawing_.title) + "</text>\n";
}

std::string Picture::draw() {
  bounds();
  low_ -= Vec2(kMargin, kMargin + 0.6);
  high_ += Vec2(kMargin, kMargin + (drawing_.title.empty() ? 0.0 : 0.6));
  low_.y() -= kLegendRow * arrange_legend();
  const Vec2 size = high_ - low_;
  const double scale = std::min(40.0, 1600.0 / size.maxCoeff());  // pixels a metre
  out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(size.x() * scale) +
         "\" height=\"" + number(size.y() * scale) + "\" viewBox=\"" + number(low_.x()) + " " +
         number(-high_.y()) + " " + number(size.x()) + " " + number(size.y()) +
         "\" font-family=\"sans-serif\">\n";
  out_ += "<rect x=\"" + number(low_.x()) + "\" y=\"" + number(-high_.y()) + "\" width=\"" +
          number(size.x()) + "\" height=\"" + number(size.y()) + "\" fill=\"" +
          (drawing_.raster ? "#dfe3e6" : "#fff") + "\"/>\n";
  raster();
  for (std::size_t i = 0; i + 1 < drawing_.lines.size(); i += 2)
    line(drawing_.lines[i], drawing_.lines[i + 1], R"(stroke="#aaa" stroke-width="0.06")");
  features();
  ways();
  strokes();
  robot();
  legend();
  return out_ + "</svg>\n";
}

}  // namespace

std::string to_svg(const Drawing& drawing) {
  return Picture(drawing).draw();
}

}  // namespace saphira::maps

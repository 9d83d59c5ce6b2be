#include "saphira/maps/route.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "lines.hpp"
#include "saphira/base/places.hpp"
#include "saphira/maps/zones.hpp"

namespace saphira::maps {
namespace {

const Topology& floor() {
  static const Topology topology(load_map(config_folder() + "/maps/office-floor.map"));
  return topology;
}

TEST(Route, ASequenceOfRegionsWithThePointsToDriveThrough) {
  const RouteResult found = find_route(floor(), Vec2(17.6, 14.0), "EJ-265");
  const std::optional<Route>& route = found.route;
  ASSERT_TRUE(route) << found.reason;
  EXPECT_EQ(text(floor(), *route),
            "corridor 2 (central corridor), junction 12, corridor 3 (lower corridor), door 1265, "
            "room 265 (EJ-265)");
  // Down to the junction, along to the door, square through it.
  EXPECT_NEAR(route->length, 7.0 + 1.35 + 1.0 + 0.7, 0.5);
  const auto points = route->points();
  EXPECT_NEAR((points.back() - Vec2(16.15, 5.3)).norm(), 0.0, 1e-9);
  for (const Leg& leg : route->legs)
    EXPECT_FALSE(leg.points.empty());
  // Every point is free ground, in the corridors a door's width from the wall.
  for (const Vec2& point : points)
    EXPECT_FALSE(floor().at(point).empty() && (point - Vec2(16.15, 6.0)).norm() > 1e-9)
        << point.transpose();
}

/// One case of routes.txt.
class Ways : public test::LinePlayer {
 public:
  Ways() {
    events_ = {
      ON("map", topology_ = Topology(parse_map(lines(in), "test.map"))),
      ON("zone", zones_ += "ZONE " + lines(in)),
      ON("advice", advice_ = rest(in)),
      ON("said", said_by_ = rest(in)),
      ON("wide", settings_.needs_width = read<double>(in)),
      ON("blocked", settings_.blocked = ids(in)),
      ON("closed", settings_.closed = ids(in)),
      ON("go", const Vec2 from = point(in);
         found_ = find_route(topology_, from, rest(in), settings())),
      ON("go-to-point", const Vec2 from = point(in);
         found_ = find_route(topology_, from, point(in), settings())),
      ON("way", way(rest(in))),
      ON("reason", expect_like(found_.reason, rest(in))),
      ON("remark", expect_like(found_.remark(), rest(in))),
      ON("length", EXPECT_NEAR(length(), read<double>(in), 0.005)),
      ON("begins", near(points().front(), point(in))),
      ON("ends", near(points().back(), point(in)))
    };
    facts_ = {IS("legs", std::to_string(found_.route.value().legs.size()))};
  }

 private:
  /// A bar is a line break.
  static std::string lines(std::istringstream& in) {
    std::string text = rest(in) + "\n";
    std::ranges::replace(text, '|', '\n');
    return text;
  }
  static Vec2 point(std::istringstream& in) {
    const double x = read<double>(in);
    return {x, read<double>(in)};
  }
  static std::set<std::uint32_t> ids(std::istringstream& in) {
    std::set<std::uint32_t> all;
    for (std::uint32_t id = 0; in >> id;)
      all.insert(id);
    return all;
  }
  RouteSettings settings() {
    settings_.zones = all_zones(parse_map(zones_, "zones.map"), topology_, advice_, said_by_);
    return settings_;
  }
  void way(const std::string& pattern) {
    if (pattern == "none") {
      EXPECT_FALSE(found_.route);
      return;
    }
    ASSERT_TRUE(found_.route) << found_.reason;
    expect_like(text(topology_, *found_.route), pattern);
  }
  double length() const { return found_.route.value().length; }
  std::vector<Vec2> points() const { return found_.route.value().points(); }
  static void near(const Vec2& is, const Vec2& expected) {
    EXPECT_NEAR((is - expected).norm(), 0.0, 1e-9) << is.transpose();
  }

  Topology topology_ = floor();
  RouteSettings settings_;
  std::string zones_;
  std::string advice_;
  std::string said_by_;
  RouteResult found_;
};

TEST(Route, IsAsWritten) {
  EXPECT_EQ(test::play<Ways>("services/common/maps/test/routes.txt"), 20);
}

}  // namespace
}  // namespace saphira::maps

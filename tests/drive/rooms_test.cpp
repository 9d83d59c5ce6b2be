// Maps of places without corridors, built from nothing and driven by.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "drive/building.hpp"
#include "saphira/explore/free_floor.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::test {
namespace {

struct Room {
  std::string name;
  std::string world;  ///< text of a world file
};

std::string box(double x, double y, double th, double length, double width) {
  const auto n = [](double v) { return std::to_string(std::lround(v)) + " "; };
  const double l = length / 2;
  const double w = width / 2;
  const double c[5][2] = {{-l, -w}, {l, -w}, {l, w}, {-l, w}, {-l, -w}};
  std::string out = "push " + n(x) + n(y) + n(th);
  for (int i = 0; i < 4; ++i)
    out += n(c[i][0]) + n(c[i][1]) + n(c[i + 1][0]) + n(c[i + 1][1]);
  return out + "pop\n";
}

std::vector<Room> rooms() {
  std::vector<Room> all;
  all.push_back({"laboratory",
                 "width 12000\nheight 11000\n500 1500 6000 500\n6000 500 11500 2500\n"
                 "11500 2500 10500 9000\n10500 9000 4500 10500\n4500 10500 1000 8000\n"
                 "1000 8000 500 1500\n" +
                     box(3500, 6000, 30, 1600, 800) + box(7500, 7000, -15, 2000, 900) +
                     box(7000, 3500, 20, 1200, 800) + "position 2000 3000 0\n"});
  return all;
}

DriveOptions drive_in(const Room& room, std::uint64_t seed) {
  DriveOptions options;
  options.seed = seed;
  options.made_world = std::make_shared<sim::World>(sim::parse_world(room.world, room.name));
  return options;
}

/// Share of the floor that the robot could get to that it has seen as free.
double share_seen(const sim::World& world, const Vec2& start, const explore::FreeFloor& floor) {
  constexpr double kCell = 0.1;
  constexpr int kSide = 160;
  const auto is_open = [&](const Vec2& at) {
    return std::none_of(world.segments.begin(), world.segments.end(), [&](const sim::Segment& s) {
      const Vec2 way = s.to - s.from;
      const double t =
          std::clamp((at - s.from).dot(way) / std::max(1e-9, way.squaredNorm()), 0.0, 1.0);
      return (s.from + t * way - at).norm() < 0.3;
    });
  };
  std::vector<char> been(kSide * kSide, 0);
  std::vector<std::pair<int, int>> open{
      {static_cast<int>(start.x() / kCell), static_cast<int>(start.y() / kCell)}};
  int reached = 0;
  int seen = 0;
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    if (x < 0 || y < 0 || x >= kSide || y >= kSide || been[static_cast<std::size_t>(y * kSide + x)])
      continue;
    been[static_cast<std::size_t>(y * kSide + x)] = 1;
    const Vec2 at((x + 0.5) * kCell, (y + 0.5) * kCell);
    if (!is_open(at))
      continue;
    ++reached;
    seen += floor.is_free(at) ? 1 : 0;
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      open.emplace_back(x + dx, y + dy);
  }
  return static_cast<double>(seen) / reached;
}

class Rooms : public ::testing::TestWithParam<std::tuple<std::size_t, std::uint64_t>> {};

TEST_P(Rooms, AreMappedAndDrivenBy) {
  const Room room = rooms()[std::get<0>(GetParam())];
  const DriveOptions options = drive_in(room, std::get<1>(GetParam()));
  Building built(options);
  built.whole.advance();
  const Pose start_pose = built.whole.truth();
  const Vec2 start = start_pose.position();
  explore::FreeFloor floor(built.whole.drive().mounts());
  built.run(15000, [&] { floor.add(built.whole.truth(), built.whole.drive().seen().readings); });
  built.draw(room.name);
  const double share = share_seen(built.whole.drive().world(), start, floor);
  const maps::Map map = built.aligned_map();
  std::printf("%s: %s; %.1f minutes, seen %.2f\n", room.name.c_str(), built.reason().c_str(),
              static_cast<double>(built.whole.cycle()) / 600.0, share);
  EXPECT_EQ(built.whole.drive().contacts(), 0);
  ASSERT_TRUE(built.done()) << built.reason();
  EXPECT_GE(share, 0.9);

  WholeOptions again{.drive = options};
  again.drive.start_in_world = start_pose;
  again.made_map = std::make_shared<const maps::Map>(map);
  Whole whole(again);
  std::vector<std::string> places;
  for (const maps::Feature& feature : map.features)
    if (feature.type == lps::PointType::position)
      places.push_back(feature.name);
  constexpr std::size_t kGoals = 5;
  for (std::size_t i = 1; i <= kGoals; ++i) {
    const std::string& place = places[i * (places.size() - 1) / kGoals];
    const auto status = whole.achieve("go-to-place", {saphira::text("place", place)}, 2500);
    const double off = (whole.believed().position() - whole.truth().position()).norm();
    const maps::Feature& at = *maps::named(map, lps::PointType::position, place).front();
    const double away = (whole.truth().position() - at.pose_in_map.position()).norm();
    std::printf("  %s: pose to %.2f m, away %.2f m\n", place.c_str(), off, away);
    EXPECT_EQ(status.state, v1::GOAL_SUCCEEDED) << place << ": " << status.reason;
    EXPECT_LT(away, 0.5) << place;
    EXPECT_LT(off, 0.3) << place;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Rooms,
                         ::testing::Combine(::testing::Values(0), ::testing::Values(1)));

}  // namespace
}  // namespace saphira::test

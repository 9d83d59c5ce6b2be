#include "saphira/logs/scan_matching.hpp"

#include <gtest/gtest.h>

#include "scan_room.hpp"

namespace saphira::logs {
namespace {

TEST(ScanMatching, NormalsAreOfTheSurfaces) {
  const Scan scan = test::scan_from({2.0, 1.0, 0.3});
  std::size_t with = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Vec2 normal = transform({0.0, 0.0, 0.3}, scan.normals[i]);
    if (normal.isZero())
      continue;
    ++with;
    EXPECT_NEAR(scan.normals[i].norm(), 1.0, 1e-9);
    EXPECT_LT(scan.normals[i].dot(scan.points[i]), 0.0);
    EXPECT_GT(std::max(std::abs(normal.x()), std::abs(normal.y())), 0.85);
  }
  EXPECT_GT(with, scan.points.size() * 4 / 5);
}

TEST(ScanMatching, RangesThatAreNoneMakeNoPoints) {
  Beams beams;
  beams.max_range = 10.0;
  const Scan scan = make_scan({1.0, 81.9, 0.0, 1e9, 2.0}, beams);
  EXPECT_EQ(scan.points.size(), 2U);
}

TEST(ScanMatching, AlignsFromAGuessThatIsOff) {
  const Pose first{2.0, 1.0, 0.3};
  const Pose second{2.3, 1.1, 0.45};
  ScanReference reference;
  reference.add(test::scan_from(first), first);
  reference.arrange();
  const Alignment found =
      align(reference, test::scan_from(second), {2.15, 1.25, 0.35}, AlignSettings{});
  EXPECT_NEAR(found.pose.x, second.x, 0.01);
  EXPECT_NEAR(found.pose.y, second.y, 0.01);
  EXPECT_NEAR(degrees(found.pose.th), degrees(second.th), 0.3);
  EXPECT_GT(found.overlap, 0.8);
  EXPECT_LT(found.rms, 0.02);
}

TEST(ScanMatching, AlongABareCorridorTheGuessDecides) {
  Scan walls;
  for (double x = -5.0; x <= 5.0; x += 0.05)
    for (const double side : {-1.0, 1.0}) {
      walls.points.emplace_back(x, side);
      walls.normals.emplace_back(0.0, -side);
    }
  ScanReference reference;
  reference.add(walls, {});
  reference.arrange();
  AlignSettings settings;
  settings.guess_information = Eigen::Vector3d(1e3, 1e3, 1e3).asDiagonal();
  const Alignment found = align(reference, walls, {0.4, 0.1, 0.02}, settings);
  EXPECT_NEAR(found.pose.x, 0.4, 0.02);
  EXPECT_NEAR(found.pose.y, 0.0, 0.01);
  EXPECT_LT(found.information(0, 0), 1e-3 * found.information(1, 1));
}

TEST(ScanMatching, SearchFindsWhatNoAlignmentWould) {
  const Pose first{2.0, 1.0, 0.3};
  const Pose second{3.0, 2.0, 0.9};
  ScanReference reference;
  reference.add(test::scan_from(first), first);
  reference.arrange();
  const ScanField field(reference);
  const Scan scan = test::scan_from(second);
  const auto found = field.search(scan, {2.1, 1.3, 0.5}, {1.5, radians(30.0), radians(1.0)}, 0.3);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->pose.x, second.x, 0.08);
  EXPECT_NEAR(found->pose.y, second.y, 0.08);
  EXPECT_NEAR(degrees(found->pose.th), degrees(second.th), 1.5);
  EXPECT_FALSE(field.search(scan, {2.1, 1.3, 0.5}, {1.5, radians(30.0), radians(1.0)}, 0.99));
}

TEST(ScanMatching, SearchIsAsGoodAsTryingAll) {
  const Pose first{2.0, 1.0, 0.3};
  ScanReference reference;
  reference.add(test::scan_from(first), first);
  reference.arrange();
  const ScanField field(reference);
  const Scan scan = test::scan_from({2.4, 1.2, 0.2});
  const Pose guess{2.2, 1.2, 0.3};
  const SearchWindow window{0.3, radians(8.0), radians(2.0)};
  const auto found = field.search(scan, guess, window, 0.1);
  ASSERT_TRUE(found);
  double best = 0.0;
  for (int turn = -4; turn <= 4; ++turn)
    for (int c = -6; c <= 6; ++c)
      for (int r = -6; r <= 6; ++r)
        best = std::max(best, field.score(scan, {guess.x + 0.05 * c, guess.y + 0.05 * r,
                                                 guess.th + turn * radians(2.0)}));
  EXPECT_NEAR(found->score, best, 1e-3);
}

TEST(ScanMatching, NothingIsNoMistake) {
  ScanReference empty;
  empty.arrange();
  EXPECT_EQ(align(empty, test::scan_from({2.0, 1.0, 0.0}), {}, {}).overlap, 0.0);
  EXPECT_FALSE(ScanField(empty).search(test::scan_from({2.0, 1.0, 0.0}), {}, {}, 0.0));
}

TEST(LookAt, WhatStandsBeforeAWallIsSeenThrough) {
  const Scan scan = test::scan_from({4.0, 2.5, 0.0});
  std::vector<Vec2> before;
  std::vector<Vec2> behind;
  for (const Vec2& p : scan.points) {
    const double range = p.norm();
    if (range < 2.0)
      continue;
    before.push_back(p * ((range - 1.0) / range));
    behind.push_back(p * ((range + 1.0) / range));
  }
  const Sight same = look_at(scan, scan.points);
  EXPECT_EQ(same.through, 0U);
  EXPECT_GT(same.agree, scan.points.size() * 9 / 10);
  const Sight through = look_at(scan, before);
  EXPECT_GT(through.through, before.size() * 8 / 10);
  const Sight hidden = look_at(scan, behind);
  EXPECT_LT(hidden.through, behind.size() / 20);
  // It saw nothing behind it.
  EXPECT_EQ(look_at(scan, {{-1.0, 0.3}}).agree + look_at(scan, {{-1.0, 0.3}}).through, 0U);
}

TEST(ScanField, SlackIsAlongWhatLooksTheSame) {
  // Between two walls, and with one across them.
  const auto corridor = [](bool end) {
    Scan scan;
    for (double x = -6.0; x <= 6.0; x += 0.05)
      for (const double y : {-1.0, 1.0}) {
        scan.points.emplace_back(x, y);
        scan.normals.emplace_back(0.0, y < 0.0 ? 1.0 : -1.0);
      }
    for (double y = -1.0; end && y <= 1.0; y += 0.02) {
      scan.points.emplace_back(3.0, y);
      scan.normals.emplace_back(-1.0, 0.0);
    }
    return scan;
  };
  const Eigen::Matrix2d prior = Eigen::Matrix2d::Identity();
  for (const bool end : {false, true}) {
    ScanReference reference;
    reference.add(corridor(end), {});
    reference.arrange();
    const ScanField field(reference);
    Scan query = corridor(end);
    std::erase_if(query.points, [](const Vec2& p) { return std::abs(p.x()) > 3.5; });
    query.normals.assign(query.points.size(), Vec2::Zero());
    const Eigen::Matrix2d slack = field.slack(query, {}, {0.0, 0.0}, prior, 3.0);
    EXPECT_LT(std::sqrt(slack(1, 1)), 0.1);
    if (end)
      EXPECT_LT(std::sqrt(slack(0, 0)), 0.2);
    else
      EXPECT_GT(std::sqrt(slack(0, 0)), 0.5);
  }
}

}  // namespace
}  // namespace saphira::logs

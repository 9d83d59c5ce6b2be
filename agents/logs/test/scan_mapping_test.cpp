#include "saphira/logs/scan_mapping.hpp"

#include <gtest/gtest.h>

#include "scan_room.hpp"

namespace saphira::logs {
namespace {

struct Drive {
  std::vector<Pose> truth;
  std::vector<Pose> odom;
  std::vector<Scan> scans;
};

// Twice around the block, with dead reckoning that turns by 1 degree per metre, and jitters.
Drive around_the_block(int rounds, std::uint64_t seed) {
  Drive drive;
  Random random(seed);
  Pose truth{9.0, -5.0, 0.0};
  Pose odom;
  const auto go = [&](const Pose& step) {
    truth = compose(truth, step);
    const double way = std::hypot(step.x, step.y);
    odom = compose(odom, {step.x * random.normal(1.02, 0.03), 0.0,
                          step.th * random.normal(1.0, 0.05) + radians(1.0) * way +
                              random.normal(0.0, radians(1.0)) * way});
    drive.truth.push_back(truth);
    drive.odom.push_back(odom);
    drive.scans.push_back(test::scan_from(truth, &random));
  };
  go({});
  for (int round = 0; round < rounds; ++round)
    for (const double length : {16.0, 12.0, 16.0, 12.0}) {
      for (double gone = 0.0; gone < length - 0.01; gone += 0.2)
        go({0.2, 0.0, 0.0});
      for (int i = 0; i < 10; ++i)
        go({0.0, 0.0, radians(9.0)});
    }
  return drive;
}

double worst(const std::vector<Pose>& estimate, const Drive& drive) {
  double most = 0.0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const Pose expected = relative(drive.truth.front(), drive.truth[i]);
    most = std::max(most, (estimate[i].position() - expected.position()).norm());
  }
  return most;
}

TEST(ScanMapper, ClosesTheLoopAndKnowsWhereItWas) {
  const Drive drive = around_the_block(2, 1);
  double odometry = 0.0;
  for (std::size_t i = 0; i < drive.odom.size(); ++i)
    odometry = std::max(odometry, (drive.odom[i].position() -
                                   relative(drive.truth.front(), drive.truth[i]).position())
                                      .norm());
  ASSERT_GT(odometry, 5.0);
  ScanMapper mapper;
  for (std::size_t i = 0; i < drive.scans.size(); ++i)
    mapper.add(drive.odom[i], drive.scans[i]);
  EXPECT_EQ(mapper.report().scans, drive.scans.size());
  EXPECT_GE(mapper.report().loops, 1U);
  EXPECT_EQ(mapper.report().unmatched, 0U);
  EXPECT_LT(worst(mapper.trajectory(), drive), 0.35);
  mapper.refine(2);
  EXPECT_LT(worst(mapper.trajectory(), drive), 0.25);
}

// Eight rooms of 5 m on either side of a corridor, all the same, with thinned scans and wheels that
// slip: into three rooms on the way there and into three others on the way back.
TEST(ScanMapper, RoomsThatLookAlikeAreNotTakenForOneAnother) {
  std::vector<test::Piece> floor{{{0.0, -1.0}, {0.0, 1.0}}, {{40.0, -1.0}, {40.0, 1.0}}};
  for (double x = 0.0; x < 40.0; x += 5.0)
    for (const double y : {-1.0, 1.0}) {
      const auto wall = [&](double x0, double y0, double x1, double y1) {
        floor.push_back({{x + x0, y * y0}, {x + x1, y * y1}});
      };
      wall(0.0, 1.0, 2.0, 1.0);
      wall(3.0, 1.0, 5.0, 1.0);
      wall(0.0, 1.0, 0.0, 6.0);
      wall(5.0, 1.0, 5.0, 6.0);
      wall(0.0, 6.0, 5.0, 6.0);
      wall(3.5, 4.0, 4.5, 4.0);  // a desk
    }
  Drive drive;
  Random random(3);
  Pose truth{1.0, 0.0, 0.0};
  Pose odom;
  double since_scan = 1.0;
  int steps = 0;
  const auto go = [&](const Pose& step) {
    truth = compose(truth, step);
    const double slip = ++steps % 300 == 0 ? radians(random.chance(0.5) ? 20.0 : -20.0) : 0.0;
    odom = compose(odom, {step.x * random.normal(1.0, 0.02), 0.0,
                          step.th * random.normal(1.0, 0.05) + radians(0.5) * step.x + slip});
    since_scan += std::abs(step.x) + 0.5 * std::abs(step.th);
    if (since_scan < 0.8)
      return;
    since_scan = 0.0;
    drive.truth.push_back(truth);
    drive.odom.push_back(odom);
    drive.scans.push_back(test::scan_from(truth, &random, floor));
  };
  const auto to = [&](double x, double y) {
    const double turn = norm2_angle(std::atan2(y - truth.y, x - truth.x) - truth.th);
    for (int i = 0; i < 10; ++i)
      go({0.0, 0.0, turn / 10.0});
    for (double left = (Vec2(x, y) - truth.position()).norm(); left > 0.05; left -= 0.1)
      go({0.1, 0.0, 0.0});
  };
  for (const auto& [room, side] : {std::pair(1, 3.0),
                                   {4, -3.0},
                                   {6, 3.0},
                                   {7, 0.0},
                                   {5, 3.0},
                                   {3, -3.0},
                                   {2, 3.0},
                                   {0, 0.0},
                                   {4, 0.0}}) {
    to(5.0 * room + 2.5, 0.0);
    to(5.0 * room + 2.5, side == 0.0 ? 0.1 : side);
    to(5.0 * room + 2.5, 0.0);
  }
  ScanMapper mapper;
  for (std::size_t i = 0; i < drive.scans.size(); ++i)
    mapper.add(drive.odom[i], drive.scans[i]);
  mapper.refine(2);
  EXPECT_GE(mapper.report().loops, 1U);
  EXPECT_LT(worst(mapper.trajectory(), drive), 0.15);
}

TEST(ScanMapper, TheSameInputsGiveTheSamePoses) {
  const Drive drive = around_the_block(1, 2);
  ScanMapper first;
  ScanMapper second;
  for (std::size_t i = 0; i < drive.scans.size(); i += 2) {
    first.add(drive.odom[i], drive.scans[i]);
    second.add(drive.odom[i], drive.scans[i]);
  }
  EXPECT_EQ(first.trajectory(), second.trajectory());
}

TEST(ScanMapper, GoesOnByDeadReckoningWhereThereIsNothingToSee) {
  ScanMapper mapper;
  Pose believed;
  for (int i = 0; i <= 50; ++i)
    believed = mapper.add({0.1 * i, 0.0, 0.0}, Scan{});
  EXPECT_NEAR(believed.x, 5.0, 1e-9);
  EXPECT_EQ(mapper.report().unmatched, 50U);
  mapper.refine();
  EXPECT_NEAR(mapper.trajectory().back().x, 5.0, 1e-6);
}

}  // namespace
}  // namespace saphira::logs

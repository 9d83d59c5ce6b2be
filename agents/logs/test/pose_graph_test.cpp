#include "saphira/logs/pose_graph.hpp"

#include <gtest/gtest.h>

#include "saphira/base/random.hpp"

namespace saphira::logs {
namespace {

// A square of 4 x 10 steps of 1 m.
std::vector<Pose> square() {
  std::vector<Pose> poses{{}};
  for (int i = 0; i < 40; ++i)
    poses.push_back(compose(poses.back(), {1.0, 0.0, i % 10 == 9 ? kPi / 2 : 0.0}));
  return poses;
}

class PoseGraph : public ::testing::Test {
 protected:
  PoseGraph() : truth_(square()) {
    Random random(1);
    for (std::size_t i = 0; i + 1 < truth_.size(); ++i) {
      Pose step = relative(truth_[i], truth_[i + 1]);
      step.x += random.normal(0.0, 0.02);
      step.y += random.normal(0.0, 0.02);
      step.th += random.normal(0.0, radians(2.0));
      edges_.push_back(
          {i, i + 1, step, Eigen::Vector3d(2500.0, 2500.0, 820.0).asDiagonal(), false});
    }
    poses_.push_back({});
    for (const PoseEdge& edge : edges_)
      poses_.push_back(compose(poses_.back(), edge.to_in_from));
  }
  double worst() const {
    double most = 0.0;
    for (std::size_t i = 0; i < poses_.size(); ++i)
      most = std::max(most, (poses_[i].position() - truth_[i].position()).norm());
    return most;
  }
  void close(std::size_t from, std::size_t to, const Pose& off = {}) {
    edges_.push_back({from, to, compose(relative(truth_[from], truth_[to]), off),
                      Eigen::Vector3d(1e4, 1e4, 1e4).asDiagonal(), true});
  }

  std::vector<Pose> truth_;
  std::vector<Pose> poses_;
  std::vector<PoseEdge> edges_;
};

TEST_F(PoseGraph, AgreesWithItsEdgesAlready) {
  const std::vector<Pose> before = poses_;
  const GraphReport report = optimize(poses_, edges_);
  EXPECT_NEAR(report.before, 0.0, 1e-9);
  EXPECT_NEAR((poses_.back().position() - before.back().position()).norm(), 0.0, 1e-6);
}

TEST_F(PoseGraph, AClosureTakesTheDriftAway) {
  const double drifted = worst();
  ASSERT_GT(drifted, 0.5);
  close(0, 40);
  close(3, 38);
  const GraphReport report = optimize(poses_, edges_);
  EXPECT_LT(report.after, report.before);
  EXPECT_LT((poses_[40].position() - truth_[40].position()).norm(), 0.05);
  EXPECT_LT(worst(), 0.7 * drifted);
  EXPECT_EQ(poses_.front(), Pose{});
}

TEST_F(PoseGraph, AWrongClosureLosesItsWeight) {
  for (std::size_t i = 0; i < 8; ++i)
    close(i, 40 - i);
  std::vector<Pose> good = poses_;
  optimize(good, edges_);
  close(5, 25, {3.0, -2.0, 1.0});
  optimize(poses_, edges_);
  EXPECT_LT((poses_[25].position() - good[25].position()).norm(), 0.15);
  EXPECT_GT(chi2(edges_.back(), poses_), 1000.0);
}

TEST_F(PoseGraph, HeadingsMayWrap) {
  for (Pose& pose : poses_)
    pose.th = norm2_angle(pose.th);
  close(0, 40);
  EXPECT_LT(optimize(poses_, edges_).after, 200.0);
}

}  // namespace
}  // namespace saphira::logs

#include "saphira/vision/tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "saphira/base/cycle.hpp"

namespace saphira::vision {
namespace {

using Kind = lps::SeenThing::Kind;
constexpr double kRangeKnown = 0.35;  // of the range: a less certain place is a direction
constexpr double kLearn = 0.35;       // share of the way to certainty for each sight
constexpr double kSlow = 0.7;         // [s] in which a track out of sight loses its velocity
constexpr double kTentative = 0.4;    // [s] of misses for an unconfirmed track
constexpr std::size_t kMost = 64;
constexpr double kNewArm = 0.3;  // share of the newest direction
constexpr int kMostArms = 6;

double seconds(std::uint64_t from, std::uint64_t to) {
  return to > from ? static_cast<double>(to - from) * kCycle : 0.0;
}

// Of a sight, in odom.
Eigen::Matrix2d noise(const Sight& sight, const Pose& robot) {
  const double th = robot.th + std::atan2(sight.place_in_robot.y(), sight.place_in_robot.x());
  Eigen::Matrix2d turn;
  turn << std::cos(th), -std::sin(th), std::sin(th), std::cos(th);
  const Eigen::Vector2d variances(sight.sigma_range * sight.sigma_range,
                                  sight.sigma_across * sight.sigma_across);
  return turn * variances.asDiagonal() * turn.transpose();
}

// Somebody who comes straight up to the robot stands before it, and does not go on through it; who
// comes aslant walks around it.
void stay_outside(Eigen::Vector4d& state, const Vec2& robot, const Vec2& before, double body) {
  if ((Vec2(state(0), state(1)) - robot).norm() >= body || before.norm() < 1e-6)
    return;
  const Vec2 away = before.normalized();
  const Vec2 velocity(state(2), state(3));
  const double towards = std::min(0.0, velocity.dot(away));
  const Vec2 aside = velocity - towards * away;
  const Vec2 place = robot + body * away;
  const Vec2 left = aside.norm() < -towards ? Vec2(0.0, 0.0) : aside;
  state << place.x(), place.y(), left.x(), left.y();
}

}  // namespace

void Tracker::predict(Track& track, std::uint64_t cycle, const Pose& robot) const {
  const double acceleration = track.thing.kind == Kind::person ? settings_.acceleration
                              : track.ranged                   ? settings_.blob_acceleration
                                                               : settings_.direction_acceleration;
  for (; track.at < cycle; ++track.at) {
    const double unseen = seconds(track.thing.seen, track.at);
    const double keeps = unseen > settings_.coast ? 1.0 - kCycle / kSlow : 1.0;
    Covariance step = Covariance::Identity();
    step(0, 2) = step(1, 3) = kCycle;
    step(2, 2) = step(3, 3) = keeps;
    const Vec2 before = Vec2(track.state(0), track.state(1)) - robot.position();
    track.state = step * track.state;
    if (track.thing.kind == Kind::person)
      stay_outside(track.state, robot.position(), before, settings_.body);
    track.covariance = step * track.covariance * step.transpose();
    const double q = acceleration * acceleration;
    for (int i = 0; i < 2; ++i) {
      track.covariance(i, i) += q * kCycle * kCycle * kCycle * kCycle / 4.0;
      track.covariance(i, i + 2) += q * kCycle * kCycle * kCycle / 2.0;
      track.covariance(i + 2, i) += q * kCycle * kCycle * kCycle / 2.0;
      track.covariance(i + 2, i + 2) += q * kCycle * kCycle;
    }
  }
}

void Tracker::update(Track& track, const Sight& sight, const Pose& robot) const {
  Sight as_far = sight;
  if (!sight.range_known) {
    // Only across: wherever the track is along the line.
    const Vec2 at = to_frame(robot, Vec2(track.state(0), track.state(1)));
    const double far = std::max(0.3, at.norm());
    as_far.place_in_robot = sight.place_in_robot.normalized() * far;
    as_far.sigma_across = sight.sigma_across / sight.place_in_robot.norm() * far;
    as_far.sigma_range = 20.0;
  }
  const Vec2 place = transform(robot, as_far.place_in_robot);
  const Eigen::Matrix<double, 4, 2> gain =
      track.covariance.leftCols<2>() *
      (track.covariance.topLeftCorner<2, 2>() + noise(as_far, robot)).inverse();
  track.state += gain * (Eigen::Vector2d(place.x(), place.y()) - track.state.head<2>());
  track.covariance -= gain * track.covariance.topRows<2>();
  track.covariance = (0.5 * (track.covariance + track.covariance.transpose())).eval();
  const double speed = track.state.tail<2>().norm();
  if (speed > settings_.fastest)
    track.state.tail<2>() *= settings_.fastest / speed;
}

void Tracker::watch_arm(Track& track, const Sight& sight, std::uint64_t cycle,
                        const Pose& robot) const {
  if (!sight.points) {
    track.arms = std::max(0, track.arms - 1);
    return;
  }
  const double th = robot.th + *sight.points;
  const Vec2 way(std::cos(th), std::sin(th));
  if (track.arms == 0 || track.arm.dot(way) < std::cos(settings_.same_arm) * track.arm.norm()) {
    track.arm = way;
    track.arms = 1;
    return;
  }
  track.arm += kNewArm * (way - track.arm);
  track.arms = std::min(track.arms + 1, kMostArms);
  if (track.arms < settings_.hold)
    return;
  track.thing.points_in_odom = std::atan2(track.arm.y(), track.arm.x());
  track.thing.pointed = cycle;
}

void Tracker::begin(const Sight& sight, std::uint64_t cycle, const Pose& robot) {
  Track track;
  track.thing.id = next_id_++;
  track.thing.kind = sight.kind;
  track.thing.channel = sight.channel;
  track.thing.since = cycle;
  const Vec2 place = transform(robot, sight.place_in_robot);
  track.state << place.x(), place.y(), 0.0, 0.0;
  track.covariance.setZero();
  track.covariance.topLeftCorner<2, 2>() = noise(sight, robot);
  const double speed = sight.kind == Kind::person ? 0.7 : 0.1;
  track.covariance(2, 2) = track.covariance(3, 3) = speed * speed;
  track.at = cycle;
  track.ranged = sight.range_known;
  tracks_.push_back(track);
}

void Tracker::see(Kind kind, std::uint64_t cycle, const Pose& robot,
                  const std::vector<Sight>& sights,
                  const std::function<bool(const Vec2&)>& in_view) {
  struct Pair {
    double unlikely;
    std::size_t track;
    std::size_t sight;
  };
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    Track& track = tracks_[t];
    if (track.thing.kind != kind)
      continue;
    predict(track, cycle, robot);
    for (std::size_t s = 0; s < sights.size(); ++s) {
      const Sight& sight = sights[s];
      if (sight.kind != kind || sight.channel != track.thing.channel)
        continue;
      const Vec2 at = to_frame(robot, Vec2(track.state(0), track.state(1)));
      Eigen::Vector2d off =
          transform(robot, sight.place_in_robot) - Vec2(track.state(0), track.state(1));
      Eigen::Matrix2d spread = track.covariance.topLeftCorner<2, 2>() + noise(sight, robot);
      if (!sight.range_known) {
        // Compared by the direction alone.
        const double turned =
            norm2_angle(std::atan2(at.y(), at.x()) -
                        std::atan2(sight.place_in_robot.y(), sight.place_in_robot.x()));
        off = {turned * at.norm(), 0.0};
        const double across = std::sqrt(track.covariance.topLeftCorner<2, 2>().trace());
        spread =
            Eigen::Matrix2d::Identity() * std::pow(std::min(across, 0.5) + sight.sigma_across, 2.0);
      }
      // Of two tracks the likelier one: a track that has not been seen for long fits everywhere.
      const double squared = off.dot(spread.inverse() * off);
      if (squared < settings_.gate)
        pairs.push_back({squared + std::log(spread.determinant()), t, s});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.unlikely < b.unlikely; });
  std::vector<bool> seen(tracks_.size(), false);
  std::vector<bool> used(sights.size(), false);
  for (const Pair& pair : pairs) {
    if (seen[pair.track] || used[pair.sight])
      continue;
    seen[pair.track] = used[pair.sight] = true;
    Track& track = tracks_[pair.track];
    const Sight& sight = sights[pair.sight];
    update(track, sight, robot);
    ++track.sights;
    track.ranged = sight.range_known;
    track.missed = 0.0;
    lps::SeenThing& thing = track.thing;
    thing.confidence += kLearn * (sight.evidence - thing.confidence);
    track.told =
        track.told || (track.sights >= settings_.confirm && thing.confidence >= settings_.sure);
    thing.area = sight.area;
    const auto blend = [](double& old, double now) {
      if (now > 0.0)
        old = old == 0.0 ? now : old + 0.2 * (now - old);
    };
    blend(thing.width, sight.width);
    blend(thing.height, sight.height);
    thing.seen = cycle;
    watch_arm(track, sight, cycle, robot);
  }
  for (std::size_t t = 0; t < seen.size(); ++t) {
    Track& track = tracks_[t];
    if (track.thing.kind != kind || seen[t])
      continue;
    track.arms = std::max(0, track.arms - 1);
    if (in_view(to_frame(robot, Vec2(track.state(0), track.state(1))))) {
      track.missed += kCycle;
      track.thing.confidence *= 0.95;
    }
  }
  std::erase_if(tracks_, [&](const Track& track) {
    const double unseen = seconds(track.thing.seen, cycle);
    if (track.thing.kind != kind)
      return false;
    if (!track.told)
      return unseen > kTentative;
    return track.missed > settings_.forget_in_view || unseen > settings_.forget_out_of_view;
  });
  for (std::size_t s = 0; s < sights.size(); ++s)
    if (!used[s] && sights[s].kind == kind && tracks_.size() < kMost) {
      begin(sights[s], cycle, robot);
      tracks_.back().sights = 1;
      tracks_.back().thing.seen = cycle;
      tracks_.back().thing.confidence = kLearn * sights[s].evidence;
    }
}

std::vector<lps::SeenThing> Tracker::things(std::uint64_t cycle, const Pose& robot) const {
  std::vector<lps::SeenThing> things;
  for (Track track : tracks_) {
    if (!track.told || seconds(track.thing.seen, cycle) > settings_.forget_out_of_view)
      continue;
    predict(track, cycle, robot);
    lps::SeenThing& thing = track.thing;
    const Vec2 place(track.state(0), track.state(1));
    const Vec2 to_robot = robot.position() - place;
    thing.pose_in_odom = {place.x(), place.y(), std::atan2(to_robot.y(), to_robot.x())};
    thing.velocity_in_odom = Vec2(track.state(2), track.state(3));
    const Eigen::Matrix2d spread = track.covariance.topLeftCorner<2, 2>();
    const Vec2 line = to_robot.norm() > 1e-9 ? Vec2(to_robot.normalized()) : Vec2(1.0, 0.0);
    const Vec2 aside(-line.y(), line.x());
    const double along = std::sqrt(std::max(0.0, line.dot(spread * line)));
    const double across = std::sqrt(std::max(0.0, aside.dot(spread * aside)));
    thing.range_known =
        thing.kind == Kind::person || along < kRangeKnown * std::max(1.0, to_robot.norm());
    thing.sigma = thing.range_known ? std::max(along, across) : across;
    things.push_back(thing);
  }
  return things;
}

}  // namespace saphira::vision

#include "saphira/authority/echo_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "lines.hpp"
#include "saphira/authority/robot.hpp"

namespace saphira::authority {
namespace {

const Pose kAhead{0.16, 0.0, 0.0};
const Pose kAskew{0.16, 0.03, radians(10.0)};

bool any_near(const std::vector<Vec2>& spots, const Vec2& place, double within = 0.07) {
  return std::any_of(spots.begin(), spots.end(),
                     [&](const Vec2& spot) { return (spot - place).norm() <= within; });
}

Reading echo(const Pose& sonar_in_robot, double range) {
  return {0, sonar_in_robot, range};
}
/// The cases of echo_map.txt.
class Echoes : public test::LinePlayer {
 public:
  Echoes() {
    events_ = {
      ON("anew", map_ = EchoMap(); edges_.clear()),
      ON("robot", robot_ = pose(in)),
      ON("echo", const Pose at = sonar(in); readings_ = {echo(at, read<double>(in))}),
      ON("silence", readings_ = {{0, sonar(in), std::nullopt}}),
      ON("silence-too", readings_.push_back({0, sonar(in), std::nullopt})),
      ON("quiet", readings_.clear()),
      ON("edges", edges_ = {{place(in), place(in)}}),
      ON("cycle", map_.update(read<std::uint64_t>(in), robot_, readings_, edges_)),
      {"cycles",
       [this](auto& in) {
         const auto from = read<std::uint64_t>(in);
         const auto to = read<std::uint64_t>(in);
         std::uint64_t step = 1;
         in >> step;
         for (std::uint64_t cycle = from; cycle <= to; cycle += step)
           map_.update(cycle, robot_, readings_, edges_);
       }},
      ON("spot", EXPECT_TRUE(any_near(map_.spots(), place(in)))),
      ON("no-spot", EXPECT_FALSE(any_near(map_.spots(), place(in)))),
      {"sees",
       [this](auto& in) {
         const auto cycle = read<std::uint64_t>(in);
         const bool ahead = read<std::string>(in) == "ahead";
         EXPECT_EQ(yes(map_.sees(cycle, ahead)), rest(in));
       }}
    };
    facts_ = {IS("empty", yes(map_.spots().empty())),
              IS("edges known", yes(!map_.edges().empty()))};
  }

 private:
  static Vec2 place(std::istringstream& in) {
    const auto x = read<double>(in);
    return {x, read<double>(in)};
  }
  static Pose pose(std::istringstream& in) {
    const Vec2 at = place(in);
    return {at.x(), at.y(), radians(read<double>(in))};
  }
  static Pose sonar(std::istringstream& in) {
    const std::istringstream::pos_type begin = in.tellg();
    const auto name = read<std::string>(in);
    if (name == "ahead" || name == "askew")
      return name == "ahead" ? kAhead : kAskew;
    if (name == "back")
      return {-0.16, 0.0, kPi};
    in.seekg(begin);
    return pose(in);
  }

  EchoMap map_;
  Pose robot_;
  std::vector<Reading> readings_;
  std::vector<Edge> edges_;
};

TEST(EchoMap, HearsAsWritten) {
  EXPECT_EQ(test::play<Echoes>("bridge/authority/test/echo_map.txt"), 11);
}

TEST(EchoMap, KnowsWhichSonarHeardASpotAndWhen) {
  EchoMap map;
  map.update(1, {}, {{3, kAhead, 1.0}});
  map.update(2, {}, {{4, kAskew, 2.0}});
  const auto of = [&](const Vec2& spot) {
    const auto found = map.heard(spot);
    return found ? std::to_string(found->sonar) + ", " + std::to_string(found->ago) : "nothing";
  };
  for (const Vec2& spot : map.spots())
    EXPECT_EQ(of(spot), spot.norm() < 1.5 ? "3, 1" : "4, 0");
  EXPECT_EQ(of({0.66, 0.0}), "nothing") << "before the arc";
  EXPECT_EQ(of({0.0, 1.0}), "nothing") << "beside the cone";
  map.update(5, {0.5, 0.0, 0.0}, {{3, kAhead, 0.5}});
  EXPECT_EQ(of({0.66, 0.0}), "3, 0") << "the newest one counts, wherever the robot was then";
  map.clear();
  EXPECT_EQ(of({0.66, 0.0}), "nothing");
}

TEST(EchoMap, OfAShortRangeIsFine) {
  for (int i = 0; i < 20; ++i) {
    EchoMap map(0.06);
    const Pose robot{0.013 * i, 0.007 * i, 0.0};
    map.update(1, robot, {echo({0.025, 0.006, radians(10.0)}, 0.03)});
    ASSERT_FALSE(map.spots().empty()) << i;
    EXPECT_TRUE(any_near(map.spots(), {0.055, 0.011}, 0.01)) << i;
  }
}

TEST(Robot, ReadingsOfAPacket) {
  protocol::RobotParameters parameters{.sonars = {{0, {0.1, 0.1, kPi / 2}}, {3, {0.13, 0.0, 0.0}}}};
  const auto readings = readings_of({{3, 1.0, true}, {0, 5.0, false}, {9, 1.0, true}}, parameters);
  ASSERT_EQ(readings.size(), 2U) << "a sonar that no file places is left out";
  EXPECT_EQ(readings[0].sonar, 3);
  EXPECT_EQ(readings[0].range, 1.0);
  EXPECT_EQ(readings[1].sonar_in_robot, (Pose{0.1, 0.1, kPi / 2}));
  EXPECT_FALSE(readings[1].range);
}

TEST(Robot, ReactsAfterHalfARoundOfItsSonars) {
  protocol::RobotParameters parameters;
  parameters.sonars.resize(16);
  parameters.sonar_arrays = 2;
  parameters.sonar_period = 0.04;
  EXPECT_NEAR(body_of(parameters).reaction, 0.36, 1e-9);
}

}  // namespace
}  // namespace saphira::authority

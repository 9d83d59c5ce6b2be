#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "crossing.hpp"
#include "saphira/base/places.hpp"

// Robots cross offices past people who stand in the way or walk, with the behaviors of go_to and
// the guard of the bridge, as in the product.
namespace saphira::test {
namespace {

struct Office {
  std::string robot;
  std::string world;
};

class PeopleOnTheWay : public ::testing::TestWithParam<Office> {};

TEST_P(PeopleOnTheWay, AreHardlyTouched) {
  CrossingOptions options;
  options.robot = GetParam().robot;
  options.world = GetParam().world;
  const auto parameters =
      protocol::load_parameters(find_file(config_folder() + "/robots", options.robot, ".p"));
  int standing = 0;
  int walking = 0;
  int stuck = 0;
  for (const Crowd crowd : {Crowd::kUsual, Crowd::kCorridor, Crowd::kDoorway, Crowd::kInside}) {
    options.crowd = crowd;
    for (options.seed = 1; options.seed <= 3; ++options.seed) {
      SCOPED_TRACE(kCrowdNames[static_cast<int>(crowd)] + std::string(", seed ") +
                   std::to_string(options.seed));
      // Every other person is wider than the shins that a sonar hears.
      options.body = options.seed % 2 == 0 ? 0.3 : 0.25;
      const auto crossing = plan_crossing(options, parameters);
      if (!crossing)
        continue;
      const CrossingResult result = drive_crossing(*crossing, options, {});
      stuck += result.arrived || !crossing->has_way ? 0 : 1;
      EXPECT_EQ(result.things, 0);
      standing += result.standing;
      walking += result.walking;
    }
  }
  // Of twelve crossings.
  EXPECT_EQ(standing, 0);
  EXPECT_LE(stuck, 1);
  EXPECT_EQ(walking, 0);
}

// A thin post straight ahead stands in the gap between the sonars of some robots.
TEST(PostsStraightAhead, AreHeardAndNotTouched) {
  for (const char* const robot : {"pioneer", "p3dx", "amigo"})
    for (const char* const radius : {"50", "100"})
      for (const bool by_hand : {true, false}) {
        int touched = 0;
        for (int seed = 1; seed <= 10; ++seed) {
          const std::string start = std::to_string(2000 + 50 * seed);
          Drive drive({.made_world = std::make_shared<const sim::World>(
                           sim::parse_world("width 10000\nheight 6000\nposition " + start +
                                                " 3000 0\npost p 5000 3000 " + radius + "\n",
                                            "hall.wld")),
                       .robot = robot,
                       .seed = static_cast<std::uint64_t>(seed),
                       .guard = true});
          for (int cycle = 0; cycle < 150; ++cycle) {
            if (by_hand)
              drive.drive(0.3, 0.0);
            else
              drive.go_to({5.0, 0.0});
            drive.advance();
          }
          touched += drive.contacts() > 0 ? 1 : 0;
        }
        EXPECT_EQ(touched, 0) << robot << ", " << radius << " mm" << (by_hand ? ", by hand" : "");
      }
}

INSTANTIATE_TEST_SUITE_P(Offices, PeopleOnTheWay,
                         ::testing::Values(Office{"pioneer", "office"}, Office{"p3dx", "office"},
                                           Office{"amigo", "office"},
                                           Office{"pioneer", "small-office"},
                                           Office{"p3dx", "small-office"},
                                           Office{"amigo", "small-office"}),
                         [](const auto& test) {
                           std::string name = test.param.robot + "_in_" + test.param.world;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace saphira::test

#include <gtest/gtest.h>

#include <algorithm>

#include "crossing.hpp"
#include "saphira/base/places.hpp"

// Robots cross offices with two standing and two walking people, with the behaviors of go_to and
// the guard of the bridge, as in the product.
namespace saphira::test {
namespace {

struct Office {
  std::string robot;
  std::string world;
};

class PeopleOnTheWay : public ::testing::TestWithParam<Office> {};

TEST_P(PeopleOnTheWay, AreNotTouched) {
  CrossingOptions options;
  options.robot = GetParam().robot;
  options.world = GetParam().world;
  const auto parameters =
      protocol::load_parameters(find_file(config_folder() + "/robots", options.robot, ".p"));
  for (options.seed = 1; options.seed <= 4; ++options.seed) {
    const auto crossing = plan_crossing(options, parameters);
    ASSERT_TRUE(crossing);
    const CrossingResult result = drive_crossing(*crossing, options, {});
    EXPECT_TRUE(result.arrived) << "seed " << options.seed << ": stands at "
                                << result.end_in_world.transpose();
    EXPECT_EQ(result.standing + result.walking, result.unheard) << "seed " << options.seed;
    EXPECT_EQ(result.things, 0) << "seed " << options.seed;
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

#include "places/places.hpp"

#include <gtest/gtest.h>

#include "saphira/base/places.hpp"

namespace saphira::test {
namespace {

// A sample: the whole is `saphira bench places`.
TEST(Places, FromAnywhereToARoomByItsNameWithoutContact) {
  const maps::Map map =
      maps::load_map(find_file(config_folder() + "/maps", "office-floor", ".map"));
  const sim::World world =
      sim::load_world(find_file(config_folder() + "/worlds", "office-floor", ".wld"));
  std::uint64_t seed = 1;
  for (const Journey& journey : random_journeys(map, world, 8, 1)) {
    const Arrival arrival = travel(journey, seed++);
    const std::string what = journey.from + " to " + journey.to + ": " + arrival.reason;
    EXPECT_TRUE(arrival.succeeded) << what;
    EXPECT_TRUE(arrival.there) << what;
    EXPECT_TRUE(arrival.at_rest) << what;
    EXPECT_EQ(arrival.contacts, 0) << what;
    EXPECT_EQ(arrival.trouble, "") << what;
  }
}

}  // namespace
}  // namespace saphira::test

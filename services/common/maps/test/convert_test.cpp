#include "maps/shell/convert.hpp"

#include <gtest/gtest.h>

namespace saphira::maps {
namespace {

TEST(Convert, MapsRoundTrip) {
  Map map{.features = {{lps::PointType::corridor, 1, {1.0, 2.0, 0.5}, 10.0, 2.0, "upper"},
                       {lps::PointType::door, 3, {3.0, 1.0, 1.5}, 0.0, 0.9, "EJ-231"},
                       {lps::PointType::wall, 0, {-1.0, 0.0, 0.0}, 3.0, 0.0, ""},
                       {lps::PointType::position, 90, {17.5, 14.0, -1.5}, 0.0, 0.0, "start"},
                       {lps::PointType::object, 91, {3.0, 4.0, 0.0}, 0.5, 0.4, "", true},
                       {lps::PointType::zone,
                        92,
                        {3.0, 4.0, 1.0},
                        2.0,
                        1.0,
                        "kitchen",
                        false,
                        ZoneRule::slow,
                        0.15}}};
  for (const ZoneRule rule : {ZoneRule::keep_out, ZoneRule::one_way, ZoneRule::preferred}) {
    map.features.push_back(map.features.back());
    map.features.back().rule = rule;
  }
  EXPECT_EQ(from_bus(to_bus(map)), map);
}

}  // namespace
}  // namespace saphira::maps

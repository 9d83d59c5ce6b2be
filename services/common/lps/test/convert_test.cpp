#include "lps/shell/convert.hpp"

#include <gtest/gtest.h>

namespace saphira::lps {
namespace {

TEST(Convert, PerceptsRoundTrip) {
  Percept percept{.id = 7,
                  .pose_in_odom = {1.0, -2.0, 0.5},
                  .length = 3.0,
                  .width = 0.9,
                  .sigma_along = 0.1,
                  .sigma_across = 0.02,
                  .sigma_heading = 0.01,
                  .confidence = 0.75,
                  .since = 10,
                  .seen = 99,
                  .readings = {{98, 3}, {99, 6}}};
  for (const PointType type : {PointType::wall, PointType::door, PointType::breach,
                               PointType::junction, PointType::corridor})
    for (const Side side : {Side::none, Side::left, Side::right}) {
      percept.type = type;
      percept.side = side;
      EXPECT_EQ(from_bus(to_bus(percept)), percept);
    }
}

TEST(Convert, SeenThings) {
  SeenThing thing{.id = 7,
                  .pose_in_odom = {1.0, 2.0, 0.3},
                  .velocity_in_odom = {0.4, -0.5},
                  .range_known = false,
                  .sigma = 0.2,
                  .width = 0.5,
                  .height = 1.7,
                  .area = 0.1,
                  .confidence = 0.8,
                  .since = 10,
                  .seen = 12,
                  .points_in_odom = 1.2,
                  .pointed = 11};
  for (const int channel : {-1, 0, 1, 2}) {
    thing.kind = channel < 0 ? SeenThing::Kind::person : SeenThing::Kind::blob;
    thing.channel = channel;
    EXPECT_EQ(from_bus(to_bus(thing)), thing);
  }
}

TEST(Convert, OfManyReadingsTheNewest) {
  Percept percept;
  for (std::uint64_t cycle = 1; cycle <= 1000; ++cycle)
    percept.readings.push_back({cycle, 0});
  const v1::Percept sample = to_bus(percept);
  EXPECT_EQ(sample.reading_cycles.size(), 64U);
  EXPECT_EQ(sample.reading_cycles.front(), 937U);
  EXPECT_EQ(sample.reading_cycles.back(), 1000U);
}

TEST(Convert, TypesNobodyKnowsAreInvalid) {
  EXPECT_EQ(from_bus(static_cast<v1::ArtifactType>(77)), PointType::invalid);
  EXPECT_EQ(from_bus(v1::ARTIFACT_BREAK), PointType::breach);
  EXPECT_EQ(to_bus(PointType::lane), v1::ARTIFACT_LANE);
}

}  // namespace
}  // namespace saphira::lps

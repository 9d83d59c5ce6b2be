#include "lps/shell/convert.hpp"

#include <gtest/gtest.h>

namespace saphira::lps {
namespace {

TEST(Convert, PerceptsRoundTrip) {
  Percept percept;
  percept.id = 7;
  percept.pose_in_odom = {1.0, -2.0, 0.5};
  percept.length = 3.0;
  percept.width = 0.9;
  percept.sigma_along = 0.1;
  percept.sigma_across = 0.02;
  percept.sigma_heading = 0.01;
  percept.confidence = 0.75;
  percept.since = 10;
  percept.seen = 99;
  percept.readings = {{98, 3}, {99, 6}};
  for (const PointType type : {PointType::wall, PointType::door, PointType::breach,
                               PointType::junction, PointType::corridor})
    for (const Side side : {Side::none, Side::left, Side::right}) {
      percept.type = type;
      percept.side = side;
      const Percept back = from_bus(to_bus(percept));
      EXPECT_EQ(back.id, percept.id);
      EXPECT_EQ(back.type, type);
      EXPECT_EQ(back.side, side);
      EXPECT_EQ(back.pose_in_odom, percept.pose_in_odom);
      EXPECT_EQ(back.length, percept.length);
      EXPECT_EQ(back.width, percept.width);
      EXPECT_EQ(back.sigma_along, percept.sigma_along);
      EXPECT_EQ(back.sigma_across, percept.sigma_across);
      EXPECT_EQ(back.sigma_heading, percept.sigma_heading);
      EXPECT_EQ(back.confidence, percept.confidence);
      EXPECT_EQ(back.since, percept.since);
      EXPECT_EQ(back.seen, percept.seen);
      EXPECT_EQ(back.readings, percept.readings);
    }
}

TEST(Convert, SeenThings) {
  SeenThing thing;
  thing.id = 7;
  thing.pose_in_odom = {1.0, 2.0, 0.3};
  thing.velocity_in_odom = {0.4, -0.5};
  thing.range_known = false;
  thing.sigma = 0.2;
  thing.width = 0.5;
  thing.height = 1.7;
  thing.area = 0.1;
  thing.confidence = 0.8;
  thing.since = 10;
  thing.seen = 12;
  thing.points_in_odom = 1.2;
  thing.pointed = 11;
  for (const int channel : {-1, 0, 1, 2}) {
    thing.kind = channel < 0 ? SeenThing::Kind::person : SeenThing::Kind::blob;
    thing.channel = channel;
    const SeenThing back = from_bus(to_bus(thing));
    EXPECT_EQ(back.id, thing.id);
    EXPECT_EQ(back.kind, thing.kind);
    EXPECT_EQ(back.channel, thing.channel);
    EXPECT_EQ(back.pose_in_odom, thing.pose_in_odom);
    EXPECT_EQ(back.velocity_in_odom, thing.velocity_in_odom);
    EXPECT_EQ(back.range_known, thing.range_known);
    EXPECT_EQ(back.sigma, thing.sigma);
    EXPECT_EQ(back.width, thing.width);
    EXPECT_EQ(back.height, thing.height);
    EXPECT_EQ(back.area, thing.area);
    EXPECT_EQ(back.confidence, thing.confidence);
    EXPECT_EQ(back.since, thing.since);
    EXPECT_EQ(back.seen, thing.seen);
    EXPECT_EQ(back.points_in_odom, thing.points_in_odom);
    EXPECT_EQ(back.pointed, thing.pointed);
  }
}

TEST(Convert, OfManyReadingsTheNewest) {
  Percept percept;
  for (std::uint64_t cycle = 1; cycle <= 1000; ++cycle)
    percept.readings.push_back({cycle, 0});
  const v1::Percept sample = to_bus(percept);
  EXPECT_EQ(sample.reading_cycles().size(), 64U);
  EXPECT_EQ(sample.reading_cycles().front(), 937U);
  EXPECT_EQ(sample.reading_cycles().back(), 1000U);
}

TEST(Convert, Readings) {
  v1::RobotState state;
  v1::SonarReading reading;
  reading.sonar(6);
  reading.range(1.5F);
  reading.echo(true);
  state.sonars().push_back(reading);
  reading.echo(false);
  state.sonars().push_back(reading);
  const std::vector<SonarReading> readings = sonars_from_bus(state);
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[0].sonar, 6);
  EXPECT_EQ(readings[0].range, 1.5);
  EXPECT_TRUE(readings[0].echo);
  EXPECT_FALSE(readings[1].echo);
}

TEST(Convert, TypesNobodyKnowsAreInvalid) {
  EXPECT_EQ(from_bus(static_cast<v1::ArtifactType>(77)), PointType::invalid);
  EXPECT_EQ(from_bus(v1::ARTIFACT_BREAK), PointType::breach);
  EXPECT_EQ(to_bus(PointType::lane), v1::ARTIFACT_LANE);
}

}  // namespace
}  // namespace saphira::lps

#include "saphira/registration/contradiction.hpp"

#include <gtest/gtest.h>

namespace saphira::registration {
namespace {

const maps::Map kCorridor = maps::parse_map("CORRIDOR (1) 10000, 0, 0, 20000, 2000\n", "test");
const LineMap kCorridorLines(kCorridor);
const Field kCorridorField(kCorridor, kCorridorLines);
const ContradictionSettings kRatios;

/// Of a sonar in the middle of the corridor, a metre from its left wall; `turn` from that wall.
double ratio(double range, bool echo, double turn = 0.0) {
  return contradiction(kCorridorField, {10.0, 0.0, kPi / 2 + turn}, range, echo);
}

TEST(Contradiction, AnEchoAtItsWallSupportsThePlaceAndAnyOtherContradictsIt) {
  EXPECT_EQ(ratio(1.0, true), kRatios.agrees);
  EXPECT_EQ(ratio(0.91, true), kRatios.agrees);
  EXPECT_EQ(ratio(1.2, true), kRatios.differs);
  EXPECT_EQ(ratio(2.5, true), kRatios.denies) << "through the wall";
  EXPECT_EQ(ratio(0.5, true), kRatios.denies) << "nothing is there";
  EXPECT_EQ(ratio(5.0, false), kRatios.silent);
  EXPECT_LT(kRatios.agrees, 0.0);
}

TEST(Contradiction, WhereNoWallFacesTheSonarNothingFollows) {
  for (const double turn : {0.5, -0.5, kPi / 2})
    for (const bool echo : {true, false})
      EXPECT_EQ(ratio(3.0, echo, turn), 0.0) << turn;
}

}  // namespace
}  // namespace saphira::registration

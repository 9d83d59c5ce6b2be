#include "saphira/base/enum_pairs.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

enum class Weather { dry, damp, wet };
enum class Umbrella { none, open };

constexpr EnumPairs<Weather, Umbrella, 3> kTable{{{
    {Weather::dry, Umbrella::none},
    {Weather::damp, Umbrella::none},
    {Weather::wet, Umbrella::open},
}}};

TEST(EnumPairs, BothWaysAreOneTable) {
  EXPECT_EQ(kTable.theirs(Weather::wet), Umbrella::open);
  EXPECT_EQ(kTable.ours(Umbrella::open, Weather::dry), Weather::wet);
}

TEST(EnumPairs, TheFirstPairCounts) {
  EXPECT_EQ(kTable.theirs(Weather::damp), Umbrella::none);
  EXPECT_EQ(kTable.ours(Umbrella::none, Weather::wet), Weather::dry);
}

TEST(EnumPairs, WhatHasNoPairIsWhatTheTableOrTheCallerSays) {
  EXPECT_EQ(kTable.theirs(static_cast<Weather>(7)), Umbrella::none);
  EXPECT_EQ(kTable.ours(static_cast<Umbrella>(7), Weather::damp), Weather::damp);
}

}  // namespace
}  // namespace saphira

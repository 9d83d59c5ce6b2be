#include "saphira/base/enum_pairs.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "saphira/base/namesakes.hpp"

namespace saphira {
namespace {

enum class Weather { dry, damp, wet };
enum class Umbrella { none, open };

constexpr EnumPairs<Weather, Umbrella, 3> kTable{{{
    {Weather::dry, Umbrella::none},
    {Weather::damp, Umbrella::none},
    {Weather::wet, Umbrella::open},
}}};

enum class Sky { clear, grey = 5, black };
enum class Lamp : unsigned char { off, on, broken };

static_assert(kEnumerators<Weather>.size() == 3);
static_assert(kEnumerators<Sky> == std::array{Sky::clear, Sky::grey, Sky::black});
static_assert(kEnumerators<Lamp>.back() == Lamp::broken);
static_assert(std::string_view(word_of(Lamp::on, {"off", "on", "broken"})) == "on");
static_assert(std::string_view(word_of(static_cast<Lamp>(3), {"off", "on", "broken"})) == "?");

enum OnTheBus : unsigned char { LAMP_BROKEN, LAMP_OFF, LAMP_ON };
constexpr auto kByName = pairs_by_name<Lamp, OnTheBus>();
static_assert(kByName.theirs(Lamp::off) == LAMP_OFF && kByName.theirs(Lamp::on) == LAMP_ON);
static_assert(kByName.ours(LAMP_BROKEN, Lamp::off) == Lamp::broken);

/// True where a table with a pair for each of these compiles.
template <Sky... with>
concept Compiles = requires {
  typename std::bool_constant<(
      EnumPairs<Sky, Lamp, sizeof...(with)>({{{with, Lamp::off}...}}, {}, {Lamp::on, Lamp::broken}),
      true)>;
};
static_assert(Compiles<Sky::clear, Sky::grey, Sky::black>);
static_assert(!Compiles<Sky::clear, Sky::black>);

TEST(EnumPairs, WhatIsLeftOutIsNamed) {
  constexpr EnumPairs<Sky, Lamp, 3> kLamps{
      {{{Sky::clear, Lamp::off}, {Sky::grey, Lamp::off}, {Sky::black, Lamp::on}}},
      {},
      {Lamp::broken}};
  EXPECT_EQ(kLamps.theirs(Sky::black), Lamp::on);
  EXPECT_EQ(kLamps.ours(Lamp::broken, Sky::grey), Sky::grey);
}

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

struct Window {
  double x = 0.0;
};
struct Room {
  std::string name = "none";
  int number = -1;
  Lamp lamp = Lamp::on;
  Window door;
  std::vector<Window> windows;
  bool locked = true;
};
struct Door {
  float x = 0.0F;
};
struct RoomOnTheBus {
  unsigned char number = 0;
  OnTheBus lamp = LAMP_OFF;
  Door door;
  std::vector<Door> windows;
  std::vector<int> locked;
  std::string label;
};

TEST(Namesakes, TakeValuesOfTheSameMeaning) {
  const auto there =
      translated<RoomOnTheBus>(Room{"hall", 7, Lamp::broken, {1.5}, {{2.0}, {3.0}}, false});
  EXPECT_EQ(there.number, 7);
  EXPECT_EQ(there.lamp, LAMP_BROKEN);
  EXPECT_EQ(there.door.x, 1.5F);
  ASSERT_EQ(there.windows.size(), 2U);
  EXPECT_EQ(there.windows[1].x, 3.0F);
  EXPECT_TRUE(there.label.empty() && there.locked.empty()) << "of another name, of another kind";
  Room back{"here", 1, Lamp::on, {0.0}, {{9.0}}, true};
  take(back, there);
  EXPECT_EQ(back.name, "here");
  EXPECT_TRUE(back.locked);
  EXPECT_EQ(back.number, 7);
  EXPECT_EQ(back.lamp, Lamp::broken);
  EXPECT_EQ(back.windows.size(), 2U) << "in the place of those that were there";
  RoomOnTheBus newer;
  newer.lamp = static_cast<OnTheBus>(9);
  take(back, newer);
  EXPECT_EQ(back.lamp, Lamp::broken) << "an unknown enumerator";
}

}  // namespace
}  // namespace saphira

#include "saphira/base/archive.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "trouble.hpp"

namespace saphira {
namespace {

enum class Mood { calm, cross = 3 };

struct Place {
  double x = 0.0;
  float y = 0.0F;
  bool operator==(const Place&) const = default;
};

struct State {
  bool truth = false;
  std::uint64_t most = 0;
  std::int8_t least = 0;
  Mood mood = Mood::calm;
  std::string text;
  std::optional<Place> there;
  std::vector<Place> ways;
  std::deque<std::pair<int, double>> turns;
  std::set<std::string> names;
  std::map<std::uint32_t, std::vector<int>> by_id;
  std::array<bool, 2> pair{};
  Saved part;

  bool operator==(const State&) const = default;
  void archive(Archive& a) {
    a.members(*this);
    a.expect(text != "bad", "a good state");
  }
};

State some() {
  State state;
  state.truth = true;
  state.most = std::numeric_limits<std::uint64_t>::max();
  state.least = -128;
  state.mood = Mood::cross;
  state.text = "\"a\"\n\t\\ \xc3\xa4;";
  state.there = Place{0.1, -0.0F};
  state.ways = {{1e300, 1e-30F}, {std::numeric_limits<double>::denorm_min(), 0.3F}, {3.0, 2.0F}};
  state.turns = {{-5, -std::numeric_limits<double>::infinity()}, {7, 1.0 / 3.0}};
  state.names = {"b", "", "a"};
  state.by_id = {{7, {1, 2}}, {4294967295U, {}}};
  state.pair = {false, true};
  state.part.text = saved(Place{0.1, 0.0F});
  return state;
}

TEST(Archive, AStateIsTheSameAfterItsText) {
  for (const State& state : {State{}, some()}) {
    const std::string text = saved(state);
    EXPECT_EQ(restored<State>(text), state) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
    State other = some();  // nothing of it stays
    restore(text, other);
    EXPECT_EQ(other, state);
  }
  EXPECT_TRUE(std::signbit(restored<double>(saved(-0.0))));
  EXPECT_TRUE(std::isnan(restored<double>(saved(std::nan("")))));
  EXPECT_EQ(restored<Place>(some().part.text), (Place{0.1, 0.0F}));
}

std::string error(const std::string& text) {
  State state;
  return test::trouble_of<std::runtime_error>([&] { restore(text, state); });
}

TEST(Archive, AnErrorNamesThePlaceAndTheExpectedValue) {
  const std::string good = saved(some());
  const auto with = [&](const std::string& part, const std::string& other) {
    std::string text = good;
    return error(text.replace(text.find(part), part.size(), other));
  };
  EXPECT_EQ(error(good), "");
  EXPECT_EQ(error("; a map\n"), "expected the state of this version as JSON, found ; a map\n");
  EXPECT_EQ(error("[]"), "expected a member \"truth\", found []");
  EXPECT_EQ(with("\"truth\":true", "\"truth\":1"), "truth: expected true or false, found 1");
  EXPECT_EQ(with("18446744073709551615", "-1"),
            "most: expected a whole number from 0 to 18446744073709551615, found -1");
  EXPECT_EQ(with("-128", "-129"), "least: expected a whole number from -128 to 127, found -129");
  EXPECT_EQ(with("-128", "128"), "least: expected a whole number from -128 to 127, found 128");
  EXPECT_EQ(with("\"cross\"", "\"angry\""), "mood: expected one of calm, cross, found \"angry\"");
  EXPECT_EQ(with("\"cross\"", "3"), "mood: expected a text, found 3");
  EXPECT_EQ(with("[false,true]", "[true]"), "pair: expected a list of 2, found [true]");
  EXPECT_EQ(with("\"y\":2.0", "\"y\":\"x\""), "ways[2].y: expected a number, found \"x\"");
  EXPECT_EQ(with("\"ways\":[", "\"ways\":{},\"was\":["), "ways: expected a list, found {}");
  EXPECT_EQ(with("\"truth\"", "\"more\":1,\"truth\"").substr(0, 20), "expected 12 members,");
  EXPECT_EQ(with("\"text\":", "\"text\":\"bad\",\"was\":").substr(0, 21), "expected a good state");
}

TEST(Archive, NoDamageOfATextIsMoreThanAnError) {
  const std::string good = saved(some());
  for (std::size_t i = 0; i < good.size(); ++i) {
    error(good.substr(0, i));
    for (int bit = 0; bit < 8; ++bit) {
      std::string text = good;
      text[i] = static_cast<char>(text[i] ^ (1 << bit));
      error(text);
    }
  }
}

struct More {
  std::array<std::array<std::int16_t, 2>, 3> cells{};
  std::variant<std::monostate, bool, Place> either;
  std::tuple<int, bool, double> three{};
  std::shared_ptr<const Place> shared;
  std::vector<bool> bits;

  void archive(Archive& a) {
    a.bytes("cells", cells);
    a("either", either)("three", three)("shared", shared)("bits", bits);
  }
};

TEST(Archive, KindsSharedValuesBitsAndBytesAreTheSameAfterTheirText) {
  More more;
  more.cells = {{{1, -2}, {300, -32768}, {0, 5}}};
  more.either = Place{2.0, 0.5F};
  more.three = {-3, true, 0.25};
  more.shared = std::make_shared<const Place>(Place{4.0, 1.5F});
  more.bits = {true, false, true};
  const More same = restored<More>(saved(more));
  EXPECT_EQ(same.cells, more.cells);
  EXPECT_TRUE(same.either == more.either);
  EXPECT_TRUE(same.three == more.three);
  ASSERT_TRUE(same.shared);
  EXPECT_EQ(*same.shared, *more.shared);
  EXPECT_EQ(same.bits, more.bits);
  EXPECT_FALSE(restored<More>(saved(More{})).shared);
  EXPECT_THROW(restored<More>(R"({"cells":"AAAA"})"), std::runtime_error);
}

}  // namespace
}  // namespace saphira

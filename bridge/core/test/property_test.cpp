// Random plays: events in any order, at any time. The rules are in play.hpp.
#include <gtest/gtest.h>

#include "play.hpp"
#include "saphira/base/random.hpp"

namespace saphira::bridge::test {
namespace {

protocol::Bytes script(std::uint64_t seed) {
  Random random(seed);
  protocol::Bytes bytes(2000);
  for (std::uint8_t& byte : bytes)
    byte = static_cast<std::uint8_t>(random.next());
  return bytes;
}

TEST(Plays, GoOnTheSameWithRestoredCores) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    EXPECT_EQ(play(script(seed), 20), play(script(seed))) << "seed " << seed;
}

TEST(Plays, KeepEveryRule) {
  Played all;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Played played = play(script(seed));
    ASSERT_EQ(played.wrong, "") << "seed " << seed;
    all.sessions += played.sessions;
    all.cycles += played.cycles;
    all.motions += played.motions;
    all.stops += played.stops;
    all.resets += played.resets;
    all.stopped += played.stopped;
    all.steps += played.steps;
    all.silences += played.silences;
    all.gaps += played.gaps;
  }
  // Otherwise the rules had no test.
  EXPECT_GT(all.sessions, 1000);
  EXPECT_GT(all.cycles, 10000);
  EXPECT_GT(all.motions, 2000);
  EXPECT_GT(all.stops, 1000);
  EXPECT_GT(all.resets, 300);
  EXPECT_GT(all.stopped, 1000);
  EXPECT_GT(all.steps, 500);
  EXPECT_GT(all.silences, 300);
  EXPECT_GT(all.gaps, 300);
}

}  // namespace
}  // namespace saphira::bridge::test

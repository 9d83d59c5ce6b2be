// Participants that want to be let in, by a clock that the test moves.
#include "entrance.hpp"

#include <gtest/gtest.h>

namespace saphira::bus::internal {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Fate = Entrance::Fate;

class EntranceTest : public testing::Test {
 protected:
  static Entrance::Prefix program(std::uint32_t number) {
    Entrance::Prefix prefix{};
    for (unsigned i = 0; i < 4; ++i)
      prefix[i] = static_cast<std::uint8_t>(number >> 8U * i);
    return prefix;
  }
  Fate announce(std::uint32_t number) {
    return entrance_.announced(program(number), "10.0.0.7", now_);
  }
  /// It is announced, and Fast DDS begins a handshake with it.
  void wait_at_the_door(std::uint32_t number) {
    announce(number);
    now_ += Entrance::kTwice;
    ASSERT_EQ(announce(number), Fate::waits) << number;
    entrance_.found(program(number));
  }
  void crowd() {
    for (std::uint32_t i = 0; i < Entrance::kCrowd; ++i)
      wait_at_the_door(kStranger + i);
  }

  static constexpr std::uint32_t kStranger = 1000000;
  Entrance entrance_{1};
  Entrance::Time now_{seconds(1000)};
};

TEST_F(EntranceTest, AMemberWaitsAndIsLetIn) {
  EXPECT_EQ(entrance_.shakes_hands(program(1), now_), Fate::drops);
  EXPECT_EQ(announce(1), Fate::waits);
  EXPECT_EQ(entrance_.shakes_hands(program(1), now_), Fate::waits);
  EXPECT_FALSE(entrance_.is_in(program(1)));
  entrance_.found(program(1));
  entrance_.let_in(program(1));
  EXPECT_TRUE(entrance_.is_in(program(1)));
  now_ += seconds(1000);
  EXPECT_EQ(announce(1), Fate::passes);
  EXPECT_EQ(entrance_.shakes_hands(program(1), now_), Fate::passes);
  EXPECT_EQ(entrance_.sends(program(1), now_), Fate::passes);
  entrance_.forget(program(1), now_);
  EXPECT_FALSE(entrance_.is_in(program(1)));
}

TEST_F(EntranceTest, InPeaceAHandshakeMayTakeLong) {
  wait_at_the_door(1);
  now_ += Entrance::kPatienceInPeace - seconds(1);
  EXPECT_EQ(announce(1), Fate::waits);
  now_ += seconds(1);
  EXPECT_EQ(announce(1), Fate::drops);
  EXPECT_EQ(entrance_.sends(program(1), now_), Fate::drops);
  entrance_.forget(program(1), now_);  // by its lease
  EXPECT_EQ(announce(1), Fate::waits);
}

TEST_F(EntranceTest, InACrowdOneWaitsShortly) {
  crowd();
  wait_at_the_door(1);
  now_ += Entrance::kPatience;
  EXPECT_EQ(announce(1), Fate::waits);
  now_ += milliseconds(1);
  EXPECT_EQ(announce(1), Fate::drops);
  EXPECT_EQ(entrance_.shakes_hands(program(1), now_), Fate::drops);
}

TEST_F(EntranceTest, InACrowdOneIsHeardTwice) {
  crowd();
  EXPECT_EQ(announce(1), Fate::drops);
  now_ += Entrance::kTwice - milliseconds(1);
  EXPECT_EQ(announce(1), Fate::drops);
  now_ += milliseconds(1);
  EXPECT_EQ(announce(1), Fate::waits);
  EXPECT_EQ(announce(2), Fate::drops);
  now_ += Entrance::kTwiceAtMost + milliseconds(1);
  EXPECT_EQ(announce(2), Fate::drops);
  now_ += Entrance::kTwice;
  EXPECT_EQ(announce(2), Fate::waits);
}

TEST_F(EntranceTest, OnesHeardOnceTakeNoPlace) {
  for (std::uint32_t i = 0; i < 10000; ++i) {
    announce(kStranger + i);
    now_ += milliseconds(1);
  }
  announce(1);
  now_ += Entrance::kTwice;
  EXPECT_EQ(announce(1), Fate::waits);
}

TEST_F(EntranceTest, SoManyWaitAndNoMore) {
  for (std::uint32_t i = 0; i < Entrance::kMost; ++i)
    wait_at_the_door(kStranger + i);
  const auto asks = [&] {
    announce(1);
    now_ += Entrance::kTwice;
    return announce(1);
  };
  EXPECT_EQ(asks(), Fate::drops);
  entrance_.forget(program(kStranger), now_);
  EXPECT_EQ(asks(), Fate::waits);
  // Those that were let in do not count.
  EXPECT_EQ(announce(2), Fate::drops);
  entrance_.let_in(program(1));
  now_ += Entrance::kTwice;
  EXPECT_EQ(announce(2), Fate::waits);
}

TEST_F(EntranceTest, ThoseThatFastDdsNeverFoundGiveWay) {
  for (std::uint32_t i = 0; i < Entrance::kMost; ++i) {
    announce(kStranger + i);
    now_ += Entrance::kTwice;
    announce(kStranger + i);
  }
  announce(1);
  now_ += Entrance::kPatience;
  EXPECT_EQ(announce(1), Fate::waits);
}

TEST_F(EntranceTest, WhoIsRefusedComesAgainLater) {
  wait_at_the_door(1);
  entrance_.refuse(program(1));
  EXPECT_EQ(announce(1), Fate::drops);
  EXPECT_EQ(entrance_.sends(program(1), now_), Fate::drops);
  entrance_.forget(program(1), now_);  // by its lease
  now_ += Entrance::kRefusal - milliseconds(1);
  EXPECT_EQ(announce(1), Fate::drops);
  now_ += milliseconds(1);
  EXPECT_EQ(announce(1), Fate::waits);
}

TEST_F(EntranceTest, OneThatIsFoundAgainBeforeItsEndIsToldStaysIn) {
  wait_at_the_door(1);
  entrance_.let_in(program(1));
  entrance_.found(program(1));
  entrance_.forget(program(1), now_);
  EXPECT_TRUE(entrance_.is_in(program(1)));
  entrance_.forget(program(1), now_);
  EXPECT_FALSE(entrance_.is_in(program(1)));
}

TEST(Entrance, StrangersWithoutASealKeepNobodyOutWhoHasIt) {
  Entrance entrance(1, Entrance::Seal::preferred);
  Entrance::Time now{seconds(1000)};
  const auto program = [](std::uint8_t number) { return Entrance::Prefix{number}; };
  // Some hundred prefixes again and again, for a minute, of which Fast DDS forgets none in time.
  std::size_t waiting = 0;
  for (int round = 0; round < 200; ++round) {
    for (std::uint8_t stranger = 0; stranger < 200; ++stranger)
      if (entrance.announced(program(stranger), "", now) == Fate::waits && round < 4)
        entrance.found(program(stranger));
    now += milliseconds(300);
  }
  for (std::uint8_t stranger = 0; stranger < 200; ++stranger)
    waiting += entrance.shakes_hands(program(stranger), now) == Fate::drops ? 0U : 1U;
  EXPECT_LE(waiting, Entrance::kMostUnsealed);
  for (std::uint8_t member = 200; member < 220; ++member) {
    EXPECT_EQ(entrance.announced(program(member), "", now, Entrance::Sealed{}), Fate::waits);
    entrance.found(program(member));
  }
  now += Entrance::kPatience + seconds(1);
  EXPECT_EQ(entrance.shakes_hands(program(200), now), Fate::waits) << "it has time";
  entrance.let_in(program(200));
  EXPECT_EQ(entrance.announced(program(200), "", now, Entrance::Sealed{}), Fate::passes);
  EXPECT_EQ(entrance.announced(program(200), "", now), Fate::drops) << "forged in its name";
}

TEST(Entrance, WhatOthersHaveSealedIsNotRepeatedForLong) {
  Entrance entrance(1, Entrance::Seal::preferred);
  const Entrance::Time now{seconds(1000)};
  const auto announced = [&](std::uint8_t number, std::chrono::seconds age) {
    return entrance.announced({number}, "", now, Entrance::Sealed{seconds(0), age});
  };
  for (std::uint8_t i = 0; i < Entrance::kRepeated; ++i)
    EXPECT_EQ(announced(i, seconds(100000)), Fate::waits) << "clocks may be wrong";
  EXPECT_EQ(announced(50, Entrance::kFresh + seconds(1)), Fate::drops);
  EXPECT_EQ(announced(50, -Entrance::kFresh - seconds(1)), Fate::drops);
  EXPECT_EQ(announced(50, seconds(1)), Fate::waits);
  for (std::uint8_t i = 0; i < Entrance::kRepeated; ++i)
    entrance.let_in({i});
  EXPECT_EQ(announced(51, seconds(100000)), Fate::waits);
}

TEST(Entrance, WhereTheSealIsRequiredNothingElsePasses) {
  Entrance entrance(1, Entrance::Seal::required);
  const Entrance::Time now{seconds(1000)};
  EXPECT_EQ(entrance.announced({1}, "", now), Fate::drops);
  EXPECT_EQ(entrance.sends({1}, now), Fate::drops);
  EXPECT_EQ(entrance.announced({1}, "", now, Entrance::Sealed{}), Fate::waits);
  EXPECT_EQ(entrance.sends({1}, now), Fate::waits);
}

TEST_F(EntranceTest, StrangersAreCountedAndNamed) {
  crowd();
  for (std::uint64_t i = 0; i + 1 < Entrance::kStranger; ++i)
    announce(1000 + static_cast<std::uint32_t>(i));
  EXPECT_EQ(entrance_.strangers(now_), "");
  EXPECT_TRUE(entrance_.take_new_strangers().empty());
  now_ += seconds(5);
  announce(1);
  now_ += seconds(2);
  EXPECT_EQ(entrance_.strangers(now_),
            "strangers are kept out: 10.0.0.7 (100 packets in 5 s, the last 2 s ago)");
  EXPECT_EQ(entrance_.take_new_strangers().size(), 1U);
  EXPECT_TRUE(entrance_.take_new_strangers().empty());
  now_ += Entrance::kSilence;
  EXPECT_EQ(entrance_.strangers(now_), "");
}

TEST_F(EntranceTest, OnlySomeAddressesAreNamed) {
  for (std::uint32_t address = 0; address < 1000; ++address)
    for (std::uint64_t i = 0; i < Entrance::kStranger; ++i)
      entrance_.drop(std::to_string(address), now_);
  EXPECT_EQ(entrance_.take_new_strangers().size(), Entrance::kMostAddresses + 1);
}

// Of one packet, since no member sends it.
TEST_F(EntranceTest, WhoIsProvedAStrangerIsNamedForEachProofOnce) {
  for (const char* const proof : {"they do this", "they do that", "they do this"})
    EXPECT_EQ(entrance_.drop("10.0.0.7", now_, proof), Fate::drops);
  const std::vector<std::string> named = entrance_.take_new_strangers();
  ASSERT_EQ(named.size(), 2U);
  EXPECT_NE(named[0].find("10.0.0.7"), std::string::npos);
  EXPECT_NE(named[0].find("they do that"), std::string::npos);
  EXPECT_NE(named[1].find("they do this"), std::string::npos);
  EXPECT_EQ(entrance_.strangers(now_),
            "strangers are kept out: 10.0.0.7 (3 packets in 0 s, the last 0 s ago)");
  for (std::uint64_t i = 0; i < 1000; ++i)
    entrance_.drop("10.0.0.7", now_, std::to_string(i));
  EXPECT_EQ(entrance_.take_new_strangers().size(), Entrance::kMostProofs - 2);
}

TEST_F(EntranceTest, WhoRepeatsAnEarlierAnnouncementIsAStranger) {
  const auto announced = [&](int time) {
    return entrance_.announced(program(1), "10.0.0.7", now_,
                               Entrance::Sealed{seconds(time), seconds(0)});
  };
  EXPECT_EQ(announced(1000), Fate::waits);
  entrance_.let_in(program(1));
  EXPECT_EQ(announced(1010), Fate::passes);
  EXPECT_EQ(announced(1008), Fate::passes) << "swapped in the network";
  EXPECT_TRUE(entrance_.take_new_strangers().empty());
  EXPECT_EQ(announced(1007), Fate::drops);
  EXPECT_EQ(announced(1011), Fate::passes);
  EXPECT_EQ(entrance_.take_new_strangers().size(), 1U);
}

TEST_F(EntranceTest, WhereOneComesFromIsKnown) {
  wait_at_the_door(1);
  EXPECT_EQ(entrance_.address_of(program(1)), "10.0.0.7");
  EXPECT_EQ(entrance_.address_of(program(2)), "");
}

TEST_F(EntranceTest, TheProgramHearsItself) {
  entrance_.let_in(program(7));
  EXPECT_EQ(announce(7), Fate::passes);
}

}  // namespace
}  // namespace saphira::bus::internal

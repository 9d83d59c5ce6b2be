// Participants that want to be let in: the cases of entrance.txt, and what is too many for a text.
#include "entrance.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <sstream>

#include "lines.hpp"

namespace saphira::bus::internal {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Fate = Entrance::Fate;

/// One case.
class Door : public saphira::test::LinePlayer {
 public:
  Door() : entrance_(std::in_place, 1) {
    events_ = {
        ON("seal", entrance_.emplace(1, seal(rest(in)))),
        ON("announce", expect(in, entrance_->announced(who(in), kAddress, now_))),
        {"sealed",
         [this](auto& in) {
           const Entrance::Prefix prefix = who(in);
           const seconds time{read<int>(in)};
           const Entrance::Sealed sealed{time, seconds(read<int>(in))};
           expect(in, entrance_->announced(prefix, kAddress, now_, sealed));
         }},
        ON("shake", expect(in, entrance_->shakes_hands(who(in), now_))),
        ON("send", expect(in, entrance_->sends(who(in), now_))),
        {"door",
         [this](auto& in) {
           const Entrance::Prefix prefix = who(in);
           entrance_->announced(prefix, kAddress, now_);
           now_ += Entrance::kTwice;
           ASSERT_EQ(entrance_->announced(prefix, kAddress, now_), Fate::waits);
           entrance_->found(prefix);
         }},
        ON("found", entrance_->found(who(in))),
        ON("let-in", entrance_->let_in(who(in))),
        ON("refuse", entrance_->refuse(who(in))),
        ON("forget", entrance_->forget(who(in), now_)),
        ON("after", after(in)),
    };
    facts_ = {IS("in", std::string(entrance_->is_in(program(1)) ? "1" : "")),
              IS("from 1", entrance_->address_of(program(1))),
              IS("from 2", entrance_->address_of(program(2))),
              IS("strangers", entrance_->strangers(now_)),
              IS("named", std::to_string(entrance_->take_new_strangers().size()))};
  }

 private:
  static Entrance::Seal seal(const std::string& word) {
    return word == "required" ? Entrance::Seal::required : Entrance::Seal::preferred;
  }
  static Entrance::Prefix program(std::uint32_t number) {
    Entrance::Prefix prefix{};
    for (unsigned i = 0; i < 4; ++i)
      prefix[i] = static_cast<std::uint8_t>(number >> 8U * i);
    return prefix;
  }
  Entrance::Prefix who(std::istringstream& in) {
    const auto word = read<std::string>(in);
    if (word == "next")
      ++stranger_;
    return program(word == "next" || word == "same" ? stranger_
                                                    : static_cast<std::uint32_t>(std::stoul(word)));
  }
  static void expect(std::istringstream& in, Fate fate) {
    const std::string expected = rest(in);
    const std::string is = fate == Fate::passes  ? "passes"
                           : fate == Fate::waits ? "waits"
                                                 : "drops";
    EXPECT_TRUE(expected.empty() || expected == is) << in.str() << ", but it " << is;
  }
  void after(std::istringstream& in) {
    const std::map<std::string, milliseconds> known{
        {"twice", Entrance::kTwice},       {"twice-at-most", Entrance::kTwiceAtMost},
        {"patience", Entrance::kPatience}, {"patience-in-peace", Entrance::kPatienceInPeace},
        {"refusal", Entrance::kRefusal},   {"silence", Entrance::kSilence}};
    for (std::string word; in >> word;) {
      const auto found = known.find(word);
      now_ += found == known.end() ? milliseconds(std::stoi(word)) : found->second;
    }
  }

  static constexpr const char* kAddress = "10.0.0.7";
  std::optional<Entrance> entrance_;
  Entrance::Time now_{seconds(1000)};
  std::uint32_t stranger_ = 999999;
};

TEST(Entrance, LetsInAsWritten) {
  EXPECT_EQ(saphira::test::play<Door>("idl/bus/test/entrance.txt"), 15);
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

TEST(Entrance, OnlySomeAddressesAreNamed) {
  Entrance entrance(1);
  for (std::uint32_t address = 0; address < 1000; ++address)
    for (std::uint64_t i = 0; i < Entrance::kStranger; ++i)
      entrance.drop(std::to_string(address), Entrance::Time{seconds(1000)});
  EXPECT_EQ(entrance.take_new_strangers().size(), Entrance::kMostAddresses + 1);
}

// Of one packet, since no member sends it.
TEST(Entrance, OneThatIsProvedAStrangerIsNamedForEachProofOnce) {
  Entrance entrance(1);
  const Entrance::Time now{seconds(1000)};
  for (const char* const proof : {"they do this", "they do that", "they do this"})
    EXPECT_EQ(entrance.drop("10.0.0.7", now, proof), Fate::drops);
  const std::vector<std::string> named = entrance.take_new_strangers();
  ASSERT_EQ(named.size(), 2U);
  EXPECT_NE(named[0].find("10.0.0.7"), std::string::npos);
  EXPECT_NE(named[0].find("they do that"), std::string::npos);
  EXPECT_NE(named[1].find("they do this"), std::string::npos);
  EXPECT_EQ(entrance.strangers(now),
            "strangers are kept out: 10.0.0.7 (3 packets in 0 s, the last 0 s ago)");
  for (std::uint64_t i = 0; i < 1000; ++i)
    entrance.drop("10.0.0.7", now, std::to_string(i));
  EXPECT_EQ(entrance.take_new_strangers().size(), Entrance::kMostProofs - 2);
}

}  // namespace
}  // namespace saphira::bus::internal

#include "saphira/base/guess.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

const std::vector<std::string> kCommands{"demo", "goal", "estop", "status", "behaviors"};

TEST(Guess, FindsWhatWasMeant) {
  EXPECT_EQ(guess("gaol", kCommands), "goal") << "two letters swapped";
  EXPECT_EQ(guess("dmo", kCommands), "demo") << "one left out";
  EXPECT_EQ(guess("estopp", kCommands), "estop") << "one too many";
  EXPECT_EQ(guess("behaviours", kCommands), "behaviors");
  EXPECT_EQ(guess("stat", kCommands), "status") << "the beginning";
  EXPECT_EQ(guess("radiusrobt", {"RadiusRobot"}), "RadiusRobot") << "whatever the case";
  EXPECT_EQ(did_you_mean("gaol", kCommands, "; help lists them"), ": did you mean goal?");
}

TEST(Guess, MarksAreLeftOut) {
  EXPECT_EQ(guess("jose", {"karen", "jos\u00e9"}), "jos\u00e9");
  EXPECT_EQ(guess("buro sud", {"B\u00fcro S\u00fcd"}), "B\u00fcro S\u00fcd");
  EXPECT_EQ(guess("BU\u0308RO SUD", {"B\u00fcro S\u00fcd"}), "B\u00fcro S\u00fcd");
  EXPECT_EQ(guess("\xFFgoal", kCommands), "goal") << "not UTF-8";
}

TEST(Guess, IsSilentWhereNothingIsNear) {
  EXPECT_EQ(guess("fly", kCommands), "");
  EXPECT_EQ(guess("", kCommands), "");
  EXPECT_EQ(guess("x", kCommands), "");
  EXPECT_EQ(guess(std::string(100'000, 'g'), kCommands), "");
  EXPECT_EQ(guess("goal", {}), "");
  EXPECT_EQ(did_you_mean("fly", kCommands), "");
  EXPECT_EQ(did_you_mean("halt", {"goal", "estop"}), ": did you mean estop?");
  EXPECT_EQ(did_you_mean("hand-back", {"drive"}), ": did you mean drive hand-back?");
  EXPECT_EQ(did_you_mean("off", {"reset"}), ": did you mean reset?");
  EXPECT_EQ(did_you_mean("off", {"goal"}), "");
  EXPECT_EQ(did_you_mean("fly", kCommands, "; help lists them"), "; help lists them");
}

TEST(Guess, TheLongestKnownBeginningOfALongerName) {
  const std::vector<std::string> robots{"p3dx", "p3dx-sh", "p3at"};
  EXPECT_EQ(guess("p3dx-sh-lms1xx", robots), "p3dx-sh");
  EXPECT_EQ(guess("P3AT_laser_and_gripper", robots), "p3at");
  EXPECT_EQ(guess("p3atlaserandgripper", robots), "");
}

}  // namespace
}  // namespace saphira

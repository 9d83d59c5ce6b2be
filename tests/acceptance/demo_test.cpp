// The demo as a user runs it: the robot arrives without a contact, and in lockstep every run of a
// seed is the same to the last bit, in one process or in many.
#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>

#include "process.hpp"

namespace saphira::test {
namespace {

struct Driven : Outcome {
  nlohmann::json summary;
};

Driven demo(const std::vector<std::string>& options) {
  std::vector<std::string> words{"demo", "--headless", "--json"};
  words.insert(words.end(), options.begin(), options.end());
  Driven driven{saphira(words, {}, std::chrono::minutes(4)), {}};
  std::string text = driven.text;
  while (text.ends_with('\n'))
    text.pop_back();
  driven.summary =
      nlohmann::json::parse(text.substr(text.rfind('\n') + 1), nullptr, /*allow_exceptions=*/false);
  return driven;
}

class LockstepDemo : public testing::TestWithParam<int> {};

TEST_P(LockstepDemo, ArrivesUntouchedAndIsTheSameInOneProcessAndInMany) {
  const std::vector<std::string> seed{"--lockstep", "--seed", std::to_string(GetParam())};
  std::vector<std::string> single = seed;
  single.emplace_back("--single-process");
  const Driven first = demo(single);
  ASSERT_EQ(first.code, 0) << first.text;
  EXPECT_TRUE(first.summary.at("arrived").get<bool>());
  EXPECT_EQ(first.summary.at("contacts"), 0);
  EXPECT_GT(first.summary.at("min_clearance_m"), 0.0);
  EXPECT_GT(first.summary.at("path_m"), 5.0);
  // A few seeds are enough for what does not depend on them.
  if (GetParam() > 3)
    return;
  const Driven again = demo(seed);
  ASSERT_EQ(again.code, 0) << again.text;
  EXPECT_EQ(again.summary.at("trajectory_hash"), first.summary.at("trajectory_hash"))
      << again.text << first.text;
  EXPECT_EQ(again.summary.at("cycles"), first.summary.at("cycles"));
}

INSTANTIATE_TEST_SUITE_P(TenSeeds, LockstepDemo, testing::Range(1, 11));

// A robot of 55 mm, whose infrared sensors see 60 mm.
class LockstepKhepera : public testing::TestWithParam<int> {};

TEST_P(LockstepKhepera, ArrivesUntouched) {
  const Driven driven = demo({"--base", "khepera", "--lockstep", "--single-process", "--seed",
                              std::to_string(GetParam())});
  EXPECT_EQ(driven.code, 0) << driven.text;
  EXPECT_EQ(driven.summary.at("contacts"), 0);
  EXPECT_GT(driven.summary.at("min_clearance_m"), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Seeds, LockstepKhepera, testing::Values(2, 3, 6));

// Bodies that are wider than the shins, in the corridor, beside and behind doors.
class LockstepPeople : public testing::TestWithParam<int> {};

TEST_P(LockstepPeople, ArrivesPastPeopleWhoStandInItsWayAndTouchesNone) {
  const std::vector<std::string> people{"--people",         "standing", "--lockstep",
                                        "--single-process", "--seed",   std::to_string(GetParam())};
  const Driven driven = demo(people);
  EXPECT_EQ(driven.code, 0) << driven.text;
  EXPECT_EQ(driven.summary.at("contacts"), 0) << driven.text;
  // Into the room in which somebody stands beside the door. Without a map it does not always find
  // the door behind the cupboard.
  std::vector<std::string> into_the_room = people;
  into_the_room.insert(into_the_room.end(), {"--goal", "9.6", "2.6"});
  EXPECT_EQ(demo(into_the_room).summary.at("contacts"), 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, LockstepPeople, testing::Values(1, 2, 3, 4));

TEST(Demo, SeedsDiffer) {
  const auto begins = [](const char* seed) {
    return demo({"--lockstep", "--single-process", "--seed", seed, "--time-limit", "3"})
        .summary.at("trajectory_hash");
  };
  EXPECT_NE(begins("1"), begins("2"));
}

/// A folder of credentials for all programs of the demo.
std::string credentials(const TempDir& folder) {
  const std::string authority = folder.path("authority");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"init", "office"},
        {"add", "demo", "--role", "bridge,services,robot,operator"}}) {
    std::vector<std::string> all{"security"};
    all.insert(all.end(), words.begin(), words.end());
    all.insert(all.end(), {"--authority", authority});
    const Outcome made = saphira(all);
    EXPECT_EQ(made.code, 0) << made.text;
  }
  return authority + "/members/demo";
}

// Security on the bus does not change the robot's trajectory.
TEST(SecuredDemo, IsTheSameAsTheOpenOne) {
  const TempDir folder;
  const std::string security = credentials(folder);
  const std::vector<std::string> open{"--lockstep", "--seed", "1"};
  std::vector<std::string> secured = open;
  secured.insert(secured.end(), {"--security", security});
  const Driven first = demo(secured);
  ASSERT_EQ(first.code, 0) << first.text;
  EXPECT_TRUE(first.summary.at("arrived").get<bool>());
  const std::string hash = demo(open).summary.at("trajectory_hash");
  EXPECT_EQ(first.summary.at("trajectory_hash"), hash) << first.text;
  secured.emplace_back("--single-process");
  EXPECT_EQ(demo(secured).summary.at("trajectory_hash"), hash);
}

TEST(SecuredDemo, LiveArrivesUntouched) {
  const TempDir folder;
  const Driven live = demo({"--seed", "1", "--goal", "3", "0", "--security", credentials(folder)});
  ASSERT_EQ(live.code, 0) << live.text;
  EXPECT_TRUE(live.summary.at("arrived").get<bool>());
  EXPECT_EQ(live.summary.at("contacts"), 0);
}

TEST(SecuredDemo, WithoutCredentialsNothingBegins) {
  const Driven none = demo({"--security", "/nowhere"});
  EXPECT_EQ(none.code, 2) << none.text;
  EXPECT_NE(none.text.find("/nowhere: there is no such folder of credentials"), std::string::npos)
      << none.text;
}

TEST(Demo, OutOfTimeIsAFailureThatSaysSo) {
  const Driven late = demo({"--lockstep", "--time-limit", "3"});
  EXPECT_EQ(late.code, 1) << late.text;
  EXPECT_FALSE(late.summary.at("arrived").get<bool>());
}

// A newcomer's first experiment: a second terminal.
TEST(Demo, CommandsWithoutABusFindIt) {
  const TempDir folder;
  const std::map<std::string, std::string> plain{{"SAPHIRA_DOMAIN", ""},
                                                 {"SAPHIRA_RUN", folder.path()}};
  const auto status = [&] { return saphira({"status"}, plain).text; };
  {
    Process demo({"saphira", "demo", "--headless"}, folder.path("demo"), plain);
    const std::string first = "of the demo that runs here (--robot demo-";
    EXPECT_TRUE(wait_until([&] {
      const std::string text = status();
      return text.find(first) != std::string::npos && text.find("bridge") != std::string::npos;
    })) << demo.output();
    demo.signal(SIGKILL);
  }
  EXPECT_EQ(status().find("of the demo"), std::string::npos) << "it was killed";
}

}  // namespace
}  // namespace saphira::test

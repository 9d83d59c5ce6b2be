#include "saphira/watch/roll.hpp"

#include <gtest/gtest.h>

namespace saphira::watch {
namespace {

using Names = std::vector<std::string>;

bus::ProgramEntry announcer(std::uint8_t number, const std::string& robot,
                            const std::string& program = "bridge") {
  return {.id = {number}, .name = program, .robot = robot};
}

bus::WriterId writer_of(std::uint8_t number) {
  bus::WriterId id{number};
  id.back() = 9;
  return id;
}

TEST(Roll, IsCompleteAfterAQuietTime) {
  Roll roll(1.0);
  EXPECT_FALSE(roll.complete(100.0));
  std::vector<bus::ProgramEntry> all{announcer(1, "ant")};
  roll.update(all, {}, 100.0);
  EXPECT_FALSE(roll.complete(100.9));
  // Any new program: where one is found, others may be on their way.
  all.push_back(announcer(2, "bee", "behaviors"));
  roll.update(all, {}, 100.9);
  EXPECT_FALSE(roll.complete(101.8));
  EXPECT_TRUE(roll.complete(101.9));
  all.pop_back();  // one that ends hides no other
  roll.update(all, {}, 101.9);
  EXPECT_TRUE(roll.complete(101.9));
  all.push_back(announcer(3, "cat"));
  roll.update(all, {}, 102.0);
  EXPECT_FALSE(roll.complete(102.0));
  for (double now = 102.0; now < 110.0; now += 0.5) {
    all.back().id[1]++;
    roll.update(all, {}, now);
  }
  EXPECT_FALSE(roll.complete(109.9));
  EXPECT_TRUE(roll.complete(110.0));
}

TEST(Roll, NamesTheRobotsThatAreMissing) {
  Roll roll(1.0);
  roll.update({announcer(1, "bee"), announcer(2, "ant"), announcer(3, "ant", "behaviors")}, {},
              0.0);
  EXPECT_EQ(roll.robots(), (Names{"ant", "bee"}));
  EXPECT_EQ(roll.without({writer_of(1)}), Names{"ant"});
  EXPECT_EQ(roll.without({writer_of(1), writer_of(2)}), Names{});
  EXPECT_EQ(roll.count(), 2U);
}

TEST(Roll, MissesARobotWhoseBridgeIsNotFound) {
  Roll roll(1.0);
  std::vector<bus::ProgramEntry> all{announcer(1, "ant"), announcer(2, "bee", "behaviors")};
  roll.update(all, {}, 0.0);
  EXPECT_EQ(roll.without({writer_of(1)}), Names{"bee"});
  EXPECT_EQ(roll.count(), 2U);
  all.push_back(announcer(3, "bee"));
  roll.update(all, {}, 0.1);
  EXPECT_EQ(roll.without({writer_of(1), writer_of(3)}), Names{});
  EXPECT_EQ(roll.count(), 2U);
}

TEST(Roll, HasBridgesThatAreHeardAlone) {
  Roll roll(1.0);
  roll.update({announcer(1, "ant", "")}, {writer_of(1), writer_of(7)}, 0.0);
  EXPECT_EQ(roll.robots(), (Names{"a robot without a name", "ant"}));
  roll.update({}, {}, 0.1);
  EXPECT_EQ(roll.count(), 0U);
}

}  // namespace
}  // namespace saphira::watch

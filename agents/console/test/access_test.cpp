#include "saphira/console/access.hpp"

#include <gtest/gtest.h>

namespace saphira::console {
namespace {

const AccessSettings kSettings{"0123456789abcdef", {"robot", "robot.local"}};

TEST(Access, OwnNamesAndAddressesMayConnect) {
  for (const char* host : {"localhost:8642", "127.0.0.1:8642", "[::1]:8642", "192.168.1.7:8642",
                           "robot:8642", "robot.local", "localhost"})
    EXPECT_EQ(refusal(kSettings, {host, "", true}), "") << host;
}

TEST(Access, AForeignNameThatLeadsHereIsRefused) {
  EXPECT_NE(refusal(kSettings, {"evil.example:8642", "http://evil.example:8642", true}), "");
  EXPECT_NE(refusal(kSettings, {"localhost.evil.example", "", true}), "");
  EXPECT_NE(refusal(kSettings, {"", "", true}), "");
  EXPECT_NE(refusal(kSettings, {"[evil]:1", "", true}), "");
}

TEST(Access, APageOfSomebodyElseIsRefused) {
  EXPECT_EQ(refusal(kSettings, {"localhost:8642", "http://localhost:8642", true}), "");
  EXPECT_EQ(refusal(kSettings, {"localhost:8642", "https://localhost:8642", true}), "");
  for (const char* origin : {"http://evil.example", "http://localhost:8080", "null",
                             "http://localhost:8642.evil.example", "file://"})
    EXPECT_NE(refusal(kSettings, {"localhost:8642", origin, true}), "") << origin;
}

TEST(Access, WatchingFromThisMachineNeedsNoKey) {
  EXPECT_TRUE(may_watch(kSettings, {"localhost", "", true}, ""));
  EXPECT_FALSE(may_watch(kSettings, {"robot", "", false}, ""));
  EXPECT_TRUE(may_watch(kSettings, {"robot", "", false}, kSettings.key));
}

TEST(Access, OnlyTheWholeKeyIsRight) {
  EXPECT_TRUE(right_key(kSettings, "0123456789abcdef"));
  for (const char* key : {"", "0", "0123456789abcdeF", "0123456789abcde", "0123456789abcdef0"})
    EXPECT_FALSE(right_key(kSettings, key)) << key;
  EXPECT_FALSE(right_key(AccessSettings{}, ""));
}

}  // namespace
}  // namespace saphira::console

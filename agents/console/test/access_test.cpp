#include "saphira/console/access.hpp"

#include <gtest/gtest.h>

namespace saphira::console {
namespace {

using security::DoorRight;

constexpr std::int64_t kNow = 1'800'000'000;
const AccessSettings kSettings{"0123456789abcdef", {"robot", "Robot.local."}, 8642, false};

TEST(Access, OwnNamesAndAddressesMayConnect) {
  for (const char* host :
       {"localhost:8642", "127.0.0.1:8642", "[::1]:8642", "192.168.1.7:8642", "robot:8642",
        "robot.local", "localhost", "LOCALHOST:8642", "Robot.Local.:8642", "localhost."})
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

TEST(Access, TheNameOfAProxyMayBeAnOrigin) {
  for (const char* host : {"127.0.0.1:8642", "robot", "localhost", "192.168.1.7"})
    for (const char* origin : {"https://robot", "http://ROBOT:8080", "https://robot.local:8443"})
      EXPECT_EQ(refusal(kSettings, {host, origin, true}), "") << host << " " << origin;
  // Without the port of the proxy's address.
  EXPECT_EQ(refusal(kSettings, {"192.168.1.7", "https://192.168.1.7:8443", true}), "");
  EXPECT_NE(refusal(kSettings, {"192.168.1.7:8642", "https://192.168.1.7:8443", true}), "");
}

TEST(Access, ARefusalNamesTheRemedyAndNothingOfAPage) {
  const auto ends = [](const std::string& text, const char* end) { return text.ends_with(end); };
  EXPECT_TRUE(
      ends(refusal(kSettings, {"Proxy.example.:80", "", true}), "--host-name proxy.example"));
  EXPECT_TRUE(ends(refusal(kSettings, {"robot", "https://proxy.example:8443", true}),
                   "--host-name proxy.example"));
  EXPECT_EQ(refusal(kSettings, {"<b>&", "", true}).find_first_of("<>&"), std::string::npos);
}

TEST(Access, WatchingFromThisMachineNeedsNoKey) {
  for (const char* host : {"localhost:8642", "LocalHost.:8642", "127.0.0.1:8642", "[::1]:8642"})
    EXPECT_TRUE(may_watch(kSettings, {host, "", true})) << host;
  EXPECT_TRUE(may_watch(kSettings, {"localhost:8642", "http://localhost:8642", true}));
  EXPECT_FALSE(may_watch(kSettings, {"localhost:8642", "", false}));
  AccessSettings always = kSettings;
  always.always = true;
  EXPECT_FALSE(may_watch(always, {"localhost:8642", "", true}));
  AccessSettings usual = kSettings;
  usual.port = 80;
  EXPECT_TRUE(may_watch(usual, {"localhost", "http://localhost", true}));
}

TEST(Access, AHostOrAnOriginOfAProxyNeedsTheKey) {
  for (const char* host : {"robot:8642", "robot", "localhost", "localhost:8080", "192.168.1.7:8642",
                           "[::2]:8642", "127.0.0.1", ""})
    EXPECT_FALSE(may_watch(kSettings, {host, "", true})) << host;
  EXPECT_FALSE(may_watch(kSettings, {"127.0.0.1:8642", "https://robot", true}));
}

TEST(Access, OnlyTheWholeKeyIsRight) {
  EXPECT_TRUE(visitor_of(kSettings, {}, "0123456789abcdef", kNow).may(DoorRight::operate));
  for (const char* key : {"", "0", "0123456789abcdeF", "0123456789abcde", "0123456789abcdef0"})
    EXPECT_FALSE(visitor_of(kSettings, {}, key, kNow).may(DoorRight::watch)) << key;
  EXPECT_FALSE(visitor_of({}, {}, "", kNow).may(DoorRight::watch));
}

TEST(Access, AVisitorWithoutAKeyIsToldApartFromThePersonWhoseNameItTakes) {
  security::DoorKeys keys;
  const Visitor wanda =
      visitor_of(kSettings, keys, keys.add("wanda", DoorRight::watch, 30, kNow), kNow);
  const Visitor operates = visitor_of(kSettings, keys, kSettings.key, kNow);
  const Visitor keyless = visitor_of(kSettings, keys, "", kNow);
  EXPECT_EQ(name_of(wanda, "karen"), "wanda");
  EXPECT_EQ(name_of(operates, "wanda"), "wanda");
  EXPECT_EQ(name_of(operates, "karen (operator), karen"), "karen operator karen");
  EXPECT_EQ(name_of(operates, ""), "");
  EXPECT_EQ(name_of(keyless, "wanda"), "a visitor without a key (wanda)");
  EXPECT_EQ(name_of(keyless, "x) karen (operator)"), "a visitor without a key (x karen operator)");
  EXPECT_EQ(name_of(keyless, "()"), "a visitor without a key");
}

TEST(Access, APersonsKeyHasItsRightsWhileItHolds) {
  security::DoorKeys keys;
  const std::string anna = keys.add("anna", DoorRight::drive, 30, kNow);
  const Visitor visitor = visitor_of(kSettings, keys, anna, kNow);
  EXPECT_TRUE(visitor.may(DoorRight::watch));
  EXPECT_TRUE(visitor.may(DoorRight::drive));
  EXPECT_FALSE(visitor.may(DoorRight::operate));
  ASSERT_TRUE(visitor.person);
  EXPECT_EQ(visitor.person->name, "anna");
  EXPECT_FALSE(visitor_of(kSettings, keys, kSettings.key, kNow).person) << "it is of nobody";
  EXPECT_FALSE(visitor_of(kSettings, keys, anna, visitor.person->until).may(DoorRight::watch));
  keys.revoke("anna");
  EXPECT_FALSE(visitor_of(kSettings, keys, anna, kNow).may(DoorRight::watch));
}

}  // namespace
}  // namespace saphira::console

#include "saphira/relay/rendezvous.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "trouble.hpp"

namespace saphira::relay {
namespace {

constexpr const char* kToken = "0123456789abcdef0123";

std::string why(const std::string& text) {
  return test::trouble_of<std::invalid_argument>([&] { parse_robots("robots", text); });
}

TEST(Relay, ReadsItsRobots) {
  const auto robots = parse_robots("robots", "# ours\npioneer 8641 " + std::string(kToken) +
                                                 "\n\nflakey\t8642 " + kToken + "  # in the lab\n");
  ASSERT_EQ(robots.size(), 2U);
  EXPECT_EQ(robots[0].name, "pioneer");
  EXPECT_EQ(robots[1].port, 8642);
  EXPECT_EQ(robots[1].token, kToken);
  const std::string line = std::string("pioneer 8641 ") + kToken + "\n";
  EXPECT_EQ(why("pioneer 8641"), "robots:1: expected NAME PORT TOKEN");
  EXPECT_NE(why(line + "pio/neer 1 " + kToken).find("robots:2: a name"), std::string::npos);
  EXPECT_NE(why("pioneer 70000 " + std::string(kToken)).find("found 70000"), std::string::npos);
  EXPECT_NE(why("pioneer 8641 secret").find("at least 16"), std::string::npos);
  EXPECT_NE(why(line + "other 8641 " + kToken).find("already"), std::string::npos);
  EXPECT_NE(why(line + "pioneer 8642 " + kToken).find("already"), std::string::npos);
  EXPECT_NE(why("# nothing").find("a line for each robot"), std::string::npos);
}

TEST(Relay, ReadsWhereAGatewayDials) {
  const Address usual = parse_address("wss://relay.example/pioneer");
  EXPECT_TRUE(usual.encrypted);
  EXPECT_EQ(usual.host, "relay.example");
  EXPECT_EQ(usual.port, 443);
  EXPECT_EQ(usual.robot, "pioneer");
  EXPECT_EQ(parse_address("wss://10.0.0.1:8640/p-1").port, 8640);
  EXPECT_FALSE(parse_address("ws://localhost:8640/p").encrypted);
  for (const char* text :
       {"", "https://relay.example/p", "wss://relay.example", "wss://relay.example/", "wss:///p",
        "wss://relay.example:x/p", "wss://relay.example:0/p", "wss://relay.example/p/q",
        "ws://relay.example/p", "wss://relay example/p"})
    EXPECT_THROW(parse_address(text), std::invalid_argument) << text;
}

TEST(Relay, KnowsAGatewayByRobotAndToken) {
  const Rendezvous relay({{"pioneer", 1, kToken}, {"flakey", 2, "fedcba9876543210"}});
  EXPECT_TRUE(relay.knows("pioneer", kToken));
  EXPECT_TRUE(relay.knows("flakey", "fedcba9876543210"));
  EXPECT_FALSE(relay.knows("flakey", kToken));
  EXPECT_FALSE(relay.knows("pioneer", ""));
  EXPECT_FALSE(relay.knows("pioneer", std::string(kToken) + "x"));
  EXPECT_FALSE(relay.knows("nobody", kToken));
}

TEST(Relay, AVisitorIsFetchedOnceAndByTheirRobotAlone) {
  Rendezvous relay({{"pioneer", 1, kToken}, {"flakey", 2, kToken}});
  EXPECT_FALSE(relay.arrive("pioneer", "here", 7, "t7", 0.0));
  EXPECT_FALSE(relay.fetch("flakey", "t7"));
  EXPECT_FALSE(relay.fetch("pioneer", "t8"));
  EXPECT_EQ(relay.fetch("pioneer", "t7"), Rendezvous::Visitor{7});
  EXPECT_FALSE(relay.fetch("pioneer", "t7"));
  // A fetched visitor does not wait any more.
  EXPECT_TRUE(relay.expire(100.0).empty());
  relay.leave(7);
}

TEST(Relay, AVisitorWhomNobodyFetchesLeaves) {
  Rendezvous relay({{"pioneer", 1, kToken}});
  relay.arrive("pioneer", "here", 1, "a", 0.0);
  relay.arrive("pioneer", "here", 2, "b", 5.0);
  EXPECT_TRUE(relay.expire(10.0).empty());
  EXPECT_EQ(relay.expire(10.1), std::vector<Rendezvous::Visitor>{1});
  EXPECT_FALSE(relay.fetch("pioneer", "a"));
  EXPECT_TRUE(relay.fetch("pioneer", "b"));
}

class CrowdedRelay : public testing::Test {
 protected:
  using Visitor = Rendezvous::Visitor;

  std::optional<Visitor> arrive(const std::string& from, Visitor visitor, double now,
                                const std::string& robot = "pioneer") {
    const auto gone = relay_.arrive(robot, from, visitor, std::to_string(visitor), now);
    EXPECT_EQ(relay_.fetch(robot, std::to_string(visitor)), visitor);
    return gone;
  }

  Rendezvous relay_{{{"pioneer", 1, kToken}, {"flakey", 2, kToken}}};
};

TEST_F(CrowdedRelay, ThreePersonsBehindOneRouterFitAndOneMoreTakesThePlaceOfWhatIsSilent) {
  // A page that drives with the camera, and two that watch with it.
  constexpr Visitor kThreePages = 10 + 5 + 5;
  Visitor last = 0;
  while (last < kThreePages)
    EXPECT_FALSE(arrive("router", ++last, 0.0));
  while (last < Rendezvous::kMostFromOne)
    EXPECT_FALSE(arrive("router", ++last, 0.0));
  EXPECT_FALSE(arrive("elsewhere", 100, 0.0)) << "older, and of another address";
  for (Visitor each = 1; each <= last; ++each)
    relay_.heard(each, each == 7 ? 1.0 : 2.0);
  EXPECT_EQ(arrive("router", 101, 3.0), 7U);
  EXPECT_EQ(arrive("router", 102, 3.0), 1U) << "of those that spoke last at once, the eldest";
  EXPECT_FALSE(arrive("router", 103, 3.0, "flakey")) << "each robot has places of its own";
  relay_.leave(2);
  EXPECT_FALSE(arrive("router", 104, 3.0));
}

TEST_F(CrowdedRelay, AtAFullRobotTheAddressWithTheMostGivesPlace) {
  Visitor last = 0;
  EXPECT_FALSE(arrive("home", ++last, 0.0)) << "silent for longest";
  for (const char* const crowd : {"one", "two"})
    for (std::size_t i = 0; i < Rendezvous::kMostFromOne; ++i)
      EXPECT_FALSE(arrive(crowd, ++last, 1.0));
  while (last < Rendezvous::kMost)
    EXPECT_FALSE(arrive("home", ++last, 2.0));
  EXPECT_EQ(arrive("phone", 100, 3.0), 2U);
  EXPECT_EQ(arrive("home", 101, 3.0), 2U + Rendezvous::kMostFromOne);
}

TEST(Relay, AGatewayComesByTwoPaths) {
  EXPECT_EQ(parse_path("/dial/pioneer")->robot, "pioneer");
  EXPECT_EQ(parse_path("/dial/pioneer")->ticket, "");
  EXPECT_EQ(parse_path("/carry/pioneer/0a1b")->robot, "pioneer");
  EXPECT_EQ(parse_path("/carry/pioneer/0a1b")->ticket, "0a1b");
  for (const char* const text : {"", "/", "/dial", "/dial/", "/dial/a/b", "/carry/pioneer",
                                 "/carry/pioneer/", "/carry//t", "/carry/a/b/c", "/other/a"})
    EXPECT_FALSE(parse_path(text)) << text;
}

}  // namespace
}  // namespace saphira::relay

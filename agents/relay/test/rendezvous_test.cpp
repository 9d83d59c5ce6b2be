#include "saphira/relay/rendezvous.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

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
  EXPECT_TRUE(relay.arrive("pioneer", "here", 7, "t7", 0.0));
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

TEST(Relay, ACrowdAtOneRobotKeepsNobodyFromAnother) {
  Rendezvous relay({{"pioneer", 1, kToken}, {"flakey", 2, kToken}});
  for (Rendezvous::Visitor i = 0; i < Rendezvous::kMost; ++i)
    EXPECT_TRUE(relay.arrive("pioneer", std::to_string(i % 8), i, std::to_string(i), 0.0));
  EXPECT_FALSE(relay.arrive("pioneer", "here", 1000, "x", 0.0));
  EXPECT_TRUE(relay.arrive("flakey", "here", 1001, "y", 0.0));
  relay.leave(3);
  EXPECT_TRUE(relay.arrive("pioneer", "here", 1002, "z", 0.0));
}

TEST(Relay, OneAddressCannotTakeAllPlaces) {
  Rendezvous relay({{"pioneer", 1, kToken}, {"flakey", 2, kToken}});
  for (Rendezvous::Visitor i = 0; i < Rendezvous::kMostFromOne; ++i)
    EXPECT_TRUE(relay.arrive("pioneer", "10.0.0.1", i, std::to_string(i), 0.0));
  EXPECT_FALSE(relay.arrive("pioneer", "10.0.0.1", 1000, "x", 0.0));
  EXPECT_TRUE(relay.arrive("pioneer", "10.0.0.2", 1001, "y", 0.0));
  EXPECT_TRUE(relay.arrive("flakey", "10.0.0.1", 1002, "z", 0.0));
  relay.leave(3);
  EXPECT_TRUE(relay.arrive("pioneer", "10.0.0.1", 1003, "x", 0.0));
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

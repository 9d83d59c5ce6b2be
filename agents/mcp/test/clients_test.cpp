#include "saphira/mcp/clients.hpp"

#include <gtest/gtest.h>

namespace saphira::mcp {
namespace {

/// One client, since 100 s, whose goal is underway.
struct McpClients : testing::Test {
  McpClients() { clients.begin("a", "desk", 100.0); }
  void see(double now, int connections, double heard, bool streams = false) {
    state = {.connections = connections, .heard = heard, .streams = streams, .busy = state.busy};
    clients.see("a", state, now);
  }
  Clients clients;
  Clients::State state{.busy = true};
};

TEST_F(McpClients, TheGoalsOfAClientEndWithItsLastConnection) {
  see(200.0, 2, 199.1);
  see(200.1, 1, 199.1);
  see(200.2, 0, 0.0);
  EXPECT_FALSE(clients.loses_goals("a", 201.6)) << "it may connect again after a second";
  EXPECT_TRUE(clients.loses_goals("a", 201.8)) << "so that the robot stands within 3 s";
  EXPECT_FALSE(clients.is_gone("a", 201.8)) << "it may come back, and hear of that";
}

TEST_F(McpClients, AClientThatAsksItsPersonIsSilentMeanwhile) {
  see(200.0, 0, 0.0);
  state.silent = true;
  clients.see("a", state, 300.0);
  EXPECT_FALSE(clients.loses_goals("a", 300.0));
  EXPECT_FALSE(clients.is_gone("a", 300.0));
  see(301.6, 0, 0.0);
  EXPECT_TRUE(clients.loses_goals("a", 301.6)) << "approved elsewhere, and nobody is there";
}

// No end of the connection comes over a broken network.
TEST_F(McpClients, AConnectionWhoseOtherSideAcknowledgesNothingDoesNotCount) {
  see(200.0, 1, 199.2);
  see(200.6, 1, 199.2);
  EXPECT_FALSE(clients.loses_goals("a", 200.6));
  see(200.7, 1, 199.2);
  EXPECT_TRUE(clients.loses_goals("a", 200.7));
}

TEST_F(McpClients, AClientBetweenItsConnectionsLivesByItsMessages) {
  for (double now = 100.0; now < 110.0; now += 1.4) {
    clients.came("a", false, now);
    see(now, 1, now);
    see(now + 1.3, 0, 0.0);
    EXPECT_FALSE(clients.loses_goals("a", now + 1.3));
  }
}

TEST_F(McpClients, GoalsEndOnceForEachAbsence) {
  see(102.0, 0, 0.0);
  EXPECT_TRUE(clients.loses_goals("a", 102.0));
  EXPECT_FALSE(clients.loses_goals("a", 102.1)) << "their end is not heard yet";
  state.busy = false;
  see(103.0, 0, 0.0);
  state.busy = true;  // a call was held back
  see(103.1, 0, 0.0);
  EXPECT_TRUE(clients.loses_goals("a", 103.1));
  clients.came("a", false, 104.0);
  see(105.5, 0, 0.0);
  EXPECT_TRUE(clients.loses_goals("a", 105.5));
}

TEST_F(McpClients, AClientWithoutAGoalIsForgottenAfterHalfAMinute) {
  state.busy = false;
  see(129.9, 0, 0.0);
  EXPECT_FALSE(clients.loses_goals("a", 129.9));
  EXPECT_FALSE(clients.is_gone("a", 129.9));
  EXPECT_TRUE(clients.is_gone("a", 130.0));
  see(130.0, 1, 129.5);
  EXPECT_FALSE(clients.is_gone("a", 159.4));
  EXPECT_TRUE(clients.is_gone("a", 159.5));
}

// A tunnel keeps its connections when the network behind it is gone.
TEST_F(McpClients, AClientThatAnswersPingsIsThereAsLongAsItDoes) {
  see(100.0, 1, 100.0, true);
  EXPECT_TRUE(clients.is_pinged("a", 100.0));
  EXPECT_FALSE(clients.is_pinged("a", 100.4));
  EXPECT_TRUE(clients.is_pinged("a", 100.5));
  see(150.0, 1, 150.0, true);
  EXPECT_FALSE(clients.loses_goals("a", 150.0)) << "it never answers, and its connection is there";
  clients.came("a", false, 150.0);
  clients.answered("a");
  see(151.4, 1, 151.4, true);
  EXPECT_FALSE(clients.loses_goals("a", 151.4));
  see(151.5, 1, 151.5, true);
  EXPECT_TRUE(clients.loses_goals("a", 151.5));
  clients.came("a", false, 152.0);
  see(153.5, 1, 153.5, false);
  EXPECT_FALSE(clients.loses_goals("a", 153.5)) << "no ping reaches it";
}

// Nothing tells a proxy either that the network behind it is gone.
TEST_F(McpClients, BehindAProxyAClientIsThereByItsMessagesAlone) {
  clients.came("a", true, 100.0);
  for (double now = 100.0; now < 110.0; now += 1.4) {
    clients.came("a", true, now);
    see(now + 0.1, 2, now + 0.1, true);
    see(now + 1.3, 1, now + 1.3, true);
    EXPECT_FALSE(clients.loses_goals("a", now + 1.3));
  }
  clients.came("a", true, 110.0);
  see(111.4, 2, 111.4, true);
  EXPECT_FALSE(clients.loses_goals("a", 111.4));
  see(111.5, 1, 111.5, true);
  EXPECT_TRUE(clients.loses_goals("a", 111.5)) << "the end of an answer is no sign of it";
  EXPECT_TRUE(clients.is_hidden("a"));
  clients.came("a", false, 120.0);
  see(125.0, 1, 125.0);
  EXPECT_FALSE(clients.loses_goals("a", 125.0)) << "it has come without the proxy";
}

TEST_F(McpClients, BehindAProxyTheConnectionsOfAClientWithoutAGoalCount) {
  state.busy = false;
  clients.came("a", true, 100.0);
  see(150.0, 1, 150.0, true);
  EXPECT_FALSE(clients.is_gone("a", 150.0));
}

TEST_F(McpClients, WithoutAGoalNobodyIsPinged) {
  state.busy = false;
  see(100.0, 1, 100.0, true);
  EXPECT_FALSE(clients.is_pinged("a", 200.0));
}

/// As many clients as there are places: a, b ... in the order of their newest messages.
struct McpPlaces : testing::Test {
  McpPlaces() {
    double now = 100.0;
    for (char id = 'a'; ids.size() < Clients::kMost; ++id) {
      ids.emplace_back(1, id);
      EXPECT_EQ(clients.place(), "");
      clients.begin(ids.back(), "", now += 1.0);
    }
  }
  Clients clients;
  std::vector<std::string> ids;
};

TEST_F(McpPlaces, TheLongestSilentGivesItsPlace) {
  EXPECT_EQ(clients.place(), "a");
  clients.came("a", false, 200.0);
  EXPECT_EQ(clients.place(), "b");
  clients.see("b", {.connections = 1, .heard = 300.0, .streams = true}, 300.0);
  EXPECT_EQ(clients.place(), "b") << "an open stream says nothing";
  clients.see("b", {.busy = true}, 300.0);
  EXPECT_EQ(clients.place(), "c");
  for (const std::string& id : ids)
    clients.see(id, {.waits = id != "f", .busy = id == "b"}, 300.0);
  EXPECT_EQ(clients.place(), "f") << "the others wait for an answer";
  clients.end("f");
  EXPECT_EQ(clients.place(), "");
}

TEST_F(McpPlaces, OneClientHasNoGoalSoThatThereIsAlwaysAPlace) {
  for (std::size_t i = 0; i < Clients::kMostBusy; ++i) {
    EXPECT_TRUE(clients.may_begin(ids[i]));
    clients.see(ids[i], {.busy = true}, 200.0);
  }
  EXPECT_TRUE(clients.may_begin("a")) << "a second goal";
  EXPECT_FALSE(clients.may_begin(ids.back()));
  EXPECT_EQ(clients.place(), ids.back());
  clients.see(ids.back(), {.busy = true}, 200.0);
  EXPECT_EQ(clients.place(), std::nullopt);
}

TEST_F(McpPlaces, NobodyTakesNoPlaceAndBeginsNothing) {
  clients.end("a");
  clients.begin(Clients::kNobody, "", 50.0);
  EXPECT_EQ(clients.place(), "");
  clients.begin("z", "", 300.0);
  EXPECT_EQ(clients.place(), "b");
  EXPECT_FALSE(clients.may_begin(Clients::kNobody));
}

TEST(McpClientNames, TwoClientsOfOneNameAreTwo) {
  Clients clients;
  EXPECT_EQ(clients.begin("a", "desk", 0.0), "desk 1");
  EXPECT_EQ(clients.begin("b", "desk", 0.0), "desk 2");
  clients.end("a");
  EXPECT_EQ(clients.begin("c", "", 0.0), "3");
}

}  // namespace
}  // namespace saphira::mcp

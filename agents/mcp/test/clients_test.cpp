#include "saphira/mcp/clients.hpp"

#include <functional>
#include <map>
#include <sstream>

#include "lines.hpp"

namespace saphira::mcp {
namespace {

/// The client of clients.txt.
class Presence {
 public:
  Presence() { clients_.begin("a", "desk", 100.0); }
  void take(const std::string& line) {
    std::istringstream in(line);
    std::string verb;
    std::string more;
    std::string last;
    double now = 0.0;
    in >> verb;
    if (verb == "answered")
      return clients_.answered("a");
    if (verb == "busy" || verb == "silent") {
      in >> more;
      (verb == "busy" ? state_.busy : state_.silent) = more == "yes";
      return;
    }
    in >> now;
    if (verb == "see") {
      in >> state_.connections >> state_.heard >> more;
      state_.streams = more == "streams";
      return clients_.see("a", state_, now);
    }
    in >> more >> last;
    if (verb == "came")
      return clients_.came("a", more == "proxy", now);
    const std::map<std::string, std::function<bool()>> facts{
        {"loses", [&] { return clients_.loses_goals("a", now); }},
        {"gone", [&] { return clients_.is_gone("a", now); }},
        {"pinged", [&] { return clients_.is_pinged("a", now); }},
        {"hidden", [&] { return clients_.is_hidden("a"); }}};
    EXPECT_EQ(facts.at(verb)() ? "yes" : "no", last) << line;
  }

 private:
  Clients clients_;
  Clients::State state_{.busy = true};
};

TEST(McpClients, AreThereAsWritten) {
  EXPECT_EQ(saphira::test::play<Presence>("agents/mcp/test/clients.txt"), 10);
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

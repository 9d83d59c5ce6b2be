// The protocol line by line.
#include "saphira/mcp/session.hpp"

#include <gtest/gtest.h>

namespace saphira::mcp {
namespace {

Tool go_to() {
  return {
      "go_to", "goes to a point",
      Json::parse(R"({"type":"object","additionalProperties":false,"required":["x"],"properties":{
            "x":{"type":"number","minimum":-100,"maximum":100},
            "frame":{"type":"string","enum":["map","robot"]}}})")};
}

struct Client {
  Client() { session.set_tools({go_to()}); }
  /// The lines that a line is answered with.
  std::vector<Json> say(const std::string& line) {
    session.take(line);
    return heard();
  }
  std::vector<Json> heard() {
    std::vector<Json> all;
    for (const std::string& line : session.take_lines())
      all.push_back(Json::parse(line));
    return all;
  }
  Json one(const std::string& line) {
    const auto all = say(line);
    EXPECT_EQ(all.size(), 1U) << line;
    return all.empty() ? Json() : all.front();
  }
  Session session{"saphira", "1", "a robot"};
};

TEST(McpSession, BeginsWithTheRevisionOfTheClientWhereItIsKnown) {
  Client client;
  const Json known = client.one(
      R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":{"protocolVersion":"2025-03-26","capabilities":{}}})");
  EXPECT_EQ(known["result"]["protocolVersion"], "2025-03-26");
  EXPECT_EQ(known["result"]["serverInfo"]["name"], "saphira");
  EXPECT_EQ(
      client.one(
          R"({"jsonrpc":"2.0","id":"a","method":"initialize","params":{"protocolVersion":"1999-01-01"}})")
          ["result"]["protocolVersion"],
      "2025-11-25");
  EXPECT_TRUE(client.say(R"({"jsonrpc":"2.0","method":"notifications/initialized"})").empty());
  EXPECT_EQ(client.one(R"({"jsonrpc":"2.0","id":2,"method":"ping"})")["result"], Json::object());
}

TEST(McpSession, ListsItsToolsAndTellsWhenTheyChange) {
  Client client;
  client.say(R"({"jsonrpc":"2.0","id":1,"method":"initialize"})");
  const Json list = client.one(R"({"jsonrpc":"2.0","id":2,"method":"tools/list"})");
  ASSERT_EQ(list["result"]["tools"].size(), 1U);
  EXPECT_EQ(list["result"]["tools"][0]["name"], "go_to");
  EXPECT_EQ(list["result"]["tools"][0]["inputSchema"]["required"][0], "x");
  client.session.set_tools({go_to()});
  EXPECT_TRUE(client.heard().empty());
  client.session.set_tools({});
  EXPECT_EQ(client.heard().at(0)["method"], "notifications/tools/list_changed");
}

TEST(McpSession, ACallIsAnsweredLaterAndTellsOfItsProgress) {
  Client client;
  EXPECT_TRUE(
      client
          .say(
              R"({"jsonrpc":"2.0","id":7,"method":"tools/call","params":{"name":"go_to","arguments":{"x":1.5},"_meta":{"progressToken":"p"}}})")
          .empty());
  const auto calls = client.session.take_calls();
  ASSERT_EQ(calls.size(), 1U);
  EXPECT_EQ(calls[0].arguments["x"], 1.5);
  client.session.progress(calls[0].number, 0.5, "half");
  EXPECT_EQ(client.heard().at(0)["params"]["progressToken"], "p");
  client.session.answer(calls[0].number, {"there", {{"state", "succeeded"}}, false});
  const Json answer = client.heard().at(0);
  EXPECT_EQ(answer["id"], 7);
  EXPECT_EQ(answer["result"]["content"][0]["text"], "there");
  EXPECT_EQ(answer["result"]["structuredContent"]["state"], "succeeded");
  EXPECT_EQ(answer["result"]["isError"], false);
  client.session.answer(calls[0].number, {"again", nullptr, false});
  EXPECT_TRUE(client.heard().empty());
}

TEST(McpSession, ArgumentsThatDoNotFitAreNamedAndNotCalled) {
  for (const auto& [arguments, named] : std::vector<std::pair<std::string, std::string>>{
           {"{}", "\"x\" is missing"},
           {R"({"x":"far"})", "\"x\": expected number"},
           {R"({"x":1e12})", "from -100 up to 100"},
           {R"({"x":1,"frame":"moon"})", "expected one of"},
           {R"({"x":1,"speed":2})", "there is no argument \"speed\""},
           {R"([1])", "the arguments: expected object"}}) {
    Client client;
    const Json answer = client.one(
        R"({"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"go_to","arguments":)" +
        arguments + "}}");
    EXPECT_EQ(answer["result"]["isError"], true) << arguments;
    EXPECT_NE(answer["result"]["content"][0]["text"].get<std::string>().find(named),
              std::string::npos)
        << answer.dump();
    EXPECT_TRUE(client.session.take_calls().empty());
  }
}

TEST(McpSession, ACallThatIsGivenUpIsNotAnswered) {
  Client client;
  client.say(
      R"({"jsonrpc":"2.0","id":"c","method":"tools/call","params":{"name":"go_to","arguments":{"x":1}}})");
  const auto calls = client.session.take_calls();
  client.say(R"({"jsonrpc":"2.0","method":"notifications/cancelled","params":{"requestId":"c"}})");
  EXPECT_EQ(client.session.take_given_up(), std::vector<std::uint64_t>{calls.at(0).number});
  client.session.answer(calls[0].number, {"late", nullptr, false});
  EXPECT_TRUE(client.heard().empty());
}

TEST(McpSession, MistakesGetTheirCodeAndEndNothing) {
  Client client;
  EXPECT_EQ(client.one("{")["error"]["code"], -32700);
  EXPECT_EQ(client.one("[]")["error"]["code"], -32600);
  EXPECT_EQ(client.one(R"({"id":1})")["error"]["code"], -32600);
  EXPECT_EQ(client.one(R"({"id":{},"method":"ping"})")["error"]["code"], -32600);
  EXPECT_EQ(client.one(R"({"id":1,"method":"prompts/list"})")["error"]["code"], -32601);
  EXPECT_EQ(client.one(R"({"id":1,"method":"ping","params":3})")["error"]["code"], -32602);
  EXPECT_EQ(client.one(R"({"id":1,"method":"tools/call","params":{"name":"rm"}})")["error"]["code"],
            -32602);
  EXPECT_EQ(client.one(std::string(Session::kLongestLine + 1, 'x'))["error"]["code"], -32600);
  EXPECT_EQ(client.one(std::string(1000, '['))["error"]["code"], -32700);
  EXPECT_TRUE(client.say("").empty());
  EXPECT_TRUE(client.say(R"({"id":9,"result":{}})").empty());
  EXPECT_EQ(client.one(R"({"id":2,"method":"ping"})")["id"], 2);
}

}  // namespace
}  // namespace saphira::mcp

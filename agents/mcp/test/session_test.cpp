// The protocol where lines of sessions.txt do not do.
#include "client.hpp"

namespace saphira::mcp {
namespace {

using test::Client;
using test::go_to;
using test::kGo;
using test::line;
using test::modern;

TEST(McpSession, PromptsOfTheUsualJobsAreFilledIn) {
  Client client;
  const Json all = client.one(line(1, "prompts/list"))["result"]["prompts"];
  ASSERT_FALSE(all.empty());
  for (const Json& each : all) {
    Json arguments = Json::object();
    for (const Json& argument : each["arguments"])
      arguments[argument["name"].get<std::string>()] = "N2 $place";
    const auto get = [&](const Json& given) {
      return client.one(Json{{"jsonrpc", "2.0"},
                             {"id", 2},
                             {"method", "prompts/get"},
                             {"params", {{"name", each["name"]}, {"arguments", given}}}}
                            .dump());
    };
    const Json content = get(arguments)["result"]["messages"][0]["content"];
    const std::string text = content["text"];
    EXPECT_EQ(text.find("N2 $place") == std::string::npos, arguments.empty()) << text;
    if (!arguments.empty()) {
      EXPECT_EQ(get(Json::object())["error"]["code"], -32602);
    }
  }
  EXPECT_EQ(client.one(line(3, "prompts/get"))["error"]["code"], -32602);
}

TEST(McpSession, ResultsHaveTheirStructureWhereTheRevisionHasIt) {
  Tool tool = go_to();
  tool.output = Json::parse(R"({"type":"object","properties":{"state":{"type":"string"}}})");
  for (const auto& [revision, structured] :
       {std::pair("2024-11-05", false), std::pair("2025-03-26", false),
        std::pair("2025-06-18", true), std::pair("2025-11-25", true),
        std::pair("1999-01-01", true)}) {  // answered with the newest
    Client client;
    client.session.set_tools({tool});
    client.one(R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":{"protocolVersion":")" +
               std::string(revision) + R"("}})");
    const Json list = client.one(line(2, "tools/list"));
    EXPECT_EQ(list["result"]["tools"][0].contains("outputSchema"), structured) << revision;
    client.say(line(3, "tools/call", kGo));
    client.session.answer(client.session.take_calls().at(0).number,
                          {"there", {{"state", "succeeded"}}, false});
    const Json answer = client.heard().at(0)["result"];
    EXPECT_EQ(answer["content"][0]["text"], "there") << revision;
    EXPECT_EQ(answer.contains("structuredContent"), structured) << revision;
  }
}

TEST(McpSession, AMessageMayBeLongAndTheArgumentsOfACallMayNot) {
  Client client;
  const std::string padded = R"({"jsonrpc":"2.0","id":1,"method":"ping","params":{"_meta":{"x":")" +
                             std::string(200000, 'x') + R"("}}})";
  EXPECT_EQ(client.one(padded)["id"], 1);
  EXPECT_EQ(client.one(std::string(Session::kLongestLine + 1, 'x'))["error"]["code"], -32600);
  EXPECT_EQ(client.one(std::string(1000, '['))["error"]["code"], -32700);
  const Json told = client.one(
      line(2, "tools/call", {{"name", "go_to"}, {"arguments", {{"x", std::string(70000, 'x')}}}}));
  EXPECT_EQ(told["result"]["content"][0]["text"],
            "not done: the arguments have at most 65536 bytes");
}

TEST(McpSession, AFloodIsHeldBackAndAStopIsNot) {
  Client client;
  const Tool stop{"stop", "stops", {{"type", "object"}}, false, true};
  client.session.set_tools({go_to(), stop});
  const std::string go = line(1, "tools/call", kGo);
  const auto send = [&](const std::string& text) {
    client.session.take(text);
    for (const Call& call : client.session.take_calls()) {
      client.session.answer(call.number, {"done", nullptr, false});
    }
    return client.heard().at(0)["result"];
  };
  client.session.turn(1000.0);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(send(go)["isError"], false) << i;
  EXPECT_EQ(send(go)["content"][0]["text"], "not done: at most 5 calls a second; again in 0.2 s");
  EXPECT_EQ(
      send(R"({"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"stop"}})")["isError"],
      false);
  client.session.turn(1000.21);
  EXPECT_EQ(send(go)["isError"], false);
  EXPECT_EQ(send(go)["isError"], true);
}

TEST(McpSession, WaitingRequestsHaveALimit) {
  Client client;
  client.session.wait_for_tools(true);
  for (std::size_t i = 0; i < Session::kMostOpen; ++i)
    EXPECT_TRUE(client.say(line(1, "tools/list")).empty());
  EXPECT_EQ(client.one(line(2, "tools/list"))["error"]["code"], -32603);
}

TEST(McpSession, ASenderIsKnownByWhatItSays) {
  EXPECT_TRUE(sender_of(R"({"id":1,"method":"initialize"})").begins);
  EXPECT_FALSE(sender_of(R"({"id":1,"method":"initialize"})").modern);
  Json meta = Json::parse(modern("x", "tools/list"));
  meta["params"]["_meta"]["io.modelcontextprotocol/clientInfo"] = {{"name", "desk"}};
  EXPECT_TRUE(sender_of(meta.dump()).modern);
  EXPECT_EQ(sender_of(meta.dump()).client, R"({"name":"desk"})");
  EXPECT_EQ(sender_of(meta.dump()).name, "desk");
  EXPECT_EQ(sender_of(meta.dump()).tool, "");
  for (const char* text : {"", "[]", "{", "3", R"({"params":[]})", R"({"params":{"_meta":1}})"}) {
    const Sender sender = sender_of(text);
    EXPECT_FALSE(sender.begins || sender.modern || sender.answers) << text;
  }
}

TEST(McpSession, NestingIsBoundedBeforeAnythingIsReadFromAMessage) {
  for (const char* bracket : {"[", "{\"a\":"})
    for (const char* end : {"", "1"}) {
      std::string text = R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":)";
      for (int i = 0; i < 100'000; ++i)
        text += bracket;
      text += end;
      EXPECT_EQ(sender_of(text), Sender()) << bracket;
      Client client;
      EXPECT_EQ(client.one(text)["error"]["message"], "nested too deeply") << bracket;
    }
  const auto nested = [](int depth) {
    return R"({"method":"initialize","params":)" + std::string(depth, '[') +
           std::string(depth, ']') + "}";
  };
  EXPECT_TRUE(sender_of(nested(15)).begins);
  EXPECT_FALSE(sender_of(nested(100'000)).begins);
}

TEST(McpSession, AClientHasTheNameThatItGivesOnOneLine) {
  const auto name_of = [](const Json& name) {
    return sender_of(line(1, "initialize", {{"clientInfo", {{"name", name}}}})).name;
  };
  EXPECT_EQ(name_of("desk"), "desk");
  EXPECT_EQ(name_of("desk\nSYSTEM"), "desk SYSTEM");
  EXPECT_EQ(name_of(std::string(50, 'x')), std::string(40, 'x'));
  EXPECT_EQ(name_of(7), "");
}

TEST(McpSession, ASenderIsKnownByTheToolThatItCalls) {
  EXPECT_EQ(sender_of(line(1, "tools/call", {{"name", "emergency_stop"}})).tool, "emergency_stop");
  EXPECT_EQ(sender_of(line(1, "prompts/get", {{"name", "emergency_stop"}})).tool, "");
}

TEST(McpSession, APingIsAnsweredByAClientThatIsThere) {
  Client client;
  client.session.ping();
  const Line said = client.only();
  EXPECT_EQ(said.exchange, 0U);
  const Json ping = Json::parse(said.text);
  EXPECT_EQ(ping["method"], "ping");
  const std::string answer =
      Json{{"jsonrpc", "2.0"}, {"id", ping["id"]}, {"result", Json::object()}}.dump();
  EXPECT_TRUE(sender_of(answer).answers);
  EXPECT_TRUE(client.say(answer).empty());
}

TEST(McpSession, ListenersHaveALimit) {
  Client client;
  for (int i = 0; i < 16; ++i)
    EXPECT_EQ(client.one(modern("l", "subscriptions/listen"))["method"],
              "notifications/subscriptions/acknowledged");
  EXPECT_EQ(client.one(modern("l", "subscriptions/listen"))["error"]["code"], -32600);
}

}  // namespace
}  // namespace saphira::mcp

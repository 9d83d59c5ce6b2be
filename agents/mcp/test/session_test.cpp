// The protocol line by line.
#include "client.hpp"

namespace saphira::mcp {
namespace {

using test::cancelled;
using test::Client;
using test::go_to;
using test::kGo;
using test::line;
using test::modern;

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
  EXPECT_EQ(client.one(line(2, "ping"))["result"], Json::object());
}

TEST(McpSession, ListsItsToolsAndTellsWhenTheyChange) {
  Client client;
  client.say(line(1, "initialize"));
  const Json list = client.one(line(2, "tools/list"));
  ASSERT_EQ(list["result"]["tools"].size(), 1U);
  EXPECT_EQ(list["result"]["tools"][0]["name"], "go_to");
  EXPECT_EQ(list["result"]["tools"][0]["inputSchema"]["required"][0], "x");
  client.session.set_tools({go_to()});
  EXPECT_TRUE(client.heard().empty());
  client.session.set_tools({});
  EXPECT_EQ(client.heard().at(0)["method"], "notifications/tools/list_changed");
}

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

TEST(McpSession, ToolsThatAreApartAreListedAndCalledByOne) {
  Client client;
  Tool apart = go_to();
  apart.name = "back_off";
  apart.apart = true;
  client.session.set_tools(
      {go_to(),
       {.name = Session::kOthers,
        .description = "others",
        .input = Json::parse(R"({"type":"object","properties":{"name":{"type":"string"},
                                 "arguments":{"type":"object"}},"additionalProperties":false})")},
       apart});
  const Json list = client.one(line(2, "tools/list"));
  EXPECT_EQ(list["result"]["tools"].size(), 2U);
  const auto call = [&](const std::string& arguments) {
    return client.say(
        R"({"jsonrpc":"2.0","id":3,"method":"tools/call","params":{"name":"activity","arguments":)" +
        arguments + "}}");
  };
  const auto text = [](const std::vector<Json>& answers) {
    return answers.at(0)["result"]["content"][0]["text"].get<std::string>();
  };
  EXPECT_TRUE(text(call("{}")).starts_with("back_off: "));
  EXPECT_TRUE(client.session.take_calls().empty());
  EXPECT_TRUE(call(R"({"name":"back_off","arguments":{"x":1.5}})").empty());
  const auto calls = client.session.take_calls();
  ASSERT_EQ(calls.size(), 1U);
  EXPECT_EQ(calls[0].tool, "back_off");
  EXPECT_EQ(calls[0].arguments["x"], 1.5);
  for (const char* wrong : {R"({"name":"back_off","arguments":{"y":1}})", R"({"name":"go_to"})",
                            R"({"name":"activity"})", R"({"name":1})"})
    EXPECT_EQ(call(wrong).at(0)["result"]["isError"], true) << wrong;
}

TEST(McpSession, ACallIsAnsweredLaterAndTellsOfItsProgress) {
  Client client;
  EXPECT_TRUE(
      client
          .say(
              R"({"jsonrpc":"2.0","id":7,"method":"tools/call","params":{"name":"go_to","arguments":{"x":1.5},"_meta":{"progressToken":"p"}}})")
          .empty());
  const Call call = client.called();
  EXPECT_EQ(call.arguments["x"], 1.5);
  client.session.progress(call.number, 0.5, "half");
  EXPECT_EQ(client.heard().at(0)["params"]["progressToken"], "p");
  client.session.answer(call.number, {"there", {{"state", "succeeded"}}, false});
  const Json answer = client.heard().at(0);
  EXPECT_EQ(answer["id"], 7);
  EXPECT_EQ(answer["result"]["content"][0]["text"], "there");
  EXPECT_EQ(answer["result"]["structuredContent"]["state"], "succeeded");
  EXPECT_EQ(answer["result"]["isError"], false);
  client.session.answer(call.number, {"again", nullptr, false});
  EXPECT_TRUE(client.heard().empty());
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

TEST(McpSession, ArgumentsThatDoNotFitAreNamedAndNotCalled) {
  for (const auto& [arguments, named] : std::vector<std::pair<std::string, std::string>>{
           {"{}", "\"x\" is missing"},
           {R"({"x":"far"})", "\"x\": expected number"},
           {R"({"x":1e12})", "from -100 up to 100"},
           {R"({"x":1,"frame":"moon"})", "expected one of"},
           {R"({"x":1,"speed":2})", "there is no argument \"speed\" (known: frame, x)"},
           {R"({"x":1,"fram":2})", "(known: frame, x): did you mean frame?"},
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
  client.say(cancelled("c"));
  EXPECT_EQ(client.session.take_given_up(), std::vector<std::uint64_t>{calls.at(0).number});
  client.session.answer(calls[0].number, {"late", nullptr, false});
  EXPECT_TRUE(client.heard().empty());
}

TEST(McpSession, NumbersThatAreNotFiniteAreNamed) {
  for (const char* const number : {"NaN", "Infinity", "1e400"}) {
    Client client;
    const Json error = client.one(
        R"({"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"go_to","arguments":{"x":)" +
        std::string(number) + "}}}")["error"];
    EXPECT_EQ(error["code"], -32700) << number;
    EXPECT_NE(error["message"].get<std::string>().find("numbers must be finite"), std::string::npos)
        << error.dump();
  }
}

// A model has tools, and no commands.
TEST(McpSession, AdviceAboutCommandsBecomesAdviceAboutTools) {
  Client client;
  client.say(
      R"({"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"go_to","arguments":{"x":1},"_meta":{"progressToken":"p"}}})");
  const std::uint64_t call = client.session.take_calls().at(0).number;
  client.session.progress(call, 0.1,
                          "waits for the way to EJ-231, which came first; with a priority of 1 it "
                          "would go first");
  EXPECT_EQ(client.heard().at(0)["params"]["message"],
            "waits for the way to EJ-231, which came first");
  const std::string told = "the map has no place \"x\": it has a, b and 9 more (saphira map show)";
  client.session.answer(call, {told, {{"goals", {{{"reason", told}}}}}, true});
  const Json result = client.heard().at(0)["result"];
  const std::string words =
      "the map has no place \"x\": it has a, b and 9 more (the tool map lists them)";
  EXPECT_EQ(result["content"][0]["text"], words);
  EXPECT_EQ(result["structuredContent"]["goals"][0]["reason"], words);
}

TEST(McpSession, MistakesGetTheirCodeAndEndNothing) {
  Client client;
  EXPECT_EQ(client.one("{")["error"]["code"], -32700);
  EXPECT_EQ(client.one("[]")["error"]["code"], -32600);
  EXPECT_EQ(client.one(R"({"id":1})")["error"]["code"], -32600);
  EXPECT_EQ(client.one(R"({"id":{},"method":"ping"})")["error"]["code"], -32600);
  EXPECT_EQ(client.one(R"({"id":1,"method":"roots/list"})")["error"]["code"], -32601);
  EXPECT_EQ(client.one(R"({"id":1,"method":"ping","params":3})")["error"]["code"], -32602);
  EXPECT_EQ(client.one(R"({"id":1,"method":"tools/call","params":{"name":"rm"}})")["error"]["code"],
            -32602);
  EXPECT_EQ(client.one(std::string(Session::kLongestLine + 1, 'x'))["error"]["code"], -32600);
  EXPECT_EQ(client.one(std::string(1000, '['))["error"]["code"], -32700);
  EXPECT_TRUE(client.say("").empty());
  EXPECT_TRUE(client.say(R"({"id":9,"result":{}})").empty());
  EXPECT_EQ(client.one(R"({"id":2,"method":"ping"})")["id"], 2);
}

TEST(McpSession, ABatchIsAnsweredInOneMessageInTheRevisionThatHasThem) {
  Client client;
  const std::string batch =
      "[" + line(1, "ping") + "," + line(2, "tools/call", kGo) +
      R"(,{"jsonrpc":"2.0","method":"notifications/initialized"},{"id":9,"result":{}},3])";
  EXPECT_EQ(client.one(batch)["error"]["code"], -32600) << "no revision is agreed upon";
  client.say(line(0, "initialize", {{"protocolVersion", "2025-03-26"}}));
  EXPECT_TRUE(client.session.take(batch, 7));
  EXPECT_TRUE(client.session.take_lines().empty());
  client.session.answer(client.session.take_calls().at(0).number, {"there", nullptr, false});
  const Line said = client.only();
  EXPECT_EQ(said.exchange, 7U);
  EXPECT_TRUE(said.last);
  const Json answers = Json::parse(said.text);
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0]["id"], 1);
  EXPECT_EQ(answers[1]["error"]["code"], -32600);
  EXPECT_EQ(answers[2]["result"]["content"][0]["text"], "there");
  EXPECT_EQ(client.one("[]")["error"]["code"], -32600);
  EXPECT_FALSE(client.session.take(R"([{"jsonrpc":"2.0","method":"notifications/initialized"}])"));
  EXPECT_TRUE(client.heard().empty());
  client.say(line(3, "initialize", {{"protocolVersion", "2025-06-18"}}));
  EXPECT_EQ(client.one(batch)["error"]["code"], -32600);
}

TEST(McpSession, ABatchWaitsForNoCallThatWasGivenUp) {
  Client client;
  client.say(line(0, "initialize", {{"protocolVersion", "2025-03-26"}}));
  const Json& call = kGo;
  client.say("[" + line(1, "ping") + "," + line(2, "tools/call", call) + "]");
  const auto answers = client.say(cancelled(2));
  ASSERT_EQ(answers.size(), 1U);
  ASSERT_EQ(answers[0].size(), 1U);
  EXPECT_EQ(answers[0][0]["id"], 1);
}

TEST(McpSession, AnOptionalArgumentMayBeNull) {
  Client client;
  client.say(
      line(1, "tools/call", {{"name", "go_to"}, {"arguments", {{"x", 1}, {"frame", nullptr}}}}));
  const Call call = client.called();
  EXPECT_EQ(call.arguments, Json({{"x", 1}}));
  client.say(line(2, "tools/call", {{"name", "go_to"}, {"arguments", {{"x", nullptr}}}}));
  client.say(line(3, "tools/call", {{"name", "go_to"}, {"arguments", {{"x", 1}, {"y", nullptr}}}}));
  EXPECT_TRUE(client.session.take_calls().empty()) << "needed, and unknown";
}

TEST(McpSession, AMessageMayBeLongAndTheArgumentsOfACallMayNot) {
  Client client;
  const std::string padded = R"({"jsonrpc":"2.0","id":1,"method":"ping","params":{"_meta":{"x":")" +
                             std::string(200000, 'x') + R"("}}})";
  EXPECT_EQ(client.one(padded)["id"], 1);
  const Json told = client.one(
      line(2, "tools/call", {{"name", "go_to"}, {"arguments", {{"x", std::string(70000, 'x')}}}}));
  EXPECT_EQ(told["result"]["content"][0]["text"],
            "not done: the arguments have at most 65536 bytes");
}

TEST(McpSession, TheNewerEraNeedsNoBeginning) {
  Client client;
  const Json discovered = client.one(modern("d", "server/discover"))["result"];
  EXPECT_EQ(discovered["supportedVersions"], Json({Session::kModern}));
  EXPECT_EQ(discovered["resultType"], "complete");
  const Json list = client.one(modern("l", "tools/list"))["result"];
  EXPECT_EQ(list["tools"][0]["name"], "go_to");
  EXPECT_FALSE(list["tools"][0].contains("outputSchema")) << "none is declared";
  EXPECT_EQ(list["ttlMs"], 0);
  EXPECT_EQ(list["cacheScope"], "private");
  client.say(modern("c", "tools/call", kGo));
  client.session.answer(client.session.take_calls().at(0).number, {"there", nullptr, false});
  const Json answer = client.heard().at(0)["result"];
  EXPECT_EQ(answer["resultType"], "complete");
  EXPECT_EQ(answer["content"][0]["text"], "there");
  // The older era on the same stream is not affected.
  EXPECT_FALSE(client.one(line(2, "tools/list"))["result"].contains("resultType"));
}

TEST(McpSession, TheNewerEraRefusesByItsOwnCodes) {
  Client client;
  Json other = Json::parse(modern("v", "tools/list"));
  other["params"]["_meta"]["io.modelcontextprotocol/protocolVersion"] = "2099-01-01";
  const Json error = client.one(other.dump())["error"];
  EXPECT_EQ(error["code"], -32022);
  EXPECT_EQ(error["data"]["supported"], Json({Session::kModern}));
  EXPECT_EQ(error["data"]["requested"], "2099-01-01");
  other["params"]["_meta"].erase("io.modelcontextprotocol/clientCapabilities");
  other["params"]["_meta"]["io.modelcontextprotocol/protocolVersion"] = Session::kModern;
  EXPECT_EQ(client.one(other.dump())["error"]["code"], -32602);
  for (const char* method : {"initialize", "ping", "logging/setLevel", "roots/list"}) {
    client.session.take(modern("m", method), 7);
    const Line said = client.only();
    EXPECT_EQ(said.status, 404);
    EXPECT_EQ(Json::parse(said.text)["error"]["code"], -32601);
  }
}

TEST(McpSession, AListenerHearsThatTheToolsChange) {
  Client client;
  const Json first = client.one(
      modern("l1", "subscriptions/listen",
             {{"notifications", {{"toolsListChanged", true}, {"resourcesListChanged", true}}}}));
  EXPECT_EQ(first["method"], "notifications/subscriptions/acknowledged");
  EXPECT_EQ(first["params"]["notifications"], Json({{"toolsListChanged", true}}));
  client.session.set_tools({});
  const Json changed = client.heard().at(0);
  EXPECT_EQ(changed["method"], "notifications/tools/list_changed");
  EXPECT_EQ(changed["params"]["_meta"]["io.modelcontextprotocol/subscriptionId"], "l1");
  client.say(cancelled("l1"));
  client.session.set_tools({go_to()});
  EXPECT_TRUE(client.heard().empty());
}

TEST(McpSession, HeadersHaveToSayWhatTheMessageSays) {
  const std::string call = modern("c", "tools/call", kGo);
  struct Case {
    Headers headers;
    const char* names;  // empty: it fits
  };
  for (const auto& [headers, names] :
       {Case{{Session::kModern, "tools/call", "go_to"}, ""},
        Case{{"", "tools/call", "go_to"}, "MCP-Protocol-Version: missing"},
        Case{{"2025-11-25", "tools/call", "go_to"}, "MCP-Protocol-Version"},
        Case{{Session::kModern, "", "go_to"}, "Mcp-Method: missing"},
        Case{{Session::kModern, "tools/list", "go_to"}, "Mcp-Method"},
        Case{{Session::kModern, "tools/call", "stop"}, "Mcp-Name"}}) {
    Client client;
    client.session.take(call, 1, &headers);
    const auto lines = client.session.take_lines();
    if (std::string(names).empty()) {
      EXPECT_TRUE(lines.empty());
      EXPECT_EQ(client.session.take_calls().size(), 1U);
      continue;
    }
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].status, 400);
    EXPECT_EQ(Json::parse(lines[0].text)["error"]["code"], -32020);
    EXPECT_NE(lines[0].text.find(names), std::string::npos) << lines[0].text;
  }
  Client client;
  const Headers unknown{"1999-01-01", "", ""};
  client.session.take(line(1, "ping"), 1, &unknown);
  EXPECT_EQ(client.session.take_lines().at(0).status, 400);
}

TEST(McpSession, AConnectionThatClosesEndsTheCallsOfTheNewerEraAlone) {
  Client client;
  client.session.take(modern("a", "tools/call", kGo), 1);
  // Another client may have chosen the same id.
  client.session.take(modern("a", "tools/call", {{"name", "go_to"}, {"arguments", {{"x", 2}}}}), 2);
  client.session.take(
      R"({"jsonrpc":"2.0","id":"b","method":"tools/call","params":{"name":"go_to","arguments":{"x":3}}})",
      3);
  const auto calls = client.session.take_calls();
  ASSERT_EQ(calls.size(), 3U);
  client.session.close(1);
  client.session.close(3);
  EXPECT_EQ(client.session.take_given_up(), std::vector<std::uint64_t>{calls[0].number});
  client.session.answer(calls[1].number, {"there", nullptr, false});
  const Line said = client.only();
  EXPECT_EQ(said.exchange, 2U);
  EXPECT_TRUE(said.last);
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

Tool emergency_stop() {
  return {"stop", "stops", {{"type", "object"}}, false, true};
}

TEST(McpSession, ListsAndCallsWaitUntilTheToolsAreKnown) {
  Client client;
  client.session.set_tools({emergency_stop()});
  client.session.wait_for_tools(true);
  EXPECT_EQ(client.one(line(1, "initialize"))["id"], 1);
  EXPECT_EQ(client.one(line(2, "ping"))["id"], 2);
  EXPECT_EQ(client.one(modern("d", "server/discover"))["id"], "d");
  EXPECT_EQ(client.one(line(3, "roots/list"))["error"]["code"], -32601);
  EXPECT_TRUE(client.say(line(4, "tools/list")).empty());
  EXPECT_TRUE(client.say(modern("m", "tools/list")).empty());
  EXPECT_TRUE(client.say(line(5, "resources/list")).empty());
  EXPECT_TRUE(client.say(line(6, "tools/call", kGo)).empty());
  EXPECT_TRUE(client.session.take_calls().empty());

  // The client has no list yet, so it is not notified of a change.
  client.session.set_tools({go_to(), emergency_stop()});
  EXPECT_TRUE(client.heard().empty());
  client.session.wait_for_tools(false);
  const auto answers = client.heard();
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0]["id"], 4);
  EXPECT_EQ(answers[0]["result"]["tools"].size(), 2U);
  EXPECT_EQ(answers[1]["id"], "m");
  EXPECT_EQ(answers[1]["result"]["tools"].size(), 2U);
  EXPECT_EQ(answers[2]["id"], 5);
  const Call call = client.called();
  EXPECT_EQ(call.tool, "go_to");
  client.session.wait_for_tools(false);
  EXPECT_TRUE(client.heard().empty());
}

TEST(McpSession, AStopDoesNotWaitForTheTools) {
  Client client;
  client.session.set_tools({emergency_stop()});
  client.session.wait_for_tools(true);
  client.say(line(1, "tools/call", {{"name", "stop"}}));
  EXPECT_EQ(client.session.take_calls().size(), 1U);
}

TEST(McpSession, AWaitingRequestThatIsGivenUpIsNotAnswered) {
  Client client;
  client.session.wait_for_tools(true);
  client.say(line(1, "tools/list"));
  client.say(cancelled(1));
  client.session.take(modern("a", "tools/list"), 1);
  client.session.take(modern("a", "tools/list"), 2);
  client.session.close(1);
  client.session.wait_for_tools(false);
  const Line said = client.only();
  EXPECT_EQ(said.exchange, 2U);
}

TEST(McpSession, AClientThatLeavesGetsItsAnswersAndBeginsNothing) {
  Client client;
  Tool drive = go_to();
  drive.name = "drive";
  drive.lasts = true;
  client.session.set_tools({go_to(), drive});
  EXPECT_FALSE(client.session.leave());
  client.session.wait_for_tools(true);
  client.say(line(1, "tools/call", {{"name", "drive"}, {"arguments", {{"x", 1}}}}));
  client.say(line(2, "tools/list"));
  client.say(line(3, "tools/call", kGo));
  EXPECT_TRUE(client.session.leave());
  client.session.wait_for_tools(false);
  const auto answers = client.heard();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0]["result"]["isError"], true);
  EXPECT_EQ(answers[1]["id"], 2);
  EXPECT_TRUE(client.session.leave()) << "a call is not answered yet";
  const Call call = client.called();
  EXPECT_EQ(call.tool, "go_to");
  client.session.answer(call.number, {"there", nullptr, false});
  EXPECT_FALSE(client.session.leave());
}

TEST(McpSession, WaitingRequestsHaveALimit) {
  Client client;
  client.session.wait_for_tools(true);
  for (std::size_t i = 0; i < Session::kMostOpen; ++i)
    EXPECT_TRUE(client.say(line(1, "tools/list")).empty());
  EXPECT_EQ(client.one(line(2, "tools/list"))["error"]["code"], -32603);
}

TEST(McpSession, AnUnknownToolIsGuessed) {
  Client client;
  const auto message = [&](const std::string& name) {
    return client.one(line(1, "tools/call", {{"name", name}}))["error"]["message"];
  };
  EXPECT_EQ(message("go_too"), "there is no tool \"go_too\": did you mean go_to?");
  EXPECT_EQ(message("dance"), "there is no tool \"dance\"");
}

TEST(McpSession, EachCallHasAnOutcomeForTheLog) {
  Client client;
  client.say(line(1, "tools/call", {{"name", "go"}}));
  client.say(line(2, "tools/call", {{"name", "go_to"}}));
  const Json& fits = kGo;
  client.say(line(3, "tools/call", fits));
  client.session.answer(client.session.take_calls().at(0).number, {"there", nullptr, false});
  client.say(line(4, "tools/call", fits));
  client.say(cancelled(4));
  const auto outcomes = client.session.take_outcomes();
  ASSERT_EQ(outcomes.size(), 4U);
  EXPECT_EQ(outcomes[0].text, "there is no tool \"go\": did you mean go_to?");
  EXPECT_EQ(outcomes[1].text, "not done: \"x\" is missing");
  EXPECT_TRUE(outcomes[1].is_error);
  EXPECT_EQ(outcomes[2].tool, "go_to");
  EXPECT_EQ(outcomes[2].text, "there");
  EXPECT_FALSE(outcomes[2].is_error);
  EXPECT_EQ(outcomes[3].text, "given up by the client");
  EXPECT_TRUE(client.session.take_outcomes().empty());
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

// A tool that reads and takes no arguments is a resource too.
TEST(McpSession, ReadsAResourceByItsTool) {
  Client client;
  const Tool why{"why", "why it does that",
                 Json{{"type", "object"}, {"properties", Json::object()}}, true};
  client.session.set_tools({go_to(), why});
  const Json list = client.one(line(1, "resources/list"))["result"];
  ASSERT_EQ(list["resources"].size(), 1U);
  EXPECT_EQ(list["resources"][0]["uri"], "saphira://robot/why");
  EXPECT_FALSE(list.contains("ttlMs"));
  EXPECT_TRUE(
      client
          .say(
              R"({"jsonrpc":"2.0","id":2,"method":"resources/read","params":{"uri":"saphira://robot/why"}})")
          .empty());
  const Call call = client.called();
  EXPECT_EQ(call.tool, "why");
  client.session.answer(call.number, {"nobody drives", nullptr, false});
  EXPECT_EQ(client.heard().front()["result"],
            Json::parse(R"({"contents":[{"uri":"saphira://robot/why","mimeType":"text/plain",
                            "text":"nobody drives"}]})"));
}

TEST(McpSession, AResourceThatIsNotThereIsAnErrorOfItsEra) {
  Client client;
  const Json old = client.one(
      R"({"jsonrpc":"2.0","id":1,"method":"resources/read","params":{"uri":"saphira://robot/go_to"}})");
  EXPECT_EQ(old["error"]["code"], -32002);
  const Json modern = client.one(
      R"({"jsonrpc":"2.0","id":2,"method":"resources/read","params":{"uri":"saphira://robot/x","_meta":{
          "io.modelcontextprotocol/protocolVersion":"2026-07-28",
          "io.modelcontextprotocol/clientCapabilities":{}}}})");
  EXPECT_EQ(modern["error"]["code"], -32602);
  EXPECT_EQ(modern["error"]["data"]["uri"], "saphira://robot/x");
}

const Json kForm = Json::parse(R"({"elicitation":{}})");

TEST(McpSession, AQuestionGoesWithTheCallThatItIsAbout) {
  Client client;
  client.session.take(line(1, "initialize", {{"capabilities", kForm}}), 3);
  client.session.take(line(2, "tools/call", kGo), 4);
  client.session.take_lines();
  const std::uint64_t call = client.called().number;
  const std::uint64_t question = client.session.ask_person("May it?", call);
  const Line asked = client.only();
  EXPECT_EQ(asked.exchange, 4U);
  EXPECT_FALSE(asked.last);
  EXPECT_TRUE(client.session.is_open(call));
  client.session.take_back(question);
  const Json taken = client.heard().at(0);
  EXPECT_EQ(taken["method"], "notifications/cancelled");
  EXPECT_EQ(taken["params"]["requestId"], Json::parse(asked.text)["id"]);
  client.session.take_back(question);
  EXPECT_TRUE(client.heard().empty()) << "once";
}

TEST(McpSession, AClientThatCannotAskSaysNoNo) {
  Client client;
  client.say(line(1, "initialize", {{"capabilities", {{"elicitation", {{"url", kForm}}}}}}));
  EXPECT_EQ(client.session.ask_person("May it?", 0), 0U) << "it has no forms";
  client.say(line(2, "initialize", {{"capabilities", kForm}}));
  client.session.ask_person("May it?", 0);
  const Json id = client.heard().at(0)["id"];
  client.say(Json{{"id", id}, {"error", {{"code", -32602}, {"message", "no"}}}}.dump());
  EXPECT_TRUE(client.session.take_consents().empty());
}

TEST(McpSession, InTheNewerEraACallIsRepeatedWithThePersonsAnswer) {
  Client client;
  const auto call = [&](const std::string& id, const Json& more, const Json& capabilities = kForm) {
    Json parameters = kGo;
    parameters.update(more);
    return client.say(modern(id, "tools/call", parameters, capabilities));
  };
  EXPECT_TRUE(call("a", Json::object(), Json::object()).empty());
  EXPECT_EQ(client.session.ask_person("May it?", client.called().number), 0U) << "it cannot ask";
  call("b", Json::object());
  const Call first = client.called();
  EXPECT_EQ(first.question, 0U);
  const std::uint64_t question = client.session.ask_person("May it?", first.number);
  EXPECT_FALSE(client.session.is_open(first.number));
  EXPECT_TRUE(client.session.is_silent_for(question));
  const Json message = client.heard().at(0);
  EXPECT_EQ(message["id"], "b");
  const Json result = message["result"];
  EXPECT_EQ(result["resultType"], "input_required");
  const std::string state = result["requestState"];
  const Json form = result["inputRequests"][state];
  EXPECT_EQ(form["method"], "elicitation/create");
  EXPECT_EQ(form["params"]["mode"], "form");
  EXPECT_EQ(form["params"]["message"], "May it?");
  EXPECT_EQ(form["params"]["requestedSchema"]["properties"]["yes"]["type"], "boolean");
  EXPECT_FALSE(form.contains("id"));

  client.session.take_back(question);
  EXPECT_TRUE(client.heard().empty()) << "the client cannot be told";
  EXPECT_EQ(call("c", {{"requestState", "question 99"}})[0]["error"]["code"], -32602);
  EXPECT_EQ(call("d", {{"requestState", state}})[0]["result"]["inputRequests"][state], form)
      << "without an answer it is asked again";
  EXPECT_TRUE(client.session.take_calls().empty());
  const Json yes{{"action", "accept"}, {"content", {{"yes", true}}}};
  const Json answer{{"requestState", state}, {"inputResponses", {{state, yes}}}};
  EXPECT_TRUE(call("e", answer).empty());
  EXPECT_EQ(client.called().question, question);
  const auto consent = saphira::test::only(client.session.take_consents());
  EXPECT_EQ(consent, std::pair(question, true));
  EXPECT_FALSE(client.session.is_silent_for(question));
  EXPECT_EQ(call("f", answer)[0]["error"]["code"], -32602) << "an answer counts once";
}

}  // namespace
}  // namespace saphira::mcp

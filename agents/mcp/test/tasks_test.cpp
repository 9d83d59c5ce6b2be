// Calls that outlast their request.
#include "client.hpp"
#include "only.hpp"

namespace saphira::mcp {
namespace {

using test::Client;
using test::kGo;
using test::line;
using test::modern;

const Json kKnowsTasks = Json::parse(R"({"extensions":{"io.modelcontextprotocol/tasks":{}}})");

/// A client that knows tasks, in the year 2026, and a goal tool.
struct Tasks : Client {
  Tasks() {
    Tool tool = test::go_to();
    tool.lasts = true;
    session.set_tools({tool});
    session.turn(100.0, 1795696207.25);
  }
  static std::string request(const std::string& id, const std::string& method,
                             const Json& parameters) {
    return modern(id, method, parameters, kKnowsTasks);
  }
  Json ask(const std::string& method, const std::string& task) {
    return one(request("r", method, {{"taskId", task}}));
  }
  /// A task of this id; its call.
  std::uint64_t begin(const std::string& id) {
    session.take(request("c", "tools/call", kGo), 5);
    const auto calls = session.take_calls();
    EXPECT_TRUE(calls.at(0).as_task);
    session.begin_task(calls[0].number, id, "asked for");
    return calls[0].number;
  }
};

TEST(McpTasks, ACallIsATaskAtOnceAndIsPolledToItsEnd) {
  Tasks client;
  const std::uint64_t call = client.begin("1f:2");
  const auto said = saphira::test::only(client.session.take_lines());
  EXPECT_TRUE(said.last) << "it ends the request";
  EXPECT_EQ(said.exchange, 5U);
  Json expected = Json::parse(R"({
      "resultType":"task","taskId":"1f:2","status":"working","statusMessage":"asked for",
      "createdAt":"2026-11-26T12:30:07.250Z","lastUpdatedAt":"2026-11-26T12:30:07.250Z",
      "ttlMs":900000,"pollIntervalMs":500,
      "_meta":{"io.modelcontextprotocol/serverInfo":{"name":"saphira","version":"1"}}})");
  EXPECT_EQ(Json::parse(said.text)["result"], expected);

  client.session.close(5);  // of no consequence to the task
  client.session.turn(101.0, 1795696208.25);
  client.session.progress(call, 0.5, "half");
  EXPECT_TRUE(client.heard().empty()) << "a task has no notifications of progress";
  expected["resultType"] = "complete";
  expected["statusMessage"] = "half";
  expected["lastUpdatedAt"] = "2026-11-26T12:30:08.250Z";
  EXPECT_EQ(client.ask("tasks/get", "1f:2")["result"], expected);

  client.session.answer(call, {"there", {{"state", "succeeded"}}, false});
  EXPECT_TRUE(client.heard().empty());
  expected["status"] = "completed";
  expected["statusMessage"] = "there";
  expected["result"] = Json::parse(R"({"content":[{"type":"text","text":"there"}],"isError":false,
                                       "structuredContent":{"state":"succeeded"}})");
  EXPECT_EQ(client.ask("tasks/get", "1f:2")["result"], expected);
  EXPECT_TRUE(client.session.take_given_up().empty());
  EXPECT_EQ(client.session.take_outcomes().at(0).text, "there");
}

TEST(McpTasks, ATaskThatIsCanceledIsSoWhenItsGoalHasEnded) {
  Tasks client;
  const std::uint64_t call = client.begin("a");
  client.heard();
  // The protocol has a request of its own for this.
  client.say(R"({"jsonrpc":"2.0","method":"notifications/cancelled","params":{"requestId":"c"}})");
  EXPECT_TRUE(client.session.take_given_up().empty());

  EXPECT_EQ(client.ask("tasks/cancel", "a")["result"]["resultType"], "complete");
  EXPECT_EQ(client.session.take_given_up(), std::vector<std::uint64_t>{call});
  EXPECT_EQ(client.ask("tasks/get", "a")["result"]["status"], "working");
  client.ask("tasks/cancel", "a");
  EXPECT_TRUE(client.session.take_given_up().empty()) << "once is enough";
  client.session.answer(call, {"goal a: canceled", nullptr, true});
  const Json state = client.ask("tasks/get", "a")["result"];
  EXPECT_EQ(state["status"], "cancelled");
  EXPECT_EQ(state["statusMessage"], "goal a: canceled");
  EXPECT_FALSE(state.contains("result"));
  EXPECT_EQ(client.ask("tasks/cancel", "a")["result"]["resultType"], "complete");
  EXPECT_TRUE(client.session.take_given_up().empty());
}

TEST(McpTasks, AFailureIsAResultAndAnEndBeforeTheCancellationStays) {
  Tasks client;
  client.session.answer(client.begin("a"), {"no route", nullptr, true});
  const std::uint64_t late = client.begin("b");
  client.heard();
  client.ask("tasks/cancel", "b");
  client.session.answer(late, {"there", nullptr, false});
  const Json failed = client.ask("tasks/get", "a")["result"];
  EXPECT_EQ(failed["status"], "completed");
  EXPECT_EQ(failed["result"]["isError"], true);
  EXPECT_EQ(client.ask("tasks/get", "b")["result"]["status"], "completed");
}

TEST(McpTasks, OnlyAClientThatDeclaresTasksGetsOne) {
  Tasks client;
  client.say(modern("c", "tools/call", kGo));
  client.say(line(1, "tools/call", kGo));
  for (const Call& call : client.session.take_calls())
    EXPECT_FALSE(call.as_task);
  for (const char* method : {"tasks/get", "tasks/cancel", "tasks/update"}) {
    const Json error = client.one(modern("r", method, {{"taskId", "a"}}))["error"];
    EXPECT_EQ(error["code"], -32021);
    EXPECT_EQ(error["data"]["requiredCapabilities"], kKnowsTasks);
    EXPECT_EQ(client.one(line(2, method))["error"]["code"], -32601) << "the older era has none";
    EXPECT_EQ(client.ask(method, "a")["error"]["code"], -32602) << "there is none";
  }
  const Headers headers{Session::kModern, "tasks/result", ""};
  client.session.take(Tasks::request("r", "tasks/result", {{"taskId", "a"}}), 1, &headers);
  EXPECT_EQ(client.heard().at(0)["error"]["code"], -32601) << "of an earlier kind of tasks";
  const Json listen{{"notifications", {{"taskIds", {"a"}}}}};
  EXPECT_EQ(client.one(modern("l", "subscriptions/listen", listen))["error"]["code"], -32021);
  EXPECT_EQ(client.one(modern("d", "server/discover"))["result"]["capabilities"]["extensions"],
            kKnowsTasks["extensions"]);
}

TEST(McpTasks, AnUpdateIsTakenAndAsksForNothing) {
  Tasks client;
  client.begin("a");
  client.heard();
  const Json reply = client.one(Tasks::request(
      "u", "tasks/update", {{"taskId", "a"}, {"inputResponses", {{"name", Json::object()}}}}));
  EXPECT_EQ(reply["result"]["resultType"], "complete");
  EXPECT_FALSE(reply["result"].contains("taskId"));
}

TEST(McpTasks, AListenerHearsOfTheTasksThatItNames) {
  Tasks client;
  const std::uint64_t call = client.begin("a");
  const std::uint64_t other = client.begin("b");
  client.heard();
  const Json first = client.one(
      Tasks::request("l", "subscriptions/listen", {{"notifications", {{"taskIds", {"a", "z"}}}}}));
  EXPECT_EQ(first["params"]["notifications"], Json::parse(R"({"taskIds":["a"]})"));
  client.session.progress(other, 0.5, "half");
  client.session.progress(call, 0.5, "half");
  client.session.answer(call, {"there", nullptr, false});
  const auto lines = client.heard();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["method"], "notifications/tasks");
  EXPECT_EQ(lines[0]["params"]["_meta"]["io.modelcontextprotocol/subscriptionId"], "l");
  EXPECT_EQ(lines[0]["params"]["taskId"], "a");
  EXPECT_EQ(lines[0]["params"]["statusMessage"], "half");
  EXPECT_EQ(lines[1]["params"]["status"], "completed");
  EXPECT_EQ(lines[1]["params"]["result"]["content"][0]["text"], "there");
}

TEST(McpTasks, ATaskIsRememberedForAQuarterOfAnHour) {
  Tasks client;
  client.session.answer(client.begin("done"), {"there", nullptr, false});
  client.begin("open");
  client.heard();
  client.session.turn(999.9);
  EXPECT_TRUE(client.ask("tasks/get", "done").contains("result"));
  client.session.turn(1000.0);
  EXPECT_EQ(client.ask("tasks/get", "done")["error"]["code"], -32602);
  EXPECT_TRUE(client.ask("tasks/get", "open").contains("result"));
}

TEST(McpTasks, TheHeaderNamesTheTask) {
  Tasks client;
  client.begin("a");
  client.heard();
  const std::string get = Tasks::request("r", "tasks/get", {{"taskId", "a"}});
  const Headers right{Session::kModern, "tasks/get", "a"};
  client.session.take(get, 1, &right);
  EXPECT_EQ(client.session.take_lines().at(0).status, 200);
  const Headers wrong{Session::kModern, "tasks/get", "b"};
  client.session.take(get, 1, &wrong);
  const auto lines = client.session.take_lines();
  EXPECT_EQ(lines.at(0).status, 400);
  EXPECT_EQ(Json::parse(lines[0].text)["error"]["code"], -32020);
}

TEST(McpTasks, ATaskThatAsksThePersonSaysSoUntilTheAnswer) {
  Tasks client;
  Json knows = kKnowsTasks;
  knows["elicitation"] = Json::object();
  client.session.take(modern("c", "tools/call", kGo, knows));
  const std::uint64_t call = client.called().number;
  client.session.begin_task(call, "1f:2", "asked for");
  const auto asks = [&] {
    const std::uint64_t number = client.session.ask_person("May it?", call);
    client.heard();
    return std::pair(number, client.ask("tasks/get", "1f:2")["result"]);
  };
  const auto [question, state] = asks();
  EXPECT_TRUE(client.session.is_open(call));
  EXPECT_FALSE(client.session.is_silent_for(question)) << "it polls";
  EXPECT_EQ(state["status"], "input_required");
  ASSERT_EQ(state["inputRequests"].size(), 1U);
  const std::string name = state["inputRequests"].items().begin().key();
  EXPECT_EQ(state["inputRequests"][name]["method"], "elicitation/create");
  client.session.progress(call, 0.0, "waits for an approval");
  EXPECT_EQ(client.ask("tasks/get", "1f:2")["result"]["status"], "input_required");
  const auto update = [&](const Json& responses) {
    return client.one(
        Tasks::request("u", "tasks/update", {{"taskId", "1f:2"}, {"inputResponses", responses}}));
  };
  EXPECT_TRUE(update({{"other", Json::object()}}).contains("result"));
  EXPECT_TRUE(client.session.take_consents().empty());
  const Json yes{{"action", "accept"}, {"content", {{"yes", true}}}};
  EXPECT_TRUE(update({{name, yes}}).contains("result"));
  EXPECT_EQ(saphira::test::only(client.session.take_consents()), std::pair(question, true));
  const Json after = client.ask("tasks/get", "1f:2")["result"];
  EXPECT_EQ(after["status"], "working");
  EXPECT_FALSE(after.contains("inputRequests"));

  client.session.take_back(asks().first);
  client.session.progress(call, 0.1, "on its way");
  EXPECT_EQ(client.ask("tasks/get", "1f:2")["result"]["status"], "working") << "approved elsewhere";
  asks();
  client.session.answer(call, {"arrived", nullptr, false});
  EXPECT_FALSE(client.ask("tasks/get", "1f:2")["result"].contains("inputRequests"));
}

}  // namespace
}  // namespace saphira::mcp

// Changes that a client wants to hear of.
#include "client.hpp"

namespace saphira::mcp {
namespace {

using test::cancelled;
using test::Client;
using test::go_to;
using test::line;
using test::modern;

const Json kWhy{{"uri", "saphira://robot/why"}};
const Json kUpdated = Json::parse(
    R"({"jsonrpc":"2.0","method":"notifications/resources/updated",
        "params":{"uri":"saphira://robot/why"}})");

Tool resource(const std::string& name) {
  return {name, "", Json{{"type", "object"}, {"properties", Json::object()}}, true};
}

/// A client, and a robot that says why it does what it does.
struct Watching : Client {
  Watching() { session.set_tools({go_to(), resource("why"), resource("map")}); }
  /// The time and the robot's words then; how often it was asked for them.
  std::size_t pass(double time, const std::string& words) {
    session.turn(time);
    const auto calls = session.take_calls();
    for (const Call& call : calls)
      session.answer(call.number, {call.tool + ": " + words, nullptr, false});
    return calls.size();
  }
};

TEST(McpSubscriptions, AResourceIsToldOfWhenItsTextChangesAndAtMostOnceASecond) {
  Watching client;
  client.say(line(1, "initialize"));
  client.session.turn(100.0);
  EXPECT_EQ(client.one(line(2, "resources/subscribe", kWhy))["result"], Json::object());
  EXPECT_EQ(client.pass(100.0, "it stands"), 1U) << "read at once, so that no change is missed";
  EXPECT_TRUE(client.heard().empty());
  EXPECT_EQ(client.pass(100.9, "it drives"), 0U);
  EXPECT_EQ(client.pass(101.0, "it stands"), 1U);
  EXPECT_TRUE(client.heard().empty()) << "the text is the same";
  EXPECT_EQ(client.pass(102.0, "it drives"), 1U);
  EXPECT_EQ(client.heard(), std::vector<Json>{kUpdated});
  EXPECT_EQ(client.pass(103.0, "it drives"), 1U);
  EXPECT_TRUE(client.heard().empty());

  EXPECT_EQ(client.one(line(3, "resources/unsubscribe", kWhy))["result"], Json::object());
  EXPECT_EQ(client.pass(105.0, "it stands"), 0U);
  EXPECT_TRUE(client.heard().empty());
  EXPECT_TRUE(client.session.take_outcomes().empty()) << "nobody has called a tool";
}

TEST(McpSubscriptions, AnAgentThatAnswersSlowlyIsNotAskedAgainMeanwhile) {
  Watching client;
  client.say(line(1, "resources/subscribe", kWhy));
  const Call call = client.called();
  client.session.turn(5.0);
  EXPECT_TRUE(client.session.take_calls().empty());
  client.session.answer(call.number, {"late", nullptr, false});
  EXPECT_EQ(client.pass(5.9, ""), 0U);
  EXPECT_EQ(client.pass(6.0, ""), 1U);
}

TEST(McpSubscriptions, AResourceThatIsNotThereIsRefused) {
  Watching client;
  const Json error =
      client.one(line(1, "resources/subscribe", {{"uri", "saphira://robot/go_to"}}))["error"];
  EXPECT_EQ(error["code"], -32002);
  EXPECT_EQ(error["data"]["uri"], "saphira://robot/go_to");
  EXPECT_EQ(client.one(line(2, "resources/subscribe"))["error"]["code"], -32002);
  EXPECT_EQ(client.one(line(3, "resources/unsubscribe"))["result"], Json::object());
  EXPECT_EQ(client.one(modern("m", "resources/subscribe", kWhy))["error"]["code"], -32601);
  EXPECT_EQ(client.one(line(4, "subscriptions/listen"))["error"]["code"], -32601);
}

TEST(McpSubscriptions, SubscriptionsAreDeclared) {
  Watching client;
  const Json expected = Json::parse(R"({"subscribe":true})");
  EXPECT_EQ(client.one(line(1, "initialize"))["result"]["capabilities"]["resources"], expected);
  EXPECT_EQ(client.one(modern("d", "server/discover"))["result"]["capabilities"]["resources"],
            expected);
}

TEST(McpSubscriptions, AListenerHearsOfTheResourcesThatItNames) {
  Watching client;
  const Json wanted{{"notifications",
                     {{"resourceSubscriptions", {"saphira://robot/why", "saphira://robot/no", 3}},
                      {"promptsListChanged", true}}}};
  const Json honoured = Json::parse(
      R"({"jsonrpc":"2.0","method":"notifications/subscriptions/acknowledged","params":{
          "_meta":{"io.modelcontextprotocol/subscriptionId":"l1"},
          "notifications":{"resourceSubscriptions":["saphira://robot/why"]}}})");
  EXPECT_EQ(client.one(modern("l1", "subscriptions/listen", wanted)), honoured);
  client.pass(0.0, "it stands");
  client.pass(1.0, "it drives");
  Json updated = kUpdated;
  updated["params"]["_meta"]["io.modelcontextprotocol/subscriptionId"] = "l1";
  EXPECT_EQ(client.heard(), std::vector<Json>{updated});
  // The tools of the robot change, which it does not want to hear.
  client.session.set_tools({resource("why")});
  EXPECT_TRUE(client.heard().empty());
  client.say(cancelled("l1"));
  EXPECT_EQ(client.pass(2.0, "it stands"), 0U);
}

TEST(McpSubscriptions, TheConnectionOfAListenerIsTheSubscription) {
  Watching client;
  const Json wanted{{"notifications", {{"resourceSubscriptions", {"saphira://robot/why"}}}}};
  client.session.take(modern("l", "subscriptions/listen", wanted), 7);
  client.session.take(modern("l", "subscriptions/listen", wanted), 8);
  client.session.take(line(1, "resources/subscribe", kWhy), 9);
  client.pass(0.0, "it stands");
  client.session.take_lines();
  client.session.close(7);
  client.pass(1.0, "it drives");
  const auto lines = client.session.take_lines();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].exchange, 8U);
  EXPECT_EQ(lines[1].exchange, 0U) << "the older era hears outside of its requests";
  EXPECT_FALSE(lines[0].last || lines[1].last);
}

TEST(McpSubscriptions, TheToolsAreToldOfAtMostOnceASecond) {
  Client client;
  client.session.turn(10.0);
  client.say(line(1, "initialize"));
  client.session.set_tools({});
  EXPECT_EQ(client.heard(),
            std::vector<Json>{
                Json::parse(R"({"jsonrpc":"2.0","method":"notifications/tools/list_changed"})")});
  client.session.turn(10.5);
  client.session.set_tools({go_to()});
  client.session.set_tools({resource("why")});
  EXPECT_TRUE(client.heard().empty());
  client.session.turn(11.0);
  EXPECT_EQ(client.heard().size(), 1U);
  client.session.turn(12.0);
  EXPECT_TRUE(client.heard().empty());
}

TEST(McpSubscriptions, ASubscriptionWaitsForTheTools) {
  Client client;
  client.session.wait_for_tools(true);
  EXPECT_TRUE(client.say(line(1, "resources/subscribe", kWhy)).empty());
  EXPECT_TRUE(client.say(modern("l", "subscriptions/listen")).empty());
  client.session.set_tools({resource("why")});
  client.session.wait_for_tools(false);
  const auto lines = client.heard();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["result"], Json::object());
  EXPECT_EQ(lines[1]["method"], "notifications/subscriptions/acknowledged");
}

TEST(McpSubscriptions, AListenerIsAnsweredWhenTheServerEnds) {
  Watching client;
  client.say(line(1, "initialize"));
  client.say(modern("l", "subscriptions/listen"));
  client.session.end();
  const auto lines = client.heard();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["method"], "notifications/cancelled");
  EXPECT_EQ(lines[0]["params"]["requestId"], "l");
  EXPECT_EQ(lines[1]["id"], "l");
  EXPECT_EQ(lines[1]["result"]["resultType"], "complete");
  EXPECT_EQ(lines[1]["result"]["_meta"]["io.modelcontextprotocol/subscriptionId"], "l");
}

TEST(McpSubscriptions, ListenersHaveALimit) {
  Watching client;
  for (int i = 0; i < 16; ++i)
    EXPECT_EQ(client.one(modern("l", "subscriptions/listen"))["method"],
              "notifications/subscriptions/acknowledged");
  EXPECT_EQ(client.one(modern("l", "subscriptions/listen"))["error"]["code"], -32600);
}

}  // namespace
}  // namespace saphira::mcp

#include "saphira/viewer/protocol.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace saphira::viewer {
namespace {

using nlohmann::json;

const std::vector<Channel> kChannels{{"robot/state", "State", R"({"type":"object"})"},
                                     {"map", "Map", R"({"type":"object"})"}};

class Connected : public testing::Test {
 protected:
  Connected() {
    client.next();
    client.next();
  }
  json text() {
    const auto frame = client.next();
    return frame && !frame->binary ? json::parse(frame->content) : json();
  }

  Client client{"robot r", kChannels, 100};
};

TEST(Client, IsToldTheChannelsFirst) {
  Client client("robot r", kChannels, 100);
  const json info = json::parse(client.next().value().content);
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["name"], "robot r");
  EXPECT_EQ(info["capabilities"], json::array());
  EXPECT_EQ(json::parse(client.next().value().content),
            json::parse(R"({"op":"advertise","channels":[
      {"id":0,"topic":"robot/state","encoding":"json","schemaName":"State",
       "schema":"{\"type\":\"object\"}","schemaEncoding":"jsonschema"},
      {"id":1,"topic":"map","encoding":"json","schemaName":"Map",
       "schema":"{\"type\":\"object\"}","schemaEncoding":"jsonschema"}]})"));
  EXPECT_FALSE(client.next());
}

TEST_F(Connected, GetsTheSamplesThatItHasSubscribedTo) {
  const auto added =
      client.take(R"({"op":"subscribe","subscriptions":[{"id":258,"channelId":1}]})");
  EXPECT_EQ(added, std::vector<std::size_t>{1});
  EXPECT_TRUE(client.wants(1));
  EXPECT_FALSE(client.wants(0));
  client.offer(0, 5, "{}");
  client.offer(1, 5, "{}");
  const auto frame = client.next();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->binary);
  EXPECT_EQ(frame->content, std::string("\x01\x02\x01\0\0\x05\0\0\0\0\0\0\0{}", 15));
  EXPECT_FALSE(client.next());
  EXPECT_TRUE(client.take(R"({"op":"unsubscribe","subscriptionIds":[258]})"));
  client.offer(1, 6, "{}");
  EXPECT_FALSE(client.next());
}

TEST_F(Connected, LosesTheOldestWhereItIsSlow) {
  client.take(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})");
  for (int i = 1; i <= 10; ++i)  // 33 bytes each
    client.offer(0, i, std::string(20, 'x'));
  EXPECT_EQ(client.dropped(), 7U);
  EXPECT_EQ(client.next().value().content[5], 8);
  client.offer(0, 11, std::string(500, 'x'));
  EXPECT_EQ(client.next().value().content[5], 11) << "one that is too long for the queue";
  EXPECT_FALSE(client.next());
}

TEST_F(Connected, CanOnlyWatch) {
  for (const char* text : {R"({"op":"advertise","channels":[{"id":1,"topic":"drive/teleop"}]})",
                           R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})",
                           R"({"op":"setParameters","parameters":[]})"}) {
    EXPECT_EQ(client.take(text), std::vector<std::size_t>{}) << text;
    EXPECT_EQ(this->text()["level"], 2) << text;
  }
  for (const char* text :
       {"", "1", "[]", "{}", R"({"op":1})", R"({"op":"subscribe)",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":0}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":4294967296}]})",
        R"({"op":"subscribe","subscriptions":[5]})"})
    EXPECT_FALSE(client.take(text)) << text;
}

}  // namespace
}  // namespace saphira::viewer

#include "saphira/bus/request_server.hpp"

#include <gtest/gtest.h>

namespace saphira::bus {
namespace {

using Numbers = std::vector<std::uint64_t>;
using Texts = std::vector<std::string>;

/// The server of a topic, and another of the same program on another topic.
class RequestServers : public testing::Test {
 protected:
  RequestServer server(const std::string& address, bool routed = false) {
    return {address, routed, [this](const v1::Answer& answer) { told_.push_back(answer); },
            [this](const std::string& text) { warnings_.push_back(text); }};
  }
  void ask(RequestServer& server, std::uint64_t number, const std::string& functor = "turn",
           const std::string& service = {}) {
    if (server.hear({.asker = 9, .number = number, .service = service, .functor = functor}))
      begun_.push_back(number);
  }
  static bool say(RequestServer& server, std::uint64_t number, v1::AnswerCode code,
                  const std::string& text = {}) {
    return server.answer(9, number, {.code = code, .text = text});
  }
  /// The texts since the last call.
  Texts told() {
    Texts texts;
    for (const v1::Answer& answer : std::exchange(told_, {}))
      texts.push_back(answer.text);
    return texts;
  }

  std::vector<v1::Answer> told_;
  Texts warnings_;
  Numbers begun_;
  RequestServer servo_ = server("bridge");
  RequestServer timer_ = server("bridge");
};

TEST_F(RequestServers, EachRequestIsBegunOnceAndHasOneEnd) {
  ask(servo_, 1);
  ask(servo_, 1);
  EXPECT_EQ(told(), Texts{}) << "there is no answer yet";
  for (const v1::AnswerCode code : {v1::ANSWER_UNDERWAY, v1::ANSWER_UNDERWAY, v1::ANSWER_DONE}) {
    EXPECT_TRUE(say(servo_, 1, code, "turns"));
    ask(servo_, 1);
    const v1::Answer answer{
        .asker = 9, .number = 1, .service = "bridge", .code = code, .text = "turns"};
    EXPECT_EQ(std::exchange(told_, {}), (std::vector<v1::Answer>{answer, answer}));
  }
  EXPECT_FALSE(say(servo_, 1, v1::ANSWER_GIVEN_UP, "too heavy"));
  EXPECT_FALSE(say(servo_, 1, v1::ANSWER_UNDERWAY, "turns again"));
  ask(servo_, 1);
  EXPECT_EQ(told(), Texts{"turns"});
  EXPECT_EQ(warnings_, Texts{"request 1 has ended: a further answer is not told: too heavy"});
  EXPECT_EQ(begun_, Numbers{1});
  EXPECT_TRUE(servo_.hear({.asker = 8, .number = 1})) << "of another asker";
}

TEST_F(RequestServers, ALaterAnswerIsOfTheTopicOnWhichItWasAsked) {
  ask(servo_, 1);
  ask(timer_, 1);
  say(servo_, 1, v1::ANSWER_UNDERWAY, "turns");
  say(timer_, 1, v1::ANSWER_UNDERWAY, "runs");
  say(servo_, 1, v1::ANSWER_DONE, "turned");
  ask(servo_, 1);
  ask(timer_, 1);
  EXPECT_EQ(told(), (Texts{"turns", "runs", "turned", "turned", "runs"}));
  EXPECT_EQ(begun_, (Numbers{1, 1}));
}

TEST_F(RequestServers, AWithdrawalStopsWhatIsUnderWayAndEndsWhatIsNotBegun) {
  int stops = 0;
  servo_.when_withdrawn([&](const v1::Request& request) {
    if (++stops == 2)
      say(servo_, request.number, v1::ANSWER_GIVEN_UP, "half way");
  });
  ask(servo_, 1);
  say(servo_, 1, v1::ANSWER_UNDERWAY, "turns");
  for (int i = 0; i < 3; ++i)
    ask(servo_, 1, kWithdraw);
  EXPECT_EQ(told(), (Texts{"turns", "turns", "half way", "half way", "half way"}));
  EXPECT_EQ(stops, 2);
  ask(servo_, 2, kWithdraw);
  ask(servo_, 2);
  EXPECT_EQ(told(), Texts(2, "withdrawn before it was begun"));
  EXPECT_EQ(begun_, Numbers{1});
}

TEST_F(RequestServers, AMemberWithTheNumbersOfAnotherForestallsAndWithdrawsNothing) {
  const Identity kate{"kate", "operator"};
  const Identity mallory{"mallory", "observer"};
  std::vector<std::string> stops;
  servo_.when_withdrawn([&](const v1::Request&) { stops.emplace_back("stop"); });
  const v1::Request request{.asker = 9, .number = 1, .functor = "turn"};
  const v1::Request withdrawal{.asker = 9, .number = 1, .functor = kWithdraw};
  EXPECT_FALSE(servo_.hear(withdrawal, &mallory));
  EXPECT_EQ(told(), Texts{"withdrawn before it was begun"});
  EXPECT_TRUE(servo_.hear(request, &kate));
  EXPECT_FALSE(servo_.hear(withdrawal, &mallory));
  EXPECT_TRUE(say(servo_, 1, v1::ANSWER_UNDERWAY, "turns"));
  EXPECT_FALSE(servo_.hear(withdrawal, &mallory));
  EXPECT_EQ(told(), Texts{"turns"});
  EXPECT_TRUE(stops.empty());
  EXPECT_FALSE(servo_.hear(withdrawal, &kate));
  EXPECT_EQ(stops.size(), 1U);
  EXPECT_TRUE(say(servo_, 1, v1::ANSWER_DONE, "turned"));
  EXPECT_FALSE(servo_.hear(request, &kate));
  EXPECT_EQ(told(), (Texts{"turns", "turned", "turned"}));
}

TEST_F(RequestServers, TheServerIsMeantByItsNameAndWithoutARouterByNone) {
  RequestServer clerk = server("1f/clerk", true);
  for (const char* service : {"", "bridge", "vision", "1f/clerk", "1f/clerk"}) {
    ask(servo_, 0, "turn", service);
    ask(clerk, 10, "write", service);
  }
  EXPECT_EQ(begun_, (Numbers{0, 0, 10})) << "number 0 is always new";
  begun_.clear();
  ask(clerk, 0, "write", "1f/clerk");
  ask(clerk, 0, "write", "1f/clerk");
  EXPECT_EQ(begun_, Numbers{0}) << "a router repeats it";
  EXPECT_TRUE(say(servo_, 0, v1::ANSWER_DONE));
  EXPECT_TRUE(say(servo_, 0, v1::ANSWER_DONE)) << "of the other one";
}

TEST_F(RequestServers, TheOldestOfItsKindIsForgotten) {
  for (std::uint64_t number = 1; number <= 256; ++number)
    ask(servo_, number);
  say(servo_, 2, v1::ANSWER_DONE);
  ask(servo_, 257);
  begun_.clear();
  for (const std::uint64_t number : {1, 2})
    ask(servo_, number);
  EXPECT_EQ(begun_, Numbers{});
  EXPECT_FALSE(say(servo_, 2, v1::ANSWER_GIVEN_UP)) << "it has ended";
  ask(servo_, 258);
  for (const std::uint64_t number : {1, 2})
    ask(servo_, number);
  EXPECT_EQ(begun_, (Numbers{258, 1})) << "the oldest under way; ends are of another kind";
}

}  // namespace
}  // namespace saphira::bus

#include "saphira/bus/request_client.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"
#include "only.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bus {
namespace {

using saphira::test::memory_options;
using saphira::test::only;

/// An asker, whose clock the test moves, and a program that answers by hand.
class RequestClients : public testing::Test {
 protected:
  /// A program that takes the requests, and its answers.
  struct Server {
    explicit Server(std::shared_ptr<MemoryBus> bus)
        : node(memory_options("bridge"), std::move(bus)) {}
    Node node;
    Reader<v1::Request> requests = node.reader<v1::Request>(topics::kDriveStop);
    Writer<v1::Answer> answers = node.writer(topics::kRobotAnswers);

    void answer(const v1::Request& request, v1::AnswerCode code, const std::string& text = {}) {
      answers.write({.asker = request.asker,
                     .number = request.number,
                     .service = "bridge",
                     .code = code,
                     .text = text});
    }
    /// The only request since the last call.
    v1::Request taken() { return only(requests.take()).data; }
    std::size_t count() { return requests.take().size(); }
  };

  RequestClient::Hear into(std::vector<v1::Answer>& answers) {
    return [&answers](const v1::Answer& answer) { answers.push_back(answer); };
  }
  std::uint64_t send(v1::Request asked = request("stop")) {
    return client_.send(std::move(asked), into(told_), 2.0, 10.0);
  }

  const std::shared_ptr<MemoryBus> bus_ = make_memory_bus();
  Node agent_{memory_options("agent"), bus_};
  RequestClient client_{agent_, topics::kDriveStop, "an agent"};
  std::vector<v1::Answer> told_;
};

TEST_F(RequestClients, AServerThatStartsLateIsAskedAtOnce) {
  const std::uint64_t number = send();
  client_.poll(100.0);
  client_.poll(101.0);
  Server server(bus_);
  EXPECT_EQ(server.count(), 0U);
  client_.poll(101.1);
  const v1::Request asked = server.taken();
  EXPECT_EQ(asked.asker, agent_.instance());
  EXPECT_EQ(asked.number, number);
  EXPECT_EQ(asked.source, "an agent");
  server.answer(asked, v1::ANSWER_DONE, "stopped");
  client_.poll(101.2);
  EXPECT_EQ(only(told_).text, "stopped");
  client_.poll(200.0);
  EXPECT_EQ(told_.size(), 1U);
  EXPECT_EQ(server.count(), 0U);
}

TEST_F(RequestClients, ALostRequestIsWrittenAgainUntilItIsAnswered) {
  Server server(bus_);
  send();
  const v1::Request first = server.taken();  // and is lost
  client_.poll(100.0);
  client_.poll(100.29);
  EXPECT_EQ(server.count(), 0U);
  client_.poll(100.31);
  EXPECT_EQ(server.taken(), first);
  client_.poll(100.62);
  server.answer(server.taken(), v1::ANSWER_UNDERWAY, "stopping");
  client_.poll(101.0);
  EXPECT_EQ(only(told_).code, v1::ANSWER_UNDERWAY);
  client_.poll(105.0);
  EXPECT_EQ(server.count(), 0U) << "it is heard";
}

TEST_F(RequestClients, AnEndIsHeardOnce) {
  Server server(bus_);
  send();
  const v1::Request asked = server.taken();
  server.answer(asked, v1::ANSWER_DONE);
  server.answer(asked, v1::ANSWER_DONE);
  client_.poll(100.0);
  server.answer(asked, v1::ANSWER_DONE);
  client_.poll(100.1);
  EXPECT_EQ(told_.size(), 1U);
}

TEST_F(RequestClients, ARequestEndsWithoutAServer) {
  send();
  client_.poll(100.0);
  client_.poll(101.9);
  EXPECT_TRUE(told_.empty());
  client_.poll(102.0);
  const v1::Answer end = only(told_);
  EXPECT_EQ(end.code, v1::ANSWER_NOBODY);
  EXPECT_EQ(end.text, "no program serves requests on drive/stop");
  EXPECT_EQ(end.asker, agent_.instance());
  EXPECT_EQ(end.service, "");
  Server late(bus_);
  client_.poll(102.1);
  EXPECT_EQ(late.count(), 0U) << "it is over";
}

TEST_F(RequestClients, ARequestEndsWithASilentServer) {
  Server server(bus_);
  send();
  client_.poll(100.0);
  client_.poll(102.0);
  EXPECT_EQ(only(told_).code, v1::ANSWER_TOO_LATE);
  EXPECT_EQ(told_[0].text, "nothing was heard of the request on drive/stop within 2 s");
}

TEST_F(RequestClients, AServerAtWorkHasTheTimeThatItNeeds) {
  Server server(bus_);
  send();
  const v1::Request asked = server.taken();
  server.answer(asked, v1::ANSWER_UNDERWAY);
  client_.poll(100.0);
  client_.poll(109.0);
  server.answer(asked, v1::ANSWER_UNDERWAY);
  client_.poll(109.5);
  client_.poll(119.0);
  EXPECT_EQ(told_.size(), 2U);
  client_.poll(119.5);
  ASSERT_EQ(told_.size(), 3U);
  EXPECT_EQ(told_[2].code, v1::ANSWER_TOO_LATE);
  EXPECT_EQ(told_[2].text, "the request is still under way");
  EXPECT_EQ(told_[2].service, "bridge");
}

TEST_F(RequestClients, ADeadlineIsNotMovedByAServerAtWork) {
  Server server(bus_);
  v1::Request asked = request("stop");
  asked.deadline = 1.0;
  send(asked);
  client_.poll(100.0);
  server.answer(server.taken(), v1::ANSWER_UNDERWAY);
  client_.poll(101.0);
  client_.poll(102.0);
  EXPECT_EQ(told_.back().text, "the request is still under way");
}

TEST_F(RequestClients, AServerThatIsStartedAgainIsAskedAgain) {
  std::optional<Server> server(std::in_place, bus_);
  const std::uint64_t number = send();
  server->answer(server->taken(), v1::ANSWER_UNDERWAY);
  client_.poll(100.0);
  server.reset();
  client_.poll(101.0);
  server.emplace(bus_);
  client_.poll(102.0);
  const v1::Request asked = server->taken();
  EXPECT_EQ(asked.number, number);
  server->answer(asked, v1::ANSWER_DONE);
  client_.poll(103.0);
  EXPECT_EQ(told_.back().code, v1::ANSWER_DONE);
}

TEST_F(RequestClients, AWithdrawalIsWrittenAgainUntilItIsAnswered) {
  Server server(bus_);
  v1::Request asked = request("stop", {text("by", "ann")});
  const std::uint64_t number = send(asked);
  server.answer(server.taken(), v1::ANSWER_UNDERWAY);
  client_.poll(100.0);
  client_.withdraw(number);
  for (const double now : {101.0, 101.4}) {
    const v1::Request withdrawal = server.taken();
    EXPECT_EQ(withdrawal.number, number);
    EXPECT_EQ(withdrawal.functor, kWithdraw);
    EXPECT_TRUE(withdrawal.arguments.empty());
    client_.poll(now);
    client_.poll(now + 0.31);
  }
  server.answer(server.taken(), v1::ANSWER_GIVEN_UP, "half of it is done");
  client_.poll(101.8);
  EXPECT_EQ(told_.back().text, "half of it is done");
  client_.withdraw(number);
  client_.poll(105.0);
  EXPECT_EQ(server.count(), 0U) << "it has ended";
}

TEST_F(RequestClients, EachHearsItsOwnAnswers) {
  Server server(bus_);
  RequestClient other(agent_, topics::kDriveStop, "another of this program");
  std::vector<v1::Answer> told_other;
  send();
  const v1::Request first = server.taken();
  other.send(request("stop"), into(told_other));
  const v1::Request second = server.taken();
  EXPECT_NE(first.number, second.number);
  server.answer(second, v1::ANSWER_DONE, "second");
  server.answer(first, v1::ANSWER_DONE, "first");
  client_.poll(100.0);
  other.poll(100.0);
  EXPECT_EQ(only(told_).text, "first");
  EXPECT_EQ(only(told_other).text, "second");
}

TEST_F(RequestClients, AnAnswerMayAskForMore) {
  Server server(bus_);
  std::vector<v1::Answer> told;
  client_.send(request("stop"),
               [&](const v1::Answer&) { client_.send(request("stop"), into(told)); });
  server.answer(server.taken(), v1::ANSWER_DONE);
  client_.poll(100.0);
  server.answer(server.taken(), v1::ANSWER_DONE);
  client_.poll(100.1);
  EXPECT_EQ(told.size(), 1U);
}

RequestClient::Servers servers(
    std::function<std::size_t()> count, std::function<bool()> complete = [] { return true; }) {
  return {[count = std::move(count)](const auto& told) { return told.size() >= count(); },
          std::move(complete)};
}

TEST_F(RequestClients, OneThatIsOnItsWayIsWaitedFor) {
  Server one(bus_);
  std::optional<Server> late;
  int turns = 0;
  const auto play = [&] {
    if (++turns == 1)
      one.answer(one.taken(), v1::ANSWER_DONE, "stopped");
    if (turns == 3)
      late.emplace(bus_);
    if (late)
      for (const auto& sample : late->requests.take())
        late->answer(sample.data, v1::ANSWER_DONE, "late");
  };
  const std::vector<v1::Answer> ends = client_.ask_each(
      request("stop"), 60.0,
      servers([&] { return late ? 2U : 1U; }, [&] { return late.has_value(); }), nullptr, play);
  EXPECT_EQ(joined(ends, ", ", &v1::Answer::text), "stopped, late");
}

TEST_F(RequestClients, EachServerComesToItsEnd) {
  Server one(bus_);
  Server other(bus_);
  std::optional<Server> late;
  const auto begun = request("stop");
  int turns = 0;
  const auto play = [&] {
    switch (++turns) {
      case 1: {
        const v1::Request asked = one.taken();
        EXPECT_EQ(other.taken(), asked);
        one.answer(asked, v1::ANSWER_UNDERWAY, "stopping");
        other.answer(asked, v1::ANSWER_DONE, "stopped");
        other.answer(asked, v1::ANSWER_DONE, "stopped");
        one.answer(asked, v1::ANSWER_DONE, "stopped too");
        late.emplace(bus_);
        break;
      }
      default:  // the one that came late hears it when it is written again
        for (const auto& sample : late->requests.take())
          late->answer(sample.data, v1::ANSWER_DONE, "late");
    }
  };
  const std::vector<v1::Answer> ends = client_.ask_each(
      begun, 60.0, servers([&] { return late ? 3U : 2U; }), nullptr, play, into(told_));
  EXPECT_EQ(joined(ends, ", ", &v1::Answer::text), "stopped, stopped too, late");
  EXPECT_EQ(told_.size(), 4U);
}

TEST_F(RequestClients, AServerThatIsLostIsNotWaitedFor) {
  std::optional<Server> one(bus_);
  Server other(bus_);
  std::size_t count = 2;
  v1::Request asked;
  const auto play = [&] {
    if (one) {
      one->answer(one->taken(), v1::ANSWER_DONE, "gone");
      asked = other.taken();
      other.answer(asked, v1::ANSWER_UNDERWAY, "stopping");
      one.reset();
      count = 1;
    } else {
      other.answer(asked, v1::ANSWER_DONE, "stopped");
    }
  };
  std::vector<v1::Answer> ends;
  ends = client_.ask_each(request("stop"), 60.0, servers([&] { return count; }), nullptr, play);
  EXPECT_EQ(ends.back().text, "stopped");
}

TEST_F(RequestClients, WithoutServersTheClientEnds) {
  const std::vector<v1::Answer> ends =
      client_.ask_each(request("stop"), 0.0, servers([] { return 0U; }));
  EXPECT_EQ(only(ends).code, v1::ANSWER_NOBODY);
}

}  // namespace
}  // namespace saphira::bus

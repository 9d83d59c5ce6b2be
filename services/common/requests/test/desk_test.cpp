#include "requests/shell/desk.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/bus/request_client.hpp"

namespace saphira {
namespace {

constexpr double kPatience = 60.0;  // [s] for expected samples

class DeskTest : public testing::Test {
 protected:
  /// A desk, and serve(), which counts.
  void open(bool lockstep = false) {
    service.emplace(test::memory_options("registration", lockstep), memory);
    desk.emplace(
        *service, bus::topics::kRegistrationRequest,
        std::vector<Functor>{{"count", "counts", {whole_parameter("by", "how far", 0.0, 10.0)}},
                             {"later", "is answered later"}});
  }
  void serve() {
    for (const Request& request : desk->take(now)) {
      newest = request;
      order += request.source;
      total += number_of(request.arguments, "by");
      desk->answer(request, request.functor == "later"
                                ? Answer{AnswerCode::underway, "", {}}
                                : Answer{AnswerCode::done, "", {number("total", total)}});
    }
  }
  v1::Answer ask(const v1::Request& request, double patience = kPatience) {
    return client.ask(request, patience, nullptr, [this] { serve(); });
  }
  static v1::Request count(double by) {
    return v1::Request{.functor = "count", .arguments = {bus::number("by", by)}};
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node person{test::memory_options("person"), memory};
  bus::RequestClient client{person, bus::topics::kRegistrationRequest, "a person"};
  bus::Writer<v1::Request> writer = person.writer<v1::Request>(bus::topics::kRegistrationRequest);
  bus::Reader<v1::Answer> answers = person.reader(bus::topics::kRegistrationAnswers);
  std::optional<bus::Node> service;
  std::optional<Desk> desk;
  v1::Stamp now{3, 20};
  double total = 0.0;
  std::string order;
  Request newest;
};

TEST_F(DeskTest, AnswersWithResults) {
  open();
  const v1::Answer answer = ask(count(3.0));
  EXPECT_EQ(answer.code, v1::ANSWER_DONE);
  EXPECT_EQ(answer.service, "registration");
  EXPECT_EQ(answer.asker, person.instance());
  EXPECT_EQ(answer.stamp.cycle, 20U);
  EXPECT_EQ(number_of(from_bus(answer).results, "total"), 3.0);
  EXPECT_EQ(newest.source, "a person");
  EXPECT_EQ(desk->refused(), 0U);
}

TEST_F(DeskTest, RefusesWhatIsNotDeclared) {
  open();
  EXPECT_EQ(ask(count(11.0)).code, v1::ANSWER_BAD_ARGUMENT);
  v1::Request request{.functor = "sing"};
  const v1::Answer answer = ask(request);
  EXPECT_EQ(answer.code, v1::ANSWER_UNKNOWN_FUNCTOR);
  EXPECT_EQ(answer.text, "functor \"sing\" is not known here: expected count, later");
  EXPECT_EQ(desk->refused(), 2U);
  EXPECT_EQ(total, 0.0);
}

TEST_F(DeskTest, SaysLaterWhatBecameOfItAndSaysItAgain) {
  open();
  const auto write_and_serve = [this] {
    writer.write({.asker = 9, .number = 1, .functor = "later"});
    serve();
  };
  write_and_serve();
  EXPECT_TRUE(desk->answer(9, 1, {AnswerCode::given_up, "too heavy", {}}));
  EXPECT_FALSE(desk->answer(9, 1, {AnswerCode::done, "", {}}));
  write_and_serve();
  const auto told = answers.take();
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0].data.code, v1::ANSWER_UNDERWAY);
  EXPECT_EQ(told[1].data.text, "too heavy");
  EXPECT_EQ(told[2].data, told[1].data);
}

TEST_F(DeskTest, InLockstepServicesAreHeardInTheSameStepAndOrderInEveryRun) {
  open(true);
  const auto write = [&](const char* source, std::uint64_t cycle, std::uint64_t number) {
    v1::Request request = count(1.0);
    request.source = source;
    request.asker = 9;
    request.number = number;
    request.stamp.epoch = now.epoch;
    request.stamp.cycle = cycle;
    writer.write(request);
  };
  write("b", 20, 1);
  write("c", 19, 2);
  write("a", 20, 3);
  serve();
  EXPECT_EQ(order, "");
  now.cycle = 21;
  serve();
  EXPECT_EQ(order, "c");
  now.cycle = 22;
  serve();
  EXPECT_EQ(order, "cab");
  write("p", 0, 4);  // without cycles: at once
  serve();
  EXPECT_EQ(order, "cabp");
}

TEST_F(DeskTest, LiveServicesAreHeardAtOnce) {
  open(false);
  v1::Request request = count(1.0);
  request.stamp.epoch = now.epoch;
  request.stamp.cycle = now.cycle;
  writer.write(request);
  serve();
  EXPECT_EQ(total, 1.0);
}

TEST_F(DeskTest, NamesTheAskerAsTheBusHasCheckedIt) {
  open();
  writer.set_sender({"flakey", "operator"});
  v1::Request request = count(1.0);
  request.asker = 5;
  request.number = 1;
  request.source = "the console";
  request.person = {"anna", "agent"};
  writer.write(request);
  auto audit = person.reader(bus::topics::kAudit);
  serve();
  const auto entries = audit.take();
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].data.act, v1::AUDIT_ASKED);
  EXPECT_EQ(entries[0].data.who, "anna at flakey (agent), the console");
  EXPECT_EQ(newest.person, (Identity{"anna at flakey", "agent"}));
  EXPECT_EQ(newest.source, "anna at flakey (agent), the console");
}

}  // namespace
}  // namespace saphira

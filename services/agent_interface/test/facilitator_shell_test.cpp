#include "agent_interface/shell/facilitator_shell.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "node_options.hpp"
#include "process.hpp"
#include "saphira/bus/agent.hpp"

namespace saphira::agent_interface {
namespace {

using std::chrono::milliseconds;

v1::Request where_is_karen() {
  v1::Request request;
  request.functor("place_of");
  request.arguments({bus::text("person", "karen"), bus::open("place")});
  return request;
}

v1::Capability place_of() {
  return bus::capability(
      "place_of", "where a person is",
      {bus::text_slot("person", "a name", true), bus::text_slot("place", "of the map")});
}

v1::Answer library(const v1::Request&) {
  return bus::done({bus::text("place", "library")});
}

/// Agents of this process, and the program, on the bus.
class OnTheBus : public testing::Test {
 protected:
  OnTheBus() : robot(test::unique_robot()) { start(); }

  void start() {
    facilitator.reset();
    facilitator = std::make_unique<test::Process>(
        std::vector<std::string>{"saphira-facilitator"}, folder.path("log"),
        std::map<std::string, std::string>{{"SAPHIRA_ROBOT", robot},
                                           {"SAPHIRA_DOMAIN", test::domain()}});
  }
  /// Asks until the answer has the wanted code: discovery of the agents takes a moment.
  v1::Answer ask_until(bus::Agent& asker, v1::AnswerCode code) {
    v1::Answer answer;
    test::wait_until([&] {
      answer = asker.ask(where_is_karen(), 2.0);
      return answer.code() == code;
    });
    return answer;
  }

  std::string robot;
  test::TempDir folder;
  std::unique_ptr<test::Process> facilitator;
};

TEST_F(OnTheBus, ARequestIsRoutedAndWhatADeadAgentCouldDoIsForgotten) {
  bus::Node node(test::node_options("person", robot));
  bus::Agent person(node, "ann", "a person");
  {
    bus::Node other(test::node_options("calendar", robot));
    bus::Agent calendar(other, "calendar", "knows where people are");
    calendar.can(place_of(), library);
    bus::Stop stop;
    std::jthread answers([&] {
      while (!stop.requested()) {
        other.wait(milliseconds(100), &stop);
        calendar.poll();
      }
    });
    const v1::Answer answer = ask_until(person, v1::ANSWER_DONE);
    EXPECT_EQ(answer.service(), "calendar");
    EXPECT_EQ(bus::text_of(answer.results(), "place"), "library");
    stop.request();
  }
  EXPECT_EQ(ask_until(person, v1::ANSWER_NOBODY).text(), "no agent can do \"place_of\"");
}

TEST_F(OnTheBus, AFacilitatorThatIsKilledIsMissedForAMomentOnly) {
  bus::Node node(test::node_options("person", robot));
  bus::Agent person(node, "ann", "a person that knows itself");
  int asked = 0;
  person.can(place_of(), [&](const v1::Request& request) {
    ++asked;
    return library(request);
  });
  ask_until(person, v1::ANSWER_DONE);
  facilitator->signal(SIGKILL);
  start();
  const v1::Answer answer = person.ask(where_is_karen(), 20.0);
  EXPECT_EQ(answer.code(), v1::ANSWER_DONE) << "the first one: " << answer.text();
  EXPECT_EQ(answer.service(), "ann");
  EXPECT_GE(asked, 2);
}

}  // namespace
}  // namespace saphira::agent_interface

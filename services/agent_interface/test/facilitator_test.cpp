// Requests where lines of requests.txt do not do.
#include "saphira/agent_interface/facilitator.hpp"

#include <gtest/gtest.h>

#include <map>

#include "saphira/base/random.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::uint64_t kSelf = 9;
constexpr std::uint64_t kPerson = 1;

Argument open_slot(const std::string& name) {
  Argument argument;
  argument.name = name;
  argument.kind = ArgumentKind::unbound;
  return argument;
}

AgentInfo agent(std::uint64_t id, const std::string& name, bool acts = false, double cost = 0.0) {
  const Functor place_of{
      "place_of",
      "where a person is",
      {text_parameter("person", "a name"), optional(text_parameter("place", "of the map"))}};
  return {id, name, "address of " + name, {{place_of, acts, cost}}};
}

Request place_of(std::uint64_t number, std::uint64_t asker = kPerson) {
  Request request;
  request.functor = "place_of";
  request.arguments = {text("person", "karen"), open_slot("place")};
  request.source = "a person";
  request.asker = asker;
  request.number = number;
  return request;
}

Request wanting(Request request, double answers) {
  request.arguments.push_back(number("answers", answers));
  return request;
}

Answer library() {
  return {AnswerCode::done, "", {text("place", "library")}};
}

TEST(Facilitators, PassOnNoAnswerThatIsNotAsDeclared) {
  const auto answered = [](const Answer& answer, bool acts) {
    Facilitator facilitator(kSelf);
    facilitator.announce(agent(1, "a", acts));
    facilitator.ask(place_of(1), 0.0);
    facilitator.step(0.0);
    facilitator.hear("address of a", kPerson, 1, answer, 0.1);
    const auto solved = facilitator.step(0.1).solved;
    EXPECT_EQ(solved.size(), 1U);
    return solved.empty() ? Answer{} : solved[0].answer;
  };
  const auto done = [](Arguments results) {
    return Answer{AnswerCode::done, "", std::move(results)};
  };
  EXPECT_EQ(answered(library(), false), library());
  for (const Answer& wrong : {done({number("place", 3.0)}), done({text("room", "library")}),
                              done({text("place",
                                         "lib\xff"
                                         "rary")}),
                              Answer{AnswerCode::done,
                                     "b\xff"
                                     "d",
                                     {}}}) {
    const Answer refused = answered(wrong, false);
    EXPECT_EQ(refused.code, AnswerCode::refused);
    EXPECT_TRUE(refused.results.empty());
    EXPECT_TRUE(refused.text.starts_with("the answer of agent a is not as it has declared: "))
        << refused.text;
    EXPECT_EQ(answered(wrong, true).code, AnswerCode::done) << "an action is done";
    EXPECT_TRUE(answered(wrong, true).results.empty());
  }
}

TEST(Facilitators, LetAFloodHurtItsSenderOnly) {
  Facilitator facilitator(kSelf);
  const auto ask = [&](const Request& request) {
    facilitator.ask(request, 0.0);
    return facilitator.step(0.0);
  };
  facilitator.announce(agent(1, "a"));
  std::size_t refused = 0;
  for (std::uint64_t i = 1; i <= 100; ++i)
    refused += ask(place_of(i)).solved.size();
  EXPECT_EQ(refused, 36u);
  EXPECT_EQ(ask(place_of(1, 2)).requests.size(), 1u);
}

Argument variable(const std::string& name, const std::string& variable) {
  Argument argument = open_slot(name);
  argument.text = variable;
  return argument;
}

/// place_of(person=karen, place=?P), go(place=?P)
Request go_to_karen(std::uint64_t number) {
  Request request = place_of(number);
  request.arguments = {text("person", "karen"), variable("place", "P"), text(kAnd, "go"),
                       variable("place", "P")};
  return request;
}

/// Agents come, go and answer at random. Each request has one end, and no more answers than wanted;
/// no agent starts an action that another one may have done.
TEST(FacilitationAtRandom, EveryRequestHasOneEnd) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const auto pick = [&](std::uint64_t n) {
      return static_cast<std::uint64_t>(random.uniform() * static_cast<double>(n)) % n;
    };
    Facilitator facilitator(kSelf);
    std::vector<Request> sent;
    std::map<std::uint64_t, int> ends;
    double now = 0.0;
    std::uint64_t made = 0;
    const auto take = [&](const Facilitator::Outputs& out) {
      for (const Request& request : out.requests) {
        sent.push_back(request);
      }
      for (const Solved& solved : out.solved)
        ends[solved.number] += ended(solved.answer.code) ? 1 : 0;
    };
    for (int step = 0; step < 300; ++step) {
      now += 0.1;
      switch (pick(6)) {
        case 0:
          facilitator.announce(agent(1 + pick(5), "a" + std::to_string(pick(5)), pick(2) == 0));
          break;
        case 1:
          facilitator.leave(1 + pick(5));
          break;
        case 2:
          facilitator.ask(wanting(place_of(++made), static_cast<double>(pick(4))), now);
          break;
        case 3: {
          Request both = go_to_karen(++made);
          both.arguments[2] = text(kAnd, "place_of");
          both.arguments[3] = variable("person", "P");
          facilitator.ask(wanting(both, static_cast<double>(pick(4))), now);
          break;
        }
        default:
          if (!sent.empty()) {
            const Request& request = sent[pick(sent.size())];
            facilitator.hear(request.service, request.asker, request.number,
                             {static_cast<AnswerCode>(pick(10)), "", {text("place", "library")}},
                             now);
          }
      }
      take(facilitator.step(now));
    }
    for (int i = 0; i < 40; ++i)  // each silent part has 10 s
      take(facilitator.step(now += 10.0));
    EXPECT_EQ(facilitator.open(), 0u);
    for (std::uint64_t request = 1; request <= made; ++request)
      EXPECT_EQ(ends[request], 1) << "seed " << seed << ", request " << request;
  }
}

}  // namespace
}  // namespace saphira::agent_interface

// The cost of a request through the facilitator: a routed request (asker, facilitator, agent,
// asker: three hops between three processes) beside a ping over the bus in the same run (two hops
// between two processes), with few agents and with many, while the robot of the demo runs.
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "bench.hpp"
#include "ping.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"
#include "support/node_options.hpp"
#include "support/quantile.hpp"

namespace {

using namespace saphira;
using saphira::bench::Child;
using Clock = std::chrono::steady_clock;

struct Options {
  unsigned agents = 200;
  unsigned capabilities = 2000;
  unsigned triggers = 1000;
  unsigned requests = 500;
  bool json = false;
  bool serve = false;
  bool echo = false;
  unsigned first = 0;
};

constexpr unsigned kProcesses = 4;  // processes for the agents
constexpr unsigned kTold = 50;      // percentage of triggers that are of time, and fire

bus::NodeOptions options(const std::string& name) {
  return test::node_options(name, std::getenv("SAPHIRA_ROBOT"));
}

std::string functor(unsigned agent, unsigned capability) {
  return "fact_" + std::to_string(agent) + "_" + std::to_string(capability);
}

/// A part of the agents, and of the triggers, in its own process: answers until it is killed.
[[noreturn]] void serve(const Options& all) {
  bus::Node node(options("agents"));
  auto announces = node.writer(bus::topics::kAgents);
  auto asked = node.reader<v1::Request>(bus::topics::kAgentRequest);
  auto answers = node.writer(bus::topics::kAgentAnswers);
  auto triggers = node.writer(bus::topics::kTriggers);
  const unsigned count = all.agents / kProcesses;
  const unsigned each = all.capabilities / all.agents;
  std::set<std::string> addresses;
  std::vector<v1::Agent> agents;
  for (unsigned i = 0; i < count; ++i) {
    v1::Agent agent{.id = all.first + i + 1};
    agent.name = "agent" + std::to_string(all.first + i);
    for (unsigned k = 0; k < each; ++k)
      agent.capabilities.push_back(bus::capability(functor(all.first + i, k),
                                                   "a fact of a benchmark",
                                                   {bus::number_slot("given", "a number", true),
                                                    bus::number_slot("found", "the same number")}));
    addresses.insert(bus::agent_address(agent.id, agent.name));
    announces.write(agent);
    agents.push_back(std::move(agent));
  }
  for (unsigned i = 0; i < all.triggers / kProcesses; ++i) {
    triggers.write({.id = {all.first + 1, i + 1},
                    .source = "a benchmark",
                    .kind = i % 100 < kTold ? v1::TRIGGER_TIME : v1::TRIGGER_EVENT,
                    .period = 60.0,
                    .condition = i % 100 < kTold ? "" : "it_happened",
                    .action = functor(all.first, 0),
                    .action_arguments = {bus::number("given", i)}});
  }
  for (;;) {
    node.wait(std::chrono::milliseconds(500));
    for (const auto& sample : asked.take()) {
      if (sample.info.disposed || !addresses.contains(sample.data.service))
        continue;
      v1::Answer answer =
          bus::done({bus::number("found", bus::number_of(sample.data.arguments, "given"))});
      answer.asker = sample.data.asker;
      answer.number = sample.data.number;
      answer.service = sample.data.service;
      answers.write(answer);
    }
    node.publish_status();
  }
}

/// Asks one after the other; returns the time of each [us].
std::vector<double> ask(bus::Node& node, bus::Agent& asker, const Options& all, unsigned agents) {
  std::vector<double> us;
  for (unsigned i = 0; i < all.requests; ++i) {
    v1::Request request{.functor = functor(i * 7 % agents, 0),
                        .arguments = {bus::number("given", i), bus::open("found")}};
    const auto begun = Clock::now();
    const v1::Answer answer = asker.ask(request, 10.0);
    const double took = std::chrono::duration<double, std::micro>(Clock::now() - begun).count();
    if (answer.code != v1::ANSWER_DONE || bus::number_of(answer.results, "found") != i)
      throw std::runtime_error(request.functor + ": " + answer.text);
    us.push_back(took);
    node.wait(std::chrono::milliseconds(10));
  }
  return us;
}

/// Waits until the last agent can be asked.
void wait_for(bus::Agent& asker, unsigned agents) {
  const auto end = Clock::now() + std::chrono::seconds(60);
  for (unsigned known = 0; known < agents;) {
    v1::Request request{.functor = functor(known, 0),
                        .arguments = {bus::number("given", 1), bus::open("found")}};
    if (asker.ask(request, 1.0).code == v1::ANSWER_DONE)
      known += agents / kProcesses;
    else if (Clock::now() > end)
      throw std::runtime_error("nobody can do " + request.functor);
  }
}

/// The late cycles of the services.
class Late {
 public:
  explicit Late(bus::Node& node) : statuses_(node.reader(bus::topics::kStatus)) {}
  std::uint64_t count() {
    for (const auto& sample : statuses_.take())
      if (!sample.info.disposed)
        late_[sample.data.instance] = sample.data.late_cycles;
    std::uint64_t sum = 0;
    for (const auto& [instance, late] : late_)
      sum += late;
    return sum;
  }

 private:
  bus::Reader<v1::ServiceStatus> statuses_;
  std::map<std::uint64_t, std::uint64_t> late_;
};

int measure(const Options& all) {
  setenv("SAPHIRA_DOMAIN", "198", 1);
  setenv("SAPHIRA_ROBOT", "bench-agents", 1);
  setenv("ROBOT_SOCKET", ("/tmp/saphira-bench-agents-" + std::to_string(getpid())).c_str(), 1);
  const Child up({"saphira", "up", "demo"});
  const Child facilitator({"saphira-facilitator"});
  bus::Node node(options("asker"));
  bus::Agent asker(node, "asker", "asks");
  Late late(node);

  const auto children = [&](unsigned agents, unsigned triggers) {
    std::vector<std::unique_ptr<Child>> made;
    for (unsigned i = 0; i < kProcesses; ++i)
      made.push_back(std::make_unique<Child>(std::vector<std::string>{
          "saphira-bench-agents", "--serve", "--agents", std::to_string(agents), "--capabilities",
          std::to_string(agents * all.capabilities / all.agents), "--triggers",
          std::to_string(triggers), "--first", std::to_string(i * agents / kProcesses)}));
    return made;
  };
  std::vector<double> few;
  {
    const auto agents = children(kProcesses, 0);
    wait_for(asker, kProcesses);
    few = ask(node, asker, all, kProcesses);
  }
  const double ping = [] {
    const Child answers({"saphira-bench-agents", "--echo"});
    bench::RoundTrip trip(bus::kOpenBus);
    for (int i = 0; i < 500; ++i) {
      usleep(10'000);
      trip.measure();
    }
    return trip.quantile(0.5);
  }();
  const auto agents = children(all.agents, all.triggers);
  wait_for(asker, all.agents);
  const std::uint64_t before = late.count();
  const std::vector<double> many = ask(node, asker, all, all.agents);
  const std::uint64_t late_cycles = late.count() - before;

  const double p50 = test::quantile(few, 0.5);
  const nlohmann::json result{{"ratio_p50", p50 / ping},
                              {"ping_p50_us", ping},
                              {"routed_p50_us", p50},
                              {"routed_p99_us", test::quantile(few, 0.99)},
                              {"many_p50_ms", test::quantile(many, 0.5) / 1000.0},
                              {"many_p99_ms", test::quantile(many, 0.99) / 1000.0},
                              {"agents", all.agents},
                              {"capabilities", all.capabilities},
                              {"triggers", all.triggers},
                              {"late", late_cycles}};
  bench::print(result, all.json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("Cost of asking by way of the facilitator");
  Options all;
  app.add_option("--agents", all.agents, "how many").in_range(4, 1000);
  app.add_option("--capabilities", all.capabilities, "of all of them");
  app.add_option("--triggers", all.triggers, "of all of them");
  app.add_option("--requests", all.requests, "to measure");
  app.add_flag("--json", all.json, "one JSON object");
  app.add_flag("--serve", all.serve, "be the agents").hidden();
  app.add_flag("--echo", all.echo, "answer the ping").hidden();
  app.add_option("--first", all.first, "of these agents").hidden();
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] {
    if (all.echo)
      bench::echo(bus::kOpenBus);
    if (all.serve)
      serve(all);
    return measure(all);
  });
}

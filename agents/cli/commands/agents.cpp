// ask and agents: requests to programs, and the list of these programs.
#include <cstdio>
#include <iostream>
#include <map>
#include <utility>

#include "commands.hpp"
#include "saphira/base/format.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/cli/talk_words.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

struct AskOptions {
  std::string functor;
  std::vector<std::string> arguments;
  std::string agent;
  int answers = 1;
  bool list = false;
  bool json = false;
  double deadline = 0.0;  // [s]; 0: none
};

// Without a deadline: until an agent says that it is at work, and then until it says so again.
constexpr double kSilence = 11.0;  // [s]

int ask(const AskOptions& ask_options, const bus::NodeOptions& options, const bus::Stop& stop) {
  v1::Request request;
  for (const std::string& word : ask_options.arguments)
    request.arguments().push_back(parse_slot(word));
  request.functor(ask_options.functor);
  request.service(ask_options.agent);
  request.deadline(ask_options.deadline);
  if (ask_options.answers != 1)
    request.arguments().push_back(bus::number("answers", ask_options.answers));

  bus::Node node(options);
  Processes processes(node);
  bus::RequestClient client(node, bus::topics::kSolve, "saphira ask");
  auto answers = node.reader(bus::topics::kSolved);
  std::string told;
  const auto tell = [&](const v1::Answer& answer) {
    const std::string text = ask_options.json ? to_json(answer) : line_of(answer);
    if (text != std::exchange(told, text))
      std::printf("%s\n", text.c_str());
  };
  const auto show = [&] {
    for (const auto& sample : answers.take())
      if (!sample.info.disposed && sample.data.asker() == node.instance() &&
          sample.data.code() == v1::ANSWER_UNDERWAY &&
          !(sample.data.text().empty() && sample.data.results().empty()))
        tell(sample.data);
  };
  const v1::Answer end = ask_program(
      kFacilitator, node, client, request,
      ask_options.deadline > 0.0 ? ask_options.deadline + 1.0 : kSilence, stop, processes, show);
  if (end.service().empty()) {
    if (ask_options.json)
      tell(end);
    std::cerr << "saphira: " << end.text();
    if (absence(node, processes, kFacilitator).empty())
      std::cerr << "; " << who_is_there(options, processes);
    std::cerr << '\n';
    return bus::kExitFailed;
  }
  show();
  tell(end);
  return bus::well(end.code()) ? bus::kExitOk : bus::kExitFailed;
}

/// The program that holds a trigger, for people; empty: unknown.
std::string holder(const bus::Census& census, const bus::WriterId& writer) {
  const std::string id = hex_text(writer);
  for (const bus::EndpointEntry& entry : census.endpoints())
    if (entry.writer && entry.id == id)
      return entry.program + ", process " + std::to_string(entry.pid) +
             (entry.host.empty() ? "" : " at " + entry.host);
  return {};
}

int list_agents(const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  Processes processes(node);
  const bus::Census census(node);
  auto agents = node.reader(bus::topics::kAgents);
  auto triggers = node.reader(bus::topics::kTriggers);
  std::map<std::uint64_t, v1::Agent> known;
  std::map<std::pair<std::uint64_t, std::uint64_t>, bus::Sample<v1::Trigger>> set;
  poll_for(node, milliseconds(1300), stop, [&] {
    processes.poll();
    keep_newest(agents, known, [](const v1::Agent& agent) { return agent.id(); });
    for (const auto& sample : triggers.take()) {
      const std::pair<std::uint64_t, std::uint64_t> id{sample.data.id().writer(),
                                                       sample.data.id().number()};
      if (sample.info.disposed)
        set.erase(id);
      else
        set[id] = sample;
    }
  });
  std::vector<v1::Agent> all;
  for (const auto& [id, agent] : known)
    all.push_back(agent);
  std::fputs(describe(all).c_str(), stdout);
  for (const auto& [id, trigger] : set) {
    const std::string held_by = holder(census, trigger.info.writer);
    std::printf("%s%s\n", describe(trigger.data, bus::describe(trigger.data.id())).c_str(),
                held_by.empty() ? "" : (" (until " + held_by + ", ends or withdraws it)").c_str());
  }
  if (!known.empty())
    return bus::kExitOk;
  const bool alone = processes.all().empty();
  const std::string absent = absence(node, processes, kFacilitator);
  (alone ? std::cerr << "saphira: " : std::cout)
      << "no agents; " << (absent.empty() ? who_is_there(options, processes) : absent) << '\n';
  return alone ? bus::kExitFailed : bus::kExitOk;
}

}  // namespace

void add_ask(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<AskOptions>();
  CLI::App* command = app.add_subcommand("ask", "Ask whichever agent can answer");
  command->add_option("functor", options->functor, "what is asked for");
  command->add_flag("--list", options->list, "what can be asked for, as saphira agents");
  command->add_option("arguments", options->arguments,
                      "name=value, or name=? for what the answer is to fill");
  command->add_option("--of", options->agent, "the agent that is meant (usual: whichever can)");
  command->add_option("--answers", options->answers, "how many are wanted; 0: of each that can")
      ->capture_default_str()
      ->check(at_least_zero());
  command
      ->add_option("--deadline", options->deadline,
                   "[s] for the answer (usual: 10 s, and while the agent says that it is at work)")
      ->check(between(0.1, 3600.0))
      ->transform(number_in_unit("s"));
  command->add_flag("--json", options->json,
                    "one JSON object for each answer: agent, code, text, values");
  command->footer("Exit code 0: it was answered; 1: it was refused or not answered, and why.");
  command->callback([options, &chosen] {
    if (options->functor.empty() != options->list)
      throw CLI::ValidationError("ask", "expected a functor, or --list");
    chosen.run = [options](const bus::NodeOptions& node, const bus::Stop& stop) {
      return options->list ? list_agents(node, stop) : ask(*options, node, stop);
    };
  });
}

void add_agents(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("agents", "The agents, what each can be asked for, and the triggers");
  command->footer(
      "A trigger lasts as long as the program that holds it: Ctrl-C for saphira write triggers.");
  chosen.when(command, [](const bus::NodeOptions& node, const bus::Stop& stop) {
    return list_agents(node, stop);
  });
}

}  // namespace saphira::cli

// ask and agents: requests to programs, and the list of these programs.
#include <cstdio>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "commands.hpp"
#include "saphira/agent_interface/facilitator.hpp"
#include "saphira/base/format.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/bus/sender.hpp"
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
constexpr double kTold = 1.0;      // [s] for the list of live triggers

/// The robots with a facilitator.
std::set<std::string> robots_with_agents(const bus::NodeOptions& options, const bus::Stop& stop) {
  const std::set<std::string> robots =
      robots_heard(options, stop, [](const bus::EndpointEntry& entry) {
        return !entry.writer && entry.topic == bus::topics::kSolve.name &&
               entry.program == kFacilitator;
      });
  if (robots.empty())
    std::cerr << "saphira: no saphira-facilitator is heard in domain " << options.domain
              << ": saphira up office has it\n";
  return robots;
}

/// robot: for people; empty: it need not be said.
int ask(const AskOptions& ask_options, const bus::NodeOptions& options, const bus::Stop& stop,
        const std::string& robot = {}) {
  std::vector<std::string> words{ask_options.functor};
  words.insert(words.end(), ask_options.arguments.begin(), ask_options.arguments.end());
  v1::Request request = parse_question(words);
  request.service = ask_options.agent;
  request.deadline = ask_options.deadline;
  if (ask_options.answers != 1)
    request.arguments.push_back(bus::number("answers", ask_options.answers));

  bus::Node node(options);
  Processes processes(node);
  bus::RequestClient client(node, bus::topics::kSolve, "saphira ask");
  const std::string in_front = robot.empty() ? "" : robot + ": ";
  v1::Answer told;
  const auto tell = [&](const v1::Answer& answer) {
    if (repeats(answer, std::exchange(told, answer)))
      return;
    const std::string text = ask_options.json ? to_json(answer, robot) : in_front + line_of(answer);
    std::printf("%s\n", text.c_str());
  };
  const auto show = [&](const v1::Answer& answer) {
    if (!bus::ended(answer.code) && !(answer.text.empty() && answer.results.empty()))
      tell(answer);
  };
  v1::Answer end = ask_program(kFacilitator, node, client, request,
                               ask_options.deadline > 0.0 ? ask_options.deadline + 1.0 : kSilence,
                               stop, processes, show);
  // The request ends with its writer.
  if (stop.requested() && end.code == v1::ANSWER_TOO_LATE)
    end.text = "withdrawn, as this command was ended: an agent at work on it is told to stop";
  if (end.service.empty()) {
    if (ask_options.json)
      tell(end);
    std::cerr << "saphira: " << in_front << end.text;
    if (!stop.requested() && absence(node, processes, kFacilitator).empty())
      std::cerr << "; " << who_is_there(processes);
    std::cerr << '\n';
    return bus::kExitFailed;
  }
  tell(end);
  return bus::well(end.code) ? bus::kExitOk : bus::kExitFailed;
}

/// Each robot's agents, one robot after another. Success: one of them has answered.
int ask_any(const AskOptions& ask_options, bus::NodeOptions options, const bus::Stop& stop) {
  int code = bus::kExitFailed;
  for (const std::string& robot : robots_with_agents(options, stop)) {
    options.robot = robot;
    if (!stop.requested() && ask(ask_options, options, stop, robot) == bus::kExitOk)
      code = bus::kExitOk;
  }
  return code;
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

int withdraw_trigger(const std::vector<std::string>& words, const bus::NodeOptions& options,
                     const bus::Stop& stop) {
  const auto id =
      words.size() == 2 && words[0] == "withdraw" ? bus::parse_goal_id(words[1]) : std::nullopt;
  if (!id)
    throw std::invalid_argument(
        "expected agents, or agents withdraw ID, such as 1f3a:2 (saphira agents lists the "
        "triggers)");
  const std::string name = bus::describe(*id);
  bus::Node node(options);
  Processes processes(node);
  bus::RequestClient client(node, bus::topics::kSolve, "saphira agents");
  auto triggers = node.writer(bus::topics::kTriggers);
  const auto live = [&] {
    return ask_program(kFacilitator, node, client, bus::request(agent_interface::kLiveTriggers),
                       5.0, stop, processes);
  };
  v1::Answer answer = live();
  if (answer.code != v1::ANSWER_DONE)
    return failed(answer.text);
  if (!is_among(name, bus::text_of(answer.results, "live")))
    return failed("no trigger " + name + " can fire: saphira agents lists them");
  v1::Trigger withdrawn{.id = *id};
  const auto begin = Clock::now();
  while (is_among(name, bus::text_of(answer.results, "live"))) {
    if (stop.requested() || seconds_since(begin) > 5.0)
      return failed("the facilitator has not taken the withdrawal");
    triggers.dispose(withdrawn);
    node.wait(milliseconds(50), &stop);
    answer = live();
  }
  std::printf("withdrawn: it fires no more\n");
  return bus::kExitOk;
}

int list_one(const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  Processes processes(node);
  const bus::Census census(node);
  auto agents = node.reader(bus::topics::kAgents);
  auto triggers = node.reader(bus::topics::kTriggers);
  std::map<std::uint64_t, v1::Agent> known;
  std::map<std::pair<std::uint64_t, std::uint64_t>, bus::Sample<v1::Trigger>> set;
  poll_for(node, listening_time(node), stop, [&] {
    processes.poll();
    for (auto& sample : agents.take()) {
      v1::Agent& agent = sample.data;
      if (sample.info.disposed) {
        known.erase(agent.id);
        continue;
      }
      // A program may call itself as it likes, also "robot": its certificate's member is said too.
      const Checked member = bus::asker_of(sample.info);
      if (member && member->role != "services" && member->role != "robot")
        agent.name = named(agent.name, member);
      known[agent.id] = std::move(agent);
    }
    for (const auto& sample : triggers.take()) {
      const std::pair<std::uint64_t, std::uint64_t> id{sample.data.id.writer,
                                                       sample.data.id.number};
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
  std::optional<std::string> live;  // unknown without a facilitator
  std::vector<v1::Argument> told;
  if (!set.empty()) {
    bus::RequestClient client(node, bus::topics::kSolve, "saphira agents");
    const v1::Answer answer =
        client.ask(bus::request(agent_interface::kLiveTriggers), kTold, &stop);
    told = answer.results;
    if (answer.code == v1::ANSWER_DONE)
      live = bus::text_of(told, "live");
  }
  for (const auto& [id, trigger] : set) {
    const std::string name = bus::describe(trigger.data.id);
    const std::string held_by = holder(census, trigger.info.writer);
    std::printf(
        "%s%s\n",
        describe(trigger.data, name, !live || is_among(name, *live), bus::text_of(told, name))
            .c_str(),
        held_by.empty() ? "" : (" (until " + held_by + ", ends or withdraws it)").c_str());
  }
  if (!known.empty())
    return bus::kExitOk;
  const std::string absent = absence(node, processes, kFacilitator);
  return nothing_there("agents", processes, absent.empty() ? who_is_there(processes) : absent);
}

/// Of every robot, one after another. Success: one has agents.
int list_agents(bus::NodeOptions options, const bus::Stop& stop) {
  if (options.robot != kEveryRobot)
    return list_one(options, stop);
  int code = bus::kExitFailed;
  for (const std::string& robot : robots_with_agents(options, stop)) {
    options.robot = robot;
    std::printf("%s:\n", called(robot).c_str());
    if (!stop.requested() && list_one(options, stop) == bus::kExitOk)
      code = bus::kExitOk;
  }
  return code;
}

}  // namespace

void add_ask(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<AskOptions>();
  CLI::App* command = app.add_subcommand("ask", "Ask whichever agent can answer");
  chosen.reach[command] = {"ask"};
  command->add_option("functor", options->functor,
                      "what is asked for; or FUNCTOR(name=value, ...), perhaps several");
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
  command->footer(
      "Several are asked in turn, and share their variables: "
      "'place_of(person=karen, place=?P)' 'go-to-place(place=?P)'.\n"
      "Where one has no answer, a further answer of the one before is tried. Only the last may be "
      "an action.\n"
      "--robot '*': the agents of each robot, with the robot's name; several robots may act then.\n"
      "Exit code 0: it was answered; 1: it was refused or not answered, and why.");
  command->callback([options, &chosen] {
    if (options->functor.empty() != options->list)
      throw CLI::ValidationError("ask", "expected a functor, or --list");
    chosen.run = [options](const bus::NodeOptions& node, const bus::Stop& stop) {
      if (options->list) {
        const int code = list_agents(node, stop);
        std::printf(
            "other requests have commands of their own: saphira goal activities, saphira device "
            "list, saphira map --help\n");
        return code;
      }
      return node.robot == kEveryRobot ? ask_any(*options, node, stop) : ask(*options, node, stop);
    };
  });
}

void add_agents(CLI::App& app, Chosen& chosen) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      app.add_subcommand("agents", "The agents, what each can be asked for, and the triggers");
  chosen.reach[command] = {"agents", [words] { return words->empty(); }};
  command->add_option("words", *words, "withdraw ID: that trigger fires no more");
  command->footer(
      "A trigger lasts as long as the program that holds it: Ctrl-C for saphira write triggers.");
  chosen.when(command, [words](const bus::NodeOptions& node, const bus::Stop& stop) {
    return words->empty() ? list_agents(node, stop) : withdraw_trigger(*words, node, stop);
  });
}

}  // namespace saphira::cli

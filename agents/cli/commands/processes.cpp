// processes: the micro-tasks of the services (manual 2.3.7 and 6.5).
#include <cstdio>
#include <stdexcept>

#include "commands.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/displays.hpp"
#include "saphira/watch/mind.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;
using watch::Mind;

constexpr milliseconds kProcessesListen{1300};  // the status comes once a second
constexpr double kAnswerPatience = 4.0;         // [s] for an answer

struct ProcessesOptions {
  std::vector<std::string> words;
  std::uint32_t cycles = 0;
};

int list_processes(const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  Mind mind(node, false);
  mind.listen(kProcessesListen, stop);
  const std::string text = processes_table(mind.services());
  if (text.empty())
    return failed("no service tells its processes; " + who_is_there(mind.processes()));
  std::fputs(text.c_str(), stdout);
  return bus::kExitOk;
}

int ask(const ProcessesOptions& asked, const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  Mind mind(node, false);
  bus::RequestClient services(node, bus::topics::kProcessRequest, "saphira processes");
  v1::Request request =
      bus::request(asked.words[0], {bus::text("process", asked.words[2])}, asked.words[1]);
  if (asked.words[0] == "suspend")
    request.arguments.push_back(bus::number("cycles", asked.cycles));
  const v1::Answer answer = services.ask(request, kAnswerPatience, &stop, [&] { mind.poll(); });
  if (bus::well(answer.code)) {
    // Its state is published in the cycle after that.
    mind.listen(milliseconds(300), stop);
    std::fputs(processes_table(mind.services()).c_str(), stdout);
    return bus::kExitOk;
  }
  std::string names;
  bool there = !answer.service.empty();  // it may answer before its processes are discovered
  for (const v1::ProcessSet& service : mind.services()) {
    names += (names.empty() ? "" : ", ") + service.service;
    there = there || service.service == request.service;
  }
  return failed(there ? answer.text
                      : "no service " + request.service + " with processes; there are " +
                            (names.empty() ? "none" : names));
}

int processes(const ProcessesOptions& asked, const bus::NodeOptions& options,
              const bus::Stop& stop) {
  const auto& words = asked.words;
  if (words.empty())
    return list_processes(options, stop);
  const bool action = words[0] == "interrupt" || words[0] == "resume" || words[0] == "suspend";
  if (!action || words.size() != 3)
    throw std::invalid_argument(
        "expected processes, or processes interrupt | resume | suspend SERVICE PROCESS" +
        (action
             ? ""
             : ", found " + words[0] + did_you_mean(words[0], {"interrupt", "resume", "suspend"})));
  return ask(asked, options, stop);
}

}  // namespace

void add_processes(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<ProcessesOptions>();
  CLI::App* command =
      app.add_subcommand("processes", "The micro-tasks of the services: list, interrupt, resume");
  command->add_option("words", options->words, "interrupt | resume | suspend SERVICE PROCESS");
  command->add_option("--cycles", options->cycles, "suspend: for so many cycles, not until resumed")
      ->check(whole<std::uint32_t>());
  command->footer(
      "Of the service intentions also an intention, by its name or number (saphira intentions).\n"
      "An interrupted process cleans up and waits until it is resumed.");
  chosen.when(command, options, processes);
}

}  // namespace saphira::cli

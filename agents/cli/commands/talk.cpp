// say, talk and knows: talking to the robot, and its knowledge from that.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "commands.hpp"
#include "input_lines.hpp"
#include "saphira/agent_interface/grammar.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/cli/talk_words.hpp"
#include "saphira/situation/words.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr const char* kDialogue = "dialogue";
constexpr double kSilence = 5.0;  // [s] for the first answer
constexpr double kOther = 3.0;    // [s] for that of another program than saphira-dialogue

struct SayOptions {
  std::vector<std::string> words;
  std::string speaker;
  bool quick = false;
};

struct TalkOptions {
  std::string speaker;
  std::string grammar = "flakey";
};

std::string user() {
  const char* const name = std::getenv("USER");
  return name == nullptr ? "" : name;  // empty: a person whom the robot does not know
}

/// The reason why a sentence got no answer; empty while one may still come. `silence`: [s] since it
/// was said. `advice`: where the dialogue hears it.
std::string no_answer(const bus::Node& node, const Processes& processes,
                      const bus::Writer<v1::Utterance>& writer, double silence,
                      const std::string& advice) {
  const std::string absent = absence(node, processes, kDialogue);
  if (!absent.empty() && (writer.matched() == 0 || silence > kOther))
    return "nothing was answered: " + absent +
           (is_heard(processes.all(), "bridge") ? "; saphira goal stop stops the robot without it"
                                                : "");
  if (silence < kSilence)
    return {};
  return "nothing was answered. " +
         (watch::is_recording(processes) ? who_is_there(processes) : advice);
}

/// Prints all utterances to and by the robot, as they come.
int listen(const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  auto heard = node.reader(bus::topics::kHeard);
  auto said = node.reader(bus::topics::kSaid);
  const auto began = Clock::now();
  const auto is_new = [&](const bus::Sample<v1::Utterance>& sample) {
    return !sample.info.disposed &&
           is_for(sample.data, sample.info.age, node.instance(), seconds_since(began));
  };
  while (!stop.requested()) {
    for (const auto& sample : heard.take())
      if (is_new(sample))
        print("%s\n", line_of(sample.data).c_str());
    for (const auto& sample : said.take())
      if (is_new(sample))
        print("%s\n", line_of(sample.data, options.robot).c_str());
    std::fflush(stdout);
    if (std::ferror(stdout) != 0)
      return bus::kExitOk;  // the reader of our output has left
    node.wait(milliseconds(500), &stop);
  }
  return bus::kExitOk;
}

/// Listeners, pages and recordings that were on the bus before have heard the sentence.
void wait_for_listeners(bus::Node& node, bus::Writer<v1::Utterance>& writer,
                        Clock::time_point began, const bus::Stop& stop) {
  while (!stop.requested() && Clock::now() - began < listening_time(node))
    node.wait(milliseconds(50), &stop);
  writer.wait_acknowledged(500);
}

int say(const SayOptions& say_options, const bus::NodeOptions& options, const bus::Stop& stop) {
  if (say_options.words.empty())
    return listen(options, stop);
  bus::Node node(options);
  Processes processes(node);
  auto writer = node.writer(bus::topics::kHeard);
  auto said = node.reader(bus::topics::kSaid);
  const v1::Utterance utterance = situation::typed(
      node.instance(), 1, say_options.speaker.empty() ? user() : say_options.speaker,
      joined(say_options.words, " "), unix_time());
  writer.write(utterance);
  print("%s\n", line_of(utterance).c_str());
  const auto began = Clock::now();
  bool answered = false;
  int code = bus::kExitFailed;  // that of the newest reply
  while (!stop.requested()) {
    node.wait(milliseconds(200), &stop);
    processes.poll();
    for (const auto& sample : said.take()) {
      if (sample.info.disposed || sample.data.answers.writer != node.instance())
        continue;
      answered = true;
      code = sample.data.refused ? bus::kExitFailed : bus::kExitOk;
      print("%s\n", line_of(sample.data, options.robot).c_str());
      std::fflush(stdout);
      if (sample.data.end || say_options.quick) {
        wait_for_listeners(node, writer, began, stop);
        return code;
      }
    }
    if (answered)
      continue;
    if (const std::string why =
            no_answer(node, processes, writer, seconds_since(began),
                      "A sentence for the robot begins with its keyword, such as \"Flakey, stop\"");
        !why.empty()) {
      complain("saphira: %s\n", why.c_str());
      return code;
    }
  }
  return code;
}

/// The sentence, addressed to the robot. A reply to its question needs no keyword.
std::string with_keyword(const std::string& line, const agent_interface::Grammar& grammar,
                         bool asked) {
  const agent_interface::Grammar::Understood understood = grammar.understand(line, asked);
  if (understood.addressed || !understood.meanings.empty() || grammar.keywords().empty())
    return line;
  return grammar.keywords().front() + ", " + line;
}

/// Each line of the input is said to the robot, and the robot's words are printed.
int talk(const TalkOptions& talk_options, const bus::NodeOptions& options, const bus::Stop& stop) {
  const agent_interface::Grammar grammar(read_file(talk_options.grammar), talk_options.grammar);
  const std::string speaker = talk_options.speaker.empty() ? user() : talk_options.speaker;
  const bool terminal = isatty(STDIN_FILENO) == 1;  // which shows what is typed
  bus::Node node(options);
  Processes processes(node);
  auto writer = node.writer(bus::topics::kHeard);
  auto said = node.reader(bus::topics::kSaid);
  InputLines input;
  const auto began = Clock::now();
  auto spoke = began;
  std::uint64_t number = 0;  // of the newest sentence
  bool answered = true;      // the newest sentence
  bool over = true;          // with all that it led to
  bool asked = false;        // the robot's newest words are a question
  int code = bus::kExitOk;
  while (!stop.requested() && !out().closed() && !(input.ended() && (terminal ? answered : over))) {
    node.wait(milliseconds(50), &stop);
    processes.poll();
    for (const auto& sample : said.take()) {
      const bool ours = sample.data.answers.writer == node.instance();
      if (sample.info.disposed ||
          !is_for(sample.data, sample.info.age, node.instance(), seconds_since(began)))
        continue;
      const std::string& text = sample.data.text;
      asked = text.ends_with("?") && !text.starts_with("what?");
      print("%s\n", line_of(sample.data, options.robot).c_str());
      if (!ours || sample.data.answers.number != number)
        continue;
      answered = true;
      over = over || sample.data.end;
      code = sample.data.refused ? bus::kExitFailed : bus::kExitOk;
    }
    while (const auto line = input.next()) {
      const v1::Utterance utterance = situation::typed(
          node.instance(), ++number, speaker, with_keyword(*line, grammar, asked), unix_time());
      writer.write(utterance);
      if (!terminal)
        print("%s\n", line_of(utterance).c_str());
      answered = over = false;
      spoke = Clock::now();
    }
    if (answered)
      continue;
    const std::string why = no_answer(node, processes, writer, seconds_since(spoke),
                                      "Its grammar may be another one: --grammar");
    if (why.empty())
      continue;
    complain("saphira: %s\n", why.c_str());
    answered = over = true;
    code = bus::kExitFailed;
  }
  return code;
}

/// Waits for the robot's knowledge on the bus; nothing where none comes within kSilence, or the
/// dialogue is not there.
std::optional<v1::Knowledge> known(bus::Node& node, Processes& processes, const bus::Stop& stop) {
  auto reader = node.reader(bus::topics::kKnows);
  std::optional<v1::Knowledge> knowledge;
  wait_for(node, std::chrono::duration<double>(kSilence), stop, [&] {
    processes.poll();
    knowledge = reader.take_newest();
    return knowledge || !absence(node, processes, kDialogue).empty();
  });
  return knowledge;
}

int knows(const std::vector<std::string>& words, const bus::NodeOptions& options,
          const bus::Stop& stop) {
  char* end = nullptr;
  const double number = words.size() == 2 ? std::strtod(words[1].c_str(), &end) : 0.0;
  if (!words.empty() && (words[0] != "forget" || number < 1.0 || end == nullptr || *end != '\0'))
    throw std::invalid_argument(
        "expected knows, or knows forget NUMBER (saphira knows lists them)");
  bus::Node node(options);
  Processes processes(node);
  if (words.empty()) {
    const auto knowledge = known(node, processes, stop);
    if (!knowledge) {
      const std::string absent = absence(node, processes, kDialogue);
      return failed("no program tells the robot's knowledge; " +
                    (absent.empty() ? who_is_there(processes) : absent));
    }
    std::fputs(knowledge_table(*knowledge).c_str(), stdout);
    return bus::kExitOk;
  }
  bus::RequestClient client(node, bus::topics::kSolve, "saphira knows");
  const v1::Answer answer = ask_program(
      kFacilitator, node, client,
      bus::request("forget", {bus::number("number", number)}, kDialogue), 10.0, stop, processes);
  std::printf("%s\n", answer.text.c_str());
  return bus::well(answer.code) ? bus::kExitOk : bus::kExitFailed;
}

}  // namespace

void add_say(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<SayOptions>();
  CLI::App* command =
      app.add_subcommand("say", "Say something to the robot; without words: hear what is said");
  command->add_option("words", options->words, "such as \"Flakey, go to EJ-231\"");
  command->add_option("--as", options->speaker, "who says it (usual: your name here)");
  command->add_flag("--quick", options->quick, "do not wait for the end of what it does");
  command->footer(
      "Sentences that are understood: config/grammars/flakey.grammar.\n"
      "Exit code 0: the robot answered the question, or does as it was told (also if that fails "
      "later); 1: it asked\n"
      "back (\"what?\"), refused, or did not answer.\n"
      "Ctrl-C ends the command, not what the robot does: say \"Flakey, stop\" for that.");
  chosen.when(command, options, say);
}

void add_talk(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<TalkOptions>();
  CLI::App* command =
      app.add_subcommand("talk", "Talk with the robot: each line of the input is said to it");
  command->add_option("--as", options->speaker, "who says it (usual: your name here)");
  command
      ->add_option("--grammar", options->grammar,
                   "the robot's: a name of config/grammars, or a file")
      ->capture_default_str();
  command->footer(
      "A line without the keyword of the grammar gets it in front; replies to a question of the "
      "robot do not need it.\n"
      "Ends with the input, or with Ctrl-C; without a terminal, when all is done that the last "
      "line led to.\n"
      "Exit code 0: the robot did as the last line said, or answered it; 1: it asked back, "
      "refused, "
      "or did not answer.");
  command->callback([options, &chosen] {
    try {
      options->grammar = find_file(config_folder() + "/grammars", options->grammar, ".grammar");
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError("--grammar", error.what());
    }
    chosen.run = [options](const bus::NodeOptions& node, const bus::Stop& stop) {
      return talk(*options, node, stop);
    };
  });
}

void add_knows(CLI::App& app, Chosen& chosen) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("knows", "Facts that the robot was told, and by whom");
  command->add_option("words", *words, "forget NUMBER: takes one back");
  chosen.when(command, words, knows);
}

}  // namespace saphira::cli

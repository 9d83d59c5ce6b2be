// intentions, behaviors, why and beliefs: the robot's reasoning.
#include <unistd.h>

#include <cstdio>
#include <stdexcept>
#include <string>

#include "commands.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/cli/displays.hpp"
#include "saphira/intentions/value.hpp"
#include "saphira/situation/why.hpp"
#include "saphira/watch/inquiry.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;
using watch::Inquiry;
using watch::kMindPatience;
using watch::Mind;

constexpr milliseconds kOthers{300};  // for programs that are discovered after the services
constexpr double kRest = 0.5;         // [s] by then schemas and programs have come as well

struct WatchOptions {
  bool once = false;
  bool watch = false;
  /// On a terminal the display is repeated, as in the windows of the manual.
  bool live() const { return !once && (watch || isatty(STDOUT_FILENO) != 0); }
};

void add_watch_options(CLI::App& command, WatchOptions& options) {
  command.add_flag("--once", options.once, "as it is now, also on a terminal");
  command.add_flag("--watch,-w", options.watch, "again and again, also into a file");
}

int nobody(const Mind& mind, const std::string& what) {
  return failed("nothing is said about " + what + "; " + who_is_there(mind.processes()));
}

/// Shows the result of `draw`, once or repeatedly: `draw` returns nothing until there is something
/// to show. A text in `refused` before that ends it: there will be nothing.
template <class Draw>
int show(const bus::NodeOptions& options, const bus::Stop& stop, const WatchOptions& watch,
         const std::string& what, Draw draw, const std::string& refused = {}) {
  bus::Node node(options);
  Mind mind(node, false);
  std::optional<std::string> text;
  const auto began = Clock::now();
  while (!stop.requested() && !text) {
    mind.listen(milliseconds(50), stop);
    text = draw(mind);
    if (!refused.empty())
      return failed(refused);
    if (!text && seconds_since(began) > kMindPatience)
      return nobody(mind, what);
  }
  if (!watch.live() && text) {
    mind.listen(kOthers, stop);
    text = draw(mind);
    std::fputs(text->c_str(), stdout);
    return bus::kExitOk;
  }
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  std::string shown;
  auto changed = Clock::now();
  while (!stop.requested()) {
    if (text && *text != shown) {
      shown = *text;
      changed = Clock::now();
      if (terminal) {
        // Overwrites the old picture line by line: clearing first would flicker.
        std::string screen = "\x1b[H";
        for (const char c : shown)
          screen += c == '\n' ? "\x1b[K\n" : std::string(1, c);
        std::fputs((screen + "\x1b[J").c_str(), stdout);
      } else {
        std::fputs((shown + "\n").c_str(), stdout);
      }
      std::fflush(stdout);
      if (std::ferror(stdout) != 0)
        return bus::kExitOk;  // the reader of our output has left
    }
    mind.listen(milliseconds(200), stop);
    text = draw(mind);
  }
  return bus::kExitOk;
}

std::string header(const v1::Stamp& stamp, const Mind& mind) {
  const std::string holds = mind.grant() == nullptr ? "" : latched(*mind.grant());
  return "cycle " + std::to_string(stamp.cycle) + (holds.empty() ? "" : "  " + holds) + "\n";
}

/// Heading of the display of a program with its own behaviors.
std::string of_program(const v1::ProgramMind& program) {
  return "\nof the program " + program.source + ":\n";
}

int intentions(const WatchOptions& watch, const bus::NodeOptions& options, const bus::Stop& stop) {
  return show(
      options, stop, watch, "intentions", [](const Mind& mind) -> std::optional<std::string> {
        const v1::Intentions* const newest = mind.intentions();
        if (newest == nullptr)
          return std::nullopt;
        std::string text =
            header(newest->stamp, mind) + intentions_display(*newest, mind.behaviors());
        for (const v1::ProgramMind* const program : mind.programs())
          text += of_program(*program) + intentions_display(program->intended, &program->behaviors);
        return text;
      });
}

/// The window of a behavior with that name or schema; nothing: it is not among these, whose names
/// are added to `names`.
std::optional<std::string> find_behavior(const std::string& name, const v1::BehaviorSet& behaviors,
                                         const v1::Intentions* intentions, const Mind& mind,
                                         std::vector<std::string>& names) {
  for (const v1::BehaviorState& state : behaviors.behaviors) {
    names.push_back(without_instance(state.name));
    if (state.name != name && state.schema != name && names.back() != name &&
        instance_words(state.name) != name)
      continue;
    const v1::IntendedBehavior* intended = nullptr;
    if (intentions != nullptr)
      for (const v1::IntendedBehavior& one : intentions->behaviors)
        if (one.name == state.name)
          intended = &one;
    return behavior_display(state, intended, mind.schema(state.schema));
  }
  return std::nullopt;
}

/// Nothing: no samples yet. `unknown`: why there is no behavior of that name; empty where it is.
std::optional<std::string> behaviors_text(const std::string& name, const Mind& mind,
                                          std::string& unknown) {
  unknown.clear();
  const v1::BehaviorSet* const newest = mind.behaviors();
  const std::vector<const v1::ProgramMind*> programs = mind.programs();
  if (newest == nullptr && programs.empty())
    return std::nullopt;
  std::string text = header(newest != nullptr ? newest->stamp : programs.front()->stamp, mind);
  if (name.empty()) {
    text += newest != nullptr ? behaviors_display(*newest) : "";
    for (const v1::ProgramMind* const program : programs)
      text += of_program(*program) + behaviors_display(program->behaviors);
    return text;
  }
  std::vector<std::string> names;
  if (newest != nullptr)
    if (const auto found = find_behavior(name, *newest, mind.intentions(), mind, names))
      return text + *found;
  for (const v1::ProgramMind* const program : programs)
    if (const auto found = find_behavior(name, program->behaviors, &program->intended, mind, names))
      return text + *found;
  if (const v1::BehaviorSchema* const schema = mind.schema(name))
    return text + schema_display(*schema);
  if (mind.schemas() != nullptr)
    for (const v1::BehaviorSchema& schema : mind.schemas()->schemas)
      names.push_back(schema.name);
  unknown = unknown_behavior(name, names);
  return text + unknown + "\n";
}

int behaviors(const std::string& name, const WatchOptions& watch, const bus::NodeOptions& options,
              const bus::Stop& stop) {
  std::string unknown;
  std::string refused;
  bool found = false;  // once: a behavior can end while it is shown
  std::optional<Clock::time_point> began;
  const auto draw = [&](const Mind& mind) -> std::optional<std::string> {
    std::optional<std::string> text = behaviors_text(name, mind, unknown);
    found = found || (text && unknown.empty());
    if (!text || found)
      return text;
    if (!began)
      began = Clock::now();
    if (seconds_since(*began) > kRest)
      refused = unknown;
    return std::nullopt;
  };
  return show(options, stop, watch, "behaviors", draw, refused);
}

using situation::Explanation;
using situation::parse_wish;
using situation::Wish;

struct WhyOptions {
  std::vector<std::string> words;
  std::int64_t cycle = 0;
  bool json = false;
};

int why(const WhyOptions& why_options, const bus::NodeOptions& options, const bus::Stop& stop) {
  std::vector<std::string> words = why_options.words;
  std::optional<Wish> wish;
  if (!words.empty()) {
    const bool negated = words.front() == "not";
    words.erase(words.begin());
    wish = negated ? parse_wish(words) : std::nullopt;
    if (!wish)
      throw std::invalid_argument(
          "expected why, or why not turn left | turn right | faster | slower");
  }
  bus::Node node(options);
  Inquiry inquiry(node, why_options.cycle);
  while (!stop.requested() && !inquiry.poll())
    node.wait(milliseconds(50), &stop);
  if (stop.requested())
    return bus::kExitFailed;
  if (const std::string missing = inquiry.missing(); !missing.empty())
    return failed(missing);
  const situation::Situation known = inquiry.situation();
  const Explanation explanation = wish ? why_not(known, *wish) : situation::why(known);
  std::fputs((why_options.json ? to_json(explanation) + "\n" : to_text(explanation)).c_str(),
             stdout);
  return bus::kExitOk;
}

struct BeliefOptions {
  std::vector<std::string> words;
  WatchOptions watch;
  bool hold = false;
};

constexpr const char* kClaimant = "saphira beliefs";

/// This command's claim for a name. It is one instance for all users: the next claim changes it,
/// and unset finds it. A held claim gets an instance of its own (see claim()).
v1::BeliefClaim claim_of(const std::string& name) {
  Fnv1a hash;
  hash.add(kClaimant + (" " + name));
  return {.id = {hash.value(), 1}, .source = kClaimant, .name = name};
}

/// The belief of that name from this command's claim; nullptr: none.
const v1::Belief* claimed(const Mind& mind, const std::string& name) {
  if (mind.beliefs() != nullptr)
    for (const v1::Belief& belief : mind.beliefs()->beliefs)
      if (belief.name == name && belief.said_by.find(kClaimant) != std::string::npos)
        return &belief;
  return nullptr;
}

int unset(const std::string& name, const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  Mind mind(node, false);
  auto writer = node.writer(bus::topics::kBeliefClaims);
  const v1::BeliefClaim sample = claim_of(name);
  const auto began = Clock::now();
  bool taken_back = false;
  while (!stop.requested() && seconds_since(began) < kMindPatience) {
    mind.listen(milliseconds(300), stop);
    if (mind.beliefs() == nullptr)
      continue;
    if (claimed(mind, name) == nullptr) {
      if (taken_back)
        return bus::kExitOk;
      return failed("nobody has said " + name + " with saphira beliefs set");
    }
    // Repeated: a reader that discovers the writer after the disposal would get nothing.
    if (writer.matched() > 0)
      taken_back = writer.dispose(sample) || taken_back;
  }
  return failed("it is still taken for true; " + who_is_there(mind.processes()));
}

void check_value(const std::string& value) {
  try {
    intentions::parse_value(value);
  } catch (const FileError& error) {
    throw std::invalid_argument(error.what());
  }
}

int claim(const std::string& name, const std::string& value, bool hold,
          const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  Mind mind(node, false);
  auto writer = node.writer(bus::topics::kBeliefClaims);
  v1::BeliefClaim sample = claim_of(name);
  if (hold)
    sample.id.writer = node.instance();
  sample.value = value;
  sample.writer_lost = hold ? v1::WRITER_LOST_CANCEL : v1::WRITER_LOST_KEEP;
  const auto began = Clock::now();
  std::optional<std::uint64_t> before;  // [cycle] of the earlier claim, if any
  bool written = false;
  while (!stop.requested()) {
    mind.listen(milliseconds(100), stop);
    const v1::Belief* const belief = claimed(mind, name);
    if (!written && mind.beliefs() != nullptr) {
      if (belief != nullptr)
        before = belief->since;
      written = writer.write(sample);
      continue;
    }
    // In the service's notation: 1 may have become 1.0.
    if (written && belief != nullptr && belief->since != before) {
      std::printf("%s = %s, said by %s\n", name.c_str(), belief->value.c_str(),
                  belief->said_by.c_str());
      std::fflush(stdout);
      while (hold && !stop.requested())
        mind.listen(std::chrono::seconds(1), stop);
      if (hold) {
        writer.dispose(sample);
        writer.wait_acknowledged(1000);
      }
      return bus::kExitOk;
    }
    if (seconds_since(began) > kMindPatience)
      return failed("nobody has taken it for true (saphira log says why); " +
                    who_is_there(mind.processes()));
  }
  return bus::kExitFailed;
}

int beliefs(const BeliefOptions& belief_options, const bus::NodeOptions& options,
            const bus::Stop& stop) {
  const auto& words = belief_options.words;
  if (!words.empty() && words[0] == "set") {
    if (words.size() != 3 || words[1].empty())
      throw std::invalid_argument(
          "expected beliefs set NAME VALUE, such as beliefs set door-open t");
    check_value(words[2]);
    return claim(words[1], words[2], belief_options.hold, options, stop);
  }
  if (words.size() == 2 && words[0] == "unset")
    return unset(words[1], options, stop);
  if (words.size() > 1)
    throw std::invalid_argument(
        "expected beliefs, beliefs NAME, beliefs set NAME VALUE, or beliefs unset NAME");
  const std::string part = words.empty() ? "" : words[0];
  return show(options, stop, belief_options.watch, "beliefs",
              [&](const Mind& mind) -> std::optional<std::string> {
                if (mind.beliefs() == nullptr)
                  return std::nullopt;
                const std::string text = beliefs_table(*mind.beliefs(), part);
                return text.empty()
                           ? "nothing is believed" + (part.empty() ? "" : " of " + part) + "\n"
                           : text;
              });
}

}  // namespace

void add_intentions(CLI::App& app, Chosen& chosen) {
  auto watch = std::make_shared<WatchOptions>();
  CLI::App* command =
      app.add_subcommand("intentions", "Intentions of the robot, as a tree down to the behaviors");
  add_watch_options(*command, *watch);
  command->footer(
      "* waits for what is below it, o goes on beside it; then the schema, (the instance), "
      "and B for a behavior.");
  chosen.when(command, watch, intentions);
}

void add_behaviors(CLI::App& app, Chosen& chosen) {
  auto watch = std::make_shared<WatchOptions>();
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("behaviors", "Outputs of the behaviors, and their blend");
  command->add_option("name", *name, "one behavior: its parameters, rules and fuzzy variables");
  add_watch_options(*command, *watch);
  command->footer(
      "* runs, o does not. On both channels the bar = is how active a behavior is, and < or > "
      "which\n"
      "way it wants to turn, or back or ahead; at the bottom what the robot is told.");
  chosen.when(command, [watch, name](const bus::NodeOptions& node, const bus::Stop& stop) {
    return behaviors(*name, *watch, node, stop);
  });
}

void add_why(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<WhyOptions>();
  CLI::App* command =
      app.add_subcommand("why", "Why the robot does what it does, from the wheels to the goal");
  command->add_option("words", options->words,
                      "not turn left | not turn right | not faster | not slower");
  command->add_option("--cycle", options->cycle,
                      "of the last minute: its number, or -N for N cycles ago");
  command->add_flag("--json", options->json, "one JSON object");
  chosen.when(command, options, why);
}

void add_beliefs(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<BeliefOptions>();
  CLI::App* command = app.add_subcommand("beliefs", "Beliefs of the activities, and who said them");
  command->add_option("words", options->words, "[part of a] NAME | set NAME VALUE | unset NAME");
  command->add_flag("--hold", options->hold, "set: until Ctrl-C, and then take it back");
  add_watch_options(*command, options->watch);
  command->footer("Values as in activities: t, nil, 2.5, \"text\", (a b).");
  chosen.when(command, options, beliefs);
}

}  // namespace saphira::cli

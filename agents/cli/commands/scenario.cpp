// The paper's story (4.6): people tell the robot where they are, and send it for a report.
#include <cstdio>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "environment.hpp"
#include "run_folder.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/deployment.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/cli/supervisor.hpp"
#include "saphira/cli/trace.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/maps/topology.hpp"
#include "story/shell/story.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr std::size_t kKeptLines = 40;
constexpr double kStart = 60.0;  // [s] for the start of the programs

struct ScenarioOptions {
  std::vector<std::string> casts{"introduction"};
  std::uint64_t seed = 1;
  std::uint64_t seeds = 1;
  double rate = 1.0;
  double time_limit = 1200.0;
  bool lockstep = false;
  bool json = false;
  std::string audio;  ///< a folder for the dialogue as sound; empty: none
};

/// One story, with one seed.
struct Run {
  std::string cast;  ///< a file
  std::uint64_t seed = 1;
  std::string folder;  ///< for sockets and the trace
  story::Cast people() const { return {read_file(cast), cast}; }

  std::string trace() const { return folder + "/trace.csv"; }
};

/// The end of a story.
struct Ending {
  bool well = false;        ///< as the cast requires
  std::string handed_over;  ///< as the people know it: "alice has the report"; empty: nothing
  double time = 0.0;        ///< [s] of the robot
  std::uint64_t utterances = 0;
  std::string hash;  ///< of the dialogue
  Track track;
  std::string said;  ///< "speaker: text" a line
};

void show(const Kept& kept, const std::string& trouble) {
  complain("saphira: %s; the last that the programs said:\n", trouble.c_str());
  for (const std::string& line : kept.lines())
    complain("  %s\n", line.c_str());
}

Places places_of(const Run& run) {
  Places places = find_places();
  places.run = run.folder;
  return places;
}

Deployment deployment_of(const Run& run, const bus::NodeOptions& node, const Places& places) {
  const story::Cast people = run.people();
  Deployment deployment = own_deployment(people.deployment(), places, node, false);
  // The simulator is the deployment's first program.
  std::vector<Placed>& simulator = deployment.programs.at(0).arguments;
  simulator.insert(simulator.end(), {Placed{"--trace"}, Placed{run.trace()}});
  if (!people.things().empty())
    simulator.insert(simulator.end(), {Placed{"--things"}, Placed{people.things()}});
  return deployment;
}

std::vector<ChildSpec> programs(const ScenarioOptions& options, const Run& run,
                                const bus::NodeOptions& node) {
  const Places places = places_of(run);
  return command_lines_on(
      node, deployment_of(run, node, places), places,
      {"seed=" + std::to_string(run.seed), "rate=" + std::to_string(options.rate)});
}

/// The whole system in one process, with the people.
std::vector<ChildSpec> one_program(const ScenarioOptions& options, const Run& run,
                                   const bus::NodeOptions& node) {
  const Places places = places_of(run);
  Deployment deployment = deployment_of(run, node, places);
  deployment.bus.lockstep = true;
  put_in_one(deployment, {"dialogue", "facilitator"});
  deployment.programs[0].restart = false;
  std::vector<ChildSpec> children =
      command_lines_on(node, deployment, places, {"seed=" + std::to_string(run.seed)});
  children.at(0).argv.insert(children.at(0).argv.end(),
                             {"--step", "--free-step", "--grammar", "flakey", "--people", run.cast,
                              "--time-limit", std::to_string(options.time_limit)});
  return children;
}

Ending play_live(const ScenarioOptions& options, const Run& run,
                 const bus::NodeOptions& node_options, const bus::Stop& stop) {
  Kept kept(kKeptLines);
  Supervisor supervisor(
      programs(options, run, node_options),
      [&](std::string_view from, std::string_view line) { kept.add(from, line); });
  supervisor.start();
  bus::Node node(node_options);
  if (!options.json)
    print("robot %s on domain %u: saphira --robot %s --domain %u why explains what it does\n",
          node_options.robot.c_str(), node_options.domain, node_options.robot.c_str(),
          node_options.domain);
  story::StoryOptions how{{"dialogue", "intentions"}, options.time_limit, {}};
  std::string said;
  how.show = [&](double time, const std::string& place, const std::string& line) {
    said += line + "\n";
    if (!options.json)
      print("%s\n", story::story_line(time, place, line).c_str());
  };
  story::Story played(node, run.people(), how);
  const auto began = Clock::now();
  std::string trouble;
  while (!stop.requested() && trouble.empty() && !played.step(unix_time())) {
    supervisor.step(milliseconds(200), {stop.fd(), node.wake_fd()});
    node.clear_wake();
    if (supervisor.misused())
      trouble = *supervisor.misused() + " refuses its options";
    else if (!played.ready() && seconds_since(began) > kStart)
      trouble = "the programs were not all there within 60 s";
  }
  supervisor.stop();
  if (!trouble.empty())
    show(kept, trouble);
  return {
      played.well(), played.handed_over(), played.time(), played.utterances(), played.hash(), {},
      said};
}

Ending play_in_lockstep(const ScenarioOptions& options, const Run& run,
                        const bus::NodeOptions& node, const bus::Stop& stop) {
  Kept kept(kKeptLines);
  Ending ending;
  std::string said;
  bool told = false;
  Supervisor supervisor(
      one_program(options, run, node), [&](std::string_view from, std::string_view line) {
        const nlohmann::json result =
            line.starts_with("{") ? nlohmann::json::parse(line, nullptr, false) : nlohmann::json();
        if (result.is_object()) {
          told = true;
          ending = {result.value("well", false),
                    result.value("handed_over", ""),
                    result.value("time_s", 0.0),
                    result.value("utterances", std::uint64_t{0}),
                    result.value("dialogue_hash", ""),
                    {},
                    {}};
        } else if (from.empty() || !story::is_story_line(line)) {
          kept.add(from, line);
        } else {
          said += story::said_in(line);
          said += '\n';
          if (options.json)
            kept.add(from, line);
          else
            print("%.*s\n", static_cast<int>(line.size()), line.data());
        }
      });
  supervisor.start();
  while (!stop.requested() && !supervisor.finished())
    supervisor.step(milliseconds(200), {stop.fd()});
  supervisor.stop();
  if (!told && !stop.requested())
    show(kept, "saphira-all ended before the story");
  ending.said = said;
  return ending;
}

/// Writes the dialogue as text and as sound.
void write_audio(const std::string& folder, const std::string& said, const bus::Stop& stop) {
  std::filesystem::create_directories(folder);
  const std::string text = folder + "/dialogue.txt";
  if (!replace_file(text, said))
    throw std::runtime_error(cannot_be(text, "written"));
  const std::string speech = find_places().bin + "/saphira-speech";
  if (!std::filesystem::exists(speech))
    throw std::runtime_error("--audio: there is no saphira-speech beside this program; " + text +
                             " has the text. To hear it, " + kInstallSpeech);
  Kept kept(kKeptLines);
  ChildSpec reader{"speech", {speech, "--read", text, "--speaker", folder}, {}, false};
  Supervisor supervisor(
      {reader}, [&](std::string_view from, std::string_view line) { kept.add(from, line); });
  supervisor.start();
  while (!stop.requested() && !supervisor.finished())
    supervisor.step(milliseconds(200), {stop.fd()});
  if (!std::filesystem::exists(folder + "/dialogue.wav"))
    show(kept, "saphira-speech wrote no sound");
}

Ending play(const ScenarioOptions& options, const std::string& cast, std::uint64_t seed,
            const bus::NodeOptions& node, const bus::Stop& stop) {
  const RunFolder folder;
  const Run run{cast, seed, folder.path()};
  Ending ending = options.lockstep ? play_in_lockstep(options, run, node, stop)
                                   : play_live(options, run, node, stop);
  ending.track = evaluate_trace(read_file(run.trace()), std::numeric_limits<std::uint64_t>::max(),
                                run.trace());
  if (!options.json)
    print("%s after %.0f s of robot time, %.0f m, %s%s\n",
          ending.handed_over.empty() ? "nobody has got anything" : ending.handed_over.c_str(),
          ending.time, ending.track.path, counted(ending.track.contacts, "contact").c_str(),
          ending.well ? "" : "; the story was to end otherwise");
  flush_output();
  if (!options.audio.empty())
    write_audio(options.audio, ending.said, stop);
  return ending;
}

/// The summary of all stories, as JSON.
class Sum {
 public:
  void add(const Ending& ending) {
    ++runs_;
    well_ += ending.well ? 1 : 0;
    delivered_ += ending.handed_over.empty() ? 0 : 1;
    time_ += ending.time;
    contacts_ += ending.track.contacts;
    utterances_ += ending.utterances;
    said_.add(ending.hash + "\n");
    driven_.add(ending.track.hash + "\n");
  }
  bool well() const { return well_ == runs_ && contacts_ == 0; }
  std::string json() const {
    const nlohmann::ordered_json result{{"runs", runs_},
                                        {"well", well_},
                                        {"delivered", delivered_},
                                        {"time_s", time_},
                                        {"contacts", contacts_},
                                        {"utterances", utterances_},
                                        {"dialogue_hash", said_.text()},
                                        {"trajectory_hash", driven_.text()}};
    return result.dump();
  }
  std::string text() const {
    return std::to_string(well_) + " of " + std::to_string(runs_) +
           " stories ended as their cast says, " + std::to_string(delivered_) +
           " with the delivery; " + counted(contacts_, "contact");
  }

 private:
  std::size_t runs_ = 0;
  std::size_t well_ = 0;
  std::size_t delivered_ = 0;
  double time_ = 0.0;
  std::uint64_t contacts_ = 0;
  std::uint64_t utterances_ = 0;
  Fnv1a said_;
  Fnv1a driven_;
};

/// Reports errors of a file of people before anything runs. A map that the deployment names
/// otherwise than in its settings is not known here.
void check_cast(const std::string& file) {
  const story::Cast people(read_file(file), file);
  const Deployment deployment =
      load_deployment(find_deployment(people.deployment(), find_places()));
  const auto map = deployment.settings.find("map");
  if (map == deployment.settings.end() || map->second.text.empty() || map->second.text == "none" ||
      map->second.text.find('$') != std::string::npos)
    return people.check([](const std::string&) { return true; });
  const maps::Topology floor(
      maps::load_map(find_file(config_folder() + "/maps", map->second.text, ".map")));
  people.check([&](const std::string& place) { return floor.place(place).has_value(); });
}

int scenario(const ScenarioOptions& options, const bus::NodeOptions& given, const bus::Stop& stop) {
  std::vector<std::string> casts;
  for (const std::string& name : options.casts) {
    casts.push_back(find_file(config_folder() + "/people", name, ".people"));
    check_cast(casts.back());
  }
  if (!options.audio.empty()) {
    std::error_code why;
    std::filesystem::create_directories(options.audio, why);
    if (why)
      throw std::invalid_argument(options.audio + ": cannot be made: " + why.message());
  }
  const bus::NodeOptions node = own_bus(given, "flakey");
  const FoundBus found(bus_of("the scenario", node));
  const bool several = casts.size() * options.seeds > 1;
  Sum sum;
  for (const std::string& cast : casts)
    for (std::uint64_t seed = options.seed; seed < options.seed + options.seeds; ++seed) {
      if (stop.requested())
        return bus::kExitFailed;
      if (several && !options.json)
        print("-- %s, seed %llu\n", cast.c_str(), static_cast<unsigned long long>(seed));
      sum.add(play(options, cast, seed, node, stop));
    }
  if (options.json)
    std::printf("%s\n", sum.json().c_str());
  else if (several)
    std::printf("%s\n", sum.text().c_str());
  return sum.well() ? bus::kExitOk : bus::kExitFailed;
}

}  // namespace

void add_scenario(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<ScenarioOptions>();
  CLI::App* command = app.add_subcommand(
      "scenario",
      "A robot follows its supervisor through an office, is told who is where, and gets a report");
  chosen.apart.insert(command);
  command->add_option("--cast", options->casts, "the people: names of config/people, or files")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the simulator's noise")
      ->check(whole<std::uint64_t>())
      ->capture_default_str();
  command->add_option("--seeds", options->seeds, "how many runs, each with the next seed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag(
      "--lockstep", options->lockstep,
      "in one process and as fast as the machine: the same seed is the same story, to "
      "the bit");
  command->add_option("--rate", options->rate, "times real time")
      ->check(between(0.1, 20.0))
      ->capture_default_str();
  command->add_option("--time-limit", options->time_limit, "[s] of robot time")
      ->check(above_zero())
      ->transform(number_in_unit("s"))
      ->capture_default_str();
  command->add_flag("--json", options->json, "the result as JSON");
  command->add_option(
      "--audio", options->audio,
      "a folder: dialogue.wav with what was said, and a file for each utterance; of "
      "several runs the last");
  command->footer(
      "Exit code 0: each story ended as its cast says, without a contact; 1: one did not.");
  chosen.when(command, options, scenario);
}

}  // namespace saphira::cli

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bridges.hpp"
#include "commands.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/watch/halt.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr double kApprovalPatience = 4.0;  ///< [s] for an answer
constexpr double kUnanswered = 15.0;       ///< [s] until a goal without any answer is given up
constexpr double kSilent = 3.0;            ///< [s] until missing intentions are reported

struct GoalOptions {
  std::vector<std::string> words;
  int priority = 0;
  double deadline = 0.0;
  double level = 0.0;
  bool keep = false;
  std::string why;
};

/// Reports once the latch that keeps a goal from driving the robot, and its end.
class Latches {
 public:
  explicit Latches(bus::Node& node) : grant_(node, bus::topics::kGrant) {}
  void poll() {
    if (!grant_.poll() || latched(*grant_) == last_)
      return;
    last_ = latched(*grant_);
    print("           %s\n", last_.empty() ? "autonomy may drive" : last_.c_str());
  }

 private:
  Newest<v1::Grant> grant_;
  std::string last_;
};

/// Prints each change of a goal's status once.
class Follower {
 public:
  /// True when the goal has come to its end.
  bool show(const v1::GoalStatus& status) {
    // Progress alone is printed every tenth.
    const std::string key = bus::describe(status.state) + status.step + status.reason +
                            status.note + std::to_string(std::floor(status.progress * 10.0));
    if (key != last_) {
      print("%7.1f s  %s\n", status.elapsed, bus::describe(status).c_str());
      last_ = key;
    }
    return bus::ended(status.state);
  }

 private:
  std::string last_;
};

/// The bridge's stop. It is no goal: it needs no other program than the bridge.
int stop_robot(const bus::NodeOptions& node_options, const bus::Stop& stop) {
  bus::Node node(node_options);
  Processes processes(node);
  Bridges bridges(node);
  bus::RequestClient stops(node, bus::topics::kDriveStop, person("saphira goal stop"));
  const auto began = Clock::now();
  const std::string robot = called(node_options.robot);
  std::set<bus::WriterId> answered;
  bool heard = false;
  watch::Halt halt;
  bus::Stop over;  // that of the signals, or the end of patience
  const auto hear = [&](const v1::Answer& answer) {
    if (!std::exchange(heard, true))
      print("%s: %s (confirmed by the bridge after %.2f s)\n", robot.c_str(), answer.text.c_str(),
            seconds_since(began));
    if (!bus::ended(answer.code))
      return;
    halt.end(answer.code);
    if (bus::well(answer.code))
      print("%s, after %.2f s\n", answer.text.c_str(), seconds_since(began));
    else
      complain("saphira: %s. The latched stop is saphira estop.\n", answer.text.c_str());
  };
  const auto meanwhile = [&] {
    processes.poll();
    bridges.poll();
    const double now = seconds_since(began);
    const watch::Halt::News news = halt.update(heard && bridges.without(answered).empty(), now);
    if (stop.requested() || news == watch::Halt::News::given_up)
      over.request();
    else if (news == watch::Halt::News::not_at_rest)
      complain(
          "saphira: NOT SEEN AT REST for %.0f s. Stop the robot by its own switch. (%s.) This goes "
          "on for %.0f s; Ctrl-C ends it.\n",
          halt.lasts(now), who_is_there(processes).c_str(), watch::Halt::kMost);
    else if (news == watch::Halt::News::not_confirmed)
      complain("saphira: %s\n",
               bridges.unconfirmed(bridges.without(answered), halt.lasts(now), processes).c_str());
  };
  stops.ask_each(bus::request("stop"), std::numeric_limits<double>::infinity(),
                 bridges.servers(&answered), &over, meanwhile, hear);
  if (over.requested()) {
    const std::string missing = bridges.without(answered);
    complain("saphira: ended before %s was seen at rest%s\n", robot.c_str(),
             missing.empty() ? "" : ("; not confirmed by the bridge of " + missing).c_str());
    return bus::kExitFailed;
  }
  if (bridges.count() > 1)
    print("this was a stop%s%s\n", bridges.several().c_str(), bridges.names().c_str());
  return halt.well() ? bus::kExitOk : bus::kExitFailed;
}

/// Tells once when the program that carries out goals is silent, and when it is back.
class Silence {
 public:
  void update(const std::vector<SeenProcess>& processes) {
    if (std::ranges::any_of(processes, [](const SeenProcess& one) {
          return (one.status.name == "intentions" || one.status.name == "all") &&
                 one.age <= kSilent;
        })) {
      heard_ = Clock::now();
      if (std::exchange(told_, false))
        print("           intentions is heard again\n");
    } else if (!told_ && seconds_since(heard_) > kSilent) {
      told_ = true;
      complain(
          "saphira: intentions is not heard (saphira status); the goal goes on when it is back, "
          "and Ctrl-C withdraws it\n");
    }
  }

 private:
  Clock::time_point heard_ = Clock::now();
  bool told_ = false;
};

int ask(const GoalOptions& options, const bus::NodeOptions& node_options, const bus::Stop& stop) {
  v1::Goal goal = parse_request(options.words);
  if (goal.functor == "stop")
    return stop_robot(node_options, stop);
  goal.priority = options.priority;
  goal.deadline = options.deadline;
  goal.level = options.level;
  goal.writer_lost = options.keep ? v1::WRITER_LOST_KEEP : v1::WRITER_LOST_CANCEL;

  bus::Node node(node_options);
  Processes processes(node);
  DeploymentWatch deployments(node, processes);
  bus::GoalClient goals(node, "saphira goal");
  const v1::GoalId id = goals.ask(goal);
  print("goal %s  %s\n", bus::describe(id).c_str(), describe(goal).c_str());

  Follower follower;
  Latches latches(node);
  Silence silence;
  const auto began = Clock::now();
  double told = 0.0;
  bool canceled = false;
  Clock::time_point canceled_at;
  while (true) {
    // After a stop request its descriptor stays readable: then wait for the bus alone.
    node.wait(milliseconds(200), canceled ? nullptr : &stop);
    deployments.poll();
    goals.poll();
    latches.poll();
    const auto status = goals.status(id);
    if (status && follower.show(*status)) {
      deployments.settle(stop);
      if (const std::string advice = advice_after_failure(goal);
          status->state == v1::GOAL_FAILED && !advice.empty())
        print("           %s\n", advice.c_str());
      return status->state == v1::GOAL_SUCCEEDED ? bus::kExitOk : bus::kExitFailed;
    }
    const bool empty = processes.all().empty();
    if (status)
      silence.update(processes.all());
    if (!status && seconds_since(began) > told + 3.0) {
      told += 3.0;
      complain("saphira: no answer yet: %s\n", who_is_there(processes).c_str());
    }
    if (!status && seconds_since(began) > (empty ? kEmptyBus : kUnanswered)) {
      complain("saphira: given up\n");
      goals.cancel(id);
      return bus::kExitFailed;
    }
    if (stop.requested() && options.keep) {
      print("left underway; saphira goal cancel %s ends it\n", bus::describe(id).c_str());
      return bus::kExitFailed;
    }
    if (stop.requested() && !canceled) {
      goals.cancel(id);
      canceled = true;
      canceled_at = Clock::now();
    }
    if (canceled && seconds_since(canceled_at) > 2.0) {
      complain("saphira: withdrawn, and nothing was heard of it within 2 s\n");
      return bus::kExitFailed;
    }
  }
}

int cancel(const GoalOptions& options, const bus::NodeOptions& node_options,
           const bus::Stop& stop) {
  const auto id = options.words.size() == 2 ? bus::parse_goal_id(options.words[1]) : std::nullopt;
  if (!id)
    throw std::invalid_argument(
        "expected goal cancel ID, such as 1f3a:2 (saphira goal list)" +
        (options.words.size() < 2 ? "" : ", found \"" + options.words[1] + "\""));
  bus::Node node(node_options);
  Processes processes(node);
  DeploymentWatch deployments(node, processes);
  bus::GoalClient goals(node, "saphira goal");
  Follower follower;
  const auto began = Clock::now();
  bool asked = false;
  while (!stop.requested() && seconds_since(began) < 5.0) {
    node.wait(milliseconds(100), &stop);
    deployments.poll();
    goals.poll();
    const auto status = goals.status(*id);
    if (status && !asked && bus::ended(status->state)) {
      follower.show(*status);
      complain("saphira: it had ended before\n");
      return bus::kExitFailed;
    }
    if (status && !asked) {
      goals.cancel(*id, options.why);
      asked = goals.delivered(2000);
    }
    if (status && follower.show(*status))
      return bus::kExitOk;
  }
  complain(
      "saphira: %s\n",
      asked ? "asked to end, and it has not ended yet. With security only its owner and operators "
              "may cancel it (saphira goal list); saphira goal stop is anybody's"
            : ("nothing is known of this goal; " + who_is_there(processes)).c_str());
  return bus::kExitFailed;
}

int approve(const GoalOptions& options, const bus::NodeOptions& node_options,
            const bus::Stop& stop) {
  if (options.words.size() != 2 || !bus::parse_goal_id(options.words[1]))
    throw std::invalid_argument("expected goal approve ID, such as 1f3a:2 (saphira goal list)");
  bus::Node node(node_options);
  Processes processes(node);
  bus::RequestClient services(node, bus::topics::kProcessRequest, person("saphira goal approve"));
  const v1::Answer answer =
      services.ask(bus::request("resume", {bus::text("process", options.words[1])}, "intentions"),
                   kApprovalPatience, &stop, [&] { processes.poll(); });
  if (bus::well(answer.code)) {
    print("goal %s is approved\n", options.words[1].c_str());
    return bus::kExitOk;
  }
  return failed(answer.service.empty() ? "no answer; " + who_is_there(processes) : answer.text);
}

int list_goals(const bus::NodeOptions& node_options, const bus::Stop& stop) {
  bus::Node node(node_options);
  Processes processes(node);
  DeploymentWatch deployments(node, processes);
  auto statuses = node.reader(bus::topics::kGoalStatus);
  auto asked = node.reader(bus::topics::kGoals);
  using Key = std::pair<std::uint64_t, std::uint64_t>;
  std::map<Key, v1::GoalStatus> goals;
  std::map<Key, std::string> calls;  // those of requesters that are still there
  poll_for(node, listening_time(node), stop, [&] {
    deployments.poll();
    keep_newest(statuses, goals, [](const v1::GoalStatus& status) {
      return Key{status.id.writer, status.id.number};
    });
    for (const auto& sample : asked.take())
      if (!sample.info.disposed)
        calls[{sample.data.id.writer, sample.data.id.number}] = describe(sample.data);
  });
  deployments.settle(stop);
  for (const v1::GoalStatus& status : by_acceptance(goals)) {
    const auto call = calls.find({status.id.writer, status.id.number});
    std::printf("%-24s %-10s by %s: %s\n", bus::describe(status.id).c_str(),
                call == calls.end() ? status.functor.c_str() : call->second.c_str(),
                status.requester.c_str(), bus::describe(status).c_str());
  }
  if (!goals.empty())
    return bus::kExitOk;
  if (const std::string absent = absence(node, processes, "intentions");
      !processes.all().empty() && !absent.empty())
    return failed("no goals are known; " + absent);
  return nothing_there("goals", processes, who_is_there(processes));
}

const char* kind_word(v1::ParameterKind kind) {
  return word_of(kind, {"anything", "number", "text", "point"});
}

void print_schema(const v1::ActivitySchema& schema) {
  std::printf("%s  %s%s%s\n", schema.name.c_str(), schema.summary.c_str(),
              schema.source.empty() ? "" : "  ", schema.source.c_str());
  for (const v1::ActivityParameter& parameter : schema.parameters) {
    std::printf("  %s  %s", parameter.name.c_str(), kind_word(parameter.kind));
    if (parameter.kind == v1::PARAMETER_NUMBER && parameter.low < parameter.high)
      std::printf(", %g to %g", parameter.low, parameter.high);
    if (!parameter.unit.empty())
      std::printf(" [%s]", parameter.unit.c_str());
    std::printf("%s\n", parameter.required        ? ", required"
                        : parameter.usual.empty() ? ""
                                                  : (", usual: " + parameter.usual).c_str());
  }
}

/// Prints the activities that a goal can name: all of them, or the given one.
int schemas(const GoalOptions& options, const bus::NodeOptions& node_options,
            const bus::Stop& stop) {
  if (options.words.size() > 2)
    throw std::invalid_argument("expected goal activities [ACTIVITY]");
  bus::Node node(node_options);
  Processes processes(node);
  Newest<v1::ActivitySchemas> known(node, bus::topics::kActivitySchemas);
  if (!wait_for(node, milliseconds(5000), stop, [&] {
        processes.poll();
        return known.poll();
      }))
    return failed("nobody said what can be asked for; " + who_is_there(processes));
  bool any = false;
  std::vector<std::string> names;
  for (const v1::ActivitySchema& schema : known->schemas) {
    names.push_back(schema.name);
    if (options.words.size() == 2 && schema.name != options.words[1])
      continue;
    print_schema(schema);
    any = true;
  }
  if (!known->trouble.empty())
    std::printf("%s\n", known->trouble.c_str());
  if (any)
    return bus::kExitOk;
  if (options.words.size() < 2)
    return failed("there are no activities");
  return failed("there is no activity \"" + options.words[1] + '"' +
                did_you_mean(options.words[1], names, "; saphira goal activities lists them"));
}

}  // namespace

void add_goal(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<GoalOptions>();
  CLI::App* command = app.add_subcommand("goal", "Send a goal and follow it to its end");
  chosen.reach[command] = {
      "goal stop", [options] { return options->words == std::vector<std::string>{"stop"}; }};
  command->add_option(
      "words", options->words,
      "go X Y [m, in odom] | go PLACE | drive SPEED | turn to DEGREES | stop | "
      "ACTIVITY name=value... | list | cancel ID | approve ID | activities [ACTIVITY]");
  command->add_option("--priority", options->priority, "larger is more important (usual: 0)");
  command->add_option("--deadline", options->deadline, "[s] of robot time until it fails")
      ->check(above_zero())
      ->transform(number_in_unit("s"));
  command->add_option("--level", options->level, "of satisfaction that is enough (0..1)")
      ->check(between(0.0, 1.0));
  command->add_flag("--keep", options->keep, "the goal goes on when this program ends");
  command->add_option("--why", options->why, "of cancel: the reason, which its status then says");
  command->footer(
      "Values: 0.3 (SI units), 90deg, 30cm, 0.3m/s, x,y or x,y,th with @odom, @robot or @map, "
      "text.\n"
      "stop ends whatever moves the robot, also a program or a person, and is done once it is at "
      "rest.\n"
      "Ctrl-C withdraws the goal. Exit code 0: it succeeded; 1: it did not.");
  chosen.when(command, [options](const bus::NodeOptions& node, const bus::Stop& stop) {
    if (!options->words.empty() && options->words[0] == "cancel")
      return cancel(*options, node, stop);
    if (!options->words.empty() && options->words[0] == "approve")
      return approve(*options, node, stop);
    if (options->words == std::vector<std::string>{"list"})
      return list_goals(node, stop);
    if (!options->words.empty() &&
        (options->words[0] == "activities" || options->words[0] == "schemas"))
      return schemas(*options, node, stop);
    return ask(*options, node, stop);
  });
}

}  // namespace saphira::cli

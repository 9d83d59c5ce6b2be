// Naps: programs that are stopped and continued, as on a laptop that sleeps. Measures the number of
// programs that hear and are heard again, and the delay.
//
// In each group five programs answer two that stay awake. A nap stops one of the five (program),
// all of them (machine), or all of them while their network is cut (cut; in a network namespace,
// which needs root). It is over when each of them answers both, has read a goal that was written
// since, and hears the other four.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "bench.hpp"
#include "saphira/base/places.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/quantile.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using namespace saphira;
using saphira::bench::Child;

constexpr unsigned kSleepers = 5;
constexpr unsigned kAwake = 2;
constexpr double kGiveUp = 60.0;  // [s]

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Options {
  unsigned naps = 100;
  unsigned groups = 6;
  unsigned domain = 130;
  double shortest = 0.3;
  double longest = 120.0;
  std::uint64_t seed = 1;
  bool cut = false;
  bool json = false;
};

struct Nap {
  std::string kind;
  double length = 0.0;
  std::optional<double> resumed;  // [s] after the nap
};

void shell(const std::string& command, bool must = true) {
  if (std::system(command.c_str()) != 0 && must)
    throw std::runtime_error("failed: " + command);
}

/// A network namespace with a link to this one; nothing without a `number`.
class Machine {
 public:
  explicit Machine(unsigned number)
      : name_("b-naps" + std::to_string(number)),
        here_("bn" + std::to_string(number) + "a"),
        there_("bn" + std::to_string(number) + "b"),
        net_("10.77." + std::to_string(number) + ".") {
    remove();
    shell("ip netns add " + name_);
    shell("ip link add " + here_ + " type veth peer name " + there_ + " netns " + name_);
    shell("ip addr add " + net_ + "1/24 dev " + here_ + " && ip link set " + here_ + " up");
    in("ip addr add " + net_ + "2/24 dev " + there_ + " && ip link set " + there_ + " up");
    in("ip link set lo up && ip route add default via " + net_ + "1");
  }
  ~Machine() { remove(); }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  void link(bool up) { shell("ip link set " + here_ + (up ? " up" : " down")); }
  std::string here() const { return net_ + "1"; }
  std::string there() const { return net_ + "2"; }
  const std::string& name() const { return name_; }

 private:
  void in(const std::string& command) const {
    shell("ip netns exec " + name_ + " sh -c '" + command + "'");
  }
  void remove() const {
    shell("ip netns del " + name_ + " 2>/dev/null", false);
    shell("ip link del " + here_ + " 2>/dev/null", false);
  }

  std::string name_;
  std::string here_;
  std::string there_;
  std::string net_;
};

bus::NodeOptions node_options(unsigned domain, const Machine* machine, unsigned number) {
  bus::NodeOptions options;
  options.name = "awake" + std::to_string(number);
  options.robot = "naps";
  options.domain = domain;
  if (machine != nullptr) {
    options.profile = bus::Profile::lan;
    options.interface = machine->here();
  }
  return options;
}

/// A program that stays awake: it writes states and wishes ten times a second, and takes the
/// answers.
class Awake {
 public:
  explicit Awake(const bus::NodeOptions& options)
      : node_(options),
        states_(node_.writer(bus::topics::kRobotState)),
        goals_(node_.writer(bus::topics::kGoals)),
        answers_(node_.reader(bus::topics::kDriveBehaviors)) {}

  void turn(std::uint64_t count) {
    v1::RobotState state;
    state.stamp().epoch(node_.instance());
    state.stamp().cycle(count);
    states_.write(state);
    v1::Goal goal;
    goal.id().writer(node_.instance());
    goal.id().number(count);
    goals_.write(goal);
    if (count > 3) {
      goal.id().number(count - 3);
      goals_.dispose(goal);
    }
    for (const auto& sample : answers_.take())
      if (sample.data.stamp().epoch() == node_.instance())
        newest_[sample.data.source()] = sample.data;
  }
  /// The sleepers that have completely answered the samples since that count.
  std::set<std::string> complete(std::uint64_t since) const {
    std::set<std::string> all;
    for (const auto& [name, answer] : newest_)
      if (answer.stamp().cycle() > since && answer.move() > since &&
          answer.number() + 1 >= kSleepers)
        all.insert(name);
    return all;
  }

 private:
  bus::Node node_;
  bus::Writer<v1::RobotState> states_;
  bus::Writer<v1::Goal> goals_;
  bus::Reader<v1::MotorCommand> answers_;
  std::map<std::string, v1::MotorCommand> newest_;
};

class Group {
 public:
  Group(unsigned domain, bool cut, unsigned number) {
    if (cut)
      machine_ = std::make_unique<Machine>(number);
    for (unsigned i = 0; i < kAwake; ++i)
      awake_.push_back(std::make_unique<Awake>(node_options(domain, machine_.get(), i)));
    for (unsigned i = 0; i < kSleepers; ++i) {
      std::vector<std::string> argv;
      if (machine_)
        argv = {"/sbin/ip",
                "netns",
                "exec",
                machine_->name(),
                program_folder() + "/saphira-bus-peer",
                "--profile",
                "lan",
                "--interface",
                machine_->there()};
      else
        argv = {"saphira-bus-peer", "--profile", "host"};
      for (const std::string& word :
           {std::string("--role"), std::string("answer"), std::string("--robot"),
            std::string("naps"), std::string("--domain"), std::to_string(domain),
            std::string("--name"), "sleeper" + std::to_string(i)})
        argv.push_back(word);
      sleepers_.push_back(std::make_unique<Child>(argv));
    }
    if (!wait_complete(0, kGiveUp))
      throw std::runtime_error("the group of domain " + std::to_string(domain) +
                               " did not come together");
  }

  Nap nap(const std::string& kind, double length, std::size_t which) {
    Nap result{kind, length, {}};
    for (std::size_t i = 0; i < sleepers_.size(); ++i)
      if (kind != "program" || i == which)
        kill(sleepers_[i]->pid(), SIGSTOP);
    turn_for(length / 4);
    if (kind == "cut")
      machine_->link(false);
    turn_for(length / 2);
    if (kind == "cut")
      machine_->link(true);
    turn_for(length / 4);
    for (const auto& sleeper : sleepers_)
      kill(sleeper->pid(), SIGCONT);
    const auto since = Clock::now();
    if (wait_complete(count_, kGiveUp))
      result.resumed = seconds_since(since);
    turn_for(1.0);
    return result;
  }

 private:
  void turn() {
    ++count_;
    for (const auto& awake : awake_)
      awake->turn(count_);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  void turn_for(double seconds) {
    for (const auto start = Clock::now(); seconds_since(start) < seconds;)
      turn();
  }
  bool wait_complete(std::uint64_t since, double limit) {
    for (const auto start = Clock::now(); seconds_since(start) < limit; turn())
      if (std::all_of(awake_.begin(), awake_.end(), [&](const auto& awake) {
            return awake->complete(since).size() == kSleepers;
          }))
        return true;
    return false;
  }

  std::unique_ptr<Machine> machine_;
  std::vector<std::unique_ptr<Awake>> awake_;
  std::vector<std::unique_ptr<Child>> sleepers_;
  std::uint64_t count_ = 0;
};

nlohmann::json summary(const std::vector<Nap>& naps) {
  std::vector<double> times;
  for (const Nap& nap : naps)
    if (nap.resumed)
      times.push_back(*nap.resumed);
  return {{"naps", naps.size()},
          {"resumed", times.size()},
          {"resumed_in_2_s",
           std::count_if(times.begin(), times.end(), [](double time) { return time <= 2.0; })},
          {"resume_s_p50", test::quantile(times, 0.5)},
          {"resume_s_p99", test::quantile(times, 0.99)},
          {"resume_s_max", test::quantile(times, 1.0)}};
}

std::vector<Nap> run(const Options& options) {
  // Lengths over the whole range, uniform in the logarithm, and the longest.
  std::mt19937_64 random(options.seed);
  std::vector<Nap> plan;
  for (unsigned i = 0; i < options.naps; ++i) {
    const double share = (i + 0.5) / options.naps;
    const double length = options.shortest * std::pow(options.longest / options.shortest, share);
    const unsigned kinds = options.cut ? 3 : 2;
    plan.push_back({i % kinds == 0 ? "program" : i % kinds == 1 ? "machine" : "cut", length, {}});
  }
  std::shuffle(plan.begin(), plan.end(), random);
  std::mutex mutex;
  std::size_t next = 0;
  std::vector<Nap> done;
  std::string trouble;
  std::vector<std::thread> threads;
  for (unsigned g = 0; g < options.groups; ++g)
    threads.emplace_back([&, g] {
      try {
        Group group(options.domain + g, options.cut, g);
        for (std::unique_lock lock(mutex); next < plan.size(); lock.lock()) {
          const std::size_t number = next++;
          const Nap nap = plan[number];
          lock.unlock();
          const Nap result = group.nap(nap.kind, nap.length, number % kSleepers);
          const std::scoped_lock result_lock(mutex);
          done.push_back(result);
          std::printf("%3zu of %zu: %-7s %6.1f s: %s\n", done.size(), plan.size(), nap.kind.c_str(),
                      nap.length,
                      result.resumed ? (std::to_string(*result.resumed) + " s").c_str()
                                     : "NEVER HEARD AGAIN");
          std::fflush(stdout);
        }
      } catch (const std::exception& error) {
        const std::scoped_lock lock(mutex);
        trouble = error.what();
      }
    });
  for (std::thread& thread : threads)
    thread.join();
  if (!trouble.empty())
    throw std::runtime_error(trouble);
  return done;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"Programs that nap: how many are heard again, and after how long"};
  Options options;
  app.add_flag("--json", options.json, "one JSON object on the last line");
  app.add_option("--naps", options.naps, "how many").in_range(1, 100000);
  app.add_option("--groups", options.groups, "so many at once, each in a domain of its own")
      .in_range(1, 60);
  app.add_option("--domain", options.domain, "the first of these domains").in_range(0, 172);
  app.add_option("--shortest", options.shortest, "[s]").positive();
  app.add_option("--longest", options.longest, "[s]").positive();
  app.add_option("--seed", options.seed, "of the order of the naps");
  app.add_flag("--cut", options.cut,
               "the sleepers are on a machine of their own (a network namespace; needs root), and "
               "in a third of the naps the link is cut meanwhile");
  if (const auto code = app.parse(argc, argv))
    return *code;
  try {
    const std::vector<Nap> naps = run(options);
    nlohmann::json result = summary(naps);
    for (const char* kind : {"program", "machine", "cut"}) {
      std::vector<Nap> some;
      std::copy_if(naps.begin(), naps.end(), std::back_inserter(some),
                   [&](const Nap& nap) { return nap.kind == kind; });
      if (!some.empty())
        result[kind] = summary(some);
    }
    std::printf("%s\n", options.json ? result.dump().c_str() : result.dump(2).c_str());
    return result["resumed"] == result["naps"] ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "saphira-bench-naps: %s\n", error.what());
    return 3;
  }
}

// Many robots in one domain on one machine: until all are whole, and their cost at rest.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <vector>

#include "bench.hpp"
#include "saphira/base/places.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/command_line/command_line.hpp"

namespace {

using namespace saphira;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The epochs of one topic's samples, by their writers.
template <class T>
class Writers {
 public:
  Writers(bus::Node& node, const bus::Topic<T>& topic) : reader_(node.reader(topic)) {}

  void look() {
    for (const auto& sample : reader_.take())
      if (!sample.info.disposed && sample.data.stamp.cycle > 0)
        epochs_[sample.info.writer].insert(sample.data.stamp.epoch);
  }
  const std::map<bus::WriterId, std::set<std::uint64_t>>& epochs() const { return epochs_; }

 private:
  bus::Reader<T> reader_;
  std::map<bus::WriterId, std::set<std::uint64_t>> epochs_;
};

/// The services of every robot, heard from outside. An epoch is one robot's.
class Robots {
 public:
  explicit Robots(bus::Node& node)
      : behaviors_(node, bus::topics::kBehaviors),
        intentions_(node, bus::topics::kIntentions),
        perception_(node, bus::topics::kPerception),
        registration_(node, bus::topics::kRegistration) {}

  void look() {
    each([](auto& writers) { writers.look(); });
  }
  /// Robots of which all services step.
  std::size_t whole() {
    std::map<std::uint64_t, int> services;
    each([&](auto& writers) {
      std::set<std::uint64_t> heard;
      for (const auto& [writer, epochs] : writers.epochs())
        heard.insert(epochs.begin(), epochs.end());
      for (const std::uint64_t epoch : heard)
        ++services[epoch];
    });
    return static_cast<std::size_t>(std::count_if(services.begin(), services.end(),
                                                  [](const auto& s) { return s.second == 4; }));
  }
  /// Services that stepped for two robots.
  std::size_t mixed() {
    std::size_t count = 0;
    each([&](auto& writers) {
      for (const auto& [writer, epochs] : writers.epochs())
        count += epochs.size() - 1;
    });
    return count;
  }

 private:
  template <class F>
  void each(F&& f) {
    f(behaviors_);
    f(intentions_);
    f(perception_);
    f(registration_);
  }

  Writers<v1::BehaviorSet> behaviors_;
  Writers<v1::Intentions> intentions_;
  Writers<v1::Perception> perception_;
  Writers<v1::Registration> registration_;
};

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"Robots in one domain: the time until all are whole, and their cost at rest"};
  int robots = 4;
  int limit = 120;
  std::uint32_t domain = 119;
  bool json = false;
  app.add_option("--robots", robots, "simulated robots, each with its services and its page")
      .in_range(1, 40);
  app.add_option("--limit", limit, "[s] until all are whole").in_range(1, 3600);
  app.add_option("--domain", domain, "DDS domain, which nobody else uses").in_range(0, 231);
  app.add_flag("--json", json, "one JSON object on the last line");
  if (const auto code = app.parse(argc, argv))
    return *code;

  bus::NodeOptions options;
  options.name = "fleet";
  options.robot = "*";
  options.domain = domain;
  bus::Node node(options);
  Robots heard(node);
  const auto begin = Clock::now();
  std::vector<std::unique_ptr<bench::Child>> children;
  for (int i = 0; i < robots; ++i)
    children.push_back(std::make_unique<bench::Child>(
        std::vector<std::string>{"/usr/bin/env", "SAPHIRA_ROBOT=fleet" + std::to_string(i),
                                 "SAPHIRA_DOMAIN=" + std::to_string(domain), "SAPHIRA_NETWORK=host",
                                 program_folder() + "/saphira", "up", "demo"}));
  const auto count = static_cast<std::size_t>(robots);
  while (heard.whole() < count && seconds_since(begin) < limit) {
    node.wait(std::chrono::milliseconds(100));
    heard.look();
  }
  const double whole_s = seconds_since(begin);
  std::printf("%zu of %d robots whole after %.1f s\n", heard.whole(), robots, whole_s);

  // At rest, behind the work of the start.
  std::this_thread::sleep_for(std::chrono::seconds(10));
  const auto cost = [&] {
    std::map<pid_t, double> seconds;
    for (const auto& child : children)
      for (const pid_t pid : bench::family(child->pid()))
        seconds[pid] = bench::cpu_seconds(pid);
    return seconds;
  };
  const auto before = cost();
  const auto measured = Clock::now();
  while (seconds_since(measured) < 20.0) {
    node.wait(std::chrono::milliseconds(100));
    heard.look();
  }
  const double span = seconds_since(measured);
  double cpu = 0.0;
  double mb = 0.0;
  for (const auto& [pid, seconds] : cost()) {
    cpu += seconds - (before.contains(pid) ? before.at(pid) : 0.0);
    mb += bench::proportional_mb(pid);
  }
  bench::print({{"robots", robots},
                {"whole", heard.whole()},
                {"whole_s", whole_s},
                {"cpu_percent_per_robot", 100.0 * cpu / span / robots},
                {"mb_per_robot", mb / robots},
                {"mixed", heard.mixed()}},
               json);
  return heard.whole() == count && heard.mixed() == 0 ? 0 : 1;
}

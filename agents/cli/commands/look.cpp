// list and echo: the present bus.
#include <iostream>

#include "commands.hpp"
#include "direct.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/cli/printer.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

/// Discovery on one machine takes tens of milliseconds, over a network up to the announcement
/// period of 250 ms and its round trips.
constexpr milliseconds kDiscovery{1000};

std::string describe_endpoint(const bus::EndpointEntry& endpoint) {
  std::string text = endpoint.program.empty() ? "?" : endpoint.program;
  if (endpoint.pid != 0)
    text += "[" + std::to_string(endpoint.pid) + "]";
  if (!endpoint.host.empty())
    text += "@" + endpoint.host;
  return text;
}

std::string qos_of(const bus::EndpointEntry& endpoint) {
  std::string text = (endpoint.reliable ? "reliable " : "best effort ") + endpoint.durability;
  if (endpoint.deadline > 0.0)
    text += ", deadline " + plain(endpoint.deadline) + " s";
  if (endpoint.liveliness != "automatic" && !endpoint.liveliness.empty())
    text += ", " + endpoint.liveliness;
  if (endpoint.ownership != "shared" && !endpoint.ownership.empty())
    text += ", " + endpoint.ownership;
  return text;
}

int list_topics(bus::NodeOptions options, const bus::Stop& stop) {
  options.others = bus::Others::met;
  bus::Node node(options);
  const bus::Census census(node);
  poll_for(node, kDiscovery, stop, [] {});
  const auto known = bus::known_topics();
  std::string topic;
  bool any = false;
  for (const bus::EndpointEntry& endpoint : census.endpoints()) {
    any = true;
    if (endpoint.topic != topic) {
      topic = endpoint.topic;
      std::string qos = "not of this contract";
      for (const bus::TopicEntry& entry : known)
        if (entry.name == topic)
          qos = entry.qos;
      std::cout << topic << "  " << endpoint.type << "  (" << qos << ")\n";
    }
    std::cout << (endpoint.writer ? "  writer  " : "  reader  ") << describe_endpoint(endpoint)
              << "  " << endpoint.robot << "  " << qos_of(endpoint)
              << (endpoint.known_type ? "" : "  TYPE " + endpoint.type) << '\n';
  }
  const auto mismatches = census.mismatches();
  for (const bus::Mismatch& mismatch : mismatches)
    std::cout << "MISMATCH on " << mismatch.writer.topic << ": "
              << describe_endpoint(mismatch.writer) << " is not heard by "
              << describe_endpoint(mismatch.reader) << ": " << mismatch.why << '\n';
  if (!any) {
    std::cout << "nobody is on the bus\n";
    return bus::kExitFailed;
  }
  return mismatches.empty() ? bus::kExitOk : bus::kExitFailed;
}

/// `once`: without a timeout, an empty bus is given up.
int echo(const std::string& topic, std::uint64_t count, bool once, double timeout,
         const bus::NodeOptions& options, const bus::Stop& stop) {
  expect_topic(topic);
  bus::Node node(options);
  bus::Echo reader(node, topic);
  Processes processes(node);
  std::uint64_t shown = 0;
  const auto began = Clock::now();
  bool warned = false;
  while (!stop.requested()) {
    for (const std::string& line : reader.take_json()) {
      std::cout << line << '\n';
      if (++shown == count) {
        std::cout.flush();
        return bus::kExitOk;
      }
    }
    std::cout.flush();
    if (!std::cout)
      return bus::kExitOk;  // the reader of our output has left
    if (!warned && shown == 0 && reader.matched() == 0 && seconds_since(began) > 2.0) {
      std::cerr << "saphira: nobody writes " << topic << " for robot " << options.robot
                << "; waiting\n";
      warned = true;
    }
    if (timeout > 0.0 && seconds_since(began) >= timeout) {
      if (count > 0)
        complain("saphira: %llu of %llu samples came on %s in %g s\n",
                 static_cast<unsigned long long>(shown), static_cast<unsigned long long>(count),
                 topic.c_str(), timeout);
      return count > 0 || shown == 0 ? bus::kExitFailed : bus::kExitOk;
    }
    processes.poll();
    if (once && timeout == 0.0 && reader.matched() == 0 && processes.all().empty() &&
        seconds_since(began) > kEmptyBus) {
      complain("saphira: no answer yet: %s\nsaphira: given up\n", who_is_there(processes).c_str());
      return bus::kExitFailed;
    }
    // A short wait: the remaining time is checked again.
    node.wait(milliseconds(timeout > 0.0 ? 50 : 500), &stop);
  }
  return count == 0 ? bus::kExitOk : bus::kExitFailed;
}

}  // namespace

void add_list(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "list", "Topics, types, writers and readers with their QoS, and mismatches");
  chosen.reach[command] = {"list"};
  chosen.when(command, list_topics);
}

void add_echo(CLI::App& app, Chosen& chosen) {
  struct Options {
    std::string topic;
    std::uint64_t count = 0;
    bool once = false;
    double timeout = 0.0;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("echo", "Samples of a topic, as JSON lines");
  command->add_option("topic", options->topic, "such as robot/state")->required();
  CLI::Option* const count =
      command->add_option("-n,--count", options->count, "end after so many samples")
          ->check(above_zero());
  command->add_flag("--once", options->once, "end after one")->excludes(count);
  command->add_option("--timeout", options->timeout, "[s] end then; exit code 1: it came to less")
      ->check(above_zero())
      ->transform(number_in_unit("s"));
  chosen.when(command, [options](const bus::NodeOptions& node, const bus::Stop& stop) {
    return echo(options->topic, options->once ? 1 : options->count, options->once, options->timeout,
                node, stop);
  });
}

}  // namespace saphira::cli

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "commands.hpp"
#include "saphira/base/heartbeat.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

/// The status comes once a second, so everybody alive has spoken after this.
constexpr milliseconds kListen{1300};

class StatusView {
 public:
  explicit StatusView(bus::Node& node)
      : node_(node),
        processes_(node),
        grants_(node.reader(bus::topics::kGrant)),
        log_(node.reader(bus::topics::kLog)) {}

  void poll() {
    processes_.poll();
    if (auto grant = grants_.take_newest()) {
      grant_ = std::move(grant);
      grant_came_ = Clock::now();
    }
    for (const auto& sample : log_.take())
      if (sample.data.text().starts_with(kStartedAgain))
        started_again_[sample.data.instance()] = sample.data.name() + " was " + sample.data.text();
  }

  std::string text() const {
    const auto all = processes_.all();
    if (all.empty())
      return who_is_there(node_.options(), processes_) + "\n" + silent_peers();
    std::string text = status_table(all);
    const double age = seconds_since(grant_came_);
    if (!grant_)
      text += "drive: nothing is said about the grant\n";
    else if (age > 1.0)
      text += "drive: nothing is said about the grant for " +
              std::to_string(static_cast<int>(age)) + " s\n";
    else
      text += "drive: " + describe(*grant_) + "\n";
    if (const std::string missing = missing_services(all); !missing.empty())
      text += "not on the bus: " + missing + "\n";
    if (const std::string second = second_deployment(all); !second.empty())
      text += second + "\n";
    for (const auto& [instance, words] : started_again_)
      text += words + "\n";
    return text + silent_peers();
  }

  bool anybody() const { return !processes_.all().empty(); }

 private:
  std::string silent_peers() const {
    std::string text;
    for (const auto& peer : node_.silent_peers())
      text += "peer " + peer +
              ": nothing is heard from it; there, `saphira up` needs profile wan and domain " +
              std::to_string(node_.options().domain) + ", and a network that lets UDP through\n";
    return text;
  }

  bus::Node& node_;
  Processes processes_;
  bus::Reader<v1::Grant> grants_;
  bus::Reader<v1::LogRecord> log_;
  std::map<std::uint64_t, std::string> started_again_;  ///< by the supervisor, and why
  std::optional<v1::Grant> grant_;
  Clock::time_point grant_came_;
};

int status(bool watch, const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  StatusView view(node);
  const auto listen = [&](milliseconds time) {
    const auto end = Clock::now() + time;
    while (!stop.requested() && Clock::now() < end) {
      node.wait(std::chrono::ceil<milliseconds>(end - Clock::now()), &stop);
      view.poll();
    }
  };
  listen(kListen);
  while (watch && !stop.requested()) {
    const bool terminal = isatty(STDOUT_FILENO) != 0;
    std::printf("%s%s%s", terminal ? "\x1b[H\x1b[2J" : "", view.text().c_str(),
                terminal ? "" : "\n");
    std::fflush(stdout);
    listen(std::chrono::seconds(1));
  }
  if (!watch)
    std::fputs(view.text().c_str(), stdout);
  return view.anybody() ? bus::kExitOk : bus::kExitFailed;
}

}  // namespace

void add_status(CLI::App& app, Chosen& chosen) {
  auto watch = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("status", "Every process, and who drives and why");
  command->add_flag("--watch,-w", *watch, "again each second, until Ctrl-C");
  command->callback([watch, &chosen] {
    chosen.run = [watch](const bus::NodeOptions& node, const bus::Stop& stop) {
      return status(*watch, node, stop);
    };
  });
}

}  // namespace saphira::cli

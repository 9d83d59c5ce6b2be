// The emergency stop, and its reset.
#include <optional>
#include <stdexcept>

#include "bridges.hpp"
#include "commands.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/teleop/pilot.hpp"
#include "saphira/watch/halt.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kAgain{20};  ///< between two commands: the topic is best effort
constexpr double kResetLimit = 5.0;

constexpr const char* kOtherStop =
    "; saphira goal stop, which observers may too, and the STOP of a page stop the robot as well";

/// A stop button of the terminal.
class Button {
 public:
  explicit Button(const bus::NodeOptions& options)
      : node_(options), processes_(node_), source_(person("saphira estop")) {}

  /// Presses until every bridge of this name confirms the latch, without a time limit.
  int press(const bus::Stop& stop) {
    watch::Halt halt;
    pilot_.press(source_);
    stops_.emplace(node_.writer(bus::topics::kDriveEstop));  // a member may have the reset alone
    while (!stop.requested()) {
      write(false);
      node_.wait(kAgain, &stop);
      poll();
      const double now = seconds_since(began_);
      const bool all = bridges_.all(is_latched);
      const watch::Halt::News news = halt.update(all, now);
      if (all && bridges_.complete()) {
        // Latched: the bridge holds the stop without us.
        while (write(true))
          node_.wait(milliseconds(5));
        print("%s: %s (confirmed by the bridge%s after %.2f s)%s\n",
              called(node_.options().robot).c_str(), latched(*bridges_.newest()).c_str(),
              bridges_.several().c_str(), now - halt.lasts(now), bridges_.names().c_str());
        return bus::kExitOk;
      }
      if (news == watch::Halt::News::not_confirmed)
        complain(
            "saphira: %s\n",
            bridges_.unconfirmed(bridges_.not_so(is_latched), halt.lasts(now), processes_).c_str());
    }
    complain("saphira: ended without a confirmation: whether the robot is stopped is not known\n");
    return bus::kExitFailed;
  }

  int reset(const bus::Stop& stop) {
    bus::RequestClient resets(node_, bus::topics::kEstopReset, source_);  // of operators alone
    const std::vector<v1::Answer> ends = resets.ask_each(
        bus::request("reset"), kResetLimit, bridges_.servers(), &stop, [this] { poll(); });
    for (const v1::Answer& end : ends) {
      if (!bus::well(end.code)) {
        complain("saphira: not reset: %s\n",
                 end.code == v1::ANSWER_NOBODY
                     ? ("no bridge is heard; " + who_is_there(processes_)).c_str()
                     : end.text.c_str());
        return bus::kExitFailed;
      }
      print("%s\n", end.text.c_str());
    }
    return bus::kExitOk;
  }

 private:
  static bool is_latched(const v1::Grant& one) { return one.estopped; }

  /// False where there is nothing more to say.
  bool write(bool latched) {
    const auto command = pilot_.stop(latched);
    if (command)
      stops_->write(*command);
    return command.has_value();
  }

  void poll() {
    processes_.poll();
    bridges_.poll();
  }
  Clock::time_point began_ = Clock::now();
  bus::Node node_;
  std::optional<bus::Writer<v1::MotorCommand>> stops_;
  Bridges bridges_{node_};
  Processes processes_;
  std::string source_;
  teleop::Pilot pilot_{source_};
};

}  // namespace

void add_estop(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand(
      "estop", "Emergency stop: the robot stands until `saphira estop reset`, whatever else runs");
  CLI::App* reset =
      command->add_subcommand("reset", "Releases it; the robot stands until a new command");
  chosen.reach[command] = {"estop"};
  command->require_subcommand(0, 1);
  command->footer(
      "Exit code 0: each bridge has confirmed it; 1: not. Who drives by then does not drive on\n"
      "after the reset: goals are ended, a person lets the keys go first.");
  command->callback([reset, &chosen] {
    const bool released = reset->parsed();
    chosen.run = [released](const bus::NodeOptions& options, const bus::Stop& stop) {
      try {
        Button button(options);
        return released ? button.reset(stop) : button.press(stop);
      } catch (const std::invalid_argument& error) {
        const std::string why = error.what();
        const bool is_role = why.find(" may not write ") != std::string::npos;
        throw std::invalid_argument(why + (is_role && !released ? kOtherStop : ""));
      }
    };
  });
}

}  // namespace saphira::cli

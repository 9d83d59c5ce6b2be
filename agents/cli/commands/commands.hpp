#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "run_folder.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/units.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/command_line/command_line.hpp"

/// The subcommands of `saphira`. Each adds itself to the command line, and when chosen gives the
/// function to run.
namespace saphira::cli {

/// The chosen subcommand; set by its callback.
struct Chosen {
  using Run = std::function<int(const bus::NodeOptions&, const bus::Stop&)>;
  Run run;
  /// Runs `what` where the command is chosen.
  void when(CLI::App* command, Run what) {
    command->callback([this, what = std::move(what)] { run = what; });
  }
  template <class Options>
  void when(CLI::App* command, std::shared_ptr<Options> options,
            int (*what)(const Options&, const bus::NodeOptions&, const bus::Stop&)) {
    when(command, [options, what](const bus::NodeOptions& node, const bus::Stop& stop) {
      return what(*options, node, stop);
    });
  }
  /// A command that reaches every robot (--robot '*') where `now` holds for its options. `name`:
  /// the command in the error about '*'; empty: the command needs no robot.
  struct Reach {
    std::string name;
    std::function<bool()> now = [] { return true; };
  };
  std::map<const CLI::App*, Reach> reach;
  /// The commands with a bus of their own, or none: they do not join one that runs.
  std::set<const CLI::App*> apart;
};

/// A validator of finite numbers; expected: the words for its error message.
inline CLI::Validator number_that(const std::string& expected,
                                  const std::function<bool(double)>& good,
                                  const std::string& in_help = "NUMBER") {
  return {[=](std::string& text) {
            double value = 0.0;
            return CLI::detail::lexical_cast(text, value) && std::isfinite(value) && good(value)
                       ? std::string()
                       : "expected " + expected + ", found " + text.substr(0, 40);
          },
          in_help};
}
inline CLI::Validator at_least_zero() {
  return number_that("0 or more", [](double value) { return value >= 0.0; });
}
inline CLI::Validator above_zero() {
  return number_that("more than 0", [](double value) { return value > 0.0; });
}
inline CLI::Validator between(double low, double high) {
  return number_that(
      "a number between " + plain(low) + " and " + plain(high),
      [=](double value) { return value >= low && value <= high; },
      "in [" + plain(low) + " - " + plain(high) + "]");
}
/// A whole number of that type.
template <class T>
CLI::Validator whole() {
  return {[](std::string& text) { return trouble_of_limits<T>(text); }, ""};
}

/// Makes the number of an option out of a number with or without its unit: "30cm" is 0.3 in m.
inline CLI::Validator number_in_unit(const std::string& unit) {
  return {[=](std::string& text) {
            const std::optional<double> value = measured(text, unit);
            const std::string found = text.substr(0, 40);
            if (value)
              text = exact(*value);
            return value ? std::string() : "expected a number in " + unit + ", found " + found;
          },
          ""};
}

/// The values of --robot and --domain, or of their variables, where they were given.
inline FilesOf given_bus(const CLI::App& root) {
  const auto value = [&](const char* option) {
    const CLI::Option& one = *root.get_option(option);
    return one.count() > 0 ? one.as<std::string>() : std::string();
  };
  return {value("--robot"), value("--domain")};
}

/// Says why the command has failed; its exit code.
inline int failed(const std::string& why) {
  std::fprintf(stderr, "saphira: %s\n", why.c_str());
  return bus::kExitFailed;
}

/// Adds a subcommand to the parser.
using AddCommand = void(CLI::App& app, Chosen& chosen);
AddCommand add_demo, add_up, add_check, add_security, add_keys, add_audit, add_box, add_stop,
    add_renew, add_status, add_doctor, add_list, add_echo, add_log, add_goal, add_intentions,
    add_behaviors, add_why, add_beliefs, add_processes, add_device, add_map, add_scenario, add_say,
    add_talk, add_knows, add_ask, add_agents, add_drive, add_direct, add_estop, add_complete,
    add_write, add_wiring, add_programs, add_bench;

}  // namespace saphira::cli

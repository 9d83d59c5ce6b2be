// The topics of each program, written and read: the system's table.
#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"
#include "system/system.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

/// The status comes once a second.
constexpr milliseconds kListen{1300};

struct WiringOptions {
  bool table = false;
  std::string drawing;
};

/// The reason why a unit does not run well, in words; empty: it does.
std::string trouble_of(const runtime::Unit& unit, const std::vector<SeenProcess>& seen) {
  const auto found = std::ranges::find_if(
      seen, [&](const SeenProcess& process) { return process.status.name == unit.name; });
  return found == seen.end() ? "not on the bus" : found->status.reason;
}

int wiring(const WiringOptions& options, const bus::NodeOptions& node_options,
           const bus::Stop& stop) {
  const std::vector<runtime::Unit> units = system::units();
  if (options.table) {
    std::fputs(runtime::wiring_table(units).c_str(), stdout);
    return bus::kExitOk;
  }
  // A drawing is of the table, as in the documents, whatever runs now.
  if (!options.drawing.empty()) {
    expect_ending(options.drawing, ".svg");
    if (!replace_file(options.drawing, runtime::wiring_drawing(units)))
      throw UnusableFile(cannot_be(options.drawing, "written"));
    std::printf("drew %s\n", options.drawing.c_str());
    return bus::kExitOk;
  }
  bus::Node node(node_options);
  Processes processes(node);
  poll_for(node, kListen, stop, [&] { processes.poll(); });
  const std::vector<SeenProcess> seen = processes.all();
  std::fputs(runtime::wiring_text(units).c_str(), stdout);
  if (seen.empty()) {
    std::printf("\nOn the bus of robot %s is no program now.\n", node_options.robot.c_str());
    return bus::kExitOk;
  }
  for (const runtime::Unit& unit : units)
    if (const std::string trouble = trouble_of(unit, seen); !trouble.empty())
      std::printf("%s: %s\n", unit.name.c_str(), trouble.c_str());
  return bus::kExitOk;
}

}  // namespace

void add_wiring(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<WiringOptions>();
  CLI::App* command =
      app.add_subcommand("wiring", "Which program writes which topic and which reads it");
  command->add_option("--draw", options->drawing, "as a drawing (SVG) into this file");
  command->add_flag("--table", options->table, "as a table in Markdown, of the system at rest");
  chosen.when(command, options, wiring);
}

}  // namespace saphira::cli

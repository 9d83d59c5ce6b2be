#include <ctime>
#include <iostream>
#include <map>

#include "commands.hpp"
#include "saphira/base/format.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

constexpr double kLogPatience = 3.0;  ///< [s] for the first line
constexpr double kQuiet = 0.7;        ///< [s] after the last line: all earlier ones have come

std::string clock_time(std::int64_t time_ns) {
  return local_text(time_ns / 1'000'000'000, "%H:%M:%S") +
         format(".%03d", static_cast<int>(time_ns / 1'000'000 % 1000));
}

std::string record_line(const v1::LogRecord& record) {
  return clock_time(record.time_ns) + "  " + name_of(record.level) + "  " + record.name + "  " +
         record.text + "\n";
}

/// The newest lines, of all programs together.
int newest(std::uint64_t count, const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  auto reader = node.reader(bus::topics::kLog);
  std::multimap<std::int64_t, std::string> lines;  // by time: each program's lines are in order
  const auto began = Clock::now();
  auto came = began;
  while (!stop.requested() && seconds_since(began) < kLogPatience &&
         (lines.empty() || seconds_since(came) < kQuiet)) {
    for (const auto& sample : reader.take())
      if (!sample.info.disposed) {
        lines.emplace(sample.data.time_ns, record_line(sample.data));
        came = Clock::now();
      }
    node.wait(std::chrono::milliseconds(50), &stop);
  }
  while (lines.size() > count)
    lines.erase(lines.begin());
  for (const auto& [time, line] : lines)
    std::cout << line;
  if (lines.empty())
    std::cerr << "saphira: no program of robot " << options.robot << " has said anything in domain "
              << options.domain << '\n';
  return lines.empty() ? bus::kExitFailed : bus::kExitOk;
}

int follow(const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  auto reader = node.reader(bus::topics::kLog);
  while (!stop.requested()) {
    for (const auto& sample : reader.take())
      if (!sample.info.disposed)
        std::cout << record_line(sample.data);
    std::cout.flush();
    if (!std::cout)
      return bus::kExitOk;
    node.wait(std::chrono::milliseconds(500), &stop);
  }
  return bus::kExitOk;
}

}  // namespace

void add_log(CLI::App& app, Chosen& chosen) {
  auto count = std::make_shared<std::uint64_t>(0);
  CLI::App* command = app.add_subcommand("log", "Messages of all programs");
  command->add_option("-n", *count, "the newest so many lines, and no more")->check(above_zero());
  chosen.when(command, [count](const bus::NodeOptions& node, const bus::Stop& stop) {
    return *count > 0 ? newest(*count, node, stop) : follow(node, stop);
  });
}

}  // namespace saphira::cli

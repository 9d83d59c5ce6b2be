#include <array>
#include <cstdio>
#include <ctime>
#include <iostream>

#include "commands.hpp"
#include "robot_log.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

std::string clock_time(std::int64_t time_ns) {
  const std::time_t seconds = time_ns / 1'000'000'000;
  std::tm local{};
  localtime_r(&seconds, &local);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%H:%M:%S", &local);
  std::snprintf(text.data() + length, text.size() - length, ".%03d",
                static_cast<int>(time_ns / 1'000'000 % 1000));
  return text.data();
}

int log(std::uint64_t count, const bus::NodeOptions& options, const bus::Stop& stop) {
  bus::Node node(options);
  auto reader = node.reader(bus::topics::kLog);
  std::uint64_t shown = 0;
  while (!stop.requested()) {
    for (const auto& sample : reader.take()) {
      if (sample.info.disposed)
        continue;
      const v1::LogRecord& record = sample.data;
      std::cout << clock_time(record.time_ns()) << "  " << name_of(record.level()) << "  "
                << record.name() << "  " << record.text() << '\n';
      if (++shown == count) {
        std::cout.flush();
        return bus::kExitOk;
      }
    }
    std::cout.flush();
    if (!std::cout)
      return bus::kExitOk;
    node.wait(std::chrono::milliseconds(500), &stop);
  }
  return count == 0 ? bus::kExitOk : bus::kExitFailed;
}

}  // namespace

void add_log(CLI::App& app, Chosen& chosen) {
  auto count = std::make_shared<std::uint64_t>(0);
  CLI::App* command =
      app.add_subcommand("log", "What the programs have to say; and tools for logs of robots");
  command->add_option("-n", *count, "end after so many lines");
  add_robot_log(*command, chosen);
  command->callback([count, command, &chosen] {
    if (!command->get_subcommands().empty())
      return;
    chosen.run = [count](const bus::NodeOptions& node, const bus::Stop& stop) {
      return log(*count, node, stop);
    };
  });
}

}  // namespace saphira::cli

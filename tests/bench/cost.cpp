// The instructions that a cycle of the robot costs, which no other load of the machine changes.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bench.hpp"
#include "drive/whole.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"

namespace {

using Costs = std::map<std::string, double>;

// Parts and their functions.
const std::map<std::string, std::string> kParts{
    {"all", "saphira::test::Whole::advance()"},
    {"interpretation", "saphira::interpretation::Service::step("},
    {"registration", "saphira::registration::Service::step("},
    {"behaviors", "saphira::behaviors::Service::step("},
    {"intentions", "saphira::intentions::Service::step("},
    {"guard", "saphira::test::Drive::guard("},
    {"services and bus", "saphira::test::Drive::step_services()"},
};

constexpr int kPeriod = 600;  // cycles

/// The robot drives to a place of the office and rests, for that many cycles in all.
void drive(int cycles) {
  using namespace saphira::test;
  WholeOptions options;
  options.drive.world = "office-floor";
  options.drive.guard = true;
  Whole whole(options);
  saphira::v1::GoalId goal;
  int drives = 0;
  for (int i = 0; i < cycles; ++i) {
    if (i % kPeriod == 0)
      goal = whole.ask("go-to-place",
                       {saphira::text("place", i % (2 * kPeriod) == 0 ? "EJ-245" : "EJ-247")});
    whole.advance();
    drives += whole.ended(goal) ? 0 : 1;
  }
  std::printf("drives in %d of %d cycles\n", drives, cycles);
}

/// Instructions of `cycles` and of the start, by part.
Costs count(const std::string& program, int cycles) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("saphira-cost." + std::to_string(getpid())))
          .string();
  using saphira::bench::output_of;
  output_of({"/usr/bin/valgrind", "--tool=callgrind", "--callgrind-out-file=" + file, program,
             "--drive", std::to_string(cycles)});
  std::istringstream lines(
      output_of({"/usr/bin/callgrind_annotate", "--inclusive=yes", "--threshold=100", file}));
  std::filesystem::remove(file);
  Costs costs;
  for (std::string line; std::getline(lines, line);)
    for (const auto& [part, function] : kParts)
      if (line.find(function) != std::string::npos && !costs.contains(part)) {
        std::string number = line.substr(0, line.find('('));
        std::erase(number, ',');
        costs[part] = std::stod(number);
      }
  if (costs.size() != kParts.size())
    throw std::runtime_error("the profile lacks a part: the program has no symbols");
  return costs;
}

}  // namespace

int main(int argc, char** argv) {
  saphira::CommandLine app{"Instructions of a cycle (callgrind), by service"};
  bool json = false;
  int cycles = 0;
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--drive", cycles, "drives that many cycles, and counts nothing")
      .in_range(0, 1'000'000);
  if (const auto code = app.parse(argc, argv))
    return *code;
  if (cycles > 0) {
    drive(cycles);
    return 0;
  }
  constexpr int kStart = kPeriod;
  constexpr int kCounted = 2 * kPeriod;
  const std::string program = std::filesystem::canonical("/proc/self/exe").string();
  const Costs start = count(program, kStart);
  Costs costs = count(program, kStart + kCounted);
  for (auto& [part, cost] : costs)
    cost = (cost - start.at(part)) / kCounted;
  saphira::bench::print(costs, json);
  return 0;
}

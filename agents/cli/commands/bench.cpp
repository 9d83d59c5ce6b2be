#include <stdlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "commands.hpp"
#include "environment.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "saphira/cli/deployment.hpp"

namespace saphira::cli {

namespace {

constexpr const char* kPrefix = "saphira-bench-";

std::vector<std::string> benchmarks(const std::string& bin) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(bin)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kPrefix) && entry.path().extension().empty())
      names.push_back(name.substr(std::strlen(kPrefix)));
  }
  std::ranges::sort(names);
  return names;
}

int bench(const std::string& name, const std::vector<std::string>& arguments) {
  const std::string bin = find_places().bin;
  const auto names = benchmarks(bin);
  if (name.empty()) {
    for (const std::string& known : names)
      std::cout << known << '\n';
    if (!names.empty())
      return bus::kExitOk;
    return failed("no benchmarks are built here (./saphira bench builds them)");
  }
  if (std::ranges::find(names, name) == names.end())
    throw std::invalid_argument(
        "no benchmark \"" + name + '"' + did_you_mean(name, names, ":") +
        (names.empty() ? " none is built here (./saphira bench, in the source tree, builds them)"
                       : " expected one of " + joined(names, " ")));
  std::vector<std::string> words{bin + "/" + kPrefix + name};
  words.insert(words.end(), arguments.begin(), arguments.end());
  setenv("SAPHIRA_BIN_DIR", bin.c_str(), 0);  // the benchmarks start our programs
  execute(std::move(words));
}

}  // namespace

void add_bench(CLI::App& app, Chosen& chosen) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "bench", "Run a benchmark, with its own options behind its name; without a name: list them");
  command->add_option("name", *name, "the benchmark");
  command->allow_extras();
  chosen.apart.insert(command);
  command->callback([name, command, &chosen] {
    chosen.run = [name, rest = command->remaining()](const bus::NodeOptions&, const bus::Stop&) {
      return bench(*name, rest);
    };
  });
}

}  // namespace saphira::cli

// The delay of the answer to a newcomer's mistake.
#include "integration/mistakes.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "process.hpp"
#include "saphira/command_line/command_line.hpp"

int main(int argc, char** argv) {
  using namespace saphira;
  CommandLine app("How long the answers to mistakes take");
  bool json = false;
  app.add_flag("--json", json, "one JSON object");
  if (const auto code = app.parse(argc, argv))
    return *code;

  double slowest = 0.0;
  double sum = 0.0;
  std::string words;
  int wrong = 0;
  for (const test::Mistake& mistake : test::mistakes()) {
    const test::TempDir folder;
    std::vector<std::string> command{"/bin/sh", "-c", "exec \"$0\" \"$@\" </dev/null",
                                     test::program("saphira")};
    command.insert(command.end(), mistake.words.begin(), mistake.words.end());
    const auto began = std::chrono::steady_clock::now();
    test::Process process(command, folder.path("said"));
    const auto code = process.wait();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    const std::string said = process.output();
    if (!(code == 1 || code == 2) ||
        std::any_of(mistake.said.begin(), mistake.said.end(),
                    [&](const std::string& part) { return said.find(part) == std::string::npos; }))
      ++wrong;
    sum += took.count();
    if (took.count() > slowest) {
      slowest = took.count();
      words.clear();
      for (const std::string& word : mistake.words)
        words += (words.empty() ? "" : " ") + word;
    }
  }
  nlohmann::ordered_json result;
  result["mistakes"] = test::mistakes().size();
  result["wrong"] = wrong;
  result["mean_s"] = sum / static_cast<double>(test::mistakes().size());
  result["slowest_s"] = slowest;
  result["slowest"] = words;
  if (json)
    std::printf("%s\n", result.dump().c_str());
  else
    std::printf("%zu mistakes, %d answered wrongly; slowest answer %.2f s (%s), mean %.2f s\n",
                test::mistakes().size(), wrong, slowest, words.c_str(),
                result["mean_s"].get<double>());
  return wrong == 0 ? 0 : 1;
}

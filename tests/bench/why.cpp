// Asks why in each situation of docs/situations.md, and counts the wrong answers.
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "saphira/command_line/command_line.hpp"
#include "table.hpp"

int main(int argc, char** argv) {
  using namespace saphira::situation;
  saphira::CommandLine app(
      "Asks why in each situation of docs/situations.md, and counts what is said falsely");
  bool json = false;
  app.add_flag("--json", json, "one JSON object");
  if (const auto code = app.parse(argc, argv))
    return *code;

  const std::vector<test::Case> cases = test::all_cases();
  int wrong = 0;
  std::size_t longest = 0;
  const auto began = std::chrono::steady_clock::now();
  for (const test::Case& one : cases) {
    const std::vector<std::string> faults = test::faults(one);
    wrong += faults.empty() ? 0 : 1;
    if (one.question != "why tree")
      longest = std::max(longest, test::answer(one).size());
    for (const std::string& fault : faults)
      std::fprintf(stderr, "%s, %s: %s\n", one.words.c_str(), one.question.c_str(), fault.c_str());
  }
  const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - began;
  nlohmann::ordered_json result;
  result["situations"] = cases.size();
  result["false"] = wrong;
  result["longest_answer"] = longest;
  result["answer_us"] = took.count() / static_cast<double>(2 * cases.size());
  if (json)
    std::printf("%s\n", result.dump().c_str());
  else
    std::printf(
        "%zu situations, %d answered falsely; longest answer %zu characters, %.0f us each\n",
        cases.size(), wrong, longest, result["answer_us"].get<double>());
  return wrong == 0 ? 0 : 1;
}

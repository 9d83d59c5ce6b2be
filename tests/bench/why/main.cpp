// The share of answers to why, why not and status that lack something, or say something false: in
// the situations of agents/situation/test/situations.txt, or of a file of your own.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../../support/guarded.hpp"
#include "../result.hpp"
#include "agents/situation/test/table.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"

namespace {

using namespace saphira;
using namespace saphira::situation::test;

int run(const std::string& file, bool json) {
  const std::vector<Case> all = read_cases(read_file(file), file);
  int half = 0;
  int wrong = 0;
  for (const Case& one : all) {
    const Faults found = faults(one);
    wrong += found.says.empty() ? 0 : 1;
    half += found.says.empty() && !found.lacks.empty() ? 1 : 0;
    if (json || (found.says.empty() && found.lacks.empty()))
      continue;
    std::printf("%s, %s: %s\n", one.words.c_str(), one.question.c_str(), answer(one).c_str());
    for (const std::string& part : found.lacks)
      std::printf("  lacks: %s\n", part.c_str());
    for (const std::string& part : found.says)
      std::printf("  says: %s\n", part.c_str());
  }
  bench::print({{"situations", all.size()}, {"half", half}, {"false", wrong}}, json);
  return half + wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("What why, why not and status say");
  std::string file = "agents/situation/test/situations.txt";
  bool json = false;
  app.add_option("--situations", file, "situations, and what each answer must name");
  app.add_flag("--json", json, "one JSON object: situations, half, false");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return saphira::test::guarded([&] { return run(file, json); });
}

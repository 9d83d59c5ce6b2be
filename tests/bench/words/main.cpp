// The share of utterances with the meaning that a person would give them, and of wrong actions: for
// services/agent_interface/test/utterances.txt, or a file of your own.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "agent_interface/test/utterances.hpp"
#include "bench/study.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"

namespace {

using namespace saphira;
using namespace saphira::agent_interface;

/// True where the meaning leads to an action.
bool acts(const std::string& meaning) {
  return meaning != "what?" && meaning != "nothing" && meaning != "ambiguous";
}

int run(const std::string& file, const std::string& grammar_file, bool json) {
  const Grammar grammar(read_file(grammar_file), grammar_file);
  const std::vector<SaidAndMeant> phrases = read_utterances(read_file(file));
  int right = 0;
  int acted_wrongly = 0;
  for (const SaidAndMeant& phrase : phrases) {
    const std::string meant = meaning_of(grammar, phrase);
    if (meant == phrase.meaning) {
      ++right;
      continue;
    }
    acted_wrongly += acts(meant) ? 1 : 0;
    if (!json)
      std::printf("\"%s\": expected %s, understood %s\n", phrase.text.c_str(),
                  phrase.meaning.c_str(), meant.c_str());
  }
  bench::print({{"utterances", phrases.size()}, {"right", right}, {"acted_wrongly", acted_wrongly}},
               json);
  return acted_wrongly == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("How utterances are understood");
  std::string file = "services/agent_interface/test/utterances.txt";
  std::string grammar;
  bool json = false;
  app.add_option("--utterances", file, "lines \"utterance => meaning\"");
  app.add_option("--grammar", grammar, "grammar file [the shipped one]");
  app.add_flag("--json", json, "one JSON object: utterances, right, acted_wrongly");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] {
    return run(file, grammar.empty() ? config_folder() + "/grammars/flakey.grammar" : grammar,
               json);
  });
}

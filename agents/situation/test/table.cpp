#include "table.hpp"

#include <sstream>

#include "saphira/situation/sentence.hpp"
#include "saphira/situation/why.hpp"

namespace saphira::situation::test {
namespace {

std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts)
    text += (text.empty() ? "" : "<br>") + part;
  return text.empty() ? "-" : text;
}

}  // namespace

std::vector<Case> all_cases() {
  std::vector<Case> all = good_cases();
  for (Case& one : bad_cases())
    all.push_back(std::move(one));
  return all;
}

std::string answer(const Case& one) {
  if (one.question == "why")
    return why(one.situation).sentence;
  if (one.question == "why tree")
    return to_text(why(one.situation));
  if (one.question == "drive")
    return driver(one.situation);
  if (one.question == "trouble")
    return trouble(one.situation);
  std::istringstream words(one.question.substr(std::string("why not ").size()));
  std::vector<std::string> wish;
  for (std::string word; words >> word;)
    wish.push_back(word);
  return why_not(one.situation, parse_wish(wish).value()).sentence;
}

std::vector<std::string> faults(const Case& one) {
  std::vector<std::string> found;
  const std::string said = answer(one);
  for (const std::string& part : one.must)
    if (said.find(part) == std::string::npos)
      found.push_back("does not say \"" + part + "\"");
  for (const std::string& part : one.must_not)
    if (said.find(part) != std::string::npos)
      found.push_back("says \"" + part + "\"");
  if (one.question.starts_with("why") && one.question != "why tree" &&
      said.size() >= kLongestSentence)
    found.push_back("has " + std::to_string(said.size()) + " characters");
  return found;
}

std::string to_markdown(const std::vector<Case>& cases) {
  std::string text =
      "# Situations, and what is said in them\n\n"
      "`saphira why`, `why not`, `status`, and what `goal`, `drive` and `map` say when nobody "
      "answers, take\ntheir words from one model of the situation (`agents/situation`). The test "
      "`saphira_situation_test`\nmakes each of these situations, asks, and compares; it also "
      "writes this table:\n`SAPHIRA_WRITE_TABLE=1 saphira_situation_test`. `drive` is the line of "
      "`status` about "
      "which program\ndrives, `trouble` its line about the programs. Sentences are shorter than "
      "200 characters; the "
      "rest is in the tree below them.\n\n"
      "| | situation | question | must be said | must not be said | answer |\n"
      "|---|---|---|---|---|---|\n";
  int number = 0;
  for (const Case& one : cases) {
    std::string said = answer(one);
    if (one.question == "why tree")
      said = "(the tree)";
    for (std::size_t at = 0; (at = said.find('|', at)) != std::string::npos; at += 2)
      said.insert(at, "\\");
    text += "| " + std::to_string(++number) + " | " + one.words + " | " + one.question + " | " +
            listed(one.must) + " | " + listed(one.must_not) + " | " +
            (said.empty() ? "(nothing)" : said) + " |\n";
  }
  return text;
}

}  // namespace saphira::situation::test

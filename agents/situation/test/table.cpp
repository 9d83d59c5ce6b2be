#include "table.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

#include "office.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/situation/why.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::situation::test {
namespace {

std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts)
    text += (text.empty() ? "" : "<br>") + part;
  return text.empty() ? "-" : text;
}

/// A change of a situation: its parameters, of which the last one is the rest of its line, and what
/// is merged into the situation's JSON (RFC 7386), or a list of operations on it (RFC 6902).
struct Change {
  std::vector<std::string> parameters;
  Json json;
};
using Changes = std::map<std::string, Change>;

std::string with_values(std::string text, const std::map<std::string, std::string>& values) {
  for (const auto& [name, value] : values)
    for (std::size_t at = 0; (at = text.find("$" + name, at)) != std::string::npos;
         at += value.size())
      text.replace(at, name.size() + 1, value);
  return text;
}

Json with_values(const Json& json, const std::map<std::string, std::string>& values) {
  if (json.is_string())
    return with_values(json.get<std::string>(), values);
  if (!json.is_object() && !json.is_array())
    return json;
  Json made = json.is_object() ? Json::object() : Json::array();
  for (const auto& [key, each] : json.items())
    if (json.is_object())
      made[with_values(key, values)] = with_values(each, values);
    else
      made.push_back(with_values(each, values));
  return made;
}

void merge(const Json& change, Json& situation) {
  const Json json = evaluated(change, situation.value("now", std::uint64_t{0}));
  if (json.is_array())
    situation = situation.patch(json);
  else
    situation.merge_patch(json);
}

/// `NAME VALUE ...` of a known change, a change itself, or `/PATH/TO/MEMBER JSON`.
void change(const std::string& text, const Changes& changes, Json& situation) {
  if (text.starts_with('{') || text.starts_with('['))
    return merge(Json::parse(text), situation);
  if (text.starts_with('/')) {
    const std::size_t space = text.find(' ');
    const std::uint64_t now = situation.value("now", std::uint64_t{0});
    situation[Json::json_pointer(text.substr(0, space))] =
        evaluated(Json::parse(text.substr(std::min(space, text.size()))), now);
    return;
  }
  std::istringstream in(text);
  std::string name;
  in >> name;
  const auto found = changes.find(name);
  if (found == changes.end())
    throw std::invalid_argument("there is no change \"" + name + "\"");
  std::map<std::string, std::string> values;
  for (const std::string& parameter : found->second.parameters)
    if (&parameter == &found->second.parameters.back())
      std::getline(in >> std::ws, values[parameter]);
    else
      in >> values[parameter];
  merge(with_values(found->second.json, values), situation);
}

/// `NAME PARAMETER ... = JSON`
void define(const std::string& text, Changes& changes) {
  const std::size_t is = text.find(" = ");
  std::istringstream in(text.substr(0, is));
  std::string name;
  in >> name;
  Change& made = changes[name];
  for (std::string parameter; in >> parameter;)
    made.parameters.push_back(parameter);
  made.json = Json::parse(text.substr(is + 3));
}

Json base(const std::string& name, const Changes& changes) {
  if (name == "nothing")
    return {{"listened", 3}};
  Json made = driving_json();
  if (name != "driving")
    change(name, changes, made);
  return made;
}

/// A line of the file: its keyword, and what follows.
struct Line {
  int number = 0;
  std::string keyword;
  std::string rest;
};

std::vector<Line> read_lines(const std::string& text) {
  std::vector<Line> lines;
  std::istringstream in(text);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t space = std::min(line.find(' '), line.size());
    if (!line.empty() && line.front() != '#')
      lines.push_back(
          {number, line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
  }
  return lines;
}

/// The cases of one situation.
void make(const std::vector<Line>& lines, const std::map<std::string, std::string>& values,
          const std::string& file, const Changes& changes, std::vector<Case>& all) {
  Json made;
  std::string words;
  bool asked = false;
  for (const Line& line : lines) {
    try {
      const std::string rest = with_values(line.rest, values);
      if (line.keyword == "situation") {
        words = rest;
      } else if (line.keyword == "is") {
        made = base(rest, changes);
      } else if (line.keyword == "with") {
        change(rest, changes, made);
      } else if (line.keyword == "ask") {
        all.push_back({asked ? "the same" : words, rest, situation_of(made), {}, {}, {}, {}});
        asked = true;
      } else if (asked && line.keyword == "must") {
        all.back().must.push_back(rest);
      } else if (asked && line.keyword == "says") {
        all.back().says = rest;
      } else if (asked && line.keyword == "once") {
        all.back().must.push_back(rest);
        all.back().once.push_back(rest);
      } else if (asked && line.keyword == "never") {
        all.back().never.push_back(rest);
      } else if (line.keyword != "each") {
        throw std::invalid_argument(
            "expected situation, each, is, with, ask, says, must, once or never");
      }
    } catch (const std::exception& error) {
      throw std::invalid_argument(file + ":" + std::to_string(line.number) + ": " + error.what());
    }
  }
}

/// With each value of the first of its lists, and so on.
void make_each(const std::vector<Line>& lines, std::size_t list,
               std::map<std::string, std::string> values, const std::string& file,
               const Changes& changes, std::vector<Case>& all) {
  while (list < lines.size() && lines[list].keyword != "each")
    ++list;
  if (list == lines.size())
    return make(lines, values, file, changes, all);
  std::istringstream in(lines[list].rest);
  std::string name;
  in >> name;
  for (std::string value; std::getline(in >> std::ws, value, ',');) {
    values[name] = value;
    make_each(lines, list + 1, values, file, changes, all);
  }
}

}  // namespace

std::vector<Case> read_cases(const std::string& text, const std::string& file) {
  std::vector<Case> all;
  std::vector<Line> lines = read_lines(text);
  Changes changes;
  std::erase_if(lines, [&](const Line& line) {
    if (line.keyword == "change")
      define(line.rest, changes);
    return line.keyword == "change";
  });
  const auto begins = [](const Line& line) { return line.keyword == "situation"; };
  for (auto from = lines.begin(); from != lines.end();) {
    const auto to = std::find_if(from + 1, lines.end(), begins);
    make_each({from, to}, 0, {}, file, changes, all);
    from = to;
  }
  return all;
}

namespace {

std::string answer_about(const Situation& s, const std::string& question,
                         const std::string& program) {
  if (question == "condition") {
    const Condition how = condition(s, program);
    return std::string(kEnumeratorNames<Health>.at(static_cast<std::size_t>(how.health))) +
           (how.heard() ? ", heard: " : ": ") + how.words;
  }
  if (question == "heard")
    return is_heard(s.programs, program) ? "yes" : "no";
  std::string all;
  const Json json = Json::parse(to_json(s));
  for (const Json& each : json.at("programs"))
    if (each.at("name") == program)
      all += (all.empty() ? "" : " | ") + each.at("condition").get<std::string>();
  return all;
}

}  // namespace

std::string answer(const Case& one) {
  const Situation& s = one.situation;
  static const std::map<std::string, std::string (*)(const Situation&)> whole{
      {"why", [](const Situation& of) { return why(of).sentence; }},
      {"why tree", [](const Situation& of) { return to_text(why(of)); }},
      {"drive", driver},
      {"trouble", trouble},
      {"all trouble", all_trouble},
      {"json", [](const Situation& of) { return to_json(of); }},
      {"clocks", [](const Situation& of) { return clocks_apart(of.programs); }},
      {"unheard", [](const Situation& of) { return situation::listed(unheard(of)); }},
      {"misses", [](const Situation& of) { return std::string(misses(of) ? "yes" : "no"); }}};
  if (const auto found = whole.find(one.question); found != whole.end())
    return found->second(s);
  if (!one.question.starts_with("why not "))
    return answer_about(s, one.question.substr(0, one.question.find(' ')),
                        one.question.substr(one.question.rfind(' ') + 1));
  std::istringstream words(one.question.substr(std::string("why not ").size()));
  std::vector<std::string> wish;
  for (std::string word; words >> word;)
    wish.push_back(word);
  return why_not(s, parse_wish(wish).value()).sentence;
}

Faults faults(const Case& one) {
  Faults found;
  const std::string said = answer(one);
  if (!one.says.empty() && said != (one.says == "-" ? "" : one.says))
    found.lacks.push_back(one.says);
  for (const std::string& part : one.must)
    if (said.find(part) == std::string::npos)
      found.lacks.push_back(part);
  for (const std::string& part : one.once)
    if (said.find(part) != said.rfind(part))
      found.says.push_back(part + " twice");
  for (const std::string& part : one.never)
    if (said.find(part) != std::string::npos)
      found.says.push_back(part);
  if (one.question.starts_with("why") && one.question != "why tree" &&
      said.size() >= kLongestSentence)
    found.says.push_back(std::to_string(said.size()) + " characters");
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
            listed(one.must) + " | " + listed(one.never) + " | " +
            (said.empty() ? "(nothing)" : said) + " |\n";
  }
  return text;
}

}  // namespace saphira::situation::test

#include "saphira/agent_interface/grammar.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "finder.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::size_t kLongestUtterance = 40;  // words; a longer one is no command
constexpr int kMostAsides = 3;                 // of an order
/// Units behind a number without a blank, and their words in the grammars.
constexpr std::array<std::pair<const char*, const char*>, 7> kUnits{{{"m", "meters"},
                                                                     {"cm", "cm"},
                                                                     {"deg", "degrees"},
                                                                     {"s", "seconds"},
                                                                     {"in", "inches"},
                                                                     {"am", "am"},
                                                                     {"pm", "pm"}}};

/// Short forms, and the words in the grammars.
constexpr std::array<std::pair<const char*, const char*>, 4> kShort{
    {{"pls", "please"}, {"plz", "please"}, {"thx", "thanks"}, {"deg", "degrees"}}};

/// Letters as names are compared, and the signs of typographers as those of a keyboard.
std::string plain(std::string_view said) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kSigns{
      {{"\u2018", "'"},
       {"\u2019", "'"},
       {"\u201c", "\""},
       {"\u201d", "\""},
       {"\u2013", " - "},
       {"\u2014", " - "},
       {"\u2026", "! "},
       {"\u00a0", " "},
       {"\u00b0", " degrees "}}};
  std::string text = lowered(said);
  for (const auto& [sign, key] : kSigns)
    for (std::size_t at = 0; (at = text.find(sign, at)) != std::string::npos; at += key.size())
      text.replace(at, sign.size(), key);
  return text;
}

/// Behind these words 's is short for "is"; behind others it tells the owner.
bool is_subject(const std::string& word) {
  constexpr std::array kSubjects{"where", "who", "what", "how", "that", "it", "he", "she", "there"};
  return std::find(kSubjects.begin(), kSubjects.end(), word) != kSubjects.end();
}

}  // namespace

bool is_number(const std::string& word) {
  return !word.empty() && std::isdigit(static_cast<unsigned char>(word.front())) != 0 &&
         std::all_of(
             word.begin(), word.end(),
             [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.'; }) &&
         std::count(word.begin(), word.end(), '.') <= 1;
}

bool is_letter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalnum(byte) != 0 || c == '-' || byte >= 0x80;
}

std::string describe(const Meaning& meaning) {
  std::string text = meaning.functor + "(";
  for (const auto& [name, value] : meaning.slots)
    text += (text.back() == '(' ? "" : ", ") + name + "=" + value;
  return text + ")";
}

std::vector<std::string> words_and_marks_of(std::string_view said) {
  const std::string text = plain(said);
  std::vector<std::string> words;
  std::string word;
  const auto end = [&] {
    if (word.empty())
      return;
    if (word.find_first_not_of('-') == std::string::npos) {
      word.clear();
      words.emplace_back(kMark);
      return;
    }
    // "2m" and "90deg", as people write them.
    const std::size_t unit = word.find_first_not_of("0123456789.");
    for (const auto& [written, spoken] : kUnits)
      if (unit != 0 && unit != std::string::npos && word.compare(unit, word.npos, written) == 0) {
        words.push_back(word.substr(0, unit));
        word = spoken;
      }
    for (const auto& [written, spoken] : kShort)
      if (word == written)
        word = spoken;
    words.push_back(std::exchange(word, {}));
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool digit_follows =
        i + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0;
    if (is_letter(c)) {
      word += c;
    } else if (digit_follows &&
               ((c == '.' && word.empty()) || ((c == '.' || c == ',') && is_number(word)))) {
      word += word.empty() ? "0." : ".";
    } else if (c == '\'' && !word.empty()) {
      const bool owner = i + 1 < text.size() && text[i + 1] == 's' &&
                         (i + 2 == text.size() || !is_letter(text[i + 2]));
      if (owner) {
        end();
        word = !words.empty() && is_subject(words.back()) ? "is" : "'s";
        end();
        ++i;
      }
    } else {
      end();
      if (c == '"' && !words.empty() && words.back() == kComma)
        words.pop_back();  // "He said, "stop"" is one clause
      else if (c == ',')
        words.emplace_back(kComma);
      else if (c == '.' || c == '!' || c == '?' || c == ';' || c == '\n')
        words.emplace_back(kMark);
    }
  }
  end();
  return words;
}

namespace {

/// The words, and the commas between them.
std::vector<std::string> words_and_commas_of(std::string_view said) {
  std::vector<std::string> words = words_and_marks_of(said);
  std::erase(words, kMark);
  words.erase(words.begin(), std::find_if(words.begin(), words.end(),
                                          [](const std::string& word) { return word != kComma; }));
  return words;
}

bool has_rest(const Grammar::Node& node) {
  return node.kind == Grammar::Node::Kind::rest ||
         std::any_of(node.parts.begin(), node.parts.end(), has_rest);
}

}  // namespace

std::vector<std::string> without_commas(std::vector<std::string> words) {
  std::erase(words, kComma);
  return words;
}

std::vector<std::string> words_of(std::string_view text) {
  return without_commas(words_and_commas_of(text));
}

Grammar::Understood Grammar::understand(std::string_view text, bool replies) const {
  Finder finder(*this);
  const Urgent urgent = this->urgent(text, finder);
  Understood result = understand(text, replies, urgent, finder);
  // With a part of the readings a sentence may seem to have another meaning.
  if (finder.is_spent()) {
    result = {result.addressed, false, false, {}};
    if (urgent.meaning)
      result.meanings = {*urgent.meaning};
  }
  result.work = finder.work;
  return result;
}

Grammar::Understood Grammar::understand(std::string_view text, bool replies, const Urgent& urgent,
                                        Finder& finder) const {
  Understood result;
  if (urgent.meaning && urgent.alone)
    return {true, false, false, {*urgent.meaning}};
  std::vector<std::string> said = words_and_commas_of(text);
  std::vector<std::string> words = without_commas(said);
  const auto is_among = [](const std::vector<std::string>& some) {
    return [&some](const std::string& word) {
      return std::find(some.begin(), some.end(), word) != some.end();
    };
  };
  const auto is_keyword = is_among(keywords_);
  const auto first = std::find_if_not(words.begin(), words.end(), is_among(greetings_));
  if (first != words.end() && is_keyword(*first) &&
      (first == words.begin() || first + 1 != words.end())) {
    result.addressed = true;
    words.erase(words.begin(), first + 1);
    said.erase(said.begin(), std::find_if(said.begin(), said.end(), is_keyword) + 1);
    if (!said.empty() && said.front() == kComma)
      said.erase(said.begin());
    for (std::vector<std::string>* const some : {&words, &said})
      if (const auto verb = std::find_if(some->begin(), some->end(),
                                         [](const std::string& word) { return word != "please"; });
          verb != some->end())
        for (const std::string& right : verbs_)
          if (is_misspelled(*verb, right))
            *verb = right;
  } else if (urgent.meaning) {
    return {true, false, false, {*urgent.meaning}};  // "stop, Flakey!"
  } else if (words.size() > 1 && is_keyword(words.back())) {
    words.pop_back();  // the words before the keyword at most answer the robot
    said = words;
  }
  // With the keyword a sentence is meant for the robot, whatever it has asked.
  const auto whole = [&](const std::vector<std::string>& sentence) {
    result.meanings =
        finder.look(without_commas(sentence), result.addressed, replies, Use::command);
    if (!result.addressed)
      return;
    // Of several ways to divide it, the one with the fewest steps.
    const bool counted = sentence.size() > 1 && sentence.front() == "first";
    const std::vector<std::string> steps(sentence.begin() + (counted ? 1 : 0), sentence.end());
    std::vector<std::vector<Meaning>> ways = finder.divided(steps, {}, false);
    if (result.meanings.empty() && ways.empty())
      ways = finder.divided(steps, {}, true);
    std::stable_sort(ways.begin(), ways.end(),
                     [](const auto& a, const auto& b) { return a.size() < b.size(); });
    if (result.meanings.empty()) {
      if (ways.empty() || (ways.size() > 1 && ways[0].size() == ways[1].size()))
        return;
      result.meanings = {ways[0].front()};
      result.then.assign(ways[0].begin() + 1, ways[0].end());
      ways.erase(ways.begin());
    }
    const Meaning& last = result.then.empty() ? result.meanings.back() : result.then.back();
    if (!ways.empty() && takes_text(last.functor))
      result.apart = ways.front();
  };
  // "In ten minutes go home", "go home at five", "go home, but not through the lobby".
  const auto with_asides = [&](const auto& again, const std::vector<std::string>& sentence,
                               int others) -> bool {
    for (const Use use : {Use::timed, Use::during})
      for (auto& [aside, rest] : finder.asides(sentence, use)) {
        if (finder.is_spent())
          return false;
        if (others > 0) {
          if (!again(again, rest, others - 1))
            continue;
        } else {
          whole(rest);
          if (result.meanings.size() != 1 || !is_step(result.meanings.front())) {
            result.meanings.clear();
            result.then.clear();
            continue;
          }
        }
        if (use == Use::during) {
          result.during.push_back(aside);
        } else {
          result.then.insert(result.then.begin(), result.meanings.front());
          result.meanings = {aside};
          result.timed = true;
        }
        result.apart.clear();
        return true;
      }
    return false;
  };
  std::vector<std::string> order = said;
  if (words.size() <= kLongestUtterance) {
    whole(said);
    // "No, go to the library" corrects the sentence before. Without the comma it forbids.
    while (result.meanings.empty() && order.size() > 2 && order[0] == "no" && order[1] == kComma) {
      order.erase(order.begin(), order.begin() + 2);
      whole(order);
    }
    while (result.meanings.empty() && result.addressed && make_plain_order(order)) {
      whole(order);
      result.polite = true;
    }
  }
  if (result.meanings.empty() && words.size() <= kLongestUtterance)
    result.meanings = finder.look(words, result.addressed, replies, Use::reply);
  if (result.meanings.empty() && urgent.meaning)
    result.meanings = {*urgent.meaning};
  else if (result.meanings.empty() && result.addressed && order.size() <= kLongestUtterance)
    for (int others = 0; others < kMostAsides && !with_asides(with_asides, order, others);)
      ++others;
  const std::vector<Meaning> as_reply = finder.look(words, false, true, Use::reply);
  if (result.meanings.empty() && result.addressed)
    result.bare = as_reply;
  else if (replies && as_reply.size() == 1)
    result.answer = as_reply.front();
  return result;
}

/// "Could you go home" becomes "please go home". So it is an order, or nothing: no line for facts
/// or questions begins with "please".
bool Grammar::make_plain_order(std::vector<std::string>& words) const {
  const auto after_commas = [&](auto at) {
    return std::find_if(at, words.end(), [](const std::string& word) { return word != kComma; });
  };
  const auto begin = words.begin() + (!words.empty() && words.front() == "please" ? 1 : 0);
  for (const std::vector<std::string>& polite : polite_) {
    auto end = after_commas(begin);
    const bool same = std::all_of(polite.begin(), polite.end(), [&](const std::string& word) {
      const bool is = end != words.end() && *end == word;
      end = is ? after_commas(end + 1) : end;
      return is;
    });
    if (!same || end == words.end())
      continue;
    words.erase(words.begin(), end);
    if (words.front() != "please")
      words.insert(words.begin(), "please");
    return true;
  }
  return false;
}

bool Grammar::is_step(const Meaning& meaning) const {
  return std::find(steps_.begin(), steps_.end(), meaning.functor) != steps_.end();
}

/// A step that leaves out how the step before it began: "to the library" or "the library" after "go
/// to the kitchen", "right" after "look left". Empty: it does not.
std::vector<std::string> Grammar::completed(const std::vector<std::string>& before,
                                            const std::vector<std::string>& words) const {
  const auto is_gaze = [&](const std::string& word) {
    const auto list = lists_.find("gaze");
    return list != lists_.end() &&
           std::any_of(list->second.begin(), list->second.end(), [&](const Entry& one) {
             return one.words.size() == 1 && one.words.front() == word;
           });
  };
  auto same = before.end();
  if (words.front() == "to" || words.front() == "the")
    same = std::find(before.begin(), before.end(), words.front());
  else if (words.size() == 1 && !before.empty() && is_gaze(before.back()) && is_gaze(words.front()))
    same = before.end() - 1;
  // "Take the mail from Karen to John, then to Bob" is no second way to Karen.
  if (same == before.begin() || same == before.end() ||
      std::find(before.begin(), same, "from") != same)
    return {};
  std::vector<std::string> whole(before.begin(), same);
  whole.insert(whole.end(), words.begin(), words.end());
  return whole;
}

/// The number of words and commas there that join two sentences: a comma, "and", "then", ", and
/// after that,"; 0: none.
std::size_t Grammar::joint(const std::vector<std::string>& words, std::size_t at) const {
  std::size_t next = at;
  const auto take = [&](std::string_view word) {
    const bool is = next < words.size() && words[next] == word;
    next += is ? 1U : 0U;
    return is;
  };
  take(kComma);
  take("and");
  for (const auto& phrase : joints_)  // "then finally", too
    if (words.size() - next >= phrase.size() &&
        std::equal(phrase.begin(), phrase.end(), words.begin() + static_cast<std::ptrdiff_t>(next)))
      next += phrase.size();
  if (next > at)
    take(kComma);
  return next - at;
}

bool Grammar::takes_text(const std::string& functor) const {
  return std::any_of(rules_.begin(), rules_.end(), [&](const Rule& rule) {
    return rule.meaning.functor == functor &&
           std::ranges::any_of(rule.patterns, has_rest, &Pattern::node);
  });
}

/// Each part of a pattern leads from one state to another.
class Grammar::GraphMaker {
 public:
  GraphMaker(const Grammar& grammar, const std::vector<std::string>& names) : grammar_(grammar) {
    for (const std::string& name : names)
      names_.push_back(words_of(name));
  }

  void words(const std::vector<std::string>& words, int from, int to) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      const int next = i + 1 == words.size() ? to : graph.states++;
      graph.arcs.push_back({from, next, words[i]});
      from = next;
    }
  }

  void lead(const Node& node, int from, int to) {
    switch (node.kind) {
      case Node::Kind::word:
        graph.arcs.push_back({from, to, node.text});
        return;
      case Node::Kind::list:
      case Node::Kind::number: {
        const auto list = grammar_.lists_.find(node.text);
        if (list != grammar_.lists_.end())
          for (const Entry& entry : list->second)
            words(entry.words, from, to);
        return;
      }
      case Node::Kind::name:
        for (const auto& name : names_)
          words(name, from, to);
        return;
      case Node::Kind::rest:
        return;
      case Node::Kind::sequence:
        for (std::size_t i = 0; i < node.parts.size(); ++i) {
          const int next = i + 1 == node.parts.size() ? to : graph.states++;
          lead(node.parts[i], from, next);
          from = next;
        }
        return;
      case Node::Kind::optional:
        graph.arcs.push_back({from, to});
        lead(node.parts.front(), from, to);
        return;
      case Node::Kind::choice:
        for (const Node& part : node.parts)
          if (!has_rest(part))
            lead(part, from, to);
        return;
    }
  }

  WordGraph graph;

 private:
  const Grammar& grammar_;
  std::vector<std::vector<std::string>> names_;
};

WordGraph Grammar::graph(const std::vector<std::string>& names, bool replies) const {
  GraphMaker maker(*this, names);
  for (const std::string& keyword : keywords_)
    maker.graph.arcs.push_back({WordGraph::kStart, WordGraph::kAddressed, keyword});
  for (const Rule& rule : rules_)
    if (rule.use == Use::command || rule.use == Use::urgent || rule.use == Use::alone ||
        (rule.use == Use::reply && replies))
      for (const auto& [pattern, ends] : rule.patterns)
        if (pattern.kind == Node::Kind::choice || !has_rest(pattern))
          maker.lead(pattern,
                     rule.use == Use::reply   ? WordGraph::kStart
                     : rule.use == Use::alone ? WordGraph::kAlone
                                              : WordGraph::kAddressed,
                     WordGraph::kEnd);
  return std::move(maker.graph);
}

std::string Grammar::paraphrase(const Meaning& meaning, Form form) const {
  const auto index = static_cast<std::size_t>(form);
  // Of several rules of a functor, the one with the most slots and values in common.
  const Rule* best = nullptr;
  int most = 0;
  for (const Rule& rule : rules_) {
    if (rule.meaning.functor != meaning.functor || rule.paraphrases.empty())
      continue;
    int common = 0;
    for (const auto& [name, value] : rule.meaning.slots)
      if (const auto slot = meaning.slots.find(name); slot != meaning.slots.end())
        common += !value.empty() && slot->second == value ? 3 : 2;
    if (best == nullptr || common > most) {
      best = &rule;
      most = common;
    }
  }
  if (best == nullptr || index >= best->paraphrases.size())
    return {};
  std::string text = best->paraphrases[index];
  for (auto slot = meaning.slots.rbegin(); slot != meaning.slots.rend(); ++slot)
    for (std::size_t at = text.find('$' + slot->first); at != std::string::npos;
         at = text.find('$' + slot->first, at + slot->second.size()))
      text.replace(at, slot->first.size() + 1, slot->second);
  return text;
}

}  // namespace saphira::agent_interface

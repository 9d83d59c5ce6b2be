// The reader of a grammar's file: see config/grammars/README.md.
#include <algorithm>
#include <utility>

#include "finder.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "words.hpp"

namespace saphira::agent_interface {

class Grammar::Reader {
 public:
  Reader(Grammar& grammar, const std::string& file) : grammar_(grammar), file_(file) {}

  void read(std::string_view text) {
    int number = 0;
    while (!text.empty()) {
      const std::size_t length = std::min(text.find('\n'), text.size());
      line_ = text.substr(0, length);
      text.remove_prefix(std::min(length + 1, text.size()));
      number_ = ++number;
      if (!line_.empty() && line_.back() == '\r')
        line_.remove_suffix(1);
      line_ = line_.substr(0, line_.find('#'));
      at_ = 0;
      const bool indented = !line_.empty() && (line_.front() == ' ' || line_.front() == '\t');
      skip();
      if (at_ < line_.size())
        indented ? pattern() : header();
    }
    check_last();
    check_steps();
    for (std::size_t i = 0; i < grammar_.rules_.size(); ++i)
      for (std::size_t k = 0; k < grammar_.rules_[i].patterns.size(); ++k) {
        Pattern& pattern = grammar_.rules_[i].patterns[k];
        note_end(pattern.node, true, pattern.ends);
        std::set<std::string> begins;
        note_end(pattern.node, false, begins);
        for (const std::string& word : begins)
          grammar_.begun_by_[word].emplace_back(i, k);
      }
    if (grammar_.keywords_.empty())
      fail("expected a line such as \"keyword: flakey\" in the file");
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(file_, number_, static_cast<int>(at_) + 1, message, line_);
  }
  void skip() {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t'))
      ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ >= line_.size() || line_[at_] != c)
      return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!take(c))
      fail(std::string("expected ") + c);
  }
  /// A word of the file: letters, digits, hyphens and a part behind an apostrophe.
  std::string word(const char* what) {
    skip();
    const std::size_t from = at_;
    while (at_ < line_.size() &&
           (is_letter(line_[at_]) || line_[at_] == '_' || line_[at_] == '\'' || line_[at_] == '.'))
      ++at_;
    if (at_ == from)
      fail(std::string("expected ") + what);
    return std::string(line_.substr(from, at_ - from));
  }
  std::string heard_word() {
    skip();
    const std::size_t from = at_;
    const std::string text = word("a word");
    if (words_of(text) != std::vector{text} && text != "'s") {
      at_ = from;
      fail("expected a word as it is heard: small letters, and \"karen 's\" for \"Karen's\"");
    }
    return text;
  }

  /// The list that such a line has, with blanks between its words; nullptr: none.
  std::vector<std::string>* words_named(std::string_view first) {
    return first == "no-names"     ? &grammar_.no_names_
           : first == "greetings"  ? &grammar_.greetings_
           : first == "verbs"      ? &grammar_.verbs_
           : first == "alarms"     ? &grammar_.alarms_
           : first == "not-behind" ? &grammar_.not_behind_
           : first == "passed"     ? &grammar_.passed_
           : first == "not-after"  ? &grammar_.not_after_
                                   : nullptr;
  }

  void header() {
    const std::size_t from = at_;
    const std::string first = word(
        "keyword, greetings, verbs, names, no-names, alarms, not-behind, passed, not-after, steps, "
        "joints, polite, "
        "list, typed, reply, urgent, alone, later, timed, during, times or a functor");
    if (std::vector<std::string>* const some = words_named(first)) {
      expect(':');
      while (at_ < line_.size()) {
        some->push_back(heard_word());
        skip();
      }
    } else if (first == "keyword") {
      expect(':');
      do
        grammar_.keywords_.push_back(heard_word());
      while (take('|'));
    } else if (first == "names") {
      expect(':');
      do
        grammar_.names_.push_back(saphira::joined(phrase(), " "));
      while (take('|'));
    } else if (first == "steps") {
      expect(':');
      do {
        skip();
        steps_.push_back({number_, at_, std::string(line_)});
        grammar_.steps_.push_back(word("a functor"));
      } while (take('|'));
    } else if (first == "polite" || first == "joints") {
      expect(':');
      do
        (first == "polite" ? grammar_.polite_ : grammar_.joints_).push_back(phrase());
      while (take('|'));
    } else if (first == "list") {
      list();
    } else {
      const Use use = first == "typed"    ? Use::typed
                      : first == "reply"  ? Use::reply
                      : first == "urgent" ? Use::urgent
                      : first == "alone"  ? Use::alone
                      : first == "later"  ? Use::later
                      : first == "timed"  ? Use::timed
                      : first == "during" ? Use::during
                      : first == "times"  ? Use::times
                                          : Use::command;
      rule(use == Use::command ? first : word("a functor"), use, from);
    }
    skip();
    if (at_ < line_.size())
      fail("expected the end of the line");
  }

  /// The words up to a | or =.
  std::vector<std::string> phrase() {
    std::vector<std::string> words;
    do {
      words.push_back(heard_word());
      skip();
    } while (at_ < line_.size() && line_[at_] != '|' && line_[at_] != '=');
    return words;
  }

  /// list side: left | to the left = left | right
  void list() {
    skip();
    const std::size_t from = at_;
    const std::string name = word("the name of the list");
    if (grammar_.lists_.contains(name)) {
      at_ = from;
      fail("the list \"" + name + "\" stands above already");
    }
    expect(':');
    std::vector<Entry>& entries = grammar_.lists_[name];
    std::size_t unnamed = entries.size();
    do {
      Entry& entry = entries.emplace_back();
      entry.words = phrase();
      entry.value = saphira::joined(entry.words, " ");
      if (take('=')) {
        std::string value = word("the value of the words before it");
        for (skip(); at_ < line_.size() && line_[at_] != '|'; skip())
          value += " " + word("a word");
        for (; unnamed < entries.size(); ++unnamed)
          entries[unnamed].value = value;
      }
    } while (take('|'));
  }

  /// move(direction=forward, distance=1) "going $distance m"
  void rule(const std::string& functor, Use use, std::size_t from) {
    check_last();
    Rule rule;
    rule.meaning.functor = functor;
    rule.use = use;
    last_ = {number_, from, std::string(line_)};
    expect('(');
    while (!take(')')) {
      const std::string slot = word("the name of a slot");
      rule.meaning.slots[slot] = take('=') ? word("the value of the slot") : "";
      skip();
      if (!take(',') && (at_ >= line_.size() || line_[at_] != ')'))
        fail("expected , or )");
    }
    while (rule.paraphrases.size() < 3 && take('"')) {
      const std::size_t end = line_.find('"', at_);
      if (end == std::string_view::npos)
        fail("expected \" at the end of the paraphrase");
      const std::string_view text = line_.substr(at_, end - at_);
      for (std::size_t i = text.find('$'); i != std::string_view::npos; i = text.find('$', i + 1)) {
        const std::string_view slot = text.substr(
            i + 1, text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", i + 1) - i - 1);
        if (!rule.meaning.slots.contains(std::string(slot))) {
          at_ += i;
          fail("the functor " + functor + " has no slot \"" + std::string(slot) + "\"");
        }
      }
      rule.paraphrases.emplace_back(text);
      at_ = end + 1;
    }
    grammar_.rules_.push_back(std::move(rule));
  }

  void check_last() {
    if (grammar_.rules_.empty() || !grammar_.rules_.back().patterns.empty())
      return;
    throw FileError(file_, last_.number, static_cast<int>(last_.at) + 1,
                    "expected a line with words below " + grammar_.rules_.back().meaning.functor,
                    last_.line);
  }

  void check_steps() const {
    std::vector<std::string> functors;
    for (const Rule& rule : grammar_.rules_)
      functors.push_back(rule.meaning.functor);
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (const std::string& step = grammar_.steps_[i];
          std::find(functors.begin(), functors.end(), step) == functors.end())
        throw FileError(file_, steps_[i].number, static_cast<int>(steps_[i].at) + 1,
                        "there is no functor \"" + step + "\"" + did_you_mean(step, functors),
                        steps_[i].line);
  }

  /// Adds the words that a part may begin or end with (`last`). False: it may have no words.
  bool note_end(const Node& node, bool last, std::set<std::string>& ends) const {
    const auto note_list = [&](const std::string& name) {
      if (const auto list = grammar_.lists_.find(name); list != grammar_.lists_.end())
        for (const Entry& one : list->second)
          ends.insert(last ? one.words.back() : one.words.front());
    };
    switch (node.kind) {
      case Node::Kind::word:
        ends.insert(node.text);
        return true;
      case Node::Kind::number:
        ends.insert(kAnyNumber);
        note_list("digit");  // "nought point two"
        note_list("number");
        return true;
      case Node::Kind::list:
        note_list(node.text);
        return true;
      case Node::Kind::name:
        ends.insert(kAnyName);
        return true;
      case Node::Kind::rest:
        ends.insert(kAnyText);
        return true;
      case Node::Kind::sequence:
        for (std::size_t i = 0; i < node.parts.size(); ++i)
          if (note_end(node.parts[last ? node.parts.size() - 1 - i : i], last, ends))
            return true;
        return false;
      case Node::Kind::optional:
        note_end(node.parts.front(), last, ends);
        return false;
      case Node::Kind::choice:
        return std::ranges::count_if(node.parts, [&](const Node& part) {
                 return note_end(part, last, ends);
               }) == std::ssize(node.parts);
    }
    return false;
  }

  void pattern() {
    if (grammar_.rules_.empty())
      fail("expected a functor such as stop() before the words that mean it");
    Node node = parts('\0');
    if (at_ < line_.size())
      fail("expected the end of the line");
    grammar_.rules_.back().patterns.push_back({std::move(node)});
  }

  /// a b | c d, up to the closing character.
  Node parts(char closing) {
    Node choice{Node::Kind::choice};
    Node sequence{Node::Kind::sequence};
    while (true) {
      skip();
      if (at_ >= line_.size() || line_[at_] == closing || line_[at_] == '|') {
        if (sequence.parts.empty())
          fail("expected a word");
        choice.parts.push_back(std::exchange(sequence, Node{Node::Kind::sequence}));
        if (!take('|'))
          break;
        continue;
      }
      sequence.parts.push_back(part());
    }
    if (closing != '\0')
      expect(closing);
    return choice.parts.size() == 1 ? choice.parts.front() : choice;
  }

  Node inner(char closing) {
    constexpr int kDeepest = 50;
    if (++depth_ > kDeepest)
      fail("expected no more than " + std::to_string(kDeepest) + " brackets within each other");
    Node node = parts(closing);
    --depth_;
    return node;
  }

  Node part() {
    if (take('('))
      return inner(')');
    if (take('['))
      return {Node::Kind::optional, {}, {}, {inner(']')}};
    if (take('{')) {
      Node node{Node::Kind::name, {}, slot()};
      skip();
      if (line_.substr(at_).starts_with("...")) {
        at_ += 3;
        node.kind = Node::Kind::rest;
      }
      expect('}');
      skip();
      if (node.kind == Node::Kind::rest && at_ < line_.size() && (line_[at_] != '|' || depth_ > 0))
        fail("expected the end of the line after {" + node.slot + " ...}");
      return node;
    }
    if (take('<')) {
      const std::size_t from = at_;
      const std::string list = word("the name of a list, or number");
      if (list != "number" && !grammar_.lists_.contains(list)) {
        at_ = from;
        fail("there is no list \"" + list + "\" above this line");
      }
      Node node{list == "number" ? Node::Kind::number : Node::Kind::list, list, {}};
      if (take(':'))
        node.slot = slot();
      expect('>');
      return node;
    }
    return {Node::Kind::word, heard_word(), {}};
  }

  std::string slot() {
    skip();
    const std::size_t from = at_;
    const std::string name = word("the name of a slot");
    if (!grammar_.rules_.back().meaning.slots.contains(name)) {
      at_ = from;
      fail("the functor " + grammar_.rules_.back().meaning.functor + " has no slot \"" + name +
           "\"");
    }
    return name;
  }

  struct Place {
    int number = 0;
    std::size_t at = 0;
    std::string line;
  };
  Grammar& grammar_;
  std::string file_;
  std::string_view line_;
  int number_ = 0;
  std::size_t at_ = 0;
  int depth_ = 0;               ///< of brackets
  std::vector<Place> steps_{};  ///< of each in grammar_.steps_
  Place last_;                  ///< the newest functor's
};

Grammar::Grammar(std::string_view text, const std::string& file) {
  expect_own_format(text, file, "a grammar");
  Reader(*this, file).read(text);
}

}  // namespace saphira::agent_interface

// The finder of urgent orders, such as a stop, in a text: see config/grammars/README.md.
#include <algorithm>
#include <cstddef>
#include <utility>

#include "finder.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::size_t kTelling = 4;  // letters of a word that is recognized although misspelled
constexpr std::size_t kLong = 5;     // letters of a word of which one may be left out

bool has(const std::vector<std::string>& some, const std::string& word) {
  return std::find(some.begin(), some.end(), word) != some.end();
}

/// Without hyphens, and with one letter for several in a row: "stooop", "sttop", "s-t-o-p".
std::string squeezed(std::string word) {
  std::erase(word, '-');
  word.erase(std::unique(word.begin(), word.end()), word.end());
  return word;
}

}  // namespace

bool is_misspelled(const std::string& word, const std::string& right) {
  std::string given = squeezed(word);
  const std::string meant = squeezed(right);
  std::string_view rest = given;
  while (rest.starts_with(meant))
    rest.remove_prefix(meant.size());
  if (rest.empty())
    return true;
  for (std::size_t i = 0; i + 1 < given.size(); ++i) {
    std::swap(given[i], given[i + 1]);
    if (squeezed(given) == meant)
      return true;
    std::swap(given[i], given[i + 1]);
  }
  for (std::size_t i = 0; meant.size() >= kLong && i < meant.size(); ++i)
    if (given == std::string(meant).erase(i, 1))
      return true;
  return false;
}

class Grammar::UrgentFinder {
 public:
  UrgentFinder(Finder& finder, const Grammar& grammar, std::string_view text)
      : finder_(finder), grammar_(grammar) {
    for (const Rule& rule : grammar.rules_)
      if (rule.use == Use::alone)
        for (const Pattern& pattern : rule.patterns)
          note_words(pattern.node);
    for (std::string& word : words_and_marks_of(text)) {
      if (word == kComma || word == kMark) {
        end_clause(word == kMark);
        continue;
      }
      words_.push_back(mended(std::move(word)));
    }
    end_clause(true);
    named_ = std::any_of(words_.begin(), words_.end(),
                         [&](const std::string& word) { return has(grammar_.keywords_, word); });
  }

  Urgent find() {
    Urgent found;
    bool fillers_only = true;  // in the sentence so far
    for (const Clause& clause : clauses_) {
      if (clause.begins_sentence) {
        fillers_only = true;
        limit_ = words_.size();
      }
      for (std::size_t at = clause.from; at < clause.to && limit_ == words_.size(); ++at)
        if (has(grammar_.not_after_, words_[at]))
          limit_ = at;
      cover(clause);
      const Meaning* const whole = covered_[clause.from].order;
      if (whole != nullptr && (named_ || fillers_only) && clause.from < limit_)
        return {*whole, true};
      if (named_ && !found.meaning)
        found.meaning = within(clause);
      fillers_only = fillers_only && covered_[clause.from].fillers;
    }
    return found;
  }

 private:
  struct Clause {
    std::size_t from = 0;
    std::size_t to = 0;
    bool begins_sentence = true;
    bool ends_sentence = false;
  };
  /// The words from here to the end of the clause.
  struct Covered {
    bool fillers = false;            ///< greetings, keywords and the like
    const Meaning* order = nullptr;  ///< the same, and this order
  };

  void note_words(const Node& node) {
    if (node.kind == Node::Kind::word)
      known_.push_back(node.text);
    for (const Node& part : node.parts)
      note_words(part);
  }

  std::string mended(std::string word) const {
    for (const auto* const some :
         {&known_, &grammar_.keywords_, &grammar_.greetings_, &grammar_.alarms_,
          &grammar_.not_behind_, &grammar_.passed_, &grammar_.not_after_})
      if (has(*some, word))
        return word;
    for (const auto* const some : {&known_, &grammar_.keywords_})
      for (const std::string& right : *some)
        if (right.size() >= kTelling && is_misspelled(word, right))
          return right;
    return word;
  }

  void end_clause(bool ends_sentence) {
    const std::size_t from = clauses_.empty() ? 0 : clauses_.back().to;
    if (from < words_.size())
      clauses_.push_back({from, words_.size(), new_sentence_});
    if (!clauses_.empty())
      clauses_.back().ends_sentence = clauses_.back().ends_sentence || ends_sentence;
    new_sentence_ = ends_sentence || (new_sentence_ && from == words_.size());
  }

  /// The numbers of words that greetings, alarms, keywords and polite words have here.
  std::vector<std::size_t> fillers(std::size_t at, std::size_t to) const {
    std::vector<std::size_t> lengths;
    if (has(grammar_.greetings_, words_[at]) || has(grammar_.alarms_, words_[at]) ||
        has(grammar_.keywords_, words_[at]))
      lengths.push_back(1);
    for (const auto& polite : grammar_.polite_)
      // "Let's stop" is for all.
      if (!has(grammar_.not_behind_, polite.back()) && polite.size() <= to - at &&
          std::equal(polite.begin(), polite.end(),
                     words_.begin() + static_cast<std::ptrdiff_t>(at)))
        lengths.push_back(polite.size());
    return lengths;
  }

  void cover(const Clause& clause) {
    covered_.resize(words_.size() + 1);
    covered_[clause.to] = {true, nullptr};
    for (std::size_t at = clause.to; at-- > clause.from;) {
      covered_[at] = {};
      for (const std::size_t length : fillers(at, clause.to)) {
        covered_[at].fillers = covered_[at].fillers || covered_[at + length].fillers;
        if (covered_[at].order == nullptr)
          covered_[at].order = covered_[at + length].order;
      }
      for (const Rule& rule : grammar_.rules_)
        for (const Pattern& pattern : rule.patterns)
          if (rule.use == Use::alone && covered_[at].order == nullptr)
            for (const Finder::Match& match : finder_.match(pattern.node, words_, {at}))
              if (match.end <= clause.to && match.end > at &&
                  (covered_[match.end].fillers || covered_[match.end].order != nullptr))
                covered_[at].order = &rule.meaning;
    }
    covered_[clause.to] = {};  // another clause begins here
  }

  /// "Never ever stop", "did Flakey stop".
  bool is_denied(const Clause& clause, std::size_t at) const {
    while (at-- > clause.from)
      if (!has(grammar_.passed_, words_[at]) && !has(grammar_.keywords_, words_[at]))
        return has(grammar_.not_behind_, words_[at]);
    return false;
  }

  /// An order at the beginning or end of a clause of the robot.
  std::optional<Meaning> within(const Clause& clause) {
    const auto end = words_.begin() + static_cast<std::ptrdiff_t>(clause.to);
    bool begins = true;
    for (std::size_t at = clause.from; at < std::min(clause.to, limit_); ++at) {
      if (covered_[at].order != nullptr && !is_denied(clause, at))
        return *covered_[at].order;
      if (!begins)
        continue;
      const std::vector<std::string> words(words_.begin() + static_cast<std::ptrdiff_t>(at), end);
      for (const Use use : {Use::urgent, Use::command})
        for (const Meaning& one : finder_.look(words, true, false, use))
          if (use == Use::urgent || (clause.ends_sentence && is_order(one)))
            return one;
      begins = !fillers(at, clause.to).empty();
    }
    return std::nullopt;
  }

  bool is_order(const Meaning& meaning) const {
    return std::any_of(grammar_.rules_.begin(), grammar_.rules_.end(), [&](const Rule& rule) {
      return meaning.functor == kHold || (rule.use == Use::alone && rule.meaning == meaning);
    });
  }

  Finder& finder_;
  const Grammar& grammar_;
  std::vector<std::string> known_;  ///< the words of urgent orders
  std::vector<std::string> words_;
  std::vector<Clause> clauses_;
  std::vector<Covered> covered_;  ///< for each word
  std::size_t limit_ = 0;         ///< behind this word no order of the sentence is urgent
  bool new_sentence_ = true;
  bool named_ = false;  ///< it has the keyword
};

Grammar::Urgent Grammar::urgent(std::string_view text) const {
  Finder finder(*this);
  return urgent(text, finder);
}

Grammar::Urgent Grammar::urgent(std::string_view text, Finder& finder) const {
  return UrgentFinder(finder, *this, text).find();
}

}  // namespace saphira::agent_interface

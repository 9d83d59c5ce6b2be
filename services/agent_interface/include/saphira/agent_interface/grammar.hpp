#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saphira/base/text.hpp"

namespace saphira::agent_interface {

/// The meaning of an utterance: a functor with slots. Numbers are written as text, such as "1.5".
struct Meaning {
  std::string functor;
  std::map<std::string, std::string> slots;

  friend bool operator==(const Meaning&, const Meaning&) = default;
};

/// Such as "move(direction=forward, distance=2)".
std::string describe(const Meaning& meaning);

/// The words of a text, as the grammar compares them: small letters, without punctuation; "Karen's"
/// is the two words "karen" and "'s".
std::vector<std::string> words_of(std::string_view text);

/// Sequences of words as ways through a graph, for a recognizer of speech. Arcs without a word are
/// passed in silence.
struct WordGraph {
  struct Arc {
    int from = 0;
    int to = 0;
    std::string word{};

    friend bool operator==(const Arc&, const Arc&) = default;
  };
  static constexpr int kStart = 0;
  static constexpr int kEnd = 1;
  static constexpr int kAddressed = 2;  ///< after the keyword
  static constexpr int kAlone = 3;      ///< before the words of a mere stop, which lead to the end
  int states = 4;
  std::vector<Arc> arcs;
};

/// Words to meanings, from a file that a person edits (config/grammars/README.md).
class Grammar {
 public:
  Grammar() = default;
  /// FileError that names line and column.
  Grammar(std::string_view text, const std::string& file);

  struct Understood {
    bool addressed = false;         ///< it began with the keyword
    bool polite = false;            ///< an order in the form of a question: "can you ..."
    bool timed = false;             ///< the first step is a time, and the others are for then
    std::vector<Meaning> meanings;  ///< none: not understood; several: ambiguous
    std::vector<Meaning> then{};    ///< "... and ...": what to do after the first meaning
    std::vector<Meaning> during{};  ///< rules for as long as it is done: a pace, a way not to take
    /// All steps, where the end of a free text may as well be an order of its own: "tell Karen that
    /// I am late and go home". Empty: it may not.
    std::vector<Meaning> apart{};
    std::vector<Meaning> bare{};  ///< replies that are a mere name, after the keyword
    /// Its meaning as a reply, where the sentence has another one by itself.
    std::optional<Meaning> answer{};
    std::size_t work = 0;  ///< look-ups, and parts of patterns that were compared with words
  };
  /// A sentence that needs more is not understood, but for its stop: a person may say "slowly"
  /// twenty times.
  static constexpr std::size_t kMostWork = 100'000;
  /// The meaning of a text. replies: also accepts rules without the keyword, since the robot has
  /// asked a question. With the keyword a reply counts only where no other rule matches.
  Understood understand(std::string_view text, bool replies = false) const;

  /// An order that does not wait for its place in a sentence, such as a stop.
  struct Urgent {
    std::optional<Meaning> meaning{};  ///< none: the text is no such order
    /// It stands alone between punctuation, and counts whatever else the text means. Otherwise it
    /// counts where no other rule has the text.
    bool alone = false;
  };
  /// Finds it before the grammar proper is asked: the words of an `alone` rule by themselves, or at
  /// the end of a sentence to the robot, or those of an `urgent` rule at the beginning of a clause.
  Urgent urgent(std::string_view text) const;

  /// The meaning in words: for the robot to say before it acts, as what it is doing ("going to the
  /// library"), or as the name of the task ("the way to the library"). Empty without one in the
  /// file.
  enum class Form { announced, doing, task };
  std::string paraphrase(const Meaning& meaning, Form form = Form::announced) const;
  const std::vector<std::string>& keywords() const { return keywords_; }
  /// Words that may be the name of a person, place or thing. In writing, `{slot}` takes any other
  /// name, too.
  const std::vector<std::string>& names() const { return names_; }

  /// All accepted phrases but the typed ones, as they are spoken: with these names where the
  /// grammar has a name, and with the words of its lists where it has a number. replies: also rules
  /// without the keyword.
  WordGraph graph(const std::vector<std::string>& names, bool replies) const;

  struct Node {
    enum class Kind { word, list, name, number, rest, sequence, choice, optional };
    Kind kind = Kind::sequence;
    std::string text{};  ///< of a word, or the name of a list
    std::string slot{};  ///< the slot to fill
    std::vector<Node> parts{};
  };

 private:
  struct Entry {
    std::vector<std::string> words;
    std::string value;
  };
  enum class Use {
    command,
    typed,   ///< a command that a recognizer of speech does not listen for
    reply,   ///< without the keyword, after a question of the robot
    later,   ///< a later step of a sequence
    timed,   ///< a time, before or behind an order
    during,  ///< a rule for the order before or behind it
    times,   ///< how often the order before or behind it is done
    urgent,  ///< where no other rule matches; more words may follow
    alone    ///< an urgent order by itself: see urgent()
  };
  struct Pattern {
    Node node;
    /// Words that it may end with, and signs for names, numbers and texts: finder.hpp.
    std::set<std::string> ends{};
  };
  struct Rule {
    Meaning meaning;  ///< slots with their default values
    Use use = Use::command;
    std::vector<std::string> paraphrases;  ///< in the order of Form
    std::vector<Pattern> patterns{};
  };
  class Finder;
  class Reader;
  class GraphMaker;
  class UrgentFinder;

  Understood understand(std::string_view text, bool replies, const Urgent& urgent,
                        Finder& finder) const;
  Urgent urgent(std::string_view text, Finder& finder) const;
  bool make_plain_order(std::vector<std::string>& words) const;
  std::size_t joint(const std::vector<std::string>& words, std::size_t at) const;
  bool is_step(const Meaning& meaning) const;
  std::vector<std::string> completed(const std::vector<std::string>& before,
                                     const std::vector<std::string>& words) const;
  bool takes_text(const std::string& functor) const;

  std::vector<std::string> keywords_;
  std::vector<std::string> names_;
  std::vector<std::string> greetings_;  ///< words that may stand before the keyword
  std::vector<std::string> verbs_;      ///< orders that may be misspelled
  std::vector<std::string> no_names_;   ///< words that no name contains
  /// Words behind which an urgent order is none ("never stop"), before which they are looked for
  /// ("never ever stop"), and after which no order of the sentence is urgent ("if").
  std::vector<std::string> not_behind_;
  std::vector<std::string> passed_;
  std::vector<std::string> not_after_;
  std::vector<std::string> alarms_;  ///< words that may stand around an urgent order: "help"
  std::vector<std::string> steps_;   ///< functors that a sequence may have
  std::vector<std::vector<std::string>> joints_;  ///< words between two steps, as "after that"
  std::vector<std::vector<std::string>> polite_;  ///< words before an order, as "can you"
  std::map<std::string, std::vector<Entry>> lists_;
  std::vector<Rule> rules_;
  using Place = std::pair<std::size_t, std::size_t>;  ///< of a rule, and of a pattern in it
  /// Patterns by the word, or the sign (finder.hpp), with which they may begin.
  std::map<std::string, std::vector<Place>> begun_by_;
};

}  // namespace saphira::agent_interface

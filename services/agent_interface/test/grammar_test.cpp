#include "saphira/agent_interface/grammar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "lines.hpp"
#include "process.hpp"
#include "utterances.hpp"

namespace saphira::agent_interface {
namespace {

constexpr const char* kFile = R"(
keyword: flakey
greetings: hey hello ok okay
no-names: the is to
list side: left = left | right | to starboard = right
stop() "I stop"
  stop [now]
turn(direction, degrees=90) "I turn $degrees degrees to the $direction"
  turn <side:direction> | turn <number:degrees> degrees <side:direction>
go_to(place)
  go to [the] {place}
reply yes()
  yes | of course
urgent stop()
  [please] halt
typed turn(direction, degrees=90)
  veer <side:direction>
list asking: if | where
steps: turn | go_to | tell | wait_there
joints: then | after that | afterwards
tell(person, message) "I tell $person: $message" "bringing $person a message" "the message"
  tell {person} [that] <asking:message> {message ...} | tell {person} to {message ...}
later wait_there()
  stop now | wait there
)";

const Grammar& grammar() {
  static const Grammar one(kFile, "test.grammar");
  return one;
}

std::string meaning(const std::string& text, bool replies = false) {
  const Grammar::Understood understood = grammar().understand(text, replies);
  std::string all;
  for (const Meaning& one : understood.meanings)
    all += (all.empty() ? "" : " or ") + describe(one);
  return all.empty() && understood.addressed ? "what?" : all;
}

/// The mistake in a file: "line:column: message".
std::string mistake(const std::string& text) {
  try {
    Grammar(text, "f");
  } catch (const FileError& error) {
    const std::string what = error.what();
    return what.substr(2, what.find('\n') - 2);
  }
  return "none";
}

TEST(Grammar, WordsAreSmallAndWithoutPunctuation) {
  EXPECT_EQ(words_of("Flakey, this is Karen's office!"),
            (std::vector<std::string>{"flakey", "this", "is", "karen", "'s", "office"}));
  EXPECT_EQ(words_of("go 1.5 m to EJ-231."),
            (std::vector<std::string>{"go", "1.5", "m", "to", "ej-231"}));
  EXPECT_EQ(words_of("go 1.5m, turn 90deg, wait 5s"),
            (std::vector<std::string>{"go", "1.5", "meters", "turn", "90", "degrees", "wait", "5",
                                      "seconds"}));
  EXPECT_EQ(words_of("3b 12mm m 2-m"), (std::vector<std::string>{"3b", "12mm", "m", "2-m"}));
  EXPECT_EQ(words_of("Don't"), std::vector<std::string>{"dont"});
}

TEST(Grammar, WordsBecomeAFunctorWithSlots) {
  EXPECT_EQ(meaning("Flakey, stop now"), "stop()");
  EXPECT_EQ(meaning("flakey turn to starboard"), "turn(degrees=90, direction=right)");
  EXPECT_EQ(meaning("flakey turn 30 degrees left"), "turn(degrees=30, direction=left)");
  EXPECT_EQ(meaning("Hello Flakey, go to the conference room"), "go_to(place=conference room)");
}

TEST(Grammar, TheKeywordComesFirstAndAllWordsCount) {
  EXPECT_EQ(meaning("stop now"), "");
  EXPECT_EQ(meaning("stop now flakey"), "");
  EXPECT_EQ(meaning("flakey stop now or never"), "what?");
  EXPECT_EQ(meaning("flakey go to the"), "what?");
  EXPECT_EQ(meaning("flakey"), "what?");
}

TEST(Grammar, UrgentWordsBeginASentenceThatNoOtherLineHas) {
  EXPECT_EQ(meaning("flakey halt"), "stop()");
  EXPECT_EQ(meaning("flakey please halt, the door is closed"), "stop()");
  std::string endless = "flakey halt";
  for (int i = 0; i < 100; ++i)
    endless += " now";
  EXPECT_EQ(meaning(endless), "stop()");
  EXPECT_EQ(meaning("flakey go to halt"), "go_to(place=halt)");
  EXPECT_EQ(meaning("flakey never halt"), "what?");
  EXPECT_EQ(meaning("flakey turn left and halt"), "what?");
  EXPECT_EQ(meaning("halt"), "");
  EXPECT_EQ(meaning("halt", true), "");
}

/// The grammar's words for stops: see also utterances.txt.
TEST(Grammar, AnUrgentOrderAloneNeedsNoKeywordAndMayEndASentence) {
  const Grammar one(
      "keyword: flakey\ngreetings: hey no please\nalarms: help\nnot-behind: not the said\n"
      "passed: ever\nnot-after: if\nsteps: go\n"
      "urgent stop()\n  stop\nalone stop()\n  (stop | freeze) [now]\n"
      "go(place)\n  go [to] {place}\ntell(what)\n  tell {what ...}\n",
      "test");
  const auto found = [&](const char* text) {
    const Grammar::Urgent urgent = one.urgent(text);
    return !urgent.meaning ? "none" : urgent.alone ? "alone" : "within";
  };
  for (const char* const text :
       {"stop", "STOP!", "hey, stop now", "help! no, stop", "freeze please", "stooop", "stop stop",
        "stopstop", "s-t-o-p", "sotp", "feeze", "the lab. Stop!", "flakey, tell it, stop",
        "flakey the lab, stop, now", "flaky, stop", "stop, or else"})
    EXPECT_STREQ(found(text), "alone") << text;
  for (const char* const text :
       {"flakey go there stop", "flakey, look, stop that", "flakey the lab no freeze now",
        "out flakey stop", "stop that flakey", "stop that, flakey", "flakey stop if it moves"})
    EXPECT_STREQ(found(text), "within") << text;
  for (const char* const text :
       {"", "!", "flakey", "the lab, stop", "stop that", "flakey do not ever stop",
        "flakey the stop", "flakey if you can, stop", "flakey he said, \"stop\"", "not flakey stop",
        "flakey stopped", "flakey go now", "flakey never"})
    EXPECT_STREQ(found(text), "none") << text;
  // An order by itself counts whatever the rest means, and any other where nothing else is meant.
  const auto meant = [&](const char* text) {
    const auto meanings = one.understand(text).meanings;
    return meanings.size() == 1 ? describe(meanings.front()) : "";
  };
  EXPECT_EQ(meant("flakey tell all to stop"), "tell(what=all to stop)");
  EXPECT_EQ(meant("flakey tell all, stop"), "stop()");
  EXPECT_EQ(meant("flakey run stop"), "stop()");
  EXPECT_TRUE(one.understand("stop").addressed);
  EXPECT_FALSE(one.understand("the lab, stop").addressed);
}

TEST(Grammar, RepliesNeedNoKeywordAndCountWhereTheRobotHasAsked) {
  EXPECT_EQ(meaning("of course", true), "yes()");
  EXPECT_EQ(meaning("of course"), "");
  EXPECT_EQ(meaning("stop", true), "");
}

TEST(Grammar, WithTheKeywordAReplyCountsWhereNothingElseIsMeant) {
  const Grammar one(
      "keyword: f\nno-names: is\ngo(place)\n  is {place}\nreply at(place)\n"
      "  is {place} | is in {place}\n",
      "test");
  const auto meant = [&](const std::string& text) {
    const auto meanings = one.understand(text, true).meanings;
    return meanings.size() == 1 ? describe(meanings.front()) : "";
  };
  EXPECT_EQ(meant("f is x"), "go(place=x)");
  EXPECT_EQ(meant("is x"), "at(place=x)");
  EXPECT_EQ(meant("is in x"), "at(place=x)");
}

TEST(Grammar, AParaphraseIsOfTheRuleWithTheSameSlotsAndValues) {
  const Grammar one(
      "keyword: f\ngo(place) \"to $place\"\n  go {place}\n"
      "go(owner) \"to $owner's\"\n  visit {owner}\n"
      "drive(kind=fast) \"I drive fast\"\n  hurry\n"
      "drive(kind=slow) \"I drive slowly\"\n  creep\n",
      "test");
  EXPECT_EQ(one.paraphrase({"go", {{"owner", "bob"}}}), "to bob's");
  EXPECT_EQ(one.paraphrase({"go", {{"place", "lab"}, {"side", "left"}}}), "to lab");
  EXPECT_EQ(one.paraphrase({"drive", {{"kind", "slow"}}}), "I drive slowly");
  EXPECT_EQ(one.paraphrase({"drive", {{"kind", "fast"}}}), "I drive fast");
}

TEST(Grammar, TypedSentencesAreNotListenedFor) {
  EXPECT_EQ(meaning("flakey veer left"), "turn(degrees=90, direction=left)");
  EXPECT_EQ(meaning("veer left", true), "");
  const auto listens_for = [](const std::string& word) {
    const WordGraph graph = grammar().graph({}, true);
    return std::any_of(graph.arcs.begin(), graph.arcs.end(),
                       [&](const WordGraph::Arc& arc) { return arc.word == word; });
  };
  EXPECT_TRUE(listens_for("turn"));
  EXPECT_TRUE(listens_for("halt"));
  EXPECT_FALSE(listens_for("veer"));
}

TEST(Grammar, TheRestOfASentenceIsFreeText) {
  EXPECT_EQ(meaning("flakey tell karen to be at John's office, and to wait"),
            "tell(message=be at john's office and to wait, person=karen)");
  EXPECT_EQ(meaning("flakey tell karen where it is"), "tell(message=where it is, person=karen)");
  EXPECT_EQ(meaning("flakey tell karen to"), "what?");
  EXPECT_EQ(meaning("flakey tell karen where"), "what?");
  // A recognizer of speech has no words for it.
  const WordGraph graph = grammar().graph({"karen"}, true);
  EXPECT_TRUE(std::none_of(graph.arcs.begin(), graph.arcs.end(),
                           [](const WordGraph::Arc& arc) { return arc.word == "tell"; }));
}

TEST(Grammar, SentencesOfStepsMayBeJoined) {
  const auto steps = [](const std::string& text) {
    const Grammar::Understood understood = grammar().understand(text);
    std::string all = understood.meanings.empty() ? "what?" : describe(understood.meanings[0]);
    for (const Meaning& step : understood.then)
      all += "; " + describe(step);
    return all;
  };
  EXPECT_EQ(steps("flakey turn left and go to the lab"),
            "turn(degrees=90, direction=left); go_to(place=lab)");
  EXPECT_EQ(steps("flakey turn left, then turn right and then wait there"),
            "turn(degrees=90, direction=left); turn(degrees=90, direction=right); wait_there()");
  EXPECT_EQ(steps("flakey turn left and stop now"),
            "turn(degrees=90, direction=left); wait_there()");
  EXPECT_EQ(steps("flakey stop now and turn left"), "what?");
  EXPECT_EQ(steps("flakey wait there"), "what?");
  EXPECT_EQ(steps("flakey turn left and"), "what?");
  EXPECT_EQ(steps("flakey turn left and dance"), "what?");
  EXPECT_EQ(steps("flakey turn left and never turn right"), "what?");
  EXPECT_EQ(steps("flakey turn left and tell karen to turn left and go to the lab"),
            "turn(degrees=90, direction=left); tell(message=turn left and go to the lab, "
            "person=karen)");
  EXPECT_EQ(steps("turn left and turn right"), "what?");
  std::string many = "flakey turn left";
  for (int i = 0; i < 7; ++i)
    many += " and turn left";
  EXPECT_EQ(grammar().understand(many).then.size(), 7u);
  EXPECT_EQ(steps(many + " and turn left"), "what?");
}

TEST(Grammar, WordsThatJoinSentences) {
  const auto last = [](const std::string& text) {
    const Grammar::Understood understood = grammar().understand(text);
    return understood.then.size() == 1 ? describe(understood.then[0]) : "none";
  };
  for (const char* const joint : {" and ", ", then ", " and then ", ", after that ",
                                  " and after that ", ", afterwards ", " and afterwards "})
    EXPECT_EQ(last(std::string("flakey turn left") + joint + "go to the lab"), "go_to(place=lab)")
        << joint;
  EXPECT_EQ(last("flakey, first turn left, then go to the lab"), "go_to(place=lab)");
  EXPECT_EQ(last("flakey turn left after go to the lab"), "none");
}

TEST(Grammar, AFreeTextThatMayEndWithAnOrderIsToldApart) {
  const auto apart = [](const std::string& text) {
    std::string all;
    for (const Meaning& step : grammar().understand(text).apart)
      all += (all.empty() ? "" : "; ") + describe(step);
    return all;
  };
  EXPECT_EQ(meaning("flakey tell karen to wait and then turn left"),
            "tell(message=wait and then turn left, person=karen)");
  EXPECT_EQ(apart("flakey tell karen to wait and then turn left"),
            "tell(message=wait, person=karen); turn(degrees=90, direction=left)");
  EXPECT_EQ(apart("flakey go to the lab and tell karen to wait and turn left"),
            "go_to(place=lab); tell(message=wait, person=karen); turn(degrees=90, direction=left)");
  EXPECT_EQ(apart("flakey tell karen to wait and dance"), "");
  EXPECT_EQ(apart("flakey turn left and go to the lab"), "");
}

TEST(Grammar, AMereNameAfterTheKeywordIsAtMostAReply) {
  const Grammar one("keyword: f\nstop()\n  stop\nreply somebody(person)\n  {person}\n", "test");
  EXPECT_TRUE(one.understand("f john", true).meanings.empty());
  ASSERT_EQ(one.understand("f john", true).bare.size(), 1u);
  EXPECT_EQ(describe(one.understand("f john", true).bare[0]), "somebody(person=john)");
  EXPECT_TRUE(one.understand("f john").meanings.empty());
  EXPECT_EQ(one.understand("f john").bare.size(), 1u) << "also where nothing was asked";
  EXPECT_TRUE(one.understand("f stop", true).bare.empty());
}

TEST(Grammar, ParaphrasesFillTheSlots) {
  EXPECT_EQ(grammar().paraphrase({"turn", {{"degrees", "30"}, {"direction", "left"}}}),
            "I turn 30 degrees to the left");
  EXPECT_EQ(grammar().paraphrase({"go_to", {}}), "");
  const Meaning tell{"tell", {{"person", "karen"}, {"message", "be here"}}};
  EXPECT_EQ(grammar().paraphrase(tell), "I tell karen: be here");
  EXPECT_EQ(grammar().paraphrase(tell, Grammar::Form::doing), "bringing karen a message");
  EXPECT_EQ(grammar().paraphrase(tell, Grammar::Form::task), "the message");
  EXPECT_EQ(grammar().paraphrase({"stop", {}}, Grammar::Form::doing), "");
}

TEST(Grammar, MistakesNameLineAndColumn) {
  const auto parse = [](const std::string& text) { Grammar(text, "f"); };
  EXPECT_EQ(test::each_mistake("services/agent_interface/test/mistakes.txt", parse), 16);
  EXPECT_EQ(mistake("keyword: f\nstop()\n  " + std::string(20'000, '(')),
            "3:54: expected no more than 50 brackets within each other");
}

/// The shipped grammar and what people may say to it.
TEST(Utterances, MeanWhatAPersonWouldTakeThemFor) {
  const std::string file = test::source("config/grammars/flakey.grammar");
  const Grammar grammar(read_file(file), file);
  const std::vector<SaidAndMeant> phrases =
      read_utterances(read_file(test::source("services/agent_interface/test/utterances.txt")));
  EXPECT_GE(phrases.size(), 250U);
  for (const SaidAndMeant& phrase : phrases)
    EXPECT_EQ(meaning_of(grammar, phrase), phrase.meaning) << phrase.text;
}

/// Sentences of people and their words, joined and repeated in any way. The work is counted, since
/// it is the time.
TEST(Utterances, TakeBoundedWork) {
  const std::string file = test::source("config/grammars/flakey.grammar");
  const Grammar grammar(read_file(file), file);
  std::vector<std::string> parts;
  std::vector<std::string> words;
  for (const SaidAndMeant& one :
       read_utterances(read_file(test::source("services/agent_interface/test/utterances.txt")))) {
    if (one.meaning != "what?") {
      EXPECT_LT(grammar.understand(one.text, one.reply).work, Grammar::kMostWork / 5) << one.text;
    }
    std::string part;
    for (const std::string& word : words_of(one.text))
      if (word != "flakey" && word != "robot") {
        part += (part.empty() ? "" : " ") + word;
        words.push_back(word);
      }
    if (!part.empty())
      parts.push_back(part);
  }
  std::mt19937 random(1);
  const auto any = [&](const std::vector<std::string>& some) {
    return some[random() % some.size()];
  };
  const std::vector<std::string> joints{
      " ", ", ", " and ", " then ", ", and after that ", " but ", " slowly ", " now ", " at five "};
  for (int i = 0; i < 300; ++i) {
    std::string text = any(parts);
    std::string repeated;
    const std::size_t length = 1 + random() % 4;
    for (std::size_t k = 0; k < length; ++k)
      repeated += any(joints) + (i % 3 == 0 ? any(parts) : any(words));
    const std::size_t size = 1 + random() % 60;
    while (words_of(text).size() < size)
      text += i % 5 == 0 ? any(joints) + any(parts) : repeated;
    if (i % 2 == 0)
      text += any(joints) + any(parts);
    text = "Flakey, " + text;
    const Grammar::Understood understood = grammar.understand(text, i % 7 == 0);
    EXPECT_LT(understood.work, 2 * Grammar::kMostWork) << text;
    if (understood.work > Grammar::kMostWork) {
      EXPECT_TRUE(understood.meanings.empty() || grammar.urgent(text).meaning) << text;
    }
  }
}

}  // namespace
}  // namespace saphira::agent_interface

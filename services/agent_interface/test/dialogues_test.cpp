// The conversations of dialogues.txt.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>
#include <map>
#include <sstream>

#include "dialogue_fixture.hpp"
#include "lines.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/idl/goal_words.hpp"

namespace saphira::agent_interface {
namespace {

Pose pose_of(const std::string& text) {
  std::istringstream in(text);
  double x = 0.0;
  double y = 0.0;
  double degrees = 0.0;
  EXPECT_TRUE(in >> x >> y >> degrees) << text;
  return {x, y, radians(degrees)};
}

/// One conversation, with a dialogue of its own.
class Conversation : public DialogueTest {
 public:
  void TestBody() override {}

  void take(const std::string& line) {
    const std::size_t arrow = std::min(line.find(" =>"), line.size());
    const std::size_t colon = std::min(line.find(':'), arrow);
    const std::string key = line.substr(0, colon);
    const std::string value = colon + 2 < arrow ? line.substr(colon + 2, arrow - colon - 2) : "";
    if (const auto fact = facts_.find(key); fact != facts_.end()) {
      EXPECT_EQ(fact->second(), value);
    } else if (const auto change = changes_.find(key); change != changes_.end()) {
      change->second(value);
    } else if (colon < arrow && (key.empty() || std::isupper(key[0]) != 0)) {
      speak(key, value);
    } else {
      ADD_FAILURE() << "not understood: " << line;
    }
    if (arrow < line.size()) {
      EXPECT_EQ(answer(), arrow + 4 < line.size() ? line.substr(arrow + 4) : "");
    }
    if (!last.goals.empty())
      wanted_ = last.goals.front().tag;
  }

 private:
  /// speaker: with the recognizer's confidence, such as "Alice (0.3)".
  void speak(const std::string& speaker, const std::string& text) {
    const std::size_t confidence = speaker.find(" (");
    Utterance utterance{{7, ++number}, speaker.substr(0, confidence), text};
    if (confidence != std::string::npos)
      utterance.confidence = std::stod(speaker.substr(confidence + 2));
    utterance.time = knows_time_ ? now : 0.0;
    situation.now = now + ago_;
    last = dialogue.hear(utterance, situation);
  }
  void use(Dialogue next) { std::swap(dialogue, next); }
  void restart() {
    Dialogue restarted{grammar()};
    restore(saved(dialogue), restarted);
    EXPECT_EQ(restarted.claims(), dialogue.claims());
    EXPECT_EQ(restarted.knowledge().all(), dialogue.knowledge().all());
    use(std::move(restarted));
  }
  std::string canceled() const {
    std::string all;
    for (const std::uint64_t tag : last.canceled)
      all += (all.empty() ? "" : " ") + std::to_string(tag);
    return all;
  }
  std::string namings() const {
    std::string all;
    for (const maps::Feature& feature : last.namings)
      all += (all.empty() ? "" : "; ") + std::to_string(feature.id) + " " + feature.name;
    return all;
  }
  /// The asker and the number of the newest stop, and its source. The dialogue is asker 9.
  void granted(const std::string& text) {
    std::istringstream in(text);
    v1::Grant grant;
    in >> grant.stop.asker >> grant.stop.number;
    std::getline(in >> std::ws, grant.stop_source);
    last = dialogue.granted(grant, 9);
  }
  /// "own deliver underway; drive of mcp suspended the reason": the goals that there are, the
  /// newest last; "own" is the dialogue's newest.
  void know_goals(const std::string& text) {
    situation.goals.clear();
    std::istringstream all(text);
    for (std::string one; std::getline(all >> std::ws, one, ';');) {
      std::istringstream in(one);
      KnownGoal goal;
      std::string word;
      in >> goal.functor;
      if (goal.functor == "own") {
        goal.tag = wanted_;
        in >> goal.functor;
      }
      in >> word;
      if (word == "of")
        in >> goal.asker >> word;
      for (goal.state = v1::GOAL_WAITING;
           word_of(goal.state) != word && word_of(goal.state) != std::string("?");)
        goal.state = static_cast<v1::GoalState>(goal.state + 1);
      std::getline(in >> std::ws, goal.reason);
      situation.goals.push_back(goal);
    }
  }
  /// The state of the newest goal, the seconds since it was accepted, and the reason.
  void own_goal(const std::string& text) {
    std::istringstream in(text);
    KnownGoal goal = known_goal(in);
    goal.tag = wanted_;
    in >> goal.elapsed;
    std::getline(in >> std::ws, goal.reason);
    goal.queued = goal.reason.empty();
    std::erase_if(situation.goals, [&](const KnownGoal& one) { return one.tag == wanted_; });
    situation.goals.push_back(goal);
  }
  /// The state, priority, functor, place and asker of a goal of another program.
  void others_goal(const std::string& text) {
    std::istringstream in(text);
    KnownGoal goal = known_goal(in);
    std::string place;
    in >> goal.priority >> goal.functor >> place;
    std::getline(in >> std::ws, goal.asker);
    if (place != "-")
      goal.arguments = {saphira::text("place", place)};
    goal.elapsed = 10.0;
    situation.goals.push_back(goal);
  }
  static KnownGoal known_goal(std::istringstream& in) {
    std::string state;
    in >> state;
    KnownGoal goal;
    goal.state = state == "waiting"     ? v1::GOAL_WAITING
                 : state == "suspended" ? v1::GOAL_SUSPENDED
                                        : v1::GOAL_UNDERWAY;
    return goal;
  }
  static std::string yes(bool is) { return is ? "yes" : "no"; }

  std::uint64_t wanted_ = 0;  ///< the newest goal
  double ago_ = 0.0;          ///< [s] since an utterance, when it is heard
  bool knows_time_ = true;    ///< of utterances
  std::uint64_t said_ = 0;    ///< activities' messages
  std::string map_ = kMap;
  std::string grammar_ = read_file(test::source("config/grammars/flakey.grammar"));
  const std::map<std::string, std::function<std::string()>> facts_{
      {"goals", [this] { return goals(); }},
      {"functor", [this] { return last.goals.at(0).functor; }},
      {"priority", [this] { return std::to_string(last.goals.at(0).priority); }},
      {"lasting", [this] { return yes(last.goals.at(0).lasting); }},
      {"canceled", [this] { return canceled(); }},
      {"why", [this] { return last.why; }},
      {"claims", [this] { return claims(last.claims); }},
      {"all claims", [this] { return claims(dialogue.claims()); }},
      {"source", [this] { return last.claims.at(0).source; }},
      {"namings", [this] { return namings(); }},
      {"answers", [this] { return std::to_string(last.said.at(0).answers.second); }},
      {"end", [this] { return yes(last.said.at(0).end); }},
      {"refused", [this] { return yes(last.said.at(0).refused); }},
      {"note", [this] { return last.note; }},
      {"changed", [this] { return yes(last.changed); }},
      {"answer to the program",
       [this] {
         const Answer answer = dialogue.place_of("karen");
         return answer.code == AnswerCode::done ? describe(answer.results) : answer.text;
       }},
      {"facts", [this] { return std::to_string(dialogue.knowledge().all().size()); }},
      {"doorway", [this] { return std::to_string(dialogue.knowledge().all().at(0).artifact); }},
      {"place of karen", [this] { return dialogue.knowledge().place_of("karen"); }}};
  const std::map<std::string, std::function<void(const std::string&)>> changes_{
      {"done",
       [this](const auto& text) {
         last = dialogue.ended({wanted_, true, text});
       }},
      {"failed",
       [this](const auto& text) {
         last = dialogue.ended({wanted_, false, text});
       }},
      {"activity",
       [this](const auto& text) {
         last = dialogue.says(text, {3, ++said_});
       }},
      {"seconds pass",
       [this](const auto& text) {
         situation.now = now += std::stod(text);
         last = dialogue.come_due(situation);
       }},
      {"stop", [this](const auto& text) { granted(text); }},
      {"driven by another", [this](const auto& text) { situation.is_driven = text == "yes"; }},
      {"restart", [this](const auto&) { restart(); }},
      {"anew", [this](const auto&) { use(Dialogue{grammar()}); }},
      {"asks about", [this](const auto& text) { situation.asked_about = text; }},
      {"asks for", [this](const auto& text) { situation.asked_for = text; }},
      {"carries",
       [this](const auto& text) {
         situation.carried = {{text, "EJ-231"}};
       }},
      {"goals are", [this](const auto& text) { know_goals(text); }},
      {"its step", [this](const auto& text) { situation.goals.back().step = text; }},
      {"its arguments",
       [this](const auto& text) {
         std::istringstream in(text);
         for (std::string name, value;
              std::getline(std::getline(in >> std::ws, name, '='), value, '"') &&
              std::getline(in, value, '"');)
           situation.goals.back().arguments.push_back(saphira::text(name, value));
       }},
      {"its note", [this](const auto& text) { situation.goals.back().note = text; }},
      {"its reason", [this](const auto& text) { situation.goals.back().reason = text; }},
      {"seconds on the way", [this](const auto& text) { ago_ = std::stod(text); }},
      {"without times", [this](const auto&) { knows_time_ = false; }},
      {"forget",
       [this](const auto& text) {
         last = dialogue.forget(std::stod(text));
         last.said = {{{}, "", last.answer.text}};
       }},
      {"nameless corridors",
       [this](const auto&) {
         for (maps::Feature& feature : situation.map.features)
           if (feature.type == lps::PointType::corridor)
             feature.name.clear();
       }},
      {"slow", [this](const auto& text) { situation.is_slow = text == "yes"; }},
      {"its goal", [this](const auto& text) { own_goal(text); }},
      {"goal of another", [this](const auto& text) { others_goal(text); }},
      {"no goals", [this](const auto&) { situation.goals.clear(); }},
      {"emergency stop", [this](const auto& text) { situation.estop = text; }},
      {"turns cameras", [this](const auto& text) { situation.turns_cameras = text == "yes"; }},
      {"at", [this](const auto& text) { situation.pose_in_map = pose_of(text); }},
      {"is lost", [this](const auto&) { situation.pose_in_map.reset(); }},
      {"points", [this](const auto& text) { situation.pointing_in_map = pose_of(text); }},
      {"no map", [this](const auto&) { situation.map = {}; }},
      {"map",
       [this](const auto& text) { situation.map = maps::parse_map(map_ += text + "\n", "map"); }},
      {"grammar", [this](const auto& text) { grammar_ += text + "\n"; }},
      {"new grammar", [this](const auto&) { dialogue.use(Grammar(grammar_, "grammar")); }}};
};

TEST(Dialogues, AreAsWritten) {
  // The machine's clock gives the time in sentences.
  setenv("TZ", "UTC", 1);
  tzset();
  EXPECT_EQ(test::play<Conversation>("services/agent_interface/test/dialogues.txt"), 118);
}

}  // namespace
}  // namespace saphira::agent_interface

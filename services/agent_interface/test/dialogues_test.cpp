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
      IS("goals", goals()),
      IS("functor", last.goals.at(0).functor),
      IS("priority", std::to_string(last.goals.at(0).priority)),
      IS("lasting", yes(last.goals.at(0).lasting)),
      IS("canceled", canceled()),
      IS("why", last.why),
      IS("claims", claims(last.claims)),
      IS("all claims", claims(dialogue.claims())),
      IS("source", last.claims.at(0).source),
      IS("namings", namings()),
      IS("answers", std::to_string(last.said.at(0).answers.second)),
      IS("end", yes(last.said.at(0).end)),
      IS("refused", yes(last.said.at(0).refused)),
      IS("note", last.note),
      IS("changed", yes(last.changed)),
      {"answer to the program",
       [this] {
         const Answer answer = dialogue.place_of("karen");
         return answer.code == AnswerCode::done ? describe(answer.results) : answer.text;
       }},
      IS("facts", std::to_string(dialogue.knowledge().all().size())),
      IS("doorway", std::to_string(dialogue.knowledge().all().at(0).artifact)),
      IS("place of karen", dialogue.knowledge().place_of("karen"))};
  const std::map<std::string, std::function<void(const std::string&)>> changes_ = {
    ON("done", last = dialogue.ended({wanted_, true, in})),
        ON("failed", last = dialogue.ended({wanted_, false, in})),
        ON("activity", last = dialogue.says(in, {3, ++said_})),
        ON("seconds pass", situation.now = now += std::stod(in);
           last = dialogue.come_due(situation)),
        ON("stop", granted(in)), ON("driven by another", situation.is_driven = in == "yes"),
        ON("restart", restart()), ON("anew", use(Dialogue{grammar()})),
        ON("asks about", situation.asked_about = in), ON("asks for", situation.asked_for = in),
        ON("carries", situation.carried = {{in, "EJ-231"}}), ON("goals are", know_goals(in)),
        ON("its step", situation.goals.back().step = in),
        {"its arguments",
         [this](const auto& text) {
           std::istringstream in(text);
           for (std::string name, value;
                std::getline(std::getline(in >> std::ws, name, '='), value, '"') &&
                std::getline(in, value, '"');)
             situation.goals.back().arguments.push_back(saphira::text(name, value));
         }},
        ON("its note", situation.goals.back().note = in),
        ON("its reason", situation.goals.back().reason = in),
        ON("seconds on the way", ago_ = std::stod(in)), ON("without times", knows_time_ = false),
        ON("forget", last = dialogue.forget(std::stod(in));
           last.said = {{{}, "", last.answer.text}}),
        {"nameless corridors",
         [this](const auto&) {
           for (maps::Feature& feature : situation.map.features)
             if (feature.type == lps::PointType::corridor)
               feature.name.clear();
         }},
        ON("slow", situation.is_slow = in == "yes"), ON("its goal", own_goal(in)),
        ON("goal of another", others_goal(in)), ON("no goals", situation.goals.clear()),
        ON("emergency stop", situation.estop = in),
        ON("turns cameras", situation.turns_cameras = in == "yes"),
        ON("at", situation.pose_in_map = pose_of(in)), ON("is lost", situation.pose_in_map.reset()),
        ON("points", situation.pointing_in_map = pose_of(in)), ON("no map", situation.map = {}),
        ON("map", situation.map = maps::parse_map(map_ += in + "\n", "map")),
        ON("grammar", grammar_ += in + "\n"),
        ON("new grammar", dialogue.use(Grammar(grammar_, "grammar")))
  };
};

TEST(Dialogues, AreAsWritten) {
  // The machine's clock gives the time in sentences.
  setenv("TZ", "UTC", 1);
  tzset();
  EXPECT_EQ(test::play<Conversation>("services/agent_interface/test/dialogues.txt"), 118);
}

}  // namespace
}  // namespace saphira::agent_interface

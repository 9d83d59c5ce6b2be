#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/agent_interface/grammar.hpp"
#include "saphira/agent_interface/knowledge.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/requests/argument.hpp"

namespace saphira::agent_interface {

using UtteranceId = std::pair<std::uint64_t, std::uint64_t>;

/// An utterance to the robot.
struct Utterance {
  UtteranceId id{};
  std::string speaker;  ///< empty: unknown
  std::string text;
  double confidence = 1.0;  ///< [0..1] of the recognizer
  double time = 0.0;        ///< [s] since 1970; 0: unknown
};

/// An utterance of the robot.
struct Said {
  UtteranceId answers{};  ///< 0, 0: to none
  std::string listener;
  std::string text;
  bool end = false;  ///< no more answers to that utterance follow
};

/// A goal on the bus: its asker, and its number there.
using GoalRef = std::pair<std::uint64_t, std::uint64_t>;

/// Epoch and cycle of the robot.
using CycleRef = std::pair<std::uint64_t, std::uint64_t>;

/// A goal that the dialogue wants; `tag` is its name within the dialogue.
struct WantedGoal {
  std::uint64_t tag = 0;
  std::string functor;
  Arguments arguments;
  double deadline = 0.0;  ///< [s]; 0: none
  bool lasting = false;   ///< a task, which continues while the dialogue restarts
  std::string speaker{};  ///< the person who asked for it; empty: unknown
};

/// A claim for activities. Empty value: withdrawn.
struct Claimed {
  std::string name;
  std::string value;   ///< a text
  std::string source;  ///< speaker, words and time, for people
};

/// A new name of an artifact of the map.
struct Naming {
  maps::Feature feature;
};

/// A goal of anybody.
struct KnownGoal {
  enum class State { waiting, underway, suspended, failed, over };
  std::string functor;
  std::string asker;  ///< empty: this dialogue
  State state = State::underway;
  std::string reason;
};

/// The world as the dialogue knows it, beside the advice.
struct Situation {
  std::optional<Pose> pose_in_map;  ///< of the robot; none: unknown
  maps::Map map;
  std::string asked_about;       ///< the question of an activity to people; empty: none
  std::vector<KnownGoal> goals;  ///< the newest change last
  /// A person who points: their place, with the heading of the arm (pointing.hpp).
  std::optional<Pose> pointing_in_map{};
};

/// The state of a goal that the dialogue asked for.
struct Outcome {
  std::uint64_t tag = 0;
  bool success = false;
  std::string reason;
};

/// Turns people's words into meanings, and meanings into goals, answers and knowledge (paper 4).
/// States its interpretation before it acts. A value: no clock, bus or file.
class Dialogue {
 public:
  explicit Dialogue(Grammar grammar) : grammar_(std::move(grammar)) {}
  void use(Grammar grammar) { grammar_ = std::move(grammar); }

  struct Outputs {
    std::vector<Said> said;
    std::vector<std::uint64_t> canceled;  ///< tags; before the new goals
    std::vector<WantedGoal> goals;
    std::vector<Claimed> claims;
    std::vector<Naming> namings;
    bool learned = false;  ///< knowledge(), or the newest utterance, has changed
  };
  Outputs hear(const Utterance& utterance, const Situation& situation);
  Outputs ended(const Outcome& outcome);
  /// A lasting goal was asked for, under that name. save() includes it.
  void asked(std::uint64_t tag, const GoalRef& goal);
  /// The lasting goals that have not ended, by tag.
  std::vector<std::pair<std::uint64_t, GoalRef>> lasting() const;
  /// An activity's message to people. Messages from before a restart are not repeated.
  Outputs says(const std::string& text, const CycleRef& when);
  /// Withdraws advice by its number. Says so where that number is unknown.
  Outputs forget(std::uint64_t number);

  const Knowledge& knowledge() const { return knowledge_; }
  /// The claims for activities that follow from all advice, after a start.
  std::vector<Claimed> claims() const;

  /// The state that outlives a restart: the knowledge, the ids of heard utterances, and lasting
  /// goals.
  std::string save() const;
  /// Returns the number of unreadable lines.
  std::size_t restore(std::string_view text);

 private:
  struct Doubt {  ///< contradicting advice, until its speaker says yes or no
    Advice advice;
    std::string speaker;
  };
  struct Open {
    std::uint64_t tag = 0;
    std::string what;  ///< the paraphrase
    UtteranceId answers{};
    std::string listener;
    GoalRef goal{};  ///< the goal of a lasting one
  };

  void act(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
           Outputs& out);
  bool move(const Meaning& meaning, const Utterance& utterance, Outputs& out);
  bool task(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
            Outputs& out);
  bool question(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                Outputs& out);
  bool advice(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
              Outputs& out);
  bool naming(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
              Outputs& out);
  bool reply(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
             Outputs& out);
  void take(const Advice& advice, const Utterance& utterance, Outputs& out);
  void learn(const Advice& advice, Outputs& out);
  void withdraw(std::uint64_t number, Outputs& out);
  void want(const Meaning& meaning, const Utterance& utterance, const std::string& functor,
            Arguments arguments, Outputs& out, double deadline = 0.0, bool lasting = false);
  void say(const Utterance& utterance, const std::string& text, bool end, Outputs& out) const;
  /// The robot's present goals in words: its own one, and those of others.
  std::string doing(const Situation& situation) const;
  /// The destination "here" of things to bring; empty: none.
  std::string bring_to(const Utterance& utterance, const Situation& situation) const;
  /// The place of the map with that name; empty: none.
  std::string place(const std::string& name, const Situation& situation) const;
  /// The place that slots stand for: "this", a side, a name, or a person's office. Reports errors.
  std::string referred(const Meaning& meaning, const Situation& situation, Outputs& out,
                       std::uint32_t& artifact, std::string& wrong) const;

  void restore_open(const std::string& line);

  Grammar grammar_;
  Knowledge knowledge_;
  std::optional<Doubt> doubt_;
  std::vector<Open> open_;
  std::uint64_t tag_ = 0;
  CycleRef said_{};                 ///< of an activity's newest message
  CycleRef before_{};               ///< the same, before a restart
  std::vector<UtteranceId> heard_;  ///< the newest, so that none is carried out twice
};

/// The robot's place in the map's words: a room, otherwise a corridor; empty: neither.
std::string place_at(const maps::Map& map, const Vec2& position);

}  // namespace saphira::agent_interface

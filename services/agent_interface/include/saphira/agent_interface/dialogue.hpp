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
  bool end = false;  ///< nothing more follows to that utterance
};

/// A goal on the bus: who asked, and its number there.
using GoalRef = std::pair<std::uint64_t, std::uint64_t>;

/// Epoch and cycle of the robot.
using CycleRef = std::pair<std::uint64_t, std::uint64_t>;

/// A goal that the dialogue wants; `tag` is how it calls it.
struct WantedGoal {
  std::uint64_t tag = 0;
  std::string functor;
  Arguments arguments;
  double deadline = 0.0;  ///< [s]; 0: none
  bool lasting = false;   ///< a task, which goes on while the dialogue is started again
};

/// A claim of what is true, for activities. Empty value: taken back.
struct Claimed {
  std::string name;
  std::string value;   ///< a text
  std::string source;  ///< who said what, and when, for people
};

/// A new name of an artifact of the map.
struct Naming {
  maps::Feature feature;
};

/// The world as the dialogue knows it, beside the advice.
struct Situation {
  std::optional<Pose> pose_in_map;  ///< of the robot; none: not known
  maps::Map map;
  std::string asked_about;  ///< what an activity has asked people about; empty: nothing
};

/// The state of a goal that the dialogue asked for.
struct Outcome {
  std::uint64_t tag = 0;
  bool success = false;
  std::string reason;
};

/// Takes what people say to meanings, and these to goals, answers and knowledge (paper 4). It says
/// what it has understood before it acts. A value: no clock, bus or file.
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
    bool learned = false;  ///< knowledge() is another, or what was heard last
  };
  Outputs hear(const Utterance& utterance, const Situation& situation);
  Outputs ended(const Outcome& outcome);
  /// A lasting goal was asked for, by that name. save() keeps it.
  void asked(std::uint64_t tag, const GoalRef& goal);
  /// The lasting goals whose end is waited for, by tag.
  std::vector<std::pair<std::uint64_t, GoalRef>> lasting() const;
  /// An activity has something to say to people. What was said before a restart is not said again.
  Outputs says(const std::string& text, const CycleRef& when);
  /// Takes advice back, by its number. Nothing known of that number: says so.
  Outputs forget(std::uint64_t number);

  const Knowledge& knowledge() const { return knowledge_; }
  /// Claims for activities that follow from all advice: made anew after a start.
  std::vector<Claimed> claims() const;

  /// State that outlives a restart: the knowledge, which utterances were heard, and lasting goals.
  std::string save() const;
  /// The number of lines that could not be read.
  std::size_t restore(std::string_view text);

 private:
  struct Doubt {  ///< advice that contradicts, until its speaker says yes or no
    Advice advice;
    std::string speaker;
  };
  struct Open {
    std::uint64_t tag = 0;
    std::string what;  ///< as it was paraphrased
    UtteranceId answers{};
    std::string listener;
    GoalRef goal{};  ///< of one that lasts
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
  bool reply(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
             Outputs& out);
  void take(const Advice& advice, const Utterance& utterance, Outputs& out);
  void learn(const Advice& advice, Outputs& out);
  void withdraw(std::uint64_t number, Outputs& out);
  void want(const Meaning& meaning, const Utterance& utterance, const std::string& functor,
            Arguments arguments, Outputs& out, double deadline = 0.0, bool lasting = false);
  void say(const Utterance& utterance, const std::string& text, bool end, Outputs& out) const;
  /// The place to bring things to for "here"; empty: none.
  std::string bring_to(const Utterance& utterance, const Situation& situation) const;
  /// The place of the map that a name means; empty: none.
  std::string place(const std::string& name, const Situation& situation) const;
  /// The place that slots mean: "this", a side, a name, or somebody's office. Says what is wrong.
  std::string referred(const Meaning& meaning, const Situation& situation, Outputs& out,
                       std::uint32_t& artifact, std::string& wrong) const;

  void restore_open(const std::string& line);

  Grammar grammar_;
  Knowledge knowledge_;
  std::optional<Doubt> doubt_;
  std::vector<Open> open_;
  std::uint64_t tag_ = 0;
  CycleRef said_{};                 ///< of what an activity said last
  CycleRef before_{};               ///< the same, before a restart
  std::vector<UtteranceId> heard_;  ///< the newest, so that none is acted on twice
};

/// Where the robot is, in the map's words: a room, otherwise a corridor; empty: neither.
std::string place_at(const maps::Map& map, const Vec2& position);

}  // namespace saphira::agent_interface

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saphira/agent_interface/grammar.hpp"
#include "saphira/agent_interface/knowledge.hpp"
#include "saphira/agent_interface/tasks.hpp"
#include "saphira/idl/goal_end.hpp"
#include "saphira/idl/intention.hpp"
#include "saphira/idl/motion.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::agent_interface {

/// Epoch and cycle of the robot.
using CycleRef = std::pair<std::uint64_t, std::uint64_t>;

/// A claim for activities. Empty value: withdrawn.
struct Claimed {
  std::string name;
  std::string value;                ///< a text
  std::string source;               ///< speaker, words and time, for people
  std::vector<std::string> list{};  ///< not empty: the value is this list
  bool nil = false;                 ///< the value is nil; it goes before the beliefs of activities

  friend bool operator==(const Claimed&, const Claimed&) = default;
};

/// The value of a claim in the language of activities.
std::string literal(const Claimed& claim);

/// The finding of an activity: the place of a person, or a thing that the robot has.
struct Find {
  Advice::Kind kind = Advice::Kind::person_at;
  std::string about;
  std::string value;
  std::optional<double> age{};  ///< [s]; none: of before this epoch

  friend bool operator==(const Find&, const Find&) = default;
};

/// A goal of anybody.
struct KnownGoal {
  std::string functor;
  std::string asker;  ///< empty: this dialogue
  v1::GoalState state = v1::GOAL_UNDERWAY;
  std::string reason;     ///< of the state, in words; empty: none
  std::uint64_t tag = 0;  ///< of this dialogue's goals that have not ended
  std::string note{};     ///< beside the state; empty: none
  std::string step{};     ///< of the work, such as "through-door: passes a door"; empty: none
  Arguments arguments{};  ///< of the goals of others, as far as known
  int priority = 0;
  double elapsed = 0.0;  ///< [s] since it was accepted
  bool queued = true;    ///< not waiting for something else than another goal
};

/// The world as the dialogue knows it, beside the advice.
struct Situation {
  std::optional<Pose> pose_in_map;  ///< of the robot; none: unknown
  maps::Map map;
  std::string asked_about;       ///< the question of an activity to people; empty: none
  std::string asked_for{};       ///< the person whose place is asked; empty: none
  std::vector<KnownGoal> goals;  ///< the newest change last
  /// A person who points: their place, with the heading of the arm (pointing.hpp).
  std::optional<Pose> pointing_in_map{};
  /// Persons of whom an activity or another program believes a place, or who knows it; in small
  /// letters.
  std::vector<std::string> findable{};
  /// Objects on the robot's back, such as "the report", and where each was to go.
  std::vector<std::pair<std::string, std::string>> carried{};
  double now = 0.0;            ///< [s] since 1970; 0: unknown, as in lockstep
  bool turns_cameras = false;  ///< the robot has a head
  bool is_slow = false;        ///< it was told to go slowly
  bool is_driven = false;      ///< by a person or program in a stronger role than the tasks
  std::string estop{};         ///< the program that pressed the emergency stop; empty: none
  std::map<std::string, std::string> agents{};  ///< functors of facts, and who knows them
};

/// The request that puts an artifact with its name on the map.
Request put_on_map(const maps::Feature& feature);

/// Puts the question that activities ask people into the situation. Returns their finds. `age`: of
/// the set [s].
std::vector<Find> heed(const v1::BeliefSet& set, double age, Situation& situation);
/// Puts the emergency stop and the role that drives into the situation.
void heed(const v1::Grant& grant, Situation& situation);

/// A person's question that is put to agents.
struct OpenQuestion {
  Utterance asked;
  Request request;
};

/// [s] that agents have for the answer to a person's question.
inline constexpr double kAgentsPatience = 5.0;

/// Turns people's words into meanings, and meanings into goals, answers and knowledge (paper 4).
/// States its interpretation before it acts. A value: no clock, bus or file.
class Dialogue {
 public:
  explicit Dialogue(Grammar grammar) : grammar_(std::move(grammar)) {}
  void use(Grammar grammar) { grammar_ = std::move(grammar); }

  /// A name in a sentence that nothing has.
  struct UnknownName {
    std::string name{};   ///< empty: none
    std::string meant{};  ///< the one that the robot asks back for instead; empty: none
    bool person = false;  ///< it may be one
  };
  struct Outputs {
    std::vector<Said> said;
    std::vector<std::uint64_t> canceled;  ///< tags; before the new goals
    std::string why{};                    ///< they are canceled, in words; empty: no reason
    std::vector<WantedGoal> goals;
    std::vector<Claimed> claims;
    std::vector<maps::Feature> namings;  ///< artifacts of the map with their new names
    bool changed = false;                ///< the memory has other contents
    std::string note;                    ///< for the log; empty: none
    v1::AuditEntry denied{};             ///< the person may not do it; without a text: they may
    UnknownName unknown{};
    std::vector<OpenQuestion> asks;
    Answer answer{};  ///< of forget()
  };
  Outputs hear(const Utterance& utterance, const Situation& situation);
  /// A program that has spoken has ended or has withdrawn its words: its tasks end.
  Outputs left(const ProgramId& program);
  Outputs ended(const Outcome& outcome);
  /// The end of a question that was put to agents, and the agent that has answered. An order that
  /// waits for it begins, or is refused.
  Outputs answered_by(const OpenQuestion& question, const std::string& agent, const Answer& answer,
                      Situation situation);
  /// A stop that is not of this dialogue (`self`), or an emergency stop, ends orders for a later
  /// time. The first grant shows an earlier stop.
  Outputs granted(const v1::Grant& grant, std::uint64_t self);
  /// Orders for a later time begin, or ask whether to drop the task of somebody else. A task that
  /// turns out to wait is told.
  Outputs come_due(const Situation& situation);
  /// The tags of all goals that are asked for and have no status yet, at `seconds` of a clock that
  /// does not go back. A goal that stays without one for kTakenUp has failed, and is withdrawn.
  Outputs without_status(const std::vector<std::uint64_t>& tags, double seconds);
  /// A lasting goal was asked for, under that name and with that text.
  void asked(std::uint64_t tag, const GoalRef& goal, const std::string& sample) {
    tasks_.asked(tag, goal, sample);
  }
  /// The lasting goals that have not ended.
  std::vector<LastingGoal> lasting() const { return tasks_.lasting(); }
  /// An activity's message to people. Messages from before a restart, and those of activities while
  /// this dialogue has no goal, are not said.
  Outputs says(const std::string& text, const CycleRef& when);
  /// Withdraws advice by its number. Its `answer` refuses one that is not whole and positive.
  Outputs forget(double number);
  /// All present finds of activities; those that are new are learned. An old one, which is heard
  /// again after a restart, counts where nothing is known of that person.
  Outputs found(const std::vector<Find>& finds, double now);

  /// The answer to a program that looks for a person.
  Answer place_of(const std::string& person) const;

  const Knowledge& knowledge() const { return knowledge_; }
  /// The claims for activities that follow from all advice, after a start.
  std::vector<Claimed> claims() const;

  /// The state that outlives a restart: the knowledge, the ids of heard utterances, lasting goals,
  /// and orders for later.
  void archive(Archive& a);

 private:
  /// A question back to the speaker of a sentence, until their next sentence or for 20 s. Of the
  /// members for a yes, one has a value, or none where only a name is an answer.
  struct Question {
    Utterance raised_by{};
    Grammar::Understood sentence{};          ///< as it was heard
    std::vector<Grammar::Understood> yes{};  ///< after a yes; of several the speaker names one
    std::vector<Task> drops{};         ///< after a yes; the task of somebody else is dropped for it
    std::optional<Advice> fact{};      ///< after a yes; against what the robot knows
    std::string no{};                  ///< the answer to a no; empty: the sentence is carried out
    std::vector<std::string> names{};  ///< in the sentence, for which another one may be said
    bool asked = true;  ///< false: the robot does it; only a correction is an answer, at any time
    bool of_agents = false;  ///< the sentence waits for their answer, or for another name
  };
  struct Gone {  ///< a person without a known place: it was withdrawn
    std::string person;
    std::string source;
  };
  struct Words {  ///< the newest sentence of a speaker, and the robot's answer
    std::string speaker;
    std::string said;
    std::string answer;
    double time = 0.0;  ///< [s] as Situation::now
    bool refused = false;
  };
  struct Ended {       ///< the newest goal that has ended
    std::string task;  ///< in words
    bool success = false;
    std::string reason;
  };

  /// The outputs of a change, with the claims that are other ones by it.
  Outputs changing(const std::function<void(Outputs&)>& change);
  void begin_due(const Situation& situation, Outputs& out);
  void take_in(const Utterance& utterance, const Situation& situation, Outputs& out);
  void take_finds(const std::vector<Find>& finds, double now, Outputs& out);
  /// Carries out a sentence, or asks back.
  void carry_out(Grammar::Understood understood, const Utterance& utterance,
                 const Situation& situation, Outputs& out);
  void ask(Question question, const Utterance& utterance);
  void ask_again(Grammar::Understood understood, const Utterance& utterance, Outputs& out);
  void ask_for_order(Grammar::Understood understood, const Utterance& utterance, Outputs& out);
  void prefer_answer(Grammar::Understood& understood, const Question* question,
                     const Situation& situation) const;
  void note_name(Grammar::Understood understood, const Utterance& utterance, const Outputs& out);
  /// The question that this utterance may answer; nullptr: none.
  const Question* question_for(const Utterance& utterance) const;
  void forget_question(const Utterance& utterance);
  /// True where the sentence answers the robot's question; then that is done.
  bool answered(Question question, const Grammar::Understood& understood,
                const Utterance& utterance, const Situation& situation, Outputs& out);
  /// Takes away the meanings that answer a question which is not asked.
  void leave_out(Grammar::Understood& understood, const Situation& situation) const;
  /// The number of the sentence that is chosen of several; none: no choice.
  std::optional<std::size_t> chosen(const Question& question, const Grammar::Understood& understood,
                                    const Utterance& utterance) const;
  /// The meanings of the sentence with other words in the place of some of its own, or of those
  /// that are named as wrong, and its text then. names: an unknown name counts, too.
  std::vector<std::pair<Meaning, std::string>> corrected(const Question& question,
                                                         const Meaning& instead, bool names,
                                                         const Situation& situation) const;
  bool names_unknown(const Meaning& meaning, const Situation& situation) const;
  /// The place or person that a reply names; empty: none.
  std::string named(const Grammar::Understood& understood, const Utterance& utterance,
                    const Situation& situation) const;
  void act(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
           Outputs& out);
  void act_on_all(const Grammar::Understood& understood, const Utterance& utterance,
                  const Situation& situation, Outputs& out);
  /// Begins the steps, or asks whether to drop the task of somebody else.
  void begin(std::vector<Task> steps, bool drops, const Utterance& utterance,
             const Situation& situation, Outputs& out);
  static void add(Tasks::Outputs more, Outputs& out);
  void end(const Outcome& outcome, Outputs& out);
  bool move(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
            Outputs& out);
  bool task(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
            Outputs& out);
  /// Tasks for people that are not in 4.6 of the paper (errands.cpp).
  bool errand(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
              Outputs& out);
  void change_pace(bool slower, const Utterance& utterance, const Situation& situation,
                   Outputs& out);
  /// Adds a rule for as long as the sentence that is being heard is done. False: it is refused.
  bool add_rule(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                Rules& rules, Outputs& out) const;
  /// Asks agents for the place of the person whose name made the order fail; the order waits.
  /// False: there is no such name or agent.
  bool ask_place(const Grammar::Understood& understood, const Utterance& utterance,
                 const Situation& situation, Outputs& out);
  /// Puts a question to the agents that know such facts. False: there is none.
  bool ask_agents(Request request, const std::string& unknown, const Utterance& utterance,
                  const Situation& situation, Outputs& out) const;
  void wait_until(const Meaning& meaning, const Utterance& utterance, Outputs& out);
  /// Keeps the place where a new task begins, for "come back".
  void note_begin(const Situation& situation, const Outputs& out);
  void go_back(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
               Outputs& out);
  bool question_about_robot(const Meaning& meaning, const Utterance& utterance,
                            const Situation& situation, Outputs& out) const;
  /// People, places and hazards.
  bool question_about_world(const Meaning& meaning, const Utterance& utterance,
                            const Situation& situation, Outputs& out) const;
  void owner_of(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                Outputs& out) const;
  bool advice(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
              Outputs& out);
  /// Ends hazards and rules of that kind at a place. here: told without the place.
  void end_hazards(const Advice& ended, bool here, const Utterance& utterance, Outputs& out);
  bool correction(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                  Outputs& out);
  bool naming(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
              Outputs& out);
  bool reply(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
             Outputs& out);
  void take(const Advice& advice, const Utterance& utterance, const Situation& situation,
            Outputs& out);
  /// A fact that also answers the open question.
  void answer_with(const Advice& advice, const Utterance& utterance, const Situation& situation,
                   Outputs& out) const;
  void learn(const Advice& advice, Outputs& out);
  void withdraw(std::uint64_t number, Outputs& out, const Utterance* because = nullptr);
  /// All hazards and rules of zones, with those of these tasks.
  Claimed hazards(const std::vector<Task>& tasks) const;
  /// The facts about a person or thing, in words; empty: none.
  std::string told_of(const std::string& about) const;
  /// The meaning as the robot would say it.
  std::string in_words(const Meaning& meaning) const;
  /// The known person of "karens office", written without apostrophe; empty: none.
  std::string owner_in(const std::string& name) const;
  void note_words(const Utterance& utterance, double now, const Outputs& out);
  const Words* words_of_speaker(const std::string& name) const;
  /// The sources of the facts in the newest answer to this speaker, or of those about somebody.
  std::string sources(const Meaning& meaning, const Utterance& utterance,
                      const Situation& situation) const;
  /// The time that the rest of the way takes, by the map.
  std::string time_left(const Situation& situation) const;
  /// The reason for which the robot stands or drives.
  std::string why(const Situation& situation, const std::string& speaker) const;
  /// Asks which of several meanings a sentence has.
  void choices(const Grammar::Understood& understood, const Utterance& utterance, Outputs& out);
  void want(const Meaning& meaning, const Utterance& utterance, const std::string& functor,
            Arguments arguments);
  void say(const Utterance& utterance, const std::string& text, bool end, Outputs& out) const;
  /// The answer to an utterance that changes nothing: asks back, or says why not. Ends it.
  void refuse(const Utterance& utterance, const std::string& text, Outputs& out) const;
  /// The robot's present goals in words, the one at work first: its own ones, and those of others.
  std::string doing(const Situation& situation) const;
  /// A goal of another asker: "the way to library for saphira goal".
  std::string named_goal(const KnownGoal& goal, Grammar::Form form) const;
  /// The goal of another asker before all others of them.
  std::optional<Tasks::Front> front(const Situation& situation) const;
  void tell_of_waiting(const Situation& situation, Outputs& out);
  /// The destination "here" of things to bring; empty: none.
  std::string bring_to(const Utterance& utterance, const Situation& situation) const;
  /// The place of the map with that name, whatever its hyphens and blanks; empty: none.
  std::string place(const std::string& name, const Situation& situation) const;
  /// True where somebody or something says where that person is, or who knows it.
  bool findable(const std::string& person, const Situation& situation) const;
  /// True for a place of the map, and for a person who is findable or asked for.
  bool is_known(const std::string& name, const Situation& situation) const;
  /// That no place, or neither place nor person, has this name; with the nearest name, or some of
  /// the places.
  std::string unknown(const std::string& name, bool people, const Situation& situation,
                      Outputs& out) const;
  /// The reason for which a task would fail, as far as it is known before; empty: none.
  std::string hindrance(const WantedGoal& goal, const Situation& situation, Outputs& out) const;
  /// The way to a place of the map by the rules of all zones; no route and no reason: there is
  /// none to ask for.
  maps::RouteResult allowed_way(const std::string& place, const Situation& situation) const;
  /// The reason why the robot is not to go to that place of the map; empty: none.
  std::string kept_out(const std::string& place, const Situation& situation) const;
  /// A thing as activities name it; "it" is the only one that the robot carries. Empty: unclear.
  static std::string thing(const std::string& name, const Situation& situation);
  /// The same as place(), or the name of a person.
  std::string place_or_person(const std::string& name, const Situation& situation) const;
  /// The place that slots stand for: "this", a side, a name, or a person's office. Reports errors.
  std::string referred(const Meaning& meaning, const Situation& situation, Outputs& out,
                       std::uint32_t& artifact, std::string& wrong) const;

  /// The same; where there is none, the reason is said.
  std::string place_or_refusal(const Meaning& meaning, const Utterance& utterance,
                               const Situation& situation, Outputs& out) const;

  Grammar grammar_;
  Knowledge knowledge_;
  std::vector<Question> questions_;  ///< the newest of each speaker
  std::optional<Question> order_;    ///< for the open task
  struct Spot {
    std::string place;
    Pose pose_in_map;
  };

  std::vector<Gone> gone_;
  std::vector<Words> words_{};  ///< since the start
  struct Pace {                 ///< a slow one that no order of this dialogue has
    std::string speaker;        ///< whose next order takes it
    std::string source;
    bool for_others = false;  ///< it was said while the robot did something for another program
  };

  std::optional<Pace> pace_{};
  std::optional<Ended> ended_;
  UtteranceId unclear_{};   ///< the newest utterance, which was no answer; 0, 0: it was one
  std::uint64_t stop_ = 0;  ///< the tag of the newest stop
  std::optional<v1::StopId> known_stop_{};  ///< the newest of anybody
  Tasks tasks_;
  std::map<std::uint64_t, double> without_status_;  ///< goals, since when [s]
  std::optional<Spot> began_;                       ///< the newest task, there
  std::vector<Task> wanted_;                     ///< the tasks of the sentence that is being heard
  CycleRef said_{};                              ///< of an activity's newest message
  CycleRef before_{};                            ///< the same, before a restart
  std::vector<UtteranceId> heard_;               ///< the newest, so that none is carried out twice
  std::map<UtteranceId, std::string> heard_by_;  ///< the checked persons, since the start
  std::vector<Find> found_;                      ///< the newest
};

/// The robot's place in the map's words: a room, otherwise a corridor; empty: neither.
std::string place_at(const maps::Map& map, const Vec2& position);

}  // namespace saphira::agent_interface

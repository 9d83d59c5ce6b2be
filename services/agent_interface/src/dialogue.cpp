#include "saphira/agent_interface/dialogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "saphira/base/archive.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kSure = 0.5;         // a lower confidence of a recognizer is ignored
constexpr double kCertain = 0.8;      // at a lower one the robot asks back before it acts
constexpr double kAhead = 10.0;       // [m] of the point to turn to
constexpr double kLongestWay = 20.0;  // [m] that one command of motion may take
constexpr double kOld = 60.0;         // [s] after which an utterance is too old to act on
constexpr double kLate = 600.0;       // [s] after its time, an order for later is not begun
constexpr std::size_t kHeard = 256;
constexpr std::size_t kLongestText = 255;  // letters: as long as an argument of a goal
/// Goals that interrupt a task for a moment.
constexpr std::array kBrief{"go_to", "drive", "turn_to", "stop", "look", "attend-person", "pause"};
/// Tasks, which continue while the dialogue restarts.
constexpr std::array kLasting{"go-to-place", "find-person", "deliver", "tell",
                              "inquire",     "patrol",      "guide",   "come-back"};

/// A sentence that changes the knowledge of the robot.
bool is_fact(const Meaning& meaning) {
  constexpr std::array kFacts{"office_of",     "person_at", "knows_where", "hazard",
                              "no_hazard",     "has",       "not_has",     "not_at",
                              "not_office_of", "not_knows", "forget",      "name_of"};
  return std::find(kFacts.begin(), kFacts.end(), meaning.functor) != kFacts.end();
}

/// The unit of a motion's distance [m].
double meters_in(std::string_view unit) {
  return unit == "yd"               ? 0.9144
         : unit == "ft"             ? 0.3048
         : unit == "inches"         ? 0.0254
         : unit == "cm"             ? 0.01
         : unit == "mm"             ? 0.001
         : unit.starts_with("step") ? 0.5
                                    : 1.0;
}

/// Puts the speaker where a slot has "me". False: the speaker has no name.
bool name_speaker(Grammar::Understood& understood, const std::string& speaker) {
  bool named = true;
  const auto name = [&](Meaning& meaning) {
    for (auto& [slot, value] : meaning.slots)
      if (value == "me" && (slot == "person" || slot == "owner")) {
        value = lowered(speaker);
        named = named && !speaker.empty();
      }
  };
  for (std::vector<Meaning>* const steps :
       {&understood.meanings, &understood.then, &understood.apart, &understood.during})
    std::for_each(steps->begin(), steps->end(), name);
  return named;
}

/// Facts about a thing are those about a person with the name "the printer". "Her office" is that
/// of the person.
void name_things(std::vector<Meaning>& meanings) {
  for (Meaning& meaning : meanings) {
    if (const auto thing = meaning.slots.extract("thing"))
      meaning.slots["person"] = "the " + thing.mapped();
    if (slot(meaning, "owner") == "self")
      meaning.slots["owner"] = slot(meaning, "person");
  }
}

}  // namespace

void Dialogue::say(const Utterance& utterance, const std::string& text, bool end,
                   Outputs& out) const {
  out.said.push_back({utterance.id, utterance.speaker, text, end});
}

void Dialogue::refuse(const Utterance& utterance, const std::string& text, Outputs& out) const {
  out.said.push_back({utterance.id, utterance.speaker, text, true, true});
}

void Dialogue::want(const Meaning& meaning, const Utterance& utterance, const std::string& functor,
                    Arguments arguments) {
  const auto is_in = [&](const auto& functors) {
    return std::find(functors.begin(), functors.end(), functor) != functors.end();
  };
  Task task;
  const bool lasts = is_in(kLasting) && utterance.program == ProgramId{};
  task.goal = {0, functor, std::move(arguments), 0.0, lasts, utterance.speaker};
  task.brief = is_in(kBrief);
  task.what = grammar_.paraphrase(meaning);
  task.doing = grammar_.paraphrase(meaning, Grammar::Form::doing);
  task.name = grammar_.paraphrase(meaning, Grammar::Form::task);
  wanted_.push_back(std::move(task));
}

bool Dialogue::move(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                    Outputs& out) {
  const auto point_ahead = [](double distance, double angle) {
    return point("position", Pose(distance * std::cos(angle), distance * std::sin(angle), 0.0),
                 Frame::robot);
  };
  if (meaning.functor == "stop") {
    want(meaning, utterance, "stop", {});
  } else if (meaning.functor == "move") {
    const double distance = number_of(meaning, "distance") * meters_in(slot(meaning, "unit"));
    if (distance <= 0.0) {
      refuse(utterance, "that is no way to go", out);
      return true;
    }
    if (distance > kLongestWay) {
      refuse(utterance, "no: I go " + plain(kLongestWay) + " m at a time at most", out);
      return true;
    }
    if (slot(meaning, "direction") == "back") {
      constexpr double kBackSpeed = 0.1;  // [m/s]
      want(meaning, utterance, "drive",
           {number("speed", -kBackSpeed), number("distance", distance)});
    } else {
      want(meaning, utterance, "go_to", {point_ahead(distance, 0.0)});
    }
  } else if (meaning.functor.starts_with("turn")) {
    const double degrees = meaning.functor == "turn_around" ? 180.0
                           : meaning.functor == "turn_side" ? 90.0
                                                            : number_of(meaning, "degrees");
    if (degrees <= 0.0) {
      refuse(utterance, "that is no turn", out);
      return true;
    }
    if (degrees > 360.0) {
      refuse(utterance, "no: I turn by 360 degrees at a time at most", out);
      return true;
    }
    const int parts = degrees > 180.0 ? 2 : 1;  // a point has no way around to it
    const double angle = degrees / parts / 180.0 * std::numbers::pi;
    for (int i = 0; i < parts; ++i)
      want(parts > 1 ? with(meaning, "degrees", plain(degrees / parts)) : meaning, utterance,
           "turn_to",
           {point_ahead(kAhead, slot(meaning, "direction") == "right" ? -angle : angle)});
  } else if (meaning.functor == "look") {
    const std::string direction = slot(meaning, "direction");
    const double angle = direction == "left"    ? std::numbers::pi / 2.0
                         : direction == "right" ? -std::numbers::pi / 2.0
                         : direction == "back"  ? std::numbers::pi
                                                : 0.0;
    if (situation.turns_cameras)
      want(meaning, utterance, "look", {number("angle", angle)});
    else if (angle == 0.0)
      say(utterance, "my cameras always look ahead", true, out);
    else  // the cameras turn with the robot
      want(meaning, utterance, "turn_to", {point_ahead(kAhead, angle)});
  } else {
    return false;
  }
  return true;
}

bool Dialogue::task(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                    Outputs& out) {
  const std::string& functor = meaning.functor;
  const auto whom = [&](const char* name) {
    return place_or_person(slot(meaning, name), situation);
  };
  if (functor == "follow_me" || functor == "look_at_me") {
    // The robot sees who points, and does not know the faces of the others.
    Arguments speaker;
    if (situation.pointing_in_map)
      speaker.push_back(point("near", *situation.pointing_in_map, Frame::map));
    want(meaning, utterance, functor == "follow_me" ? "follow-person" : "attend-person", speaker);
  } else if (functor == "follow_corridor") {
    want(meaning, utterance, "find-and-follow", {});
  } else if (functor == "explore") {
    want(meaning, utterance, "explore", {});
  } else if (functor == "find") {
    want(meaning, utterance, "find-person", {text("name", slot(meaning, "person"))});
  } else if (functor == "go_to" || functor == "to_place") {
    const std::string name = slot(meaning, "place");
    std::uint32_t artifact = 0;
    std::string wrong;
    const std::string where = referred(meaning, situation, out, artifact, wrong);
    Meaning shown = with(meaning, "place", where);
    shown.slots["owner"] = "";
    if (!where.empty()) {
      Arguments arguments{text("place", where)};
      const std::string written = place(name, situation).empty() ? owner_in(name) : std::string();
      const std::string whose = written.empty() ? slot(meaning, "owner") : written;
      if (!whose.empty())
        arguments.push_back(text("whose", whose));
      want(shown, utterance, "go-to-place", arguments);
    } else if (name.empty() || out.unknown.name != name)
      refuse(utterance, wrong, out);
    else if (!findable(name, situation))
      refuse(utterance, unknown(name, true, situation, out), out);
    else {
      out.unknown = {};
      want(with(meaning, "place", name), utterance, "find-person", {text("name", name)});
    }
  } else if (functor == "face") {
    const std::string where = place_or_refusal(meaning, utterance, situation, out);
    const maps::Feature* const spot =
        situation.pose_in_map && !where.empty() ? nearest_of(where, situation) : nullptr;
    if (spot != nullptr)
      want(with(with(meaning, "place", where), "owner", ""), utterance, "turn_to",
           {point("position", Pose(spot->pose_in_map.x, spot->pose_in_map.y, 0.0), Frame::map)});
    else if (!where.empty())
      refuse(utterance, kLost, out);
  } else if (functor == "deliver" || functor == "fetch") {
    const bool here = functor == "fetch";
    const char* const owner = here ? "person" : "from";
    const std::string object = thing(slot(meaning, "object"), situation);
    const bool aboard = is_aboard(object, situation);
    const Advice* const known = knowledge_.find(Advice::Kind::has, object);
    const bool told = known != nullptr && known->value != named_person("");
    std::string from = slot(meaning, owner).empty() && told ? known->value : whom(owner);
    if (from.empty())
      from = place(slot(meaning, "object"), situation);
    const std::string to = here ? bring_to(utterance, situation) : whom("to");
    if (to.empty()) {
      refuse(utterance, "I do not know where to bring it: where I am has no name", out);
    } else if (from.empty() && !aboard) {
      refuse(utterance, "nobody has told me who has " + object, out);
    } else {
      Arguments arguments{text("object", object), text(aboard ? "sender" : "from", from),
                          text("to", to)};
      if (here)
        arguments.push_back(text("receiver", lowered(utterance.speaker)));
      want(aboard ? Meaning{"deliver_here", {{"object", slot(meaning, "object")}, {"to", to}}}
                  : with(with(meaning, owner, from), "to", to),
           utterance, "deliver", std::move(arguments));
    }
  } else {
    return false;
  }
  return true;
}

std::string Dialogue::in_words(const Meaning& meaning) const {
  Meaning shown = meaning;
  if (slot(meaning, "place") == "this")
    shown.slots["place"] = "this place";
  if (const std::string owner = slot(meaning, "owner"); !owner.empty()) {
    shown.slots["owner"] = owner + "'s office";
    if (shown.slots.contains("place"))
      shown.slots["place"] = "";
  }
  return grammar_.paraphrase(shown);
}

/// The answer to a question of an activity.
bool Dialogue::reply(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                     Outputs& out) {
  std::string value;
  const std::string asked_for = lowered(situation.asked_for);
  Advice told;  // about nobody: nothing
  const bool holder = situation.asked_about == "who-has";
  const bool thing = holder || is_handover(situation.asked_about);
  told.kind = thing ? Advice::Kind::has : Advice::Kind::person_at;
  told.about = asked_for;
  told.speaker = utterance.speaker;
  told.said = utterance.text;
  told.time = utterance.time;
  const bool open = !situation.asked_about.empty();
  const std::string called = slot(meaning, "person");
  if (open && meaning.functor == "somebody") {
    if (called == asked_for) {
      refuse(utterance, "yes, I ask where " + called + " is", out);
      return true;
    }
    // Somebody is called to hand it over.
    if (saphira::joined(words_of(utterance.text), " ") == called &&
        (is_question(utterance.text) || is_handover(situation.asked_about)))
      return true;
  }
  const bool takes = situation.asked_about == "taken";
  if (meaning.functor == "gives" && !holder && situation.asked_about != "given")
    return true;
  if (holder && meaning.functor == "other_has") {
    refuse(utterance, "who is that? Say the name", out);
    return true;
  }
  const bool handed = meaning.functor == "handed" || meaning.functor == "gives";
  if (meaning.functor == "yes" || handed || meaning.functor == "other_has") {
    const bool own = takes ? meaning.functor != "other_has" : holder && handed;
    value = own && !utterance.speaker.empty() ? lowered(utterance.speaker) : "yes";
    if (value == "yes")
      told.about.clear();
  } else if (takes && meaning.functor == "somebody") {
    value = called;
  } else if (meaning.functor == "no" || meaning.functor == "dont_know") {
    const bool knows = meaning.functor == "no" || situation.asked_about != "answer";
    value = knows ? "no" : "does not know";
    told.about.clear();
  } else if (open && is_question(utterance.text)) {
    refuse(utterance, "is that a question? Without the question mark I take it as an answer", out);
    return true;
  } else if (meaning.functor == "somebody") {
    const std::string name = slot(meaning, "person");
    const bool person = place(name, situation).empty();
    value = place_or_person(name, situation);
    if (open && person && !findable(name, situation)) {
      refuse(utterance, "nobody has told me where " + name + " is", out);
      return true;
    }
    if (!person && thing)
      told.about.clear();
    else if (person && !thing)
      told.kind = Advice::Kind::knows_where;
  } else if (meaning.functor == "at") {
    std::uint32_t artifact = 0;
    std::string wrong;
    value = referred(meaning, situation, out, artifact, wrong);
    if (open && value.empty()) {
      refuse(utterance, wrong, out);
      return true;
    }
    told.kind = Advice::Kind::person_at;
    if (const std::string who = slot(meaning, "who"); !who.empty() || thing)
      told.about = who;
  } else {
    return false;
  }
  if (!open)
    return true;  // no question is open
  told.value = value;
  const bool answers = thing || asked_for.empty() || told.about.empty() || told.about == asked_for;
  say(utterance,
      answers ? "thank you"
              : "I know now that " + describe(told) + ", and still ask for " + asked_for,
      true, out);
  if (answers)
    out.claims.push_back({situation.asked_about, value, claim_source(utterance)});
  if (!told.about.empty() && told.about != value)
    learn(told, out);
  return true;
}

void Dialogue::act(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                   Outputs& out) {
  if (move(meaning, utterance, situation, out) || task(meaning, utterance, situation, out) ||
      errand(meaning, utterance, situation, out) ||
      question_about_robot(meaning, utterance, situation, out) ||
      question_about_world(meaning, utterance, situation, out) ||
      advice(meaning, utterance, situation, out) ||
      correction(meaning, utterance, situation, out) ||
      naming(meaning, utterance, situation, out) || reply(meaning, utterance, situation, out))
    return;
  Request question{meaning.functor, {}};
  for (const auto& [name, value] : meaning.slots)
    question.arguments.push_back(value.empty() ? open_slot(name) : text(name, value));
  if (!ask_agents(std::move(question), "", utterance, situation, out))
    refuse(utterance, "I understand " + meaning.functor + ", and do not know how to do it", out);
}

void Dialogue::add(Tasks::Outputs more, Outputs& out) {
  out.said.insert(out.said.end(), more.said.begin(), more.said.end());
  out.canceled.insert(out.canceled.end(), more.canceled.begin(), more.canceled.end());
  if (!more.canceled.empty())
    out.why = std::move(more.why);
  out.goals.insert(out.goals.end(), more.goals.begin(), more.goals.end());
  if (!more.denied.text.empty())
    out.denied = more.denied;
}

/// A sentence of several steps counts as a whole: where one is not possible, nothing is done.
void Dialogue::act_on_all(const Grammar::Understood& understood, const Utterance& utterance,
                          const Situation& situation, Outputs& out) {
  wanted_.clear();
  Rules rules;
  for (const Meaning& rule : understood.during)
    if (!add_rule(rule, utterance, situation, rules, out))
      return;
  act(understood.meanings.front(), utterance, situation, out);
  for (const Meaning& meaning : understood.then) {
    const std::size_t before = wanted_.size();
    if (before == 0)
      return;  // the reason is said
    act(meaning, utterance, situation, out);
    if (wanted_.size() == before)
      return;
  }
  for (Task& task : wanted_)
    task.rules = rules;
  for (const Task& task : wanted_)
    if (const std::string why = hindrance(task.goal, situation, out); !why.empty()) {
      wanted_.clear();
      refuse(utterance, why, out);
      return;
    }
  if (!wanted_.empty())
    wanted_.back().what += rules.text;
  if (understood.timed && situation.now > 0.0) {
    const double seconds = wanted_.front().goal.arguments.front().number;
    wanted_.erase(wanted_.begin());
    add(tasks_.later(situation.now + seconds, std::exchange(wanted_, {}), utterance), out);
  } else {
    begin(std::exchange(wanted_, {}), false, utterance, situation, out);
  }
}

Dialogue::Outputs Dialogue::granted(const v1::Grant& grant, std::uint64_t self) {
  Outputs out;
  const std::optional<v1::StopId> before = std::exchange(known_stop_, grant.stop);
  if (!grant.estopped && (!before || *before == grant.stop || grant.stop.asker == self))
    return out;
  std::erase_if(questions_, [](const Question& one) { return one.of_agents; });
  add(tasks_.stopped(grant.stop_source.empty() ? "somebody" : grant.stop_source), out);
  return out;
}

Dialogue::Outputs Dialogue::come_due(const Situation& situation) {
  return changing([&](Outputs& out) { begin_due(situation, out); });
}

void Dialogue::begin_due(const Situation& situation, Outputs& out) {
  wanted_.clear();
  const auto front = this->front(situation);
  if (pace_ && pace_->for_others && !front)
    pace_.reset();
  tasks_.heed(front);
  tell_of_waiting(situation, out);
  for (Tasks::Later& one : tasks_.take_due(situation.now)) {
    out.changed = true;
    one.order.time = situation.now;
    std::string why =
        situation.now - one.time > kLate
            ? "it is too late for that: " + time_text(one.time) + one.steps.front().what
            : std::string();
    wanted_ = one.steps;
    for (const Task& step : one.steps) {
      if (why.empty())
        why = hindrance(step.goal, situation, out);
      if (std::exchange(out.unknown, {}).person && situation.agents.contains(kPlaceFact))
        why.clear();  // the activity asks them
    }
    wanted_.clear();
    if (why.empty())
      begin(std::move(one.steps), false, one.order, situation, out);
    else
      refuse(one.order, why, out);
  }
}

void Dialogue::begin(std::vector<Task> steps, bool drops, const Utterance& utterance,
                     const Situation& situation, Outputs& out) {
  const bool goes_on = std::all_of(steps.begin(), steps.end(), [](const Task& step) {
    return step.brief && step.goal.functor != "stop";
  });
  if (pace_ && !steps.empty() && same_person(pace_->speaker, utterance.speaker) &&
      steps.front().goal.functor != "stop") {
    for (Task& step : steps) {
      step.rules.slow = true;
      step.rules.source = pace_->source;
    }
    pace_.reset();
  }
  const bool stops = !steps.empty() && steps.front().goal.functor == "stop";
  Tasks::Outputs begun = tasks_.want(std::move(steps), utterance, drops);
  if (!begun.asks.empty()) {
    Question question;
    question.drops = std::move(begun.asks);
    question.no = "good";
    ask(std::move(question), utterance);
  } else if (!goes_on) {
    std::erase_if(questions_, [&](const Question& one) {
      return !one.drops.empty() || (stops && one.of_agents);
    });
  }
  const bool dropped = !begun.canceled.empty();
  add(std::move(begun), out);
  if (dropped)
    for (const auto& [object, to] : situation.carried)
      say(utterance, "I still have " + object, false, out);
  note_begin(situation, out);
  if (!out.goals.empty() && out.goals.back().functor == "stop")
    stop_ = out.goals.back().tag;
  else if (!out.goals.empty())
    ended_.reset();
}

Dialogue::Outputs Dialogue::hear(const Utterance& utterance, const Situation& situation) {
  Outputs out = changing([&](Outputs& more) { take_in(utterance, situation, more); });
  note_words(utterance, situation.now, out);
  return out;
}

void Dialogue::note_words(const Utterance& utterance, double now, const Outputs& out) {
  constexpr std::size_t kMostSpeakers = 16;
  Words words{utterance.speaker, utterance.text, "", now};
  for (const Said& one : out.said)
    if (same_person(one.listener, utterance.speaker)) {
      words.answer += (words.answer.empty() ? "" : ". ") + one.text;
      words.refused = words.refused || one.refused;
    }
  if (words.answer.empty())
    return;  // it was to somebody else
  std::erase_if(words_,
                [&](const Words& one) { return same_person(one.speaker, utterance.speaker); });
  words_.push_back(std::move(words));
  if (words_.size() > kMostSpeakers)
    words_.erase(words_.begin());
}

void Dialogue::take_in(const Utterance& utterance, const Situation& situation, Outputs& out) {
  if (utterance.id != UtteranceId{}) {
    // Ids are public: nobody else uses up a person's next ones.
    const std::string person = utterance.person ? utterance.person->text() : std::string();
    const auto known = std::ranges::find(heard_, utterance.id);
    const auto by = heard_by_.find(utterance.id);
    if (known != heard_.end() && (by == heard_by_.end() || by->second == person))
      return;
    if (known == heard_.end())
      heard_.push_back(utterance.id);
    heard_by_[utterance.id] = person;
    if (heard_.size() > kHeard) {
      heard_by_.erase(heard_.front());
      heard_.erase(heard_.begin());
    }
    out.changed = true;
  }
  // It waited somewhere, or the clock of its machine differs. A stop counts all the same.
  const double age = utterance.time > 0.0 ? situation.now - utterance.time : 0.0;
  const auto is_stop = [](const std::vector<Meaning>& meanings) {
    return meanings.size() == 1 && meanings.front().functor == "stop";
  };
  if (situation.now > 0.0 && age > kOld && !is_stop(grammar_.understand(utterance.text).meanings)) {
    out.note = "not acted on, since it is older than a minute: " + quoted(utterance.text);
    refuse(utterance,
           "by our clocks that was said more than a minute ago: say it again, or set the clocks",
           out);
    return;
  }
  tasks_.heed(front(situation));
  unclear_ = {};
  const bool asked = !situation.asked_about.empty();
  const Question* const question = question_for(utterance);
  const bool answers = question != nullptr && question->asked;
  const bool certain = utterance.confidence >= kCertain && utterance.text.size() <= kLongestText;
  Grammar::Understood understood = grammar_.understand(utterance.text, asked || answers);
  name_things(understood.meanings);
  prefer_answer(understood, question, situation);
  const bool corrects = question != nullptr && !question->asked &&
                        (!asked || (understood.meanings.size() == 1 &&
                                    !slot(understood.meanings.front(), "meant").empty()));
  const auto as_correction = [&](const Question& of) {
    Grammar::Understood again = grammar_.understand(utterance.text, true);
    if (again.answer)
      again.meanings = {*again.answer};
    return again.meanings.size() == 1 && again.meanings.front().functor == kInstead &&
           answered(of, again, utterance, situation, out);
  };
  // "No, right" after "turn left 30 degrees" is no turn of its own.
  const std::vector<std::string> words = words_of(utterance.text);
  constexpr std::array kNo{"no", "nope", "nah"};
  const bool denies =
      std::find_first_of(words.begin(), words.end(), kNo.begin(), kNo.end()) != words.end();
  if (corrects && certain && understood.addressed &&
      (understood.meanings.empty() ||
       (denies && understood.meanings.front().functor == "to_place") ||
       understood.meanings.front().functor == question->sentence.meanings.front().functor) &&
      as_correction(*question))
    return;
  if ((answers || corrects) && certain &&
      answered(*question, understood, utterance, situation, out))
    return;
  // The task under way may be corrected after other sentences, too.
  if (certain && !answers && understood.addressed && understood.meanings.empty() && order_ &&
      tasks_.task() != nullptr && tasks_.task()->answers == order_->raised_by.id &&
      same_person(utterance.speaker, order_->raised_by.speaker) && as_correction(*order_))
    return;
  leave_out(understood, situation);
  // Another sentence of that speaker ends the robot's question. What was not understood may be said
  // once more.
  const bool heard = !understood.meanings.empty();
  if (utterance.confidence >= kSure && (heard || answers) &&
      (understood.meanings.size() != 1 || !is_yes_or_no(understood.meanings.front())))
    forget_question(utterance);
  if (utterance.text.size() > kLongestText) {
    const bool meant = understood.addressed && !understood.meanings.empty();
    std::erase_if(understood.meanings, [](const Meaning& one) { return one.functor != "stop"; });
    if (meant && understood.meanings.empty()) {
      refuse(utterance, "that is too long for me", out);
      return;
    }
  }
  // A word alone may be to somebody else.
  if (asked && understood.meanings.empty() && utterance.confidence >= kSure &&
      words_of(utterance.text).size() > 1) {
    unclear_ = utterance.id;
    out.claims.push_back({kNotUnderstood, named_person(utterance.speaker) + ": " + utterance.text,
                          claim_source(utterance)});
  }
  if (!understood.addressed && understood.meanings.empty())
    return;  // people talk to each other
  const std::string present = tasks_.going_on(utterance.speaker);
  if (!asked && denies && understood.bare.size() == 1 && understood.meanings.empty() &&
      understood.bare.front().functor == "no" && !(tasks_.empty() && present.empty()))
    understood.meanings = {{"stop", {}}};  // "no!"
  const bool stops =
      understood.meanings.size() == 1 && (understood.meanings.front().functor == "stop" ||
                                          understood.meanings.front().functor == kHold);
  // A stop too many costs less than one that was missed.
  if (understood.meanings.empty() || (utterance.confidence < kSure && !stops))
    refuse(utterance,
           present.empty() ? "what?" : "what?" + present.substr(1) + "; say stop to end it", out);
  else if (utterance.confidence < kCertain && !stops)
    ask_again(std::move(understood), utterance, out);
  else
    carry_out(std::move(understood), utterance, situation, out);
}

void Dialogue::carry_out(Grammar::Understood understood, const Utterance& utterance,
                         const Situation& situation, Outputs& out) {
  if (understood.meanings.size() > 1) {
    std::vector<Meaning> known = understood.meanings;
    std::erase_if(known, [&](const Meaning& one) { return names_unknown(one, situation); });
    if (known.size() == 1)
      understood.meanings = std::move(known);
  }
  if (understood.meanings.size() > 1) {
    choices(understood, utterance, out);
  } else if (is_fact(understood.meanings.front()) && is_question(utterance.text) &&
             !understood.polite) {
    refuse(utterance, "is that a question? Without the question mark I take it as a fact", out);
  } else if (!name_speaker(understood, utterance.speaker)) {
    refuse(utterance, "I do not know who you are: say your name in place of my or I", out);
  } else if (!understood.apart.empty()) {
    ask_for_order(std::move(understood), utterance, out);
  } else {
    act_on_all(understood, utterance, situation, out);
    if (!ask_place(understood, utterance, situation, out))
      note_name(std::move(understood), utterance, out);
  }
}

Dialogue::Outputs Dialogue::left(const ProgramId& program) {
  std::erase_if(questions_, [&](const Question& one) { return one.raised_by.program == program; });
  return changing([&](Outputs& out) {
    add(tasks_.left(program), out);
    out.changed = !out.canceled.empty();
  });
}

void Dialogue::end(const Outcome& outcome, Outputs& out) {
  const Task* const task = tasks_.find(outcome.tag);
  if (task != nullptr && (outcome.tag != stop_ || !ended_ || ended_->success))
    ended_ = Ended{named_task(*task, ""), outcome.success, outcome.reason};
  out.changed = out.changed || task != nullptr;
  add(tasks_.ended(outcome), out);
}

Dialogue::Outputs Dialogue::ended(const Outcome& outcome) {
  return changing([&](Outputs& out) { end(outcome, out); });
}

Dialogue::Outputs Dialogue::without_status(const std::vector<std::uint64_t>& tags, double seconds) {
  std::vector<std::uint64_t> late;
  const std::map<std::uint64_t, double> before = std::exchange(without_status_, {});
  for (const std::uint64_t tag : tags) {
    const auto known = before.find(tag);
    const double since = known == before.end() ? seconds : known->second;
    if (seconds - since < kTakenUp) {
      without_status_[tag] = since;
      continue;
    }
    late.push_back(tag);
  }
  if (late.empty())
    return {};
  return changing([&](Outputs& out) {
    for (const std::uint64_t tag : late) {
      out.canceled.push_back(tag);
      out.why = kNotTakenUp;
      end({tag, false, kNotTakenUp}, out);
    }
  });
}

Dialogue::Outputs Dialogue::says(const std::string& text, const CycleRef& when) {
  Outputs out;
  if (tasks_.empty())
    return out;
  if (when.first == before_.first && when.second <= before_.second)
    return out;
  said_ = when;
  out.changed = true;
  // The activity speaks first of a reply that was no answer.
  const UtteranceId unclear = std::exchange(unclear_, {});
  const bool back = unclear != UtteranceId{};
  out.said.push_back({back ? unclear : tasks_.spoken_for(), {}, text, back, back});
  return out;
}

void Dialogue::archive(Archive& a) {
  a("knowledge", knowledge_)("heard", heard_)("gone", gone_)("said", said_)("tasks", tasks_);
  a("began", began_)("pace", pace_);
  if (a.restores())
    before_ = said_;
}

}  // namespace saphira::agent_interface

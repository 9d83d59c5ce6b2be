// The part of the dialogue for people's questions: about the robot, its reasons, and its knowledge.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::size_t kFewFacts = 3;

std::string state_in_words(v1::GoalState state) {
  return word_of(state, {"is waiting", "failed", "is underway", "is suspended", "is over", "failed",
                         "is over"});
}

/// The goal that is the reason why the robot stands or drives: the newest one that is held up,
/// otherwise the newest one that is underway, otherwise the newest one that has ended. A stop after
/// a failure is not the reason.
const KnownGoal* reason_of(const std::vector<KnownGoal>& goals) {
  const auto rank = [](const KnownGoal& goal) {
    return ended(goal.state) ? 0 : goal.state == v1::GOAL_UNDERWAY ? 1 : 2;
  };
  const KnownGoal* best = nullptr;
  const KnownGoal* before_stop = nullptr;
  for (const KnownGoal& goal : goals) {
    if (best == nullptr || rank(goal) >= rank(*best))
      best = &goal;
    if (ended(goal.state) && goal.functor != "stop")
      before_stop = &goal;
  }
  const bool stopped = best != nullptr && best->functor == "stop" && rank(*best) < 2;
  const bool failed = before_stop != nullptr && (before_stop->state == v1::GOAL_FAILED ||
                                                 before_stop->state == v1::GOAL_REFUSED);
  return stopped && failed ? before_stop : best;
}

/// The step of a goal, such as "through-door: passes a door", as a sentence.
std::string step_in_words(const std::string& step) {
  const std::size_t colon = step.find(": ");
  if (colon == std::string::npos || step.find(' ') < colon)
    return step;
  return "the robot " + step.substr(colon + 2);
}

/// The state of a goal with the best explanation that is known of it.
std::string state_of(const KnownGoal& goal) {
  const std::string detail = !goal.reason.empty() ? goal.reason
                             : !goal.note.empty() ? goal.note
                                                  : step_in_words(goal.step);
  return state_in_words(goal.state) + (detail.empty() ? "" : ": " + detail);
}

/// The order in which goals are done.
bool goes_before(const KnownGoal& a, const KnownGoal& b) {
  const auto rank = [](const KnownGoal& goal) {
    return std::tuple(goal.state != v1::GOAL_UNDERWAY, !goal.queued, -goal.priority, -goal.elapsed);
  };
  return rank(a) < rank(b);
}

const KnownGoal* of_tag(const std::vector<KnownGoal>& goals, std::uint64_t tag) {
  const auto found = std::ranges::find(goals, tag, &KnownGoal::tag);
  return found == goals.end() ? nullptr : &*found;
}

/// The goal of a task. Before it has a status, it goes behind all others of its priority.
KnownGoal goal_of(const Task& task, const std::vector<KnownGoal>& goals) {
  const KnownGoal* const known = of_tag(goals, task.goal.tag);
  KnownGoal goal = known != nullptr ? *known : KnownGoal{};
  if (known == nullptr) {
    goal.state = task.waits ? v1::GOAL_WAITING : v1::GOAL_UNDERWAY;
    goal.elapsed = -1.0;
  }
  goal.priority = task.goal.priority;
  return goal;
}

}  // namespace

std::string Dialogue::named_goal(const KnownGoal& goal, Grammar::Form form) const {
  constexpr std::array<std::pair<std::string_view, const char*>, 7> kOrders{
      {{"go-to-place", "go_to"},
       {"deliver", "deliver"},
       {"tell", "tell"},
       {"guide", "guide"},
       {"find-person", "find"},
       {"patrol", "patrol"},
       {"explore", "explore"}}};
  std::string words;
  for (const auto& [functor, order] : kOrders)
    if (goal.functor == functor) {
      Meaning meaning{order, {{"owner", ""}}};
      for (const Argument& one : goal.arguments)
        meaning.slots[one.name == "name" ? "person" : one.name] =
            one.text.starts_with("the ") ? one.text.substr(4) : one.text;
      words = grammar_.paraphrase(meaning, form);
    }
  // An argument that the words have a place for may be unknown.
  if (words.empty() || words.find('$') != std::string::npos) {
    const std::string arguments = describe(goal.arguments);
    words = goal.functor + (arguments.empty() ? "" : " " + arguments);
  }
  return words;
}

std::optional<Tasks::Front> Dialogue::front(const Situation& situation) const {
  const KnownGoal* first = nullptr;
  for (const KnownGoal& goal : situation.goals)
    if (!v1::ended(goal.state) && !goal.asker.empty() && goal.queued && goal.functor != "look" &&
        goal.functor != "stop" && (first == nullptr || goes_before(goal, *first)))
      first = &goal;
  if (first == nullptr)
    return std::nullopt;
  const Task* task = tasks_.task();
  for (const Task& one : tasks_.open())
    if (task == nullptr && one.goal.functor != "stop")
      task = &one;
  return Tasks::Front{named_goal(*first, Grammar::Form::task) + " for " + first->asker,
                      first->priority,
                      task == nullptr || goes_before(*first, goal_of(*task, situation.goals))};
}

std::string Dialogue::doing(const Situation& situation) const {
  std::vector<std::pair<KnownGoal, std::string>> all;
  const std::vector<Task>& open = tasks_.open();
  for (auto one = open.rbegin(); one != open.rend(); ++one)
    all.emplace_back(goal_of(*one, situation.goals), whole_text(*one));
  for (const KnownGoal& goal : situation.goals)
    if (!v1::ended(goal.state) && !goal.asker.empty())
      all.emplace_back(
          goal,
          "for " + goal.asker + ": " + named_goal(goal, Grammar::Form::announced) +
              (goal.state == v1::GOAL_UNDERWAY ? "" : ", which " + state_in_words(goal.state)));
  std::ranges::stable_sort(
      all, [](const auto& a, const auto& b) { return goes_before(a.first, b.first); });
  std::string text;
  bool others = false;  // before it
  for (const auto& [goal, words] : all) {
    const bool own = goal.asker.empty();
    const bool waits = own && goal.state != v1::GOAL_UNDERWAY;
    text += (text.empty() ? "" : "; ") +
            std::string(waits && goal.queued && others ? "after that, " : "") + words +
            (waits && !goal.queued ? ", which " + state_of(goal) : "");
    others = others || !own;
  }
  if (const std::string later = tasks_.doing_later(); !later.empty())
    text += (text.empty() ? "" : "; ") + later;
  return text.empty() ? "nothing that I was told" : text;
}

/// A task for which another program or person has to be waited was announced as if it began.
void Dialogue::tell_of_waiting(const Situation& situation, Outputs& out) {
  constexpr double kSoon = 0.5;  // [s] after which a goal begins that need not wait
  for (const KnownGoal& goal : situation.goals) {
    const Task* const task = tasks_.find(goal.tag);
    if (task == nullptr || goal.state != v1::GOAL_WAITING || goal.elapsed < kSoon ||
        !tasks_.note_waiting(goal.tag))
      continue;
    const auto front = this->front(situation);
    const std::string name = named_task(*task, task->goal.speaker);
    out.said.push_back(
        {task->answers, task->goal.speaker,
         name + (goal.queued && front ? " waits for " + front->name : " " + state_of(goal)),
         false});
  }
}

std::string Dialogue::why(const Situation& situation, const std::string& speaker) const {
  const Words* const newest = words_of_speaker(speaker);
  constexpr double kLately = 60.0;  // [s]
  if (newest != nullptr && newest->refused && situation.now - newest->time < kLately &&
      !newest->answer.starts_with("what?"))
    return newest->answer;  // the reason for which that was not done
  const KnownGoal* const goal = reason_of(situation.goals);
  if (ended_ && (goal == nullptr || (v1::ended(goal->state) && goal->asker.empty()) ||
                 (goal->tag == stop_ && stop_ != 0 && !ended_->success)))
    return ended_->task + (ended_->success ? " is done: " : " failed: ") + ended_->reason;
  if (goal == nullptr)
    return "I have nothing to do";
  const Task* const own = tasks_.find(goal->tag);
  return (own != nullptr ? named_task(*own, "")
                         : named_goal(*goal, Grammar::Form::task) +
                               (goal->asker.empty() ? "" : " for " + goal->asker)) +
         " " + state_of(*goal);
}

std::string Dialogue::time_left(const Situation& situation) const {
  constexpr double kCruise = 0.3;  // [m/s] of go-to-place, at most
  constexpr double kGuided = 0.2;  // [m/s]
  constexpr double kSlow = 0.15;   // [m/s]
  std::string place;
  double pace = kCruise;
  for (const KnownGoal& goal : situation.goals) {
    if (goal.state != v1::GOAL_UNDERWAY ||
        (goal.functor != "go-to-place" && goal.functor != "guide"))
      continue;
    const Task* const own = tasks_.find(goal.tag);
    const Arguments& arguments = own != nullptr ? own->goal.arguments : goal.arguments;
    const Argument* const to = find(arguments, "place");
    const Argument* const speed = find(arguments, "speed");
    place = to != nullptr ? to->text : "";
    pace = speed != nullptr ? speed->number : goal.functor == "guide" ? kGuided : kCruise;
  }
  if (place.empty())
    return "I do not know: I am on no way to a place";
  if (!situation.pose_in_map)
    return kLost;
  const maps::RouteResult way = allowed_way(place, situation);
  if (!way.route || !(pace > 0.0))
    return "I do not know: " + (way.reason.empty() ? "I see no way" : way.reason);
  pace = situation.is_slow ? std::min(pace, kSlow) : pace;
  const double seconds = way.route->length / pace;
  constexpr double kMinute = 60.0;
  return place + " is " + saphira::plain(std::round(way.route->length)) +
         " m from here: at least " +
         (seconds < 2.0 * kMinute ? saphira::plain(std::round(seconds)) + " s"
                                  : saphira::plain(std::floor(seconds / kMinute)) + " minutes");
}

const Dialogue::Words* Dialogue::words_of_speaker(const std::string& name) const {
  const auto found = std::ranges::find_if(
      words_, [&](const Words& one) { return same_person(one.speaker, name); });
  return found == words_.end() ? nullptr : &*found;
}

std::string Dialogue::sources(const Meaning& meaning, const Utterance& utterance,
                              const Situation& situation) const {
  const std::string about = slot(meaning, "about");
  const Words* const newest = words_of_speaker(utterance.speaker);
  const auto is_meant = [&](const Advice& one) {
    if (!about.empty())
      return one.about == about || one.about == "the " + about || one.value == about;
    return newest != nullptr && (newest->answer.find(describe(one)) != std::string::npos ||
                                 newest->answer.find(as_told(one)) != std::string::npos);
  };
  const std::string value = slot(meaning, "place");
  bool told = value.empty();
  std::string all;
  for (const Advice& one : knowledge_.all())
    if (is_meant(one)) {
      all += (all.empty() ? "" : "; ") + source_of(one);
      told = told || one.about == "the " + value || one.value == place(value, situation);
    }
  if (!told && !all.empty())
    all = "that I do not know; " + all;
  return !all.empty()    ? all
         : about.empty() ? "tell me which fact: ask who told you about, and a name"
                         : "nobody has told me anything about " + about;
}

bool Dialogue::question_about_robot(const Meaning& meaning, const Utterance& utterance,
                                    const Situation& situation, Outputs& out) const {
  const std::string& functor = meaning.functor;
  const std::string place = here(situation);
  if (functor == "where_are_you") {
    say(utterance,
        !situation.pose_in_map ? kLost
        : place.empty()        ? "I am at a place without a name"
                               : "I am in " + place,
        true, out);
  } else if (functor == "are_you_lost") {
    say(utterance,
        !situation.pose_in_map ? std::string("yes: ") + kLost
        : place.empty()        ? "no, but this place has no name"
                               : "no: I am in " + place,
        true, out);
  } else if (functor == "you_are_in") {
    std::uint32_t artifact = 0;
    std::string wrong;
    const std::string at = referred(meaning, situation, out, artifact, wrong);
    if (!at.empty() && at == place)
      say(utterance, "I know: I am in " + at, true, out);
    else
      refuse(utterance,
             at.empty() ? wrong
                        : (place.empty() ? "" : "I think that I am in " + place + ". ") +
                              "To put me in " + at +
                              " I need the exact place: saphira map place X Y HEADING, or saphira "
                              "map find",
             out);
  } else if (functor == "what_are_you_doing") {
    say(utterance, doing(situation), true, out);
  } else if (functor == "why") {
    say(utterance, why(situation, utterance.speaker), true, out);
  } else if (functor == "what_can_you_do" || functor == "talk") {
    const auto seconds = static_cast<std::int64_t>(utterance.time);
    const std::string time = seconds > 0 ? local_text(seconds, "%H:%M") : "unknown to me";
    const bool clock = slot(meaning, "what") == "clock";
    say(utterance, grammar_.paraphrase(clock ? with(meaning, "time", time) : meaning), true, out);
  } else if (functor == "how_long") {
    say(utterance, time_left(situation), true, out);
  } else if (functor == "told_by") {
    say(utterance, sources(meaning, utterance, situation), true, out);
  } else if (functor == "what_said") {
    const std::string who = slot(meaning, "who");
    const bool own = who == "me" || who == "robot";
    const Words* const words = words_of_speaker(own ? utterance.speaker : who);
    say(utterance,
        words == nullptr ? (own ? "that was your first sentence to me since I began"
                                : "I remember no sentence of " + who + " to me")
        : who == "robot" ? "I said: " + words->answer
                         : (own ? "you" : words->speaker) + " said: " + quoted(words->said),
        true, out);
  } else if (functor == "what_do_you_carry") {
    std::string all;
    for (const auto& [object, to] : situation.carried)
      all += (all.empty() ? "I have " : ", and ") + object + ": I was to bring it to " + to;
    say(utterance, all.empty() ? "I carry nothing" : all, true, out);
  } else {
    return false;
  }
  return true;
}

/// The owner of an office; with a person in the question, yes or no before it.
void Dialogue::owner_of(const Meaning& meaning, const Utterance& utterance,
                        const Situation& situation, Outputs& out) const {
  const std::string person = slot(meaning, "person");
  Meaning place = meaning;
  place.functor = "office_of";
  Outputs unnamed;  // a nameless doorway stays so
  std::uint32_t artifact = 0;
  std::string wrong;
  std::string at = referred(place, situation, unnamed, artifact, wrong);
  if (at.empty()) {
    out.unknown = unnamed.unknown;
    refuse(utterance, wrong, out);
    return;
  }
  const bool nameless = !unnamed.namings.empty();
  std::string owners;
  bool same = false;
  for (const Advice& one : knowledge_.all())
    if (one.kind == Advice::Kind::office_of && one.value == at && !nameless) {
      owners += (owners.empty() ? "" : "; ") + as_told(one);
      same = same || one.about == person;
    }
  const Advice* const own = knowledge_.find(Advice::Kind::office_of, person);
  if (person.empty() || (owners.empty() && own == nullptr))
    say(utterance,
        !owners.empty() ? owners
        : nameless      ? "this office has no name on my map, and nobody has told me whose it is"
                        : "nobody has told me whose office " + at + " is",
        true, out);
  else
    say(utterance,
        same             ? "yes: " + as_told(*own)
        : own != nullptr ? "no: " + as_told(*own)
                         : "not that I know: " + owners,
        true, out);
}

bool Dialogue::ask_agents(Request request, const std::string& unknown, const Utterance& utterance,
                          const Situation& situation, Outputs& out) const {
  const auto agents = situation.agents.find(request.functor);
  if (agents == situation.agents.end())
    return false;
  say(utterance,
      unknown + (unknown.empty() ? "" : "; ") + "I ask " + agents->second + ", for " +
          saphira::plain(kAgentsPatience) + " s at most",
      false, out);
  request.deadline = kAgentsPatience;
  out.asks.push_back({utterance, std::move(request)});
  return true;
}

bool Dialogue::ask_place(const Grammar::Understood& understood, const Utterance& utterance,
                         const Situation& situation, Outputs& out) {
  const std::string person = out.unknown.name;
  Outputs asking;
  if (!out.unknown.person ||
      !ask_agents({kPlaceFact, {text("person", person), open_slot("place")}},
                  "nobody has told me where " + person + " is", utterance, situation, asking))
    return false;
  out.said.pop_back();  // the refusal
  out.said.push_back(asking.said.back());
  out.asks = std::move(asking.asks);
  Question question;
  question.sentence = understood;
  question.names = {person};
  question.no = kLeft;
  question.of_agents = true;
  ask(std::move(question), utterance);
  return true;
}

Dialogue::Outputs Dialogue::answered_by(const OpenQuestion& question, const std::string& agent,
                                        const Answer& answer, Situation situation) {
  const Utterance& asked = question.asked;
  const bool of_place = question.request.functor == kPlaceFact;
  bool known = answer.code == AnswerCode::done && !answer.results.empty();
  std::string text = known ? agent + " says: " : "no agent knows it";
  for (const Argument& one : known ? answer.results : Arguments{}) {
    const bool is_place = of_place && one.name == "place";
    text += (text.ends_with(": ") ? "" : ", ") +
            (is_place ? question.request.arguments.front().text + " is at " + one.text
                      : describe(Arguments{one}));
    if (is_place && !situation.map.features.empty() &&
        place(lowered(one.text), situation).empty()) {
      known = false;
      text = agent + " names " + quoted(one.text) + ", which is no place of my map";
    }
  }
  if (!answer.text.empty())
    text += (known ? "; " : ": ") + answer.text;
  const auto waits = std::ranges::find_if(questions_, [&](const Question& one) {
    return one.of_agents && one.raised_by.id == asked.id;
  });
  return changing([&](Outputs& out) {
    if (waits == questions_.end()) {
      known ? say(asked, text, true, out) : refuse(asked, text, out);
      return;
    }
    Grammar::Understood sentence = std::move(waits->sentence);
    questions_.erase(waits);
    situation.agents.clear();
    if (known)
      situation.findable.push_back(question.request.arguments.front().text);
    say(asked, text, false, out);
    carry_out(std::move(sentence), asked, situation, out);
  });
}

bool Dialogue::question_about_world(const Meaning& meaning, const Utterance& utterance,
                                    const Situation& situation, Outputs& out) const {
  const std::string& functor = meaning.functor;
  const std::vector<Advice>& known = knowledge_.all();
  if (functor == "where_is" || functor == "who_has") {
    const bool holder = functor == "who_has";
    const std::string person = slot(meaning, holder ? "object" : "person");
    const std::string owner = place(person, situation).empty() ? owner_in(person) : std::string();
    if (!owner.empty())
      return question_about_world(with({"where_office", {}}, "person", owner), utterance, situation,
                                  out);
    const std::string item = thing(person, situation);
    std::string all;
    for (const auto& [object, to] : situation.carried)
      if (object == item)
        all = "I have it: I was to bring it to " + to;
    if (all.empty())
      all = told_of(person);
    if (all.empty())
      all = told_of(item);
    if (all.empty())
      all = way_to(place(person, situation), situation);
    for (const maps::Feature& thing : situation.map.features)
      if (all.empty() && lowered(thing.name) == person)
        all = way_to(thing.name, situation);
    const std::string unknown =
        "nobody has told me " + (holder ? "who has the " + person : "where " + person + " is");
    Request request{kPlaceFact, {text("person", person), open_slot("place")}};
    if (all.empty() && !holder &&
        ask_agents(std::move(request), unknown, utterance, situation, out))
      return true;
    say(utterance, all.empty() ? unknown : all, true, out);
  } else if (functor == "where_office") {
    const std::string person = slot(meaning, "person");
    const Advice* const office = knowledge_.find(Advice::Kind::office_of, person);
    std::vector<std::string> people;
    for (const Advice& one : knowledge_.all())
      if (one.kind == Advice::Kind::office_of)
        people.push_back(one.about);
    say(utterance,
        office == nullptr
            ? "nobody has told me where " + person + "'s office is" + did_you_mean(person, people)
            : as_told(*office),
        true, out);
  } else if (functor == "whose_office" || functor == "is_office_of") {
    owner_of(meaning, utterance, situation, out);
  } else if (functor == "nearest") {
    const maps::Feature* const nearest =
        situation.pose_in_map
            ? nearest_door(situation.map, situation.pose_in_map->position(),
                           std::numeric_limits<double>::infinity(),
                           [](const maps::Feature& door) { return !door.name.empty(); })
            : nullptr;
    say(utterance,
        !situation.pose_in_map ? kLost
        : nearest == nullptr   ? "I know no door with a name"
                               : "the nearest door with a name is that of " + nearest->name +
                                   ": say go to " + nearest->name,
        true, out);
  } else if (functor == "what_do_you_know") {
    constexpr std::array kKinds{
        std::tuple{Advice::Kind::office_of, "office", "offices"},
        std::tuple{Advice::Kind::person_at, "place of a person", "places of people"},
        std::tuple{Advice::Kind::knows_where, "person who knows where others are",
                   "people who know where others are"},
        std::tuple{Advice::Kind::hazard, "hazard or rule for places",
                   "hazards and rules for places"}};
    std::string counts;
    for (const auto& [kind, one, many] : kKinds) {
      const auto count = std::ranges::count(known, kind, &Advice::kind);
      if (count > 0)
        counts +=
            (counts.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
    }
    std::string newest;
    for (std::size_t i = 0; i < std::min(known.size(), kFewFacts); ++i)
      newest += "; " + as_told(known[known.size() - 1 - i]);
    say(utterance,
        (known.empty() ? "nobody has told me anything" : "I know " + counts + newest) +
            (situation.is_slow ? "; I go slowly" : ""),
        true, out);
  } else if (functor == "is_there" || functor == "who_is_in") {
    const bool people = functor == "who_is_in";
    std::string at;
    if (!slot(meaning, "place").empty() || !slot(meaning, "owner").empty()) {
      at = place_or_refusal(meaning, utterance, situation, out);
      if (at.empty())
        return true;
    }
    std::string all;
    for (const Advice& one : known)
      if ((people ? one.kind == Advice::Kind::person_at ||
                        (one.kind == Advice::Kind::office_of &&
                         knowledge_.place_of(one.about) == one.value)
                  : one.kind == Advice::Kind::hazard && !maps::zone_rule(one.about) &&
                        (slot(meaning, "kind") == kDanger ||
                         one.about.ends_with(slot(meaning, "kind")))) &&
          (at.empty() || one.value == at) && !(people && one.about.starts_with("the ")))
        all += (all.empty() ? "" : "; ") + as_told(one);
    if (all.empty())
      all = people ? "nobody has told me who is in " + at
                   : "nobody has told me of a " + slot(meaning, "kind") +
                         (at.empty() ? "" : " at " + at);
    say(utterance, all, true, out);
  } else {
    return false;
  }
  return true;
}

}  // namespace saphira::agent_interface

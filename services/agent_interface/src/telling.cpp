// The part of the dialogue for what people tell the robot and take back, and the claims that
// follow.
#include <algorithm>
#include <cmath>
#include <utility>

#include "saphira/base/cycle.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/maps/artifact_traits.hpp"
#include "saphira/maps/zones.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr std::size_t kMostGone = 256;
// Beliefs of config/activities/people.act: the claim that the robot waits for, and the person whose
// place it asks; the place where it has found somebody.
constexpr const char* kQuestion = "asking-about";
constexpr const char* kPerson = "asking-for";
constexpr std::string_view kPlaceOf = "place-of-";
constexpr std::string_view kKnowers = "knows-where-";
constexpr std::string_view kCarries = "carries-";
constexpr const char* kFinder = "find-person";
constexpr double kFresh = 1.0;  // [s] age of a find that was not heard before

/// A text in the language of activities: "karen's office".
std::string literal(const std::string& text) {
  std::string result = "\"";
  for (const char c : text)
    result += c == '"' || c == '\\' ? ' ' : c;
  return result + "\"";
}

/// The text of a belief; empty: nil.
std::string text_of(const std::string& value) {
  return value == "nil"                             ? std::string()
         : value.size() > 1 && value.front() == '"' ? value.substr(1, value.size() - 2)
                                                    : value;
}

}  // namespace

std::string literal(const Claimed& claim) {
  if (claim.nil)
    return "nil";
  if (claim.list.empty())
    return literal(claim.value);
  std::string result = "(";
  for (const std::string& one : claim.list)
    result += (result.size() == 1 ? "" : " ") + literal(one);
  return result + ")";
}

Request put_on_map(const maps::Feature& feature) {
  return {"put",
          {number("id", feature.id), text("type", std::string(maps::traits(feature.type).word)),
           point("position", feature.pose_in_map, Frame::map), number("length", feature.length),
           number("width", feature.width), text("name", feature.name),
           truth("learned", feature.learned)}};
}

std::vector<Find> heed(const v1::BeliefSet& set, double age, Situation& situation) {
  situation.asked_about.clear();
  situation.asked_for.clear();
  situation.findable.clear();
  situation.carried.clear();
  situation.is_slow = false;
  std::vector<Find> finds;
  for (const v1::Belief& belief : set.beliefs) {
    const std::string value = text_of(belief.value);
    std::optional<double> changed;
    if (belief.since > 0)
      changed = age + seconds_of(set.stamp.cycle) - seconds_of(belief.since);
    if (belief.name == kQuestion)
      situation.asked_about = value;
    else if (belief.name == kPerson)
      situation.asked_for = value;
    else if (belief.name == kPace)
      situation.is_slow = value == "slow";
    else if (belief.name.starts_with(kCarries) && !value.empty()) {
      situation.carried.emplace_back(belief.name.substr(kCarries.size()), value);
      finds.push_back({Advice::Kind::has, situation.carried.back().first, kRobot, changed});
    }
    for (const std::string_view about : {kPlaceOf, kKnowers})
      if (belief.name.starts_with(about) && !value.empty())
        situation.findable.push_back(lowered(belief.name.substr(about.size())));
    if (belief.said_by == kFinder && belief.name.starts_with(kPlaceOf) && !value.empty())
      finds.push_back(
          {Advice::Kind::person_at, lowered(belief.name.substr(kPlaceOf.size())), value, changed});
  }
  return finds;
}

void heed(const v1::Grant& grant, Situation& situation) {
  situation.estop = !grant.estopped              ? ""
                    : grant.estop_source.empty() ? "a program without a name"
                                                 : grant.estop_source;
  situation.is_driven = grant.role == v1::ROLE_TELEOP || grant.role == v1::ROLE_DIRECT;
}

/// First where a person is, then who knows it.
std::string Dialogue::told_of(const std::string& about) const {
  std::string text;
  for (const Advice::Kind kind :
       {Advice::Kind::person_at, Advice::Kind::office_of, Advice::Kind::hazard,
        Advice::Kind::knows_where, Advice::Kind::has})
    for (const Advice& one : knowledge_.all())
      if (one.kind == kind && one.about == about)
        text += (text.empty() ? "" : "; ") + as_told(one);
  return text;
}

void Dialogue::take(const Advice& advice, const Utterance& utterance, const Situation& situation,
                    Outputs& out) {
  const Advice* const known = knowledge_.find(advice.kind, advice.about, advice.value);
  if (known != nullptr && known->value == advice.value) {
    say(utterance, "I know: " + describe(advice), true, out);
    return;
  }
  // A person's place changes all the time; the owner of an office does not.
  if (known != nullptr && advice.kind == Advice::Kind::office_of) {
    refuse(utterance,
           named_person(known->speaker) + " told me that " + describe(*known) + ". Is it now " +
               advice.value + "?",
           out);
    Question question;
    question.fact = advice;
    question.no = "then I leave it as it is";
    ask(std::move(question), utterance);
    return;
  }
  // Only the taker, or an answer to the robot's question, takes a load off without a question back.
  const bool aboard = advice.kind == Advice::Kind::has && is_aboard(advice.about, situation);
  if (aboard && !same_person(advice.value, utterance.speaker) && advice.value != named_person("") &&
      situation.asked_about != "taken") {
    refuse(utterance, "I carry " + advice.about + ": has " + advice.value + " taken it off?", out);
    Question question;
    question.fact = advice;
    question.no = "then I go on carrying it";
    ask(std::move(question), utterance);
    return;
  }
  // The activity that drives replans at once; the answer says so.
  const Task* const task = tasks_.task();
  std::string goal;
  if (advice.kind == Advice::Kind::hazard && task != nullptr)
    for (const Argument& one : task->goal.arguments)
      if (one.name == "place")
        goal = one.text;
  const maps::RouteResult before = allowed_way(goal, situation);
  learn(advice, out);
  const maps::RouteResult now = allowed_way(goal, situation);
  std::string change;
  if (before.route && !now.route)
    change = "; so " + named_task(*task, utterance.speaker) + " ends";
  else if (before.around != now.around)
    change = "; so I look for another way";
  if (aboard)
    change = "; so I no longer carry it";
  say(utterance, "I know now that " + describe(advice) + change, true, out);
}

void Dialogue::end_hazards(const Advice& ended, bool here, const Utterance& utterance,
                           Outputs& out) {
  using maps::ZoneRule;
  const auto rule = maps::zone_rule(ended.about);
  const bool all = ended.about == kDanger;
  // A leak may have been told as a water leak.
  const auto is_meant = [&](const Advice& one) {
    const auto its_rule = maps::zone_rule(one.about);
    return one.kind == Advice::Kind::hazard &&
           (rule || its_rule ? one.about == ended.about || (all && its_rule == ZoneRule::slow)
                             : all || one.about.ends_with(ended.about));
  };
  std::vector<Advice> over;
  for (const Advice& one : knowledge_.all())
    if (is_meant(one) && one.value == ended.value)
      over.push_back(one);
  if (const auto elsewhere =
          std::find_if(knowledge_.all().begin(), knowledge_.all().end(), is_meant);
      over.empty() && here && !rule && !all && elsewhere != knowledge_.all().end())
    over.push_back(*elsewhere);
  std::string text;
  for (const Advice& one : over) {
    const auto its_rule = maps::zone_rule(one.about);
    text +=
        (text.empty() ? "good: " : ", and ") +
        (its_rule == ZoneRule::keep_out    ? "I may go to " + one.value + " again"
         : its_rule == ZoneRule::slow      ? "I may go fast in " + one.value + " again"
         : its_rule == ZoneRule::preferred ? "I need not prefer " + one.value + " any more"
                                           : "no " + one.about + " at " + one.value + " any more");
    withdraw(one.number, out);
  }
  if (text.empty())
    text = rule == ZoneRule::keep_out ? "nobody told me to keep out of " + ended.value
           : rule                     ? "I did not know that " + describe(ended)
                  : "I knew of no " + (ended.about == "floor" ? "wet floor" : ended.about) +
                        " at " + ended.value;
  for (const Advice& one : knowledge_.all())
    if (all && one.kind == Advice::Kind::hazard && one.value == ended.value &&
        maps::zone_rule(one.about) == ZoneRule::keep_out)
      text += "; " + as_told(one);
  say(utterance, text, true, out);
}

bool Dialogue::advice(const Meaning& meaning, const Utterance& utterance,
                      const Situation& situation, Outputs& out) {
  Advice advice;
  advice.speaker = utterance.speaker;
  advice.said = utterance.text;
  advice.time = utterance.time;
  advice.about = slot(meaning, "person");
  std::string wrong;
  if (meaning.functor == "knows_where") {
    advice.kind = Advice::Kind::knows_where;
    advice.value = slot(meaning, "other");
    if (advice.value == advice.about)
      wrong = advice.about + " knows that, but I would have to find " + advice.about + " first";
  } else if (meaning.functor == "office_of" || meaning.functor == "person_at" ||
             meaning.functor == "hazard" || meaning.functor == "no_hazard") {
    advice.kind = meaning.functor == "office_of"   ? Advice::Kind::office_of
                  : meaning.functor == "person_at" ? Advice::Kind::person_at
                                                   : Advice::Kind::hazard;
    if (advice.kind == Advice::Kind::hazard)
      advice.about = slot(meaning, "kind");
    advice.value = referred(meaning, situation, out, advice.artifact, wrong);
  } else if (meaning.functor == "has") {
    advice.kind = Advice::Kind::has;
    advice.about = thing(slot(meaning, "object"), situation);
    advice.value = slot(meaning, "person");
    if (advice.about.empty())
      wrong = kWhichThing;
    else if (advice.value == named_person("") && !is_aboard(advice.about, situation))
      wrong = "I do not carry " + advice.about;
    else if (meaning.slots.contains("off"))
      say(utterance, "I have no arm: please take " + advice.about + " off", false, out);
  } else {
    return false;
  }
  if (advice.kind == Advice::Kind::hazard && meaning.functor == "no_hazard" && wrong.empty()) {
    end_hazards(advice, slot(meaning, "place") == "this", utterance, out);
    return true;
  }
  if (!wrong.empty()) {
    refuse(utterance, wrong, out);
  } else {
    if (const std::string day = slot(meaning, "day"); !day.empty())
      say(utterance, "I keep that until you take it back, not only " + day, false, out);
    take(advice, utterance, situation, out);
    answer_with(advice, utterance, situation, out);
  }
  return true;
}

/// The robot asks for a person, and somebody tells it about that person after the keyword: this
/// also answers the question.
void Dialogue::answer_with(const Advice& advice, const Utterance& utterance,
                           const Situation& situation, Outputs& out) const {
  if (situation.asked_about.empty() || lowered(situation.asked_for) != advice.about)
    return;
  const bool holder = advice.kind == Advice::Kind::has &&
                      (situation.asked_about == "taken" ||
                       (situation.asked_about == "who-has" && findable(advice.value, situation)));
  if (advice.kind == Advice::Kind::person_at || holder ||
      (advice.kind == Advice::Kind::knows_where && knowledge_.findable(advice.value)))
    out.claims.push_back({situation.asked_about, advice.value, claim_source(utterance)});
}

/// People say that a fact about a person is wrong.
bool Dialogue::correction(const Meaning& meaning, const Utterance& utterance,
                          const Situation& situation, Outputs& out) {
  using Kind = Advice::Kind;
  std::string person = slot(meaning, "person");
  std::vector<Advice> wrong;
  std::string unknown;
  const auto doubt = [&](Kind kind, const std::string& value) {
    Advice meant;
    meant.kind = kind;
    meant.about = person;
    meant.value = value;
    const Advice* const known = knowledge_.find(kind, person, value);
    if (known != nullptr && known->value == value)
      wrong.push_back(*known);
    else
      unknown = "I did not believe that " + describe(meant);
  };
  if (meaning.functor == "not_at" || meaning.functor == "not_office_of") {
    const bool office = meaning.functor == "not_office_of";
    Meaning where = meaning;
    where.functor = office ? "office_of" : meaning.functor;
    Outputs unnamed;  // a nameless doorway stays so
    std::uint32_t artifact = 0;
    std::string no_place;
    const std::string place = referred(where, situation, unnamed, artifact, no_place);
    if (!no_place.empty()) {
      out.unknown = unnamed.unknown;
      refuse(utterance, no_place, out);
      return true;
    }
    doubt(office ? Kind::office_of : Kind::person_at, place);
  } else if (meaning.functor == "not_has") {
    const std::string holder = std::exchange(person, thing(slot(meaning, "object"), situation));
    doubt(Kind::has, holder);
  } else if (meaning.functor == "not_knows") {
    doubt(Kind::knows_where, slot(meaning, "other"));
  } else if (meaning.functor == "forget") {
    const std::string what = slot(meaning, "what");
    const std::string there = what == "mine" ? place(person, situation) : std::string();
    for (const Advice& one : knowledge_.all())
      if (!there.empty() && one.value == there && same_person(one.speaker, utterance.speaker))
        wrong.push_back(one);
      else if (one.about == person &&
               (what == "all" ? one.kind != Kind::hazard
                : what == "mine"
                    ? one.kind != Kind::hazard && same_person(one.speaker, utterance.speaker)
                : what == "office" ? one.kind == Kind::office_of
                                   : one.kind == Kind::person_at))
        wrong.push_back(one);
    if (wrong.empty())
      unknown = what == "mine" ? "you have told me nothing about " + person
                               : "nobody has told me " + (what == "all" ? "anything about " + person
                                                          : what == "office"
                                                              ? "where " + person + "'s office is"
                                                              : "where " + person + " is");
  } else {
    return false;
  }
  std::string text;
  for (const Advice& one : wrong) {
    text += (text.empty() ? "I no longer believe that " : ", nor that ") + describe(one);
    withdraw(one.number, out, &utterance);
  }
  const std::string rest = told_of(person);
  say(utterance, (text.empty() ? unknown : text) + (rest.empty() ? "" : "; " + rest), true, out);
  return true;
}

void Dialogue::learn(const Advice& advice, Outputs& out) {
  knowledge_.learn(advice);
  if (advice.kind == Advice::Kind::person_at || advice.kind == Advice::Kind::office_of)
    std::erase_if(gone_, [&](const Gone& one) { return one.person == advice.about; });
  out.changed = true;
}

Dialogue::Outputs Dialogue::found(const std::vector<Find>& finds, double now) {
  return changing([&](Outputs& out) { take_finds(finds, now, out); });
}

void Dialogue::take_finds(const std::vector<Find>& finds, double now, Outputs& out) {
  const std::vector<Find> known = std::exchange(found_, finds);
  for (const Find& find : finds) {
    const bool repeated = std::any_of(known.begin(), known.end(), [&](const Find& one) {
      return one.kind == find.kind && one.about == find.about && one.value == find.value &&
             !(find.age && (!one.age || *find.age < *one.age));
    });
    const bool fresh = find.age && *find.age <= kFresh;
    const Advice* const told = knowledge_.find(find.kind, find.about);
    if (repeated || (!fresh && (told != nullptr ||
                                std::any_of(gone_.begin(), gone_.end(), [&](const Gone& one) {
                                  return one.person == find.about;
                                }))))
      continue;
    if (find.kind == Advice::Kind::has) {  // the belief says it by itself
      if (told != nullptr)
        withdraw(told->number, out);
      continue;
    }
    Advice advice;
    advice.kind = find.kind;
    advice.about = find.about;
    advice.value = find.value;
    advice.speaker = kRobot;
    if (find.age && now > 0.0)
      advice.time = now - *find.age;
    learn(advice, out);
  }
}

Dialogue::Outputs Dialogue::forget(double wanted) {
  constexpr double most = 4294967295.0;  // of Advice.number on the bus
  if (!(wanted >= 1.0 && wanted <= most) || wanted != std::floor(wanted)) {
    Outputs out;
    out.answer = {AnswerCode::bad_argument,
                  "argument \"number\": expected a whole number from 1 on "
                  "(saphira knows lists them), found " +
                      saphira::plain(wanted)};
    return out;
  }
  const auto number = static_cast<std::uint64_t>(wanted);
  Outputs out = changing([&](Outputs& more) { withdraw(number, more); });
  out.answer =
      out.changed ? Answer{AnswerCode::done, "forgotten"}
                  : Answer{AnswerCode::refused, "nothing is known under " + std::to_string(number) +
                                                    " (saphira knows lists the facts)"};
  return out;
}

Answer Dialogue::place_of(const std::string& person) const {
  const std::string place = knowledge_.place_of(person);
  if (place.empty())
    return {AnswerCode::refused, "nobody has told me where " + person + " is"};
  return {AnswerCode::done, "", {text("place", place)}};
}

void Dialogue::withdraw(std::uint64_t number, Outputs& out, const Utterance* because) {
  const std::optional<Advice> forgotten = knowledge_.forget(number);
  if (!forgotten)
    return;
  out.changed = true;
  // Claims about the person end, too.
  if ((forgotten->kind == Advice::Kind::person_at || forgotten->kind == Advice::Kind::office_of) &&
      knowledge_.place_of(forgotten->about).empty()) {
    if (gone_.size() >= kMostGone)
      gone_.erase(gone_.begin());
    gone_.push_back({forgotten->about, because == nullptr ? "taken back" : claim_source(*because)});
  }
}

Dialogue::Outputs Dialogue::changing(const std::function<void(Outputs&)>& change) {
  Outputs out;
  const std::vector<Claimed> before = claims();
  change(out);
  std::vector<Claimed> now = claims();
  for (const Claimed& one : before)
    if (std::ranges::find(now, one.name, &Claimed::name) == now.end())
      out.claims.push_back({one.name, "", ""});
  for (Claimed& one : now)
    if (std::ranges::find(before, one) == before.end())
      out.claims.push_back(std::move(one));
  return out;
}

Claimed Dialogue::hazards(const std::vector<Task>& tasks) const {
  Claimed all{maps::kHazards, "", ""};
  const auto join = [&](const std::string& value, const std::string& source) {
    all.value += (all.value.empty() ? "" : "; ") + value;
    all.source += (all.source.empty() ? "" : "; ") + source;
  };
  for (const Advice& one : knowledge_.all())
    if (one.kind == Advice::Kind::hazard)
      join(one.about + " at " + one.value, source_of(one));
  for (const Task& one : tasks)
    for (const std::string& zone : one.rules.zones)
      join(zone, one.rules.source);
  return all;
}

std::vector<Claimed> Dialogue::claims() const {
  std::vector<Claimed> result;
  for (const Advice& one : knowledge_.all()) {
    const std::string name =
        std::string(one.kind == Advice::Kind::knows_where ? kKnowers : kPlaceOf) + one.about;
    const auto same = std::ranges::find(result, name, &Claimed::name);
    if (one.kind == Advice::Kind::has) {  // so the robot has it not
      result.push_back({std::string(kCarries) + one.about, "nil", source_of(one), {}, true});
    } else if (one.kind == Advice::Kind::knows_where) {
      Claimed& all = same == result.end() ? result.emplace_back(Claimed{name, "", ""}) : *same;
      all.value += (all.value.empty() ? "" : ", ") + one.value;
      all.source += (all.source.empty() ? "" : "; ") + source_of(one);
      all.list.push_back(one.value);
    } else if (one.kind == Advice::Kind::person_at ||
               (one.kind == Advice::Kind::office_of &&
                knowledge_.find(Advice::Kind::person_at, one.about) == nullptr)) {
      result.push_back({name, one.value, source_of(one)});
    }
  }
  for (const Gone& one : gone_)
    result.push_back({"place-of-" + one.person, "nil", one.source, {}, true});
  const auto slow =
      std::ranges::find_if(tasks_.open(), [](const Task& one) { return one.rules.slow; });
  if (pace_ || slow != tasks_.open().end())
    result.push_back({kPace, "slow", pace_ ? pace_->source : slow->rules.source});
  if (Claimed all = hazards(tasks_.open()); !all.value.empty())
    result.push_back(std::move(all));
  return result;
}

}  // namespace saphira::agent_interface

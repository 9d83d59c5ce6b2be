#include "saphira/agent_interface/dialogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>

#include "saphira/agent_interface/pointing.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/numbers.hpp"

namespace saphira::agent_interface {
namespace {

constexpr const char* kHazards = "hazards";  // the belief: "leak at lab; fire at hall"
constexpr double kSure = 0.5;                // a lower confidence of a recognizer is ignored
constexpr double kDoorInSight = 5.0;         // [m] "this office" is no farther
constexpr double kAhead = 10.0;              // [m] of the point to turn to
constexpr double kLongestWay = 20.0;         // [m] that one command of motion may take
constexpr double kDoubtful = 20.0;           // [s] that a doubt waits for a yes
constexpr std::size_t kMostGone = 256;
constexpr std::size_t kHeard = 256;
/// Goals that interrupt a task for a moment.
constexpr std::array kBrief{"go_to", "drive", "turn_to", "stop", "attend-person", "pause"};
constexpr const char* kHeardLine = "heard\t";
constexpr const char* kOpenLine = "open\t";
constexpr const char* kSaidLine = "said\t";
constexpr const char* kGoneLine = "gone\t";

std::string slot(const Meaning& meaning, const std::string& name) {
  const auto found = meaning.slots.find(name);
  return found == meaning.slots.end() ? std::string() : found->second;
}

double number_of(const Meaning& meaning, const std::string& name) {
  return std::strtod(slot(meaning, name).c_str(), nullptr);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_room(lps::PointType type) {
  return type == lps::PointType::office;
}

/// "at 10:02 ", in local time; empty for an unknown time.
std::string time_text(double unix_time) {
  const auto seconds = static_cast<std::time_t>(unix_time);
  std::tm local{};
  char text[16] = "";
  if (seconds > 0 && localtime_r(&seconds, &local) != nullptr)
    std::strftime(text, sizeof text, "at %H:%M ", &local);
  return text;
}

/// The direction of a point, seen from the robot.
std::string direction_of(const Vec2& from_robot) {
  const double angle =
      std::atan2(from_robot.y(), from_robot.x()) / std::numbers::pi * 180.0;  // [deg] left: > 0
  const std::string side = angle > 0.0 ? "left" : "right";
  const double off = std::abs(angle);
  return off < 22.5    ? "ahead of me"
         : off < 67.5  ? "ahead of me on the " + side
         : off < 112.5 ? "on my " + side
         : off < 157.5 ? "behind me on the " + side
                       : "behind me";
}

/// The way to a place of the map, as the crow flies. Empty: no such place.
std::string way_to(const std::string& place, const Situation& situation) {
  if (place.empty() || !situation.pose_in_map)
    return place.empty() ? "" : place + " is on my map, but I do not know where I am on it";
  const Pose& robot = *situation.pose_in_map;
  if (place_at(situation.map, robot.position()) == place)
    return "I am in " + place;
  std::optional<Vec2> nearest;
  for (const maps::Feature& feature : situation.map.features) {
    const Vec2 from_robot = to_frame(robot, feature.pose_in_map.position());
    if (feature.name == place && (!nearest || from_robot.norm() < nearest->norm()))
      nearest = from_robot;
  }
  if (!nearest)
    return {};
  const long meters = std::lround(nearest->norm());
  return place + " is " +
         (meters < 1 ? std::string("less than a meter")
                     : "about " + std::to_string(meters) + (meters == 1 ? " meter" : " meters")) +
         " away, " + direction_of(*nearest);
}

/// A name in the letters of the text that it is from.
std::string as_said(const std::string& name, const std::string& text) {
  const std::size_t at = lower(text).rfind(name);
  return at == std::string::npos ? name : text.substr(at, name.size());
}

/// The corridor around the robot; or the room, otherwise the nearest doorway. Of a corridor and a
/// doorway, the one at which a person points.
const maps::Feature* feature_at(const maps::Map& map, const Vec2& position,
                                const std::optional<Pose>& arm, bool corridor) {
  if (corridor && arm)
    return area_at(map, *arm, true);
  const maps::Feature* nearest = nullptr;
  double distance = kDoorInSight;
  for (const maps::Feature& feature : map.features) {
    if ((corridor ? feature.type == lps::PointType::corridor : is_room(feature.type)) &&
        feature.width > 0.0 && maps::contains(feature, position))
      return &feature;
    const double away = (feature.pose_in_map.position() - position).norm();
    if (!corridor && feature.type == lps::PointType::door && away < distance) {
      nearest = &feature;
      distance = away;
    }
  }
  return arm ? doorway_at(map, *arm) : nearest;
}

bool is_open(const KnownGoal& goal) {
  return goal.state != KnownGoal::State::failed && goal.state != KnownGoal::State::over;
}

std::string state_in_words(KnownGoal::State state) {
  switch (state) {
    case KnownGoal::State::waiting:
      return "is waiting";
    case KnownGoal::State::underway:
      return "is underway";
    case KnownGoal::State::suspended:
      return "is suspended";
    case KnownGoal::State::failed:
      return "failed";
    case KnownGoal::State::over:
      return "is over";
  }
  return {};
}

/// The goal that is the reason why the robot stands or drives: the newest one that is held up,
/// otherwise the newest one that is underway, otherwise the newest one that has ended. A stop after
/// a failure is not the reason.
const KnownGoal* reason_of(const std::vector<KnownGoal>& goals) {
  const auto rank = [](const KnownGoal& goal) {
    return !is_open(goal) ? 0 : goal.state == KnownGoal::State::underway ? 1 : 2;
  };
  const KnownGoal* best = nullptr;
  const KnownGoal* before_stop = nullptr;
  for (const KnownGoal& goal : goals) {
    if (best == nullptr || rank(goal) >= rank(*best))
      best = &goal;
    if (!is_open(goal) && goal.functor != "stop")
      before_stop = &goal;
  }
  const bool stopped = best != nullptr && best->functor == "stop" && rank(*best) < 2;
  return stopped && before_stop != nullptr && before_stop->state == KnownGoal::State::failed
             ? before_stop
             : best;
}

/// "passes a door, and waits" as "pass a door, and wait". Empty: not in such words.
std::string first_person(const std::string& words) {
  constexpr std::array<const char*, 10> kFurther{"waits", "keeps", "follows", "brings", "backs",
                                                 "turns", "comes", "faces",   "stays",  "goes"};
  std::string text;
  std::string word;
  for (const char c : words + ' ') {
    if (c != ' ') {
      word += c;
      continue;
    }
    if (word == "it" || word == "robot")
      return {};
    const bool verb =
        text.empty() || std::find(kFurther.begin(), kFurther.end(), word) != kFurther.end();
    const auto ends = [&](const char* end) { return word.ends_with(end); };
    if (verb && (ends("sses") || ends("shes") || ends("ches") || ends("oes")))
      word.resize(word.size() - 2);
    else if (verb && ends("s"))
      word.pop_back();
    else if (text.empty())
      return {};
    text += (text.empty() ? "" : " ") + word;
    word.clear();
  }
  return text;
}

/// The step of a goal, such as "through-door: passes a door", as a sentence of the robot.
std::string step_in_words(const std::string& step) {
  const std::size_t colon = step.find(": ");
  if (colon == std::string::npos || step.find(' ') < colon)
    return step;
  const std::string words = step.substr(colon + 2);
  const std::string mine = first_person(words);
  return mine.empty() ? "the robot " + words : "I " + mine;
}

/// "Alice asked me to go to EJ-233", of an announcement.
std::string asked_in_words(const std::string& speaker, const std::string& what) {
  const std::string who = speaker.empty() ? "somebody" : speaker;
  constexpr std::string_view kYou = " you";
  if (what.ends_with(kYou))
    return asked_in_words(speaker, what.substr(0, what.size() - kYou.size() + 1) + who);
  return who + (what.starts_with("I ") ? " asked me to " + what.substr(2)
                                       : " asked me: \"" + what + "\"");
}

/// The origin of a claim that follows from an utterance.
std::string claim_source(const Utterance& utterance) {
  return (utterance.speaker.empty() ? "somebody" : utterance.speaker) + " said \"" +
         utterance.text + "\"";
}

bool is_yes_or_no(const Meaning& meaning) {
  return meaning.functor == "yes" || meaning.functor == "no";
}

std::string speaker_of(const Advice& advice) {
  return advice.speaker.empty() ? "somebody" : advice.speaker;
}

/// "Alice said that karen is at EJ-231".
std::string as_told(const Advice& advice) {
  return advice.speaker == kRobot ? "I found " + advice.about + " at " + advice.value
                                  : speaker_of(advice) + " said that " + describe(advice);
}

Meaning with(Meaning meaning, const std::string& name, const std::string& value) {
  meaning.slots[name] = value;
  return meaning;
}

}  // namespace

std::string place_at(const maps::Map& map, const Vec2& position) {
  std::string corridor;
  for (const maps::Feature& feature : map.features) {
    if (feature.name.empty() || feature.width <= 0.0 || !maps::contains(feature, position))
      continue;
    if (is_room(feature.type))
      return feature.name;
    if (corridor.empty() && feature.type == lps::PointType::corridor)
      corridor = feature.name;
  }
  return corridor;
}

void Dialogue::say(const Utterance& utterance, const std::string& text, bool end,
                   Outputs& out) const {
  out.said.push_back({utterance.id, utterance.speaker, text, end});
}

std::string Dialogue::place(const std::string& name, const Situation& situation) const {
  for (const maps::Feature& feature : situation.map.features)
    if (!feature.name.empty() && lower(feature.name) == name)
      return feature.name;
  return {};
}

/// The destination "here" of things to bring. A corridor is long: there it is the speaker's own
/// place, if its doorway is near.
std::string Dialogue::bring_to(const Utterance& utterance, const Situation& situation) const {
  const std::string own = place(lower(knowledge_.place_of(lower(utterance.speaker))), situation);
  if (!situation.pose_in_map)
    return own;
  const Vec2 robot = situation.pose_in_map->position();
  bool in_room = false;
  bool near = false;
  for (const maps::Feature& feature : situation.map.features) {
    in_room = in_room || (is_room(feature.type) && maps::contains(feature, robot));
    near = near || (!own.empty() && feature.name == own && feature.type == lps::PointType::door &&
                    (feature.pose_in_map.position() - robot).norm() < kDoorInSight);
  }
  const std::string here = place_at(situation.map, robot);
  return here.empty() || (near && !in_room) ? own : here;
}

std::string Dialogue::referred(const Meaning& meaning, const Situation& situation, Outputs& out,
                               std::uint32_t& artifact, std::string& wrong) const {
  const std::string name = slot(meaning, "place");
  const std::string written = place(name, situation).empty() ? owner_in(name) : std::string();
  const std::string owner = written.empty() ? slot(meaning, "owner") : written;
  const std::string side = slot(meaning, "side");
  if (!owner.empty()) {
    const Advice* const office = knowledge_.find(Advice::Kind::office_of, owner);
    if (office == nullptr)
      wrong = "nobody has told me where " + owner + "'s office is";
    return office == nullptr ? std::string() : office->value;
  }
  if (side.empty() && name != "this" && !name.empty()) {
    const std::string known = place(name, situation);
    if (known.empty()) {
      std::vector<std::string> names;
      for (const maps::Feature& feature : situation.map.features)
        if (!feature.name.empty())
          names.push_back(lower(feature.name));
      const std::string meant = guess(name, names);
      wrong = "I know no place called " + name +
              (meant.empty() ? "" : "; do you mean " + place(meant, situation) + "?");
    }
    return known;
  }
  if (!situation.pose_in_map) {
    wrong = "I do not know where I am on the map";
    return {};
  }
  // "This office" is the nearest doorway (paper 4.5), or before that the room around the robot. A
  // person may point at a doorway or area (paper 4.2).
  const Pose& robot = *situation.pose_in_map;
  const std::optional<Pose>& arm = situation.pointing_in_map;
  if (meaning.functor != "office_of") {
    const maps::Feature* const area = arm ? area_at(situation.map, *arm, false) : nullptr;
    const std::string here =
        area != nullptr ? area->name : place_at(situation.map, robot.position());
    if (here.empty())
      wrong = "where I am has no name on the map";
    return here;
  }
  const maps::Feature* nearest = nullptr;
  double distance = kDoorInSight;
  for (const maps::Feature& feature : situation.map.features) {
    if (is_room(feature.type) && side.empty() && !feature.name.empty() &&
        maps::contains(feature, robot.position())) {
      artifact = feature.id;
      return feature.name;
    }
    if (feature.type != lps::PointType::door)
      continue;
    const Vec2 from_robot = to_frame(robot, feature.pose_in_map.position());
    if ((side == "left" && from_robot.y() <= 0.0) || (side == "right" && from_robot.y() >= 0.0) ||
        from_robot.norm() >= distance)
      continue;
    nearest = &feature;
    distance = from_robot.norm();
  }
  const bool points = arm && side.empty();
  if (points)
    nearest = doorway_at(situation.map, *arm);
  if (nearest == nullptr) {
    wrong = points         ? "I know no doorway where you point"
            : side.empty() ? "I know no doorway here"
                           : "I know no doorway here on the " + side;
    return {};
  }
  artifact = nearest->id;
  if (!nearest->name.empty())
    return nearest->name;
  Naming naming{*nearest};
  naming.feature.name = slot(meaning, "person") + "'s office";
  out.namings.push_back(naming);
  return naming.feature.name;
}

void Dialogue::want(const Meaning& meaning, const Utterance& utterance, const std::string& functor,
                    Arguments arguments, Outputs&, double deadline, bool lasting) {
  Task task;
  task.goal = {0, functor, std::move(arguments), deadline, lasting, utterance.speaker};
  task.brief = std::find(kBrief.begin(), kBrief.end(), functor) != kBrief.end();
  task.what = grammar_.paraphrase(meaning);
  task.doing = grammar_.paraphrase(meaning, Grammar::Form::doing);
  task.name = grammar_.paraphrase(meaning, Grammar::Form::task);
  wanted_.push_back(std::move(task));
}

bool Dialogue::move(const Meaning& meaning, const Utterance& utterance, Outputs& out) {
  const auto point_ahead = [](double distance, double angle) {
    return point("position", Pose(distance * std::cos(angle), distance * std::sin(angle), 0.0),
                 Frame::robot);
  };
  if (meaning.functor == "stop") {
    want(meaning, utterance, "stop", {}, out);
  } else if (meaning.functor == "move") {
    const double distance = number_of(meaning, "distance");
    if (distance <= 0.0) {
      say(utterance, "that is no way to go", true, out);
      return true;
    }
    if (distance > kLongestWay) {
      say(utterance, "I go up to " + plain(kLongestWay) + " m at a time", true, out);
      return true;
    }
    if (slot(meaning, "direction") == "back") {
      constexpr double kBackSpeed = 0.1;  // [m/s]
      want(meaning, utterance, "drive", {number("speed", -kBackSpeed)}, out, distance / kBackSpeed);
    } else {
      want(meaning, utterance, "go_to", {point_ahead(distance, 0.0)}, out);
    }
  } else if (meaning.functor == "turn" || meaning.functor == "turn_around") {
    const bool around = meaning.functor == "turn_around";
    const double degrees = around ? 180.0 : number_of(meaning, "degrees");
    if (degrees <= 0.0) {
      say(utterance, "that is no turn", true, out);
      return true;
    }
    if (degrees > 180.0) {
      say(utterance, "I turn by up to 180 degrees at a time", true, out);
      return true;
    }
    const double angle = degrees / 180.0 * std::numbers::pi;
    want(meaning, utterance, "turn_to",
         {point_ahead(kAhead, slot(meaning, "direction") == "right" ? -angle : angle)}, out);
  } else {
    return false;
  }
  return true;
}

bool Dialogue::task(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                    Outputs& out) {
  const std::string& functor = meaning.functor;
  const auto whom = [&](const std::string& name) {
    const std::string known = place(name, situation);
    return known.empty() ? name : known;
  };
  if (functor == "follow_me") {
    want(meaning, utterance, "follow-person", {}, out);
  } else if (functor == "look_at_me") {
    want(meaning, utterance, "attend-person", {}, out);
  } else if (functor == "follow_corridor") {
    want(meaning, utterance, "find-and-follow", {}, out);
  } else if (functor == "explore") {
    want(meaning, utterance, "explore", {}, out);
  } else if (functor == "find") {
    want(meaning, utterance, "find-person", {text("name", slot(meaning, "person"))}, out, 0.0,
         true);
  } else if (functor == "go_to") {
    const std::string name = slot(meaning, "place");
    std::uint32_t artifact = 0;
    std::string wrong;
    const std::string where = referred(meaning, situation, out, artifact, wrong);
    Meaning shown = with(meaning, "place", where);
    shown.slots["owner"] = "";
    if (!where.empty())
      want(shown, utterance, "go-to-place", {text("place", where)}, out, 0.0, true);
    else if (!name.empty() && !knowledge_.place_of(name).empty())
      want(with(meaning, "place", name), utterance, "find-person", {text("name", name)}, out, 0.0,
           true);
    else
      say(utterance, wrong, true, out);
  } else if (functor == "deliver") {
    want(meaning, utterance, "deliver",
         {text("object", "the " + slot(meaning, "object")),
          text("from", whom(slot(meaning, "from"))), text("to", whom(slot(meaning, "to")))},
         out, 0.0, true);
  } else if (functor == "fetch") {
    const std::string to = bring_to(utterance, situation);
    if (to.empty())
      say(utterance, "I do not know where to bring it: where I am has no name", true, out);
    else
      want(meaning, utterance, "deliver",
           {text("object", "the " + slot(meaning, "object")),
            text("from", whom(slot(meaning, "person"))), text("to", to)},
           out, 0.0, true);
  } else {
    return false;
  }
  return true;
}

std::string Dialogue::doing(const Situation& situation) const {
  std::string text = tasks_.doing();
  for (const KnownGoal& goal : situation.goals)
    if (is_open(goal) && !goal.asker.empty())
      text +=
          (text.empty() ? "" : "; ") + ("for " + goal.asker) + ": " + goal.functor +
          (goal.state == KnownGoal::State::underway ? "" : ", which " + state_in_words(goal.state));
  return text.empty() ? "nothing that I was told" : text;
}

std::string Dialogue::why(const Situation& situation) const {
  const KnownGoal* const goal = reason_of(situation.goals);
  if (ended_ && (goal == nullptr || (!is_open(*goal) && goal->asker.empty()) ||
                 (goal->tag == stop_ && stop_ != 0 && !ended_->success)))
    return asked_in_words(ended_->speaker, ended_->what) +
           (ended_->success ? "; that is done: " : "; that failed: ") + ended_->reason;
  if (goal == nullptr)
    return "I have nothing to do";
  const Task* const asked = goal->tag == 0 ? nullptr : tasks_.find(goal->tag);
  const bool underway = goal->state == KnownGoal::State::underway;
  const std::string reason = underway ? step_in_words(goal->reason) : goal->reason;
  if (asked != nullptr)
    return asked_in_words(asked->goal.speaker, asked->what) +
           (underway
                ? (reason.empty() ? "" : "; " + reason)
                : "; that " + state_in_words(goal->state) + (reason.empty() ? "" : ": " + reason));
  return goal->functor + (goal->asker.empty() ? "" : " of " + goal->asker) + " " +
         state_in_words(goal->state) + (reason.empty() ? "" : ": " + reason);
}

/// First where a person is, then who knows it.
std::string Dialogue::told_of(const std::string& about) const {
  std::string text;
  for (const Advice::Kind kind : {Advice::Kind::person_at, Advice::Kind::office_of,
                                  Advice::Kind::hazard, Advice::Kind::knows_where})
    for (const Advice& one : knowledge_.all())
      if (one.kind == kind && one.about == about)
        text += (text.empty() ? "" : "; ") + as_told(one);
  return text;
}

std::string Dialogue::owner_in(const std::string& name) const {
  for (const char* const room : {" office", " room"}) {
    if (!name.ends_with(room))
      continue;
    std::string owner = name.substr(0, name.size() - std::string_view(room).size());
    if (knowledge_.knows(owner))
      return owner;
    if (owner.ends_with('s') && knowledge_.knows(owner.substr(0, owner.size() - 1)))
      return owner.substr(0, owner.size() - 1);
  }
  return {};
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

void Dialogue::choices(const std::vector<Meaning>& meanings, const Utterance& utterance,
                       Outputs& out) const {
  std::vector<std::string> all;
  for (const Meaning& meaning : meanings)
    if (const std::string words = in_words(meaning);
        !words.empty() && std::find(all.begin(), all.end(), words) == all.end())
      all.push_back(words);
  std::string text;
  for (const std::string& one : all)
    text += (text.empty() ? "\"" : ", or \"") + one + "\"";
  if (all.size() < 2)
    text = "several things";
  text = "what? That may mean " + text;
  say(utterance, text, true, out);
}

bool Dialogue::question(const Meaning& meaning, const Utterance& utterance,
                        const Situation& situation, Outputs& out) {
  if (meaning.functor == "where_are_you") {
    const std::string here =
        situation.pose_in_map ? place_at(situation.map, situation.pose_in_map->position()) : "";
    say(utterance,
        !situation.pose_in_map ? "I do not know where I am on the map"
        : here.empty()         ? "I am at a place without a name"
                               : "I am in " + here,
        true, out);
  } else if (meaning.functor == "what_are_you_doing") {
    say(utterance, doing(situation), true, out);
  } else if (meaning.functor == "why") {
    say(utterance, why(situation), true, out);
  } else if (meaning.functor == "what_can_you_do") {
    say(utterance, grammar_.paraphrase(meaning), true, out);
  } else if (meaning.functor == "where_is") {
    const std::string person = slot(meaning, "person");
    const std::string owner = place(person, situation).empty() ? owner_in(person) : std::string();
    if (!owner.empty())
      return question(with({"where_office", {}}, "person", owner), utterance, situation, out);
    std::string text = told_of(person);
    if (text.empty())
      text = way_to(place(person, situation), situation);
    say(utterance, text.empty() ? "nobody has told me where " + person + " is" : text, true, out);
  } else if (meaning.functor == "where_office") {
    const std::string person = slot(meaning, "person");
    const Advice* const office = knowledge_.find(Advice::Kind::office_of, person);
    say(utterance,
        office == nullptr ? "nobody has told me where " + person + "'s office is"
                          : as_told(*office),
        true, out);
  } else {
    return false;
  }
  return true;
}

void Dialogue::learn(const Advice& advice, Outputs& out) {
  const std::vector<Claimed> before = claims();
  knowledge_.learn(advice);
  if (advice.kind == Advice::Kind::person_at || advice.kind == Advice::Kind::office_of)
    std::erase_if(gone_, [&](const Gone& one) { return one.person == advice.about; });
  out.learned = true;
  claim_changes(before, "", out);
}

void Dialogue::claim_changes(const std::vector<Claimed>& before, const std::string& name,
                             Outputs& out) const {
  for (Claimed& one : claims())
    if (one.name == name || std::find(before.begin(), before.end(), one) == before.end())
      out.claims.push_back(std::move(one));
}

Dialogue::Outputs Dialogue::found(const std::string& person, const std::string& place, double time,
                                  bool before) {
  Outputs out;
  Advice advice;
  advice.kind = Advice::Kind::person_at;
  advice.about = lower(person);
  if (before && (knowledge_.find(advice.kind, advice.about) != nullptr ||
                 std::any_of(gone_.begin(), gone_.end(),
                             [&](const Gone& one) { return one.person == advice.about; })))
    return out;
  advice.value = place;
  advice.speaker = kRobot;
  advice.time = time;
  learn(advice, out);
  return out;
}

void Dialogue::take(const Advice& advice, const Utterance& utterance, Outputs& out) {
  const Advice* const known = knowledge_.find(advice.kind, advice.about, advice.value);
  if (known != nullptr && known->value == advice.value) {
    say(utterance, "I know: " + describe(advice), true, out);
    return;
  }
  // A person's place changes all the time; the owner of an office does not.
  if (known != nullptr && advice.kind == Advice::Kind::office_of) {
    say(utterance,
        speaker_of(*known) + " told me that " + describe(*known) + ". Is it now " + advice.value +
            "?",
        true, out);
    doubt_ = Doubt{advice, utterance.speaker};
    return;
  }
  say(utterance, "I know now that " + describe(advice), true, out);
  learn(advice, out);
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
  } else {
    return false;
  }
  if (advice.kind == Advice::Kind::hazard && meaning.functor == "no_hazard" && wrong.empty()) {
    const Advice* known = knowledge_.find(Advice::Kind::hazard, advice.about, advice.value);
    const bool rule =
        advice.about == kKeepOut || advice.about == kSlow || advice.about == kPreferred;
    if (known == nullptr && slot(meaning, "place") == "this" && !rule)
      known = knowledge_.find(Advice::Kind::hazard, advice.about);  // reported from elsewhere
    if (known == nullptr) {
      say(utterance,
          advice.about == kSlow || advice.about == kPreferred
              ? "I did not know that " + describe(advice)
              : "I knew of no " + advice.about + " at " + advice.value,
          true, out);
    } else {
      const std::string& place = known->value;
      say(utterance,
          "good: " + (advice.about == kKeepOut ? "I may go to " + place + " again"
                      : advice.about == kSlow  ? "I may go fast in " + place + " again"
                      : advice.about == kPreferred
                          ? "I need not prefer " + place + " any more"
                          : "no " + advice.about + " at " + place + " any more"),
          true, out);
      withdraw(known->number, out);
    }
    return true;
  }
  if (!wrong.empty()) {
    say(utterance, wrong, true, out);
  } else {
    take(advice, utterance, out);
    answer_with(advice, utterance, situation, out);
  }
  return true;
}

/// What people say about a person after the keyword may be what the robot has asked for.
void Dialogue::answer_with(const Advice& advice, const Utterance& utterance,
                           const Situation& situation, Outputs& out) const {
  if (situation.asked_about.empty() || lower(situation.asked_for) != advice.about)
    return;
  if (advice.kind == Advice::Kind::person_at ||
      (advice.kind == Advice::Kind::knows_where && knowledge_.findable(advice.value)))
    out.claims.push_back({situation.asked_about, advice.value, claim_source(utterance)});
}

/// Facts about people that hold no longer.
bool Dialogue::correction(const Meaning& meaning, const Utterance& utterance,
                          const Situation& situation, Outputs& out) {
  using Kind = Advice::Kind;
  const std::string person = slot(meaning, "person");
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
      say(utterance, no_place, true, out);
      return true;
    }
    doubt(office ? Kind::office_of : Kind::person_at, place);
  } else if (meaning.functor == "not_knows") {
    doubt(Kind::knows_where, slot(meaning, "other"));
  } else if (meaning.functor == "forget") {
    const std::string what = slot(meaning, "what");
    for (const Advice& one : knowledge_.all())
      if (one.about == person && (what == "all"      ? one.kind != Kind::hazard
                                  : what == "office" ? one.kind == Kind::office_of
                                                     : one.kind == Kind::person_at))
        wrong.push_back(one);
    if (wrong.empty())
      unknown = "nobody has told me " + (what == "all"      ? "anything about " + person
                                         : what == "office" ? "where " + person + "'s office is"
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

/// A name for the nameless room, doorway or corridor at the robot. A name that the map has stays.
bool Dialogue::naming(const Meaning& meaning, const Utterance& utterance,
                      const Situation& situation, Outputs& out) {
  if (meaning.functor != "name_of")
    return false;
  const std::string name = as_said(slot(meaning, "name"), utterance.text);
  const bool corridor = slot(meaning, "kind") == "corridor";
  const std::string known = place(lower(name), situation);
  if (!situation.pose_in_map) {
    say(utterance, "I do not know where I am on the map", true, out);
    return true;
  }
  const maps::Feature* const here = feature_at(situation.map, situation.pose_in_map->position(),
                                               situation.pointing_in_map, corridor);
  if (here == nullptr) {
    say(utterance,
        std::string("I know no ") + (corridor ? "corridor" : "room or doorway") +
            (situation.pointing_in_map ? " where you point" : " here"),
        true, out);
  } else if (!here->name.empty()) {
    say(utterance, (here->name == known ? "I know: this is " : "on my map this is ") + here->name,
        true, out);
  } else if (!known.empty()) {
    say(utterance, "my map has " + known + " at another place", true, out);
  } else {
    Naming naming{*here};
    naming.feature.name = name;
    out.namings.push_back(naming);
    say(utterance, "I put it on my map: this is " + name, true, out);
  }
  return true;
}

/// The answer to a question of an activity, or of this dialogue.
bool Dialogue::reply(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                     Outputs& out) {
  const bool yes = meaning.functor == "yes";
  if ((yes || meaning.functor == "no") && tasks_.asks(utterance)) {
    add(tasks_.answer(yes, utterance), out);
    note_begin(situation, out);
    return true;
  }
  if (situation.asked_about.empty() && tasks_.asks(utterance))
    return true;  // it answers something else
  if (doubt_ && doubt_->speaker == utterance.speaker && is_yes_or_no(meaning)) {
    const Doubt doubt = *doubt_;
    doubt_.reset();
    if (yes) {
      say(utterance, "I know now that " + describe(doubt.advice), true, out);
      learn(doubt.advice, out);
    } else {
      say(utterance, "then I leave it as it is", true, out);
    }
    return true;
  }
  std::string value;
  const std::string asked_for = lower(situation.asked_for);
  Advice told;  // about nobody: nothing
  told.kind = Advice::Kind::person_at;
  told.about = asked_for;
  told.speaker = utterance.speaker;
  told.said = utterance.text;
  told.time = utterance.time;
  const bool open = !situation.asked_about.empty();
  if (yes || meaning.functor == "handed") {
    value = "yes";
    told.about.clear();
  } else if (meaning.functor == "no" || meaning.functor == "dont_know") {
    value = "no";
    told.about.clear();
  } else if (meaning.functor == "somebody") {
    const std::string name = slot(meaning, "person");
    const std::string known = place(name, situation);
    value = known.empty() ? name : known;
    if (open && known.empty() && !knowledge_.findable(name)) {
      say(utterance, "nobody has told me where " + name + " is", true, out);
      return true;
    }
    if (known.empty())
      told.kind = Advice::Kind::knows_where;
  } else if (meaning.functor == "at") {
    std::uint32_t artifact = 0;
    std::string wrong;
    value = referred(meaning, situation, out, artifact, wrong);
    if (open && value.empty()) {
      say(utterance, wrong, true, out);
      return true;
    }
    if (const std::string who = slot(meaning, "who"); !who.empty())
      told.about = who;
  } else {
    return false;
  }
  if (!open)
    return true;  // no question is open
  told.value = value;
  const bool answers = asked_for.empty() || told.about.empty() || told.about == asked_for;
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
  if (move(meaning, utterance, out) || task(meaning, utterance, situation, out) ||
      errand(meaning, utterance, situation, out) || inquiry(meaning, utterance, situation, out) ||
      question(meaning, utterance, situation, out) || advice(meaning, utterance, situation, out) ||
      correction(meaning, utterance, situation, out) ||
      naming(meaning, utterance, situation, out) || reply(meaning, utterance, situation, out))
    return;
  say(utterance, "I understand " + meaning.functor + ", and do not know how to do it", true, out);
}

void Dialogue::add(Tasks::Outputs more, Outputs& out) {
  out.said.insert(out.said.end(), more.said.begin(), more.said.end());
  out.canceled.insert(out.canceled.end(), more.canceled.begin(), more.canceled.end());
  out.goals.insert(out.goals.end(), more.goals.begin(), more.goals.end());
}

/// A sentence of several steps counts as a whole: where one is not possible, nothing is done.
void Dialogue::act_on_all(const Grammar::Understood& understood, const Utterance& utterance,
                          const Situation& situation, Outputs& out) {
  wanted_.clear();
  act(understood.meanings.front(), utterance, situation, out);
  for (const Meaning& meaning : understood.then) {
    const std::size_t before = wanted_.size();
    if (before == 0)
      return;  // the reason is said
    act(meaning, utterance, situation, out);
    if (wanted_.size() == before)
      return;
  }
  add(tasks_.want(std::move(wanted_), utterance), out);
  wanted_.clear();
  note_begin(situation, out);
  if (!out.goals.empty() && out.goals.back().functor == "stop")
    stop_ = out.goals.back().tag;
  else if (!out.goals.empty())
    ended_.reset();
}

Dialogue::Outputs Dialogue::hear(const Utterance& utterance, const Situation& situation) {
  Outputs out;
  if (utterance.id != UtteranceId{}) {
    if (std::find(heard_.begin(), heard_.end(), utterance.id) != heard_.end())
      return out;
    heard_.push_back(utterance.id);
    if (heard_.size() > kHeard)
      heard_.erase(heard_.begin());
    out.learned = true;
  }
  if (doubt_ && utterance.time > 0.0 && doubt_->advice.time > 0.0 &&
      utterance.time - doubt_->advice.time > kDoubtful)
    doubt_.reset();
  const bool doubted = doubt_ && doubt_->speaker == utterance.speaker;
  const bool drops = tasks_.asks(utterance);
  const bool asked = !situation.asked_about.empty();
  Grammar::Understood understood = grammar_.understand(utterance.text, asked || doubted || drops);
  if ((doubted || drops) && !asked && !understood.addressed)
    std::erase_if(understood.meanings, [](const Meaning& one) { return !is_yes_or_no(one); });
  // Whoever goes on to something else leaves the doubt.
  if (doubted && utterance.confidence >= kSure &&
      (understood.meanings.size() != 1 || !is_yes_or_no(understood.meanings.front())))
    doubt_.reset();
  if (!understood.addressed && understood.meanings.empty())
    return out;  // people talk to each other
  if (understood.meanings.empty() || utterance.confidence < kSure) {
    say(utterance, "what?", true, out);
  } else if (understood.meanings.size() > 1) {
    choices(understood.meanings, utterance, out);
  } else {
    act_on_all(understood, utterance, situation, out);
  }
  return out;
}

Dialogue::Outputs Dialogue::ended(const Outcome& outcome) {
  Outputs out;
  const Task* const task = tasks_.find(outcome.tag);
  if (task != nullptr && (outcome.tag != stop_ || !ended_ || ended_->success))
    ended_ = Ended{task->what, task->goal.speaker, outcome.success, outcome.reason};
  add(tasks_.ended(outcome), out);
  return out;
}

Dialogue::Outputs Dialogue::says(const std::string& text, const CycleRef& when) {
  Outputs out;
  if (when.first == before_.first && when.second <= before_.second)
    return out;
  said_ = when;
  out.said.push_back({tasks_.spoken_for(), {}, text, false});
  return out;
}

Dialogue::Outputs Dialogue::forget(std::uint64_t number) {
  Outputs out;
  withdraw(number, out);
  return out;
}

void Dialogue::withdraw(std::uint64_t number, Outputs& out, const Utterance* because) {
  const std::vector<Claimed> before = claims();
  const std::optional<Advice> forgotten = knowledge_.forget(number);
  if (!forgotten)
    return;
  out.learned = true;
  const bool hazard = forgotten->kind == Advice::Kind::hazard;
  const bool knows = forgotten->kind == Advice::Kind::knows_where;
  const std::string name =
      hazard ? kHazards : (knows ? "knows-where-" : "place-of-") + forgotten->about;
  // What activities believe of the person is withdrawn, too.
  if (!hazard && !knows && knowledge_.place_of(forgotten->about).empty()) {
    if (gone_.size() >= kMostGone)
      gone_.erase(gone_.begin());
    Gone gone{forgotten->about, because == nullptr ? "taken back" : claim_source(*because)};
    std::replace(gone.source.begin(), gone.source.end(), '\n', ' ');  // a line of save()
    gone_.push_back(std::move(gone));
  }
  out.claims.push_back({name, "", ""});
  claim_changes(before, name, out);
}

std::vector<Claimed> Dialogue::claims() const {
  std::vector<Claimed> result;
  const auto source = [](const Advice& advice) {
    return advice.speaker == kRobot
               ? kRobot + (" found " + advice.about) + " " + time_text(advice.time) + "there"
               : speaker_of(advice) + " said " + time_text(advice.time) + "\"" + advice.said + "\"";
  };
  const auto join = [&](Claimed& all, const Advice& advice, const std::string& value,
                        const char* between) {
    all.value += (all.value.empty() ? "" : between) + value;
    all.source += (all.source.empty() ? "" : "; ") + source(advice);
  };
  Claimed hazards{kHazards, "", ""};
  for (const Advice& one : knowledge_.all()) {
    const std::string name =
        (one.kind == Advice::Kind::knows_where ? "knows-where-" : "place-of-") + one.about;
    const auto same = std::find_if(result.begin(), result.end(),
                                   [&](const Claimed& each) { return each.name == name; });
    if (one.kind == Advice::Kind::hazard) {
      join(hazards, one, one.about + " at " + one.value, "; ");
    } else if (one.kind == Advice::Kind::knows_where) {
      Claimed& all = same == result.end() ? result.emplace_back(Claimed{name, "", ""}) : *same;
      join(all, one, one.value, ", ");
      all.list.push_back(one.value);
    } else if (one.kind == Advice::Kind::person_at ||
               knowledge_.find(Advice::Kind::person_at, one.about) == nullptr) {
      result.push_back({name, one.value, source(one)});
    }
  }
  for (const Gone& one : gone_)
    result.push_back({"place-of-" + one.person, "nil", one.source, {}, true});
  if (!hazards.value.empty())
    result.push_back(std::move(hazards));
  return result;
}

std::string Dialogue::save() const {
  std::string text = knowledge_.save();
  for (const UtteranceId& id : heard_)
    text += sealed_line(kHeardLine + std::to_string(id.first) + "\t" + std::to_string(id.second)) +
            "\n";
  for (const Gone& one : gone_)
    text += sealed_line(kGoneLine + one.person + "\t" + one.source) + "\n";
  if (said_ != CycleRef{})
    text +=
        sealed_line(kSaidLine + std::to_string(said_.first) + "\t" + std::to_string(said_.second)) +
        "\n";
  for (const std::string& line : tasks_.save())
    text += sealed_line(kOpenLine + line) + "\n";
  return text;
}

std::size_t Dialogue::restore(std::string_view text) {
  std::string advice;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, length);
    const std::optional<std::string_view> content = unsealed_line(line);
    if (content && content->starts_with(kHeardLine)) {
      const std::string rest(content->substr(std::string_view(kHeardLine).size()));
      const std::size_t tab = rest.find('\t');
      if (tab != std::string::npos)
        heard_.emplace_back(std::strtoull(rest.c_str(), nullptr, 10),
                            std::strtoull(rest.c_str() + tab + 1, nullptr, 10));
    } else if (content && content->starts_with(kSaidLine)) {
      const std::string rest(content->substr(std::string_view(kSaidLine).size()));
      char* end = nullptr;
      before_.first = std::strtoull(rest.c_str(), &end, 10);
      before_.second = std::strtoull(end, nullptr, 10);
      said_ = before_;
    } else if (content && content->starts_with(kGoneLine)) {
      const std::string rest(content->substr(std::string_view(kGoneLine).size()));
      const std::size_t tab = rest.find('\t');
      if (tab != std::string::npos)
        gone_.push_back({rest.substr(0, tab), rest.substr(tab + 1)});
    } else if (content && content->starts_with(kOpenLine)) {
      tasks_.restore(std::string(content->substr(std::string_view(kOpenLine).size())));
    } else {
      advice += std::string(line) + "\n";
    }
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return knowledge_.restore(advice);
}

}  // namespace saphira::agent_interface

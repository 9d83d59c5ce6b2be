#include "saphira/agent_interface/dialogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>

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
constexpr std::size_t kHeard = 256;
constexpr const char* kHeardLine = "heard\t";
constexpr const char* kOpenLine = "open\t";
constexpr const char* kSaidLine = "said\t";

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

/// The corridor around a position; or the room, otherwise the nearest doorway.
const maps::Feature* feature_at(const maps::Map& map, const Vec2& position, bool corridor) {
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
  return nearest;
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

/// The reason for which the robot stands: of the newest goal that is held up, otherwise of the
/// newest one that is underway, otherwise of the newest one that has ended.
std::string why_standing(const std::vector<KnownGoal>& goals) {
  const auto rank = [](const KnownGoal& goal) {
    return !is_open(goal) ? 0 : goal.state == KnownGoal::State::underway ? 1 : 2;
  };
  const KnownGoal* best = nullptr;
  for (const KnownGoal& goal : goals)
    if (best == nullptr || rank(goal) >= rank(*best))
      best = &goal;
  if (best == nullptr)
    return "I have nothing to do";
  return best->functor + (best->asker.empty() ? "" : " of " + best->asker) + " " +
         state_in_words(best->state) + (best->reason.empty() ? "" : ": " + best->reason);
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
  const std::string owner = slot(meaning, "owner");
  const std::string name = slot(meaning, "place");
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
  // "This office" is the nearest doorway (paper 4.5), or before that the room around the robot.
  const Pose& robot = *situation.pose_in_map;
  if (meaning.functor != "office_of") {
    const std::string here = place_at(situation.map, robot.position());
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
  if (nearest == nullptr) {
    wrong = "I know no doorway here" + (side.empty() ? "" : " on the " + side);
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
                    Arguments arguments, Outputs& out, double deadline, bool lasting) {
  const std::string what = grammar_.paraphrase(meaning);
  for (const Open& open : open_)
    out.canceled.push_back(open.tag);
  open_.clear();
  say(utterance, what, false, out);
  out.goals.push_back(
      {++tag_, functor, std::move(arguments), deadline, lasting, utterance.speaker});
  open_.push_back({tag_, what, utterance.id, utterance.speaker, {}});
}

void Dialogue::asked(std::uint64_t tag, const GoalRef& goal) {
  for (Open& open : open_)
    if (open.tag == tag)
      open.goal = goal;
}

std::vector<std::pair<std::uint64_t, GoalRef>> Dialogue::lasting() const {
  std::vector<std::pair<std::uint64_t, GoalRef>> goals;
  for (const Open& open : open_)
    if (open.goal != GoalRef{})
      goals.emplace_back(open.tag, open.goal);
  return goals;
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
    if (distance <= 0.0 || distance > kLongestWay) {
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
    if (degrees <= 0.0 || degrees > 180.0) {
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
  std::string text = open_.empty() ? "" : open_.back().what;
  for (const KnownGoal& goal : situation.goals)
    if (is_open(goal) && !goal.asker.empty())
      text +=
          (text.empty() ? "" : "; ") + ("for " + goal.asker) + ": " + goal.functor +
          (goal.state == KnownGoal::State::underway ? "" : ", which " + state_in_words(goal.state));
  return text.empty() ? "nothing that I was told" : text;
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
    say(utterance, why_standing(situation.goals), true, out);
  } else if (meaning.functor == "what_can_you_do") {
    say(utterance, grammar_.paraphrase(meaning), true, out);
  } else if (meaning.functor == "where_is") {
    const std::string person = slot(meaning, "person");
    std::string text;
    for (const Advice& one : knowledge_.all())
      if (one.about == person)
        text += (text.empty() ? "" : "; ") +
                (one.speaker.empty() ? std::string("somebody") : one.speaker) + " said that " +
                describe(one);
    if (text.empty())
      text = way_to(place(person, situation), situation);
    say(utterance, text.empty() ? "nobody has told me where " + person + " is" : text, true, out);
  } else {
    return false;
  }
  return true;
}

void Dialogue::learn(const Advice& advice, Outputs& out) {
  knowledge_.learn(advice);
  out.learned = true;
  const std::vector<Claimed> all = claims();
  out.claims.insert(out.claims.end(), all.begin(), all.end());
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
        (known->speaker.empty() ? std::string("somebody") : known->speaker) + " told me that " +
            describe(*known) + ". Is it now " + advice.value + "?",
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
  if (!wrong.empty())
    say(utterance, wrong, true, out);
  else
    take(advice, utterance, out);
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
  const maps::Feature* const here =
      feature_at(situation.map, situation.pose_in_map->position(), corridor);
  if (here == nullptr) {
    say(utterance,
        std::string("I know no ") + (corridor ? "corridor" : "room or doorway") + " here", true,
        out);
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
  if (doubt_ && (yes || meaning.functor == "no")) {
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
  if (yes) {
    value = "yes";
  } else if (meaning.functor == "no" || meaning.functor == "dont_know") {
    value = "no";
  } else if (meaning.functor == "somebody") {
    const std::string name = slot(meaning, "person");
    const std::string known = place(name, situation);
    value = known.empty() ? name : known;
    if (known.empty() && knowledge_.place_of(name).empty()) {
      say(utterance, "nobody has told me where " + name + " is", true, out);
      return true;
    }
  } else if (meaning.functor == "at") {
    std::uint32_t artifact = 0;
    std::string wrong;
    Meaning where = meaning;
    where.functor = "at";
    value = referred(where, situation, out, artifact, wrong);
    if (value.empty()) {
      say(utterance, wrong, true, out);
      return true;
    }
  } else {
    return false;
  }
  if (situation.asked_about.empty())
    return true;  // no question is open
  say(utterance, "thank you", true, out);
  out.claims.push_back({situation.asked_about, value,
                        (utterance.speaker.empty() ? "somebody" : utterance.speaker) + " said \"" +
                            utterance.text + "\""});
  return true;
}

void Dialogue::act(const Meaning& meaning, const Utterance& utterance, const Situation& situation,
                   Outputs& out) {
  if (move(meaning, utterance, out) || task(meaning, utterance, situation, out) ||
      question(meaning, utterance, situation, out) || advice(meaning, utterance, situation, out) ||
      naming(meaning, utterance, situation, out) || reply(meaning, utterance, situation, out))
    return;
  say(utterance, "I understand " + meaning.functor + ", and do not know how to do it", true, out);
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
  const bool asked =
      !situation.asked_about.empty() || (doubt_ && doubt_->speaker == utterance.speaker);
  const Grammar::Understood understood = grammar_.understand(utterance.text, asked);
  if (!understood.addressed && understood.meanings.empty())
    return out;  // people talk to each other
  if (understood.meanings.empty() || utterance.confidence < kSure) {
    say(utterance, "what?", true, out);
  } else if (understood.meanings.size() > 1) {
    std::string choices;
    for (const Meaning& meaning : understood.meanings)
      choices += (choices.empty() ? "" : ", or ") + describe(meaning);
    say(utterance, "what? That may mean " + choices, true, out);
  } else {
    act(understood.meanings.front(), utterance, situation, out);
  }
  return out;
}

Dialogue::Outputs Dialogue::ended(const Outcome& outcome) {
  Outputs out;
  const auto found = std::find_if(open_.begin(), open_.end(),
                                  [&](const Open& one) { return one.tag == outcome.tag; });
  if (found == open_.end())
    return out;
  const std::string text =
      outcome.success ? "done: " + outcome.reason : "I could not: " + outcome.reason;
  out.said.push_back({found->answers, found->listener, text, true});
  open_.erase(found);
  return out;
}

Dialogue::Outputs Dialogue::says(const std::string& text, const CycleRef& when) {
  Outputs out;
  if (when.first == before_.first && when.second <= before_.second)
    return out;
  said_ = when;
  Said said{{}, {}, text, false};
  if (!open_.empty())
    said.answers = open_.back().answers;
  out.said.push_back(std::move(said));
  return out;
}

Dialogue::Outputs Dialogue::forget(std::uint64_t number) {
  Outputs out;
  withdraw(number, out);
  return out;
}

void Dialogue::withdraw(std::uint64_t number, Outputs& out) {
  const std::optional<Advice> forgotten = knowledge_.forget(number);
  if (!forgotten)
    return;
  out.learned = true;
  const char* const name = forgotten->kind == Advice::Kind::hazard        ? kHazards
                           : forgotten->kind == Advice::Kind::knows_where ? "knows-where-"
                                                                          : "place-of-";
  out.claims.push_back(
      {name + (forgotten->kind == Advice::Kind::hazard ? "" : forgotten->about), "", ""});
  const std::vector<Claimed> all = claims();
  out.claims.insert(out.claims.end(), all.begin(), all.end());
}

std::vector<Claimed> Dialogue::claims() const {
  std::vector<Claimed> result;
  const auto source = [](const Advice& advice) {
    return (advice.speaker.empty() ? std::string("somebody") : advice.speaker) + " said " +
           time_text(advice.time) + "\"" + advice.said + "\"";
  };
  Claimed hazards{kHazards, "", ""};
  for (const Advice& one : knowledge_.all()) {
    if (one.kind == Advice::Kind::hazard) {
      const char* const between = hazards.value.empty() ? "" : "; ";
      hazards.value += between + one.about + " at " + one.value;
      hazards.source += between + source(one);
    } else if (one.kind == Advice::Kind::knows_where) {
      result.push_back({"knows-where-" + one.about, one.value, source(one)});
    } else if (knowledge_.place_of(one.about) == one.value) {
      result.push_back({"place-of-" + one.about, one.value, source(one)});
    }
  }
  if (!hazards.value.empty())
    result.push_back(std::move(hazards));
  return result;
}

std::string Dialogue::save() const {
  std::string text = knowledge_.save();
  for (const UtteranceId& id : heard_)
    text += sealed_line(kHeardLine + std::to_string(id.first) + "\t" + std::to_string(id.second)) +
            "\n";
  if (said_ != CycleRef{})
    text +=
        sealed_line(kSaidLine + std::to_string(said_.first) + "\t" + std::to_string(said_.second)) +
        "\n";
  for (const Open& open : open_)
    if (open.goal != GoalRef{})
      text +=
          sealed_line(
              kOpenLine + std::to_string(open.tag) + "\t" + std::to_string(open.goal.first) + "\t" +
              std::to_string(open.goal.second) + "\t" + std::to_string(open.answers.first) + "\t" +
              std::to_string(open.answers.second) + "\t" + open.listener + "\t" + open.what) +
          "\n";
  return text;
}

void Dialogue::restore_open(const std::string& line) {
  std::array<std::uint64_t, 5> numbers{};
  const char* at = line.c_str();
  for (std::uint64_t& number : numbers) {
    char* end = nullptr;
    number = std::strtoull(at, &end, 10);
    if (*end != '\t')
      return;
    at = end + 1;
  }
  const std::string words = at;
  const std::size_t tab = words.find('\t');
  if (tab == std::string::npos)
    return;
  tag_ = std::max(tag_, numbers[0]);
  open_.push_back({numbers[0],
                   words.substr(tab + 1),
                   {numbers[3], numbers[4]},
                   words.substr(0, tab),
                   {numbers[1], numbers[2]}});
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
    } else if (content && content->starts_with(kOpenLine)) {
      restore_open(std::string(content->substr(std::string_view(kOpenLine).size())));
    } else {
      advice += std::string(line) + "\n";
    }
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return knowledge_.restore(advice);
}

}  // namespace saphira::agent_interface

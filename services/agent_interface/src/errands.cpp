// The part of the dialogue for errands between people, ways of several steps, and questions about
// what the robot knows.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "saphira/agent_interface/dialogue.hpp"
#include "saphira/base/numbers.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kLongestWait = 3600.0;  // [s]
constexpr double kWaitThere = 600.0;     // [s] until the robot is free for others
constexpr std::size_t kFewFacts = 3;

std::string of_slot(const Meaning& meaning, const char* name) {
  const auto found = meaning.slots.find(name);
  return found == meaning.slots.end() ? std::string() : found->second;
}

Meaning with_slot(Meaning meaning, const std::string& name, const std::string& value) {
  meaning.slots[name] = value;
  return meaning;
}

/// The end of an utterance that has these words, as its speaker wrote it.
std::string end_as_said(const std::string& words, const std::string& text) {
  const std::vector<std::string> wanted = words_of(words);
  for (std::size_t at = text.size(); at-- > 0;) {
    if (text[at] == ' ' || (at > 0 && text[at - 1] != ' ') || words_of(text.substr(at)) != wanted)
      continue;
    std::string end = text.substr(at);
    while (!end.empty() && (end.back() == ' ' || end.back() == '.' || end.back() == '!'))
      end.pop_back();
    return end;
  }
  return words;
}

std::string sender_of(const Utterance& utterance) {
  return utterance.speaker.empty() ? "somebody" : utterance.speaker;
}

}  // namespace

void Dialogue::note_begin(const Situation& situation, const Outputs& out) {
  if (out.goals.empty() || !out.goals.back().lasting || out.goals.back().functor == "come-back" ||
      !situation.pose_in_map)
    return;
  const std::string here = place_at(situation.map, situation.pose_in_map->position());
  if (!here.empty())
    began_ = Spot{here, *situation.pose_in_map};
}

/// Back to where the last task began, or home; as a later step to where the first one begins.
void Dialogue::go_back(const Meaning& meaning, const Utterance& utterance,
                       const Situation& situation, Outputs& out) {
  const std::string named = place("home", situation);
  const std::string home = named.empty() ? place("start", situation) : named;
  std::optional<Spot> spot = began_;
  if (!wanted_.empty() && situation.pose_in_map) {
    const std::string here = place_at(situation.map, situation.pose_in_map->position());
    if (!here.empty())
      spot = Spot{here, *situation.pose_in_map};
  }
  if (meaning.functor == "go_home" ? !home.empty() : !spot && !home.empty())
    want(with_slot(meaning, "place", home), utterance, "go-to-place", {text("place", home)}, out,
         0.0, true);
  else if (spot)
    want(with_slot(meaning, "place", spot->place), utterance, "come-back",
         {text("place", spot->place), point("spot", spot->pose_in_map, Frame::map)}, out, 0.0,
         true);
  else
    say(utterance, "I do not know where that is: my map has no place called home or start", true,
        out);
}

bool Dialogue::errand(const Meaning& meaning, const Utterance& utterance,
                      const Situation& situation, Outputs& out) {
  const std::string& functor = meaning.functor;
  const auto whom = [&](const std::string& name) {
    const std::string known = place(name, situation);
    return known.empty() ? name : known;
  };
  // A place that the sentence names, or that of an owner; empty, and said, where there is none.
  const auto where = [&](const char* name) {
    Meaning referring = with_slot(meaning, "place", of_slot(meaning, name));
    std::uint32_t artifact = 0;
    std::string wrong;
    const std::string found = referred(referring, situation, out, artifact, wrong);
    if (found.empty())
      say(utterance, wrong, true, out);
    return found;
  };
  const auto back = [&] {
    const std::string known = bring_to(utterance, situation);
    return text("back", known);
  };
  if (functor == "deliver_here") {
    const bool office = !of_slot(meaning, "owner").empty();
    const std::string to = office ? where("to") : whom(of_slot(meaning, "to"));
    if (!to.empty())
      want(with_slot(meaning, "to", to), utterance, "deliver",
           {text("object", "the " + of_slot(meaning, "object")), text("to", to),
            text("sender", sender_of(utterance))},
           out, 0.0, true);
  } else if (functor == "tell") {
    const std::string message = end_as_said(of_slot(meaning, "message"), utterance.text);
    want(with_slot(meaning, "message", message), utterance, "tell",
         {text("person", of_slot(meaning, "person")), text("message", message),
          text("sender", sender_of(utterance)), back()},
         out, 0.0, true);
  } else if (functor == "ask_person") {
    const std::string question = of_slot(meaning, "question");
    want(meaning, utterance, "inquire",
         {text("person", of_slot(meaning, "person")), text("question", question),
          text("sender", sender_of(utterance)), back()},
         out, 0.0, true);
  } else if (functor == "patrol") {
    want(meaning, utterance, "patrol", {}, out, 0.0, true);
  } else if (functor == "guide") {
    const std::string to = where("place");
    if (!to.empty())
      want(with_slot(with_slot(meaning, "place", to), "owner", ""), utterance, "guide",
           {text("place", to)}, out, 0.0, true);
  } else if (functor == "pause") {
    const double unit = of_slot(meaning, "unit") == "minutes" ? 60.0 : 1.0;
    const double seconds = std::strtod(of_slot(meaning, "time").c_str(), nullptr) * unit;
    if (seconds <= 0.0 || seconds > kLongestWait)
      say(utterance, "I wait for up to an hour", true, out);
    else
      want(meaning, utterance, "pause", {number("seconds", seconds)}, out);
  } else if (functor == "wait_there") {
    want(meaning, utterance, "pause", {number("seconds", kWaitThere)}, out);
    wanted_.back().brief = false;
  } else if (functor == "come_back" || functor == "go_home") {
    go_back(meaning, utterance, situation, out);
  } else {
    return false;
  }
  return true;
}

bool Dialogue::inquiry(const Meaning& meaning, const Utterance& utterance,
                       const Situation& situation, Outputs& out) const {
  const std::string& functor = meaning.functor;
  const std::vector<Advice>& known = knowledge_.all();
  const auto told = [](const Advice& one) {
    return (one.speaker.empty() ? std::string("somebody") : one.speaker) + " said that " +
           describe(one);
  };
  if (functor == "nearest") {
    const maps::Feature* nearest = nullptr;
    double distance = 0.0;
    for (const maps::Feature& feature : situation.map.features) {
      if (!situation.pose_in_map || feature.type != lps::PointType::door || feature.name.empty())
        continue;
      const double away =
          (feature.pose_in_map.position() - situation.pose_in_map->position()).norm();
      if (nearest == nullptr || away < distance) {
        nearest = &feature;
        distance = away;
      }
    }
    say(utterance,
        !situation.pose_in_map ? "I do not know where I am on the map"
        : nearest == nullptr   ? "I know no door with a name"
                               : "the nearest door with a name is that of " + nearest->name +
                                   ": say go to " + nearest->name,
        true, out);
  } else if (functor == "what_do_you_know") {
    constexpr std::array kKinds{
        std::pair{Advice::Kind::office_of, "offices"},
        std::pair{Advice::Kind::person_at, "places of people"},
        std::pair{Advice::Kind::knows_where, "people who know where others are"},
        std::pair{Advice::Kind::hazard, "hazards and places to keep out of"}};
    std::string counts;
    for (const auto& [kind, words] : kKinds) {
      const auto count = std::count_if(known.begin(), known.end(),
                                       [&](const Advice& one) { return one.kind == kind; });
      if (count > 0)
        counts += (counts.empty() ? "" : ", ") + std::to_string(count) + " " + words;
    }
    std::string newest;
    std::vector<const Advice*> by_number;
    for (const Advice& one : known)
      by_number.push_back(&one);
    std::sort(by_number.begin(), by_number.end(),
              [](const Advice* a, const Advice* b) { return a->number > b->number; });
    for (std::size_t i = 0; i < std::min(by_number.size(), kFewFacts); ++i)
      newest += "; " + told(*by_number[i]);
    say(utterance, known.empty() ? "nobody has told me anything" : "I know " + counts + newest,
        true, out);
  } else if (functor == "are_you_lost") {
    const std::string here =
        situation.pose_in_map ? place_at(situation.map, situation.pose_in_map->position()) : "";
    say(utterance,
        !situation.pose_in_map ? "yes: I do not know where I am on the map"
        : here.empty()         ? "no, but this place has no name"
                               : "no: I am in " + here,
        true, out);
  } else if (functor == "is_there" || functor == "who_is_in") {
    const bool people = functor == "who_is_in";
    std::string at;
    if (!of_slot(meaning, "place").empty() || !of_slot(meaning, "owner").empty()) {
      std::uint32_t artifact = 0;
      std::string wrong;
      at = referred(meaning, situation, out, artifact, wrong);
      if (at.empty()) {
        say(utterance, wrong, true, out);
        return true;
      }
    }
    std::string all;
    for (const Advice& one : known)
      if ((people ? one.kind == Advice::Kind::person_at ||
                        (one.kind == Advice::Kind::office_of &&
                         knowledge_.place_of(one.about) == one.value)
                  : one.kind == Advice::Kind::hazard && one.about != kKeepOut &&
                        one.about.ends_with(of_slot(meaning, "kind"))) &&
          (at.empty() || one.value == at))
        all += (all.empty() ? "" : "; ") + told(one);
    if (all.empty())
      all = people ? "nobody has told me who is in " + at
                   : "nobody has told me of a " + of_slot(meaning, "kind") +
                         (at.empty() ? "" : " at " + at);
    say(utterance, all, true, out);
  } else if (functor == "you_are_in") {
    std::uint32_t artifact = 0;
    std::string wrong;
    const std::string at = referred(meaning, situation, out, artifact, wrong);
    const std::string here =
        situation.pose_in_map ? place_at(situation.map, situation.pose_in_map->position()) : "";
    say(utterance,
        at.empty() ? wrong
        : at == here
            ? "I know: I am in " + at
            : (here.empty() ? "" : "I think that I am in " + here + ". ") + "To put me in " + at +
                  " I need the exact place: saphira map place X Y HEADING, or saphira map find",
        true, out);
  } else {
    return false;
  }
  return true;
}

}  // namespace saphira::agent_interface

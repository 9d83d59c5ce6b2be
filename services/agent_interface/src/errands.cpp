// The part of the dialogue for errands between people, and for ways back.
#include <algorithm>

#include "saphira/base/numbers.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kLongestWait = 3600.0;  // [s]
constexpr double kWaitThere = 600.0;     // [s] until the robot is free for others

/// The end of an utterance that has these words, as its speaker wrote it.
std::string end_as_said(const std::string& words, const std::string& text) {
  const std::vector<std::string> wanted = words_of(words);
  for (std::size_t at = text.size(); at-- > 0;) {
    if (text[at] == ' ' || (at > 0 && text[at - 1] != ' ') || words_of(text.substr(at)) != wanted)
      continue;
    std::string end = text.substr(at);
    while (!end.empty() &&
           (end.back() == ' ' || end.back() == '.' || end.back() == '!' || end.back() == '?'))
      end.pop_back();
    return end;
  }
  return words;
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
    want(with(meaning, "place", home), utterance, "go-to-place", {text("place", home)}, out, 0.0,
         true);
  else if (spot)
    want(with(meaning, "place", spot->place), utterance, "come-back",
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
    Meaning referring = with(meaning, "place", slot(meaning, name));
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
    const bool office = !slot(meaning, "owner").empty();
    const std::string to = office ? where("to") : whom(slot(meaning, "to"));
    if (!to.empty())
      want(with(meaning, "to", to), utterance, "deliver",
           {text("object", "the " + slot(meaning, "object")), text("to", to),
            text("sender", speaker_of(utterance))},
           out, 0.0, true);
  } else if (functor == "tell") {
    const std::string message = end_as_said(slot(meaning, "message"), utterance.text);
    want(with(meaning, "message", message), utterance, "tell",
         {text("person", slot(meaning, "person")), text("message", message),
          text("sender", speaker_of(utterance)), back()},
         out, 0.0, true);
  } else if (functor == "ask_person") {
    const std::string question = end_as_said(slot(meaning, "question"), utterance.text);
    want(meaning, utterance, "inquire",
         {text("person", slot(meaning, "person")), text("question", question),
          text("sender", speaker_of(utterance)), back()},
         out, 0.0, true);
  } else if (functor == "patrol") {
    want(meaning, utterance, "patrol", {}, out, 0.0, true);
  } else if (functor == "guide") {
    const std::string to = where("place");
    if (!to.empty())
      want(with(with(meaning, "place", to), "owner", ""), utterance, "guide", {text("place", to)},
           out, 0.0, true);
  } else if (functor == "pause") {
    const double unit = slot(meaning, "unit") == "minutes" ? 60.0 : 1.0;
    const double seconds = number_of(meaning, "time") * unit;
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

}  // namespace saphira::agent_interface

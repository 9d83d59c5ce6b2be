// The part of the dialogue for errands between people, and for ways back.
#include <algorithm>
#include <cmath>

#include "saphira/base/format.hpp"
#include "words.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kLongestWait = 36000.0;  // [s] of the activity, or until it is told to go on
constexpr double kWaitThere = 600.0;      // [s] until the robot is free for others

/// The last part of an utterance that has these words, as its speaker wrote it.
std::string part_as_said(const std::string& words, std::string text) {
  const std::vector<std::string> wanted = words_of(words);
  for (; !text.empty(); text.resize(std::min(text.rfind(' '), text.size()))) {
    for (std::size_t at = text.size(); at-- > 0;)
      if (text[at] != ' ' && (at == 0 || text[at - 1] == ' ') &&
          words_of(text.substr(at)) == wanted)
        return text.substr(at, text.find_last_not_of(" .,!?") + 1 - at);
    if (text.find(' ') == std::string::npos)
      break;
  }
  return words;
}

}  // namespace

void Dialogue::note_begin(const Situation& situation, const Outputs& out) {
  if (out.goals.empty() || !out.goals.back().lasting || out.goals.back().functor == "come-back")
    return;
  if (const std::string place = here(situation); !place.empty())
    began_ = Spot{place, *situation.pose_in_map};
}

/// Back to where the last task began, or home; as a later step to where the first one begins.
void Dialogue::go_back(const Meaning& meaning, const Utterance& utterance,
                       const Situation& situation, Outputs& out) {
  const std::string named = place("home", situation);
  const std::string home = named.empty() ? place("start", situation) : named;
  std::optional<Spot> spot = began_;
  if (const std::string place = here(situation); !wanted_.empty() && !place.empty())
    spot = Spot{place, *situation.pose_in_map};
  if (meaning.functor == "go_home" ? !home.empty() : !spot && !home.empty())
    want(with(meaning, "place", home), utterance, "go-to-place", {text("place", home)});
  else if (spot)
    want(with(meaning, "place", spot->place), utterance, "come-back",
         {text("place", spot->place), point("spot", spot->pose_in_map, Frame::map)});
  else
    refuse(utterance, "I do not know where that is: my map has no place called home or start", out);
}

/// A slow pace holds until the present tasks have ended; without one, it is for the speaker's next
/// order.
void Dialogue::change_pace(bool slower, const Utterance& utterance, const Situation& situation,
                           Outputs& out) {
  const std::vector<Claimed> before = claims();
  const bool others = front(situation).has_value();
  pace_.reset();
  const std::string names = tasks_.set_pace(slower, claim_source(utterance), utterance.speaker);
  if (slower && names.empty())
    pace_ = Pace{utterance.speaker, claim_source(utterance), others};
  const bool was = std::ranges::find(before, kPace, &Claimed::name) != before.end();
  if (slower)
    say(utterance,
        situation.is_slow ? "I go slowly already"
                          : "I go slowly until " + (!names.empty() ? names + " ends"
                                                    : others       ? "that ends"
                                                                   : "your next order ends"),
        true, out);
  else if (was)
    say(utterance, "I go as fast as before", true, out);
  else
    refuse(utterance,
           situation.is_slow ? "another program wants me to go slowly"
                             : "I go no faster than the task asks for",
           out);
}

bool Dialogue::add_rule(const Meaning& meaning, const Utterance& utterance,
                        const Situation& situation, Rules& rules, Outputs& out) const {
  if (meaning.functor == "pace") {
    rules.slow = true;
    rules.text += ", slowly";
  } else if (meaning.functor == "hazard") {
    const std::string place = place_or_refusal(meaning, utterance, situation, out);
    if (place.empty())
      return false;
    const std::string kind = slot(meaning, "kind");
    rules.zones.push_back(kind + " at " + place);
    rules.text += (kind == "preferred" ? ", preferably through " : ", but not through ") + place;
  }
  rules.source = claim_source(utterance);
  return true;
}

/// The next time that the clock shows that. Without "am" or "pm" an hour up to eleven is of either
/// half of the day, but not where it is written as "09:00".
void Dialogue::wait_until(const Meaning& meaning, const Utterance& utterance, Outputs& out) {
  constexpr std::int64_t kMinute = 60;
  constexpr std::int64_t kHour = 60 * kMinute;
  const std::string written = slot(meaning, "hour");
  const double hour = number_of(meaning, "hour");
  const double minute = number_of(meaning, "minute");
  const std::string half = slot(meaning, "half");
  const bool either = half.empty() && hour >= 1.0 && hour < 12.0 && written.front() != '0';
  if (hour != std::floor(hour) || minute != std::floor(minute) || hour >= 24.0 || minute >= 60.0 ||
      (!half.empty() && (hour < 1.0 || hour > 12.0))) {
    refuse(utterance, "I know no such time of the day", out);
    return;
  }
  if (utterance.time <= 0.0) {
    refuse(utterance, "I do not know what time it is", out);
    return;
  }
  const auto now = static_cast<std::int64_t>(utterance.time);
  const auto clock = [&](const char* part) { return std::stoll(local_text(now, part)); };
  const std::int64_t shown = clock("%H") * kHour + clock("%M") * kMinute + clock("%S");
  const std::int64_t turn = (either ? 12 : 24) * kHour;
  const auto whole = static_cast<std::int64_t>(hour);
  const std::int64_t wanted =
      (half.empty() ? whole : whole % 12 + (half == "pm" ? 12 : 0)) * kHour +
      static_cast<std::int64_t>(minute) * kMinute;
  const std::int64_t seconds = (wanted - shown + 2 * turn) % turn;
  const std::string time = local_text(now + seconds, "%H:%M");
  if (static_cast<double>(seconds) > kLongestWait)
    refuse(utterance,
           "no: " + time + " is in " + std::to_string((seconds + kHour - 1) / kHour) +
               " hours, and I wait for ten hours at most",
           out);
  else
    want(with(meaning, "hour", time), utterance, "pause",
         {number("seconds", static_cast<double>(seconds))});
}

bool Dialogue::errand(const Meaning& meaning, const Utterance& utterance,
                      const Situation& situation, Outputs& out) {
  const std::string& functor = meaning.functor;
  // A place that the sentence names, or that of an owner; empty, and said, where there is none.
  const auto where = [&](const char* name) {
    return place_or_refusal(with(meaning, "place", slot(meaning, name)), utterance, situation, out);
  };
  const auto back = [&] { return text("back", bring_to(utterance, situation)); };
  if (functor == "take_way") {
    refuse(utterance, "I find the way myself: say \"go to\" and the place", out);
  } else if (functor == "deliver_here") {
    const bool office = !slot(meaning, "owner").empty();
    const std::string to = office ? where("to") : place_or_person(slot(meaning, "to"), situation);
    const std::string object = thing(slot(meaning, "object"), situation);
    if (object.empty())
      refuse(utterance, kWhichThing, out);
    else if (!to.empty())
      want(with(with(meaning, "to", to), "object",
                object.starts_with("the ") ? object.substr(4) : object),
           utterance, "deliver",
           {text("object", object), text("to", to),
            text("sender", named_person(utterance.speaker))});
  } else if (functor == "tell") {
    const std::string message = part_as_said(slot(meaning, "message"), utterance.text);
    want(with(meaning, "message", message), utterance, "tell",
         {text("person", slot(meaning, "person")), text("message", message),
          text("sender", named_person(utterance.speaker)), back()});
  } else if (functor == "ask_person") {
    const std::string question = part_as_said(slot(meaning, "question"), utterance.text);
    want(meaning, utterance, "inquire",
         {text("person", slot(meaning, "person")), text("question", question),
          text("sender", named_person(utterance.speaker)), back()});
  } else if (functor == "patrol") {
    want(meaning, utterance, "patrol", {});
  } else if (functor == "guide") {
    const std::string person = slot(meaning, "place");
    const bool known = place(person, situation).empty() && !knowledge_.place_of(person).empty();
    const std::string to = known ? knowledge_.place_of(person) : where("place");
    if (!to.empty())
      want(with(with(meaning, "place", to), "owner", ""), utterance, "guide", {text("place", to)});
  } else if (functor == "pause") {
    const std::string name = slot(meaning, "unit");
    const double unit = name.starts_with("hour") ? 3600.0 : name.starts_with("minute") ? 60.0 : 1.0;
    const double seconds = number_of(meaning, "time") * unit;
    if (seconds <= 0.0)
      refuse(utterance, "that is no time to wait", out);
    else if (seconds > kLongestWait)
      refuse(utterance, "no: I wait for ten hours at most", out);
    else
      want(meaning, utterance, "pause", {number("seconds", seconds)});
  } else if (functor == "until") {
    wait_until(meaning, utterance, out);
  } else if (functor == "cannot") {
    refuse(utterance, grammar_.paraphrase(meaning), out);
  } else if (functor == kHold) {
    // Only a stop ends what moves the robot for somebody else.
    const bool moves_for_others =
        situation.is_driven ||
        std::any_of(situation.goals.begin(), situation.goals.end(), [](const KnownGoal& goal) {
          return goal.state == v1::GOAL_UNDERWAY && !goal.asker.empty();
        });
    if (tasks_.task() != nullptr && !moves_for_others)
      want(meaning, utterance, "pause", {number("seconds", kLongestWait)});
    else
      want({"stop", {}}, utterance, "stop", {});
  } else if (functor == "go_on") {
    add(tasks_.go_on(utterance), out);
  } else if (functor == "pace") {
    change_pace(slot(meaning, "change") == "slower", utterance, situation, out);
  } else if (functor == "wait_there") {
    want(meaning, utterance, "pause", {number("seconds", kWaitThere)});
    wanted_.back().brief = false;
  } else if (functor == "come_back" || functor == "go_home") {
    go_back(meaning, utterance, situation, out);
  } else {
    return false;
  }
  return true;
}

}  // namespace saphira::agent_interface

#include "saphira/situation/why.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "saphira/situation/words.hpp"
#include "why_reason.hpp"

namespace saphira::situation {
namespace {

void draw(const Cause& cause, const std::string& indent, std::string& text) {
  for (std::size_t i = 0; i < cause.because.size(); ++i) {
    const bool last = i + 1 == cause.because.size();
    text.append(indent).append(last ? "`- " : "|- ").append(cause.because[i].text).append("\n");
    draw(cause.because[i], indent + (last ? "   " : "|  "), text);
  }
}

nlohmann::ordered_json json_of(const Cause& cause) {
  nlohmann::ordered_json json;
  json["kind"] = cause.kind;
  json["text"] = cause.text;
  json["because"] = nlohmann::ordered_json::array();
  for (const Cause& one : cause.because)
    json["because"].push_back(json_of(one));
  return json;
}

}  // namespace

Explanation Reason::finish(const Sentence& sentence, Cause cause) const {
  Explanation result;
  result.cycle = scene_.cycle;
  if (scene_.grant)
    result.epoch = scene_.grant->stamp.epoch;
  else if (scene_.behaviors)
    result.epoch = scene_.behaviors->stamp.epoch;
  result.sentence = sentence.text();
  result.cause = std::move(cause);
  add_conditions(result.cause);
  return result;
}

void Reason::add_conditions(Cause& cause) const {
  const std::vector<const char*> programs =
      scene_.own_mind ? std::vector{"bridge"} : std::vector{"bridge", "behaviors", "intentions"};
  for (const char* const name : programs)
    if (const Condition how = condition(scene_, name); !how.words.empty())
      cause.because.push_back({"program", std::string(name) + " " + how.words});
  for (const std::string& name : unheard(scene_))
    if (name == "interpretation" || name == "registration")
      cause.because.push_back({"program", name + " " + condition(scene_, name).words});
  if (scene_.past)
    return;
  if (const std::string words = place_trouble(scene_); !words.empty())
    cause.because.push_back({"registration", words});
  // The robot is served with limitations: a bad line, or motors that are off.
  for (const Program& program : scene_.programs)
    if (program.status.name == "bridge" && program.status.state == v1::SERVICE_DEGRADED &&
        !(scene_.grant && scene_.grant->estopped))
      cause.because.push_back({"program", "bridge is degraded: " + program.status.reason});
}

/// The rest that matters for the motion: a place that is lost, motors that are off, a bad line, a
/// program that has just begun.
void Reason::add_troubles(Sentence& sentence) const {
  if (!scene_.past && scene_.robot && scene_.robot->status == v1::MOTORS_NO_POWER && !hindrance() &&
      std::abs(scene_.robot->velocity) < kNoSpeed)
    sentence.add(1, "; its motors are off (saphira device motors on)");
  for (const Program& program : scene_.programs)
    if (!scene_.past && program.status.name == "bridge" &&
        program.status.state == v1::SERVICE_DEGRADED &&
        program.status.reason.find("motors are off") == std::string::npos &&
        !(scene_.grant && scene_.grant->estopped))
      sentence.add(1, "; " + program.status.reason);
  for (const char* const name : {"bridge", "behaviors", "intentions"})
    if (const Condition how = condition(scene_, name); how.health == Health::fresh)
      sentence.add(2, "; " + std::string(name) + " " + how.words);
  for (const std::string& name : unheard(scene_))
    if (!scene_.past && (name == "interpretation" || name == "registration"))
      sentence.add(2, "; " + name + " " + condition(scene_, name).words,
                   "; " + name + " is silent");
  if (is_lost(scene_))
    sentence.add(1, "; the robot does not know where it is on the map", "; it is lost on the map");
  else if (const std::string words = doubt(scene_); !words.empty())
    sentence.add(1, "; " + words, "; it is unsure of its place on the map");
}

Explanation Reason::stopped() const {
  const v1::Grant& grant = *scene_.grant;
  const std::string idle = idle_reason();
  Cause cause{"wheels", "The robot is told to stand", {grant_cause()}};
  Sentence sentence;
  const std::string still = meanwhile();
  sentence.add(0,
               still.empty() ? "The robot stands: " : "The robot is told to stop" + still + ": ");
  struct Part {
    std::string text;
    std::string brief = {};
  };
  std::vector<Part> reasons;
  if (const std::string latch = held(); !latch.empty())
    reasons.push_back({latch});
  else if (grant.stamp.epoch == 0)
    reasons.push_back({grant.reason});
  if (auto age = age_cause()) {
    // A silent program is a reason by itself.
    if (!scene_.behaviors->limit_reason.empty() && condition(scene_, "intentions").heard())
      reasons.push_back({age->text});
    cause.because.push_back(std::move(*age));
  }
  if (!idle.empty()) {
    reasons.push_back({idle, idle_reason(true)});
    cause.because.front().because.push_back({"goal", idle});
  }
  if (const std::string goal = goal_so_far(false); !goal.empty()) {
    reasons.push_back({goal, goal_so_far(true)});
    cause.because.front().because.push_back({"goal", goal});
  }
  if (reasons.empty() && !grant.refused.empty())
    reasons.push_back({"nobody drives it: " + refused(grant.refused.front())});
  if (reasons.empty())
    reasons.push_back({"nobody drives it: " + grant.reason});
  if (!grant.stop_source.empty() && !grant.estopped &&
      std::ranges::none_of(reasons, [&](const Part& part) {
        return part.text.find(grant.stop_source) != std::string::npos;
      })) {
    const std::string last = "the last to stop it was " + grant.stop_source;
    reasons.push_back({last});
    cause.because.front().because.push_back({"grant", last});
  }
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    const std::string separator = i == 0 ? "" : "; ";
    const auto& [text, brief] = reasons[i];
    sentence.add(static_cast<int>(i), separator + text, brief.empty() ? "" : separator + brief);
  }
  add_troubles(sentence);
  return finish(sentence, std::move(cause));
}

Explanation Reason::by_hand() const {
  const v1::Grant& grant = *scene_.grant;
  Sentence sentence;
  if (grant.role == v1::ROLE_ESTOP) {
    sentence.add(0, held());
    sentence.add(1, meanwhile());
  } else {
    sentence.add(0, told());
    sentence.add(2, meanwhile());
    sentence.add(0, ": " + grant.source + " drives it (" + situation::name_of(grant.role) + ")");
    if (grant.command_age >= kOldInput)
      sentence.add(1,
                   format("; its newest command is %.1f s old: the network between it and bridge, "
                          "or a computer, is slow",
                          grant.command_age),
                   format("; its newest command is %.1f s old", grant.command_age));
  }
  Cause cause{"wheels",
              grant.role == v1::ROLE_ESTOP ? "The robot is told to stop" : told(),
              {grant_cause()}};
  if (auto hindered = hindrance(); hindered && grant.role != v1::ROLE_ESTOP) {
    sentence.add(0, "; " + hindered->text);
    cause.because.push_back(std::move(*hindered));
  }
  if (auto guard = guard_cause()) {
    sentence.add(1, "; " + guard->text, "; " + guard_words(true));
    cause.because.push_back(std::move(*guard));
  }
  add_troubles(sentence);
  return finish(sentence, std::move(cause));
}

/// The robot itself is silent: its last state, and the cause of the silence.
Explanation Reason::silent() {
  const Condition bridge = condition(scene_, "bridge");
  Sentence sentence;
  sentence.add(0, "The robot's motion is not known: nothing has been heard of it for " +
                      seconds_text(scene_.silence));
  if (!bridge.words.empty())
    sentence.add(1, "; bridge " + bridge.words,
                 "; bridge " + bridge.words.substr(0, bridge.words.find(" (")));
  if (nothing_known())
    return finish(sentence, {"wheels", "not known"});
  if (const std::string goal = last_known(false); !goal.empty())
    sentence.add(1, "; " + goal, "; " + last_known(true));
  const Explanation before = known_so_far();
  sentence.add(2, "; before that: " + before.sentence.substr(0, before.sentence.size() - 1));
  return finish(sentence, {"wheels", "before that: " + before.cause.text, before.cause.because});
}

Explanation Reason::by_behaviors_unknown() const {
  Sentence sentence;
  Cause cause{"wheels", "not known"};
  const Condition how = condition(scene_, "behaviors");
  if (scene_.grant) {
    sentence.add(0, told());
    sentence.add(2, ": " + scene_.grant->source + " drives it");
    cause = {"wheels", told(), {grant_cause()}};
    if (auto hindered = hindrance()) {
      sentence.add(0, "; " + hindered->text);
      cause.because.push_back(std::move(*hindered));
    }
  } else {
    sentence.add(0, "The robot's command in this cycle is not known");
  }
  sentence.add(
      1, "; its reasons are not known" + (how.words.empty() ? "" : ": behaviors " + how.words),
      how.words.empty() ? "" : "; behaviors " + how.words);
  if (const std::string goal = goal_so_far(false); !goal.empty())
    sentence.add(2, "; " + goal, "; " + goal_so_far(true));
  add_troubles(sentence);
  return finish(sentence, std::move(cause));
}

Explanation Reason::by_behaviors_known() {
  const std::string what = told();
  Sentence sentence;
  sentence.add(0, what);
  sentence.add(1, meanwhile());
  const bool guarded = scene_.grant && scene_.grant->guard != v1::GUARD_NONE;
  const bool aged = age_cause().has_value();
  std::vector<Say> speeds = says(Channel::speed);
  std::vector<Say> turns = says(Channel::turn);
  const auto few = [](std::vector<Say>& all) {
    std::erase_if(all,
                  [](const Say& say) { return say.share < kMentioned || say.weight < kNoSay; });
    if (all.size() > kMostMentioned)
      all.resize(kMostMentioned);
  };
  few(speeds);
  few(turns);
  // Straight on needs no reason unless some behavior wanted to turn.
  std::erase_if(turns, [](const Say& say) { return std::abs(say.behavior->turn) < kNoTurn; });
  if (std::abs(told_turn()) < kNoTurn && turns.size() < 2)
    turns.clear();
  std::vector<const v1::BehaviorState*> mentioned;
  for (const std::vector<Say>* const all : {&speeds, &turns})
    for (const Say& say : *all)
      if (std::ranges::find(mentioned, say.behavior) == mentioned.end())
        mentioned.push_back(say.behavior);

  const char* separator = ": ";
  const auto add = [&](int rank, const std::string& text, const std::string& brief = {}) {
    sentence.add(rank, separator + text, brief.empty() ? "" : separator + brief);
    separator = ", ";
  };
  if (const auto hindered = hindrance())
    add(0, hindered->text);
  if (guarded)
    add(1, guard_cause()->text, guard_words(true));
  if (aged) {
    const std::string age = age_cause()->text;
    add(1, age, age.substr(0, std::min(age.find(", and"), age.find(" (slow "))));
  }
  int rank = 2;
  for (const v1::BehaviorState* behavior : mentioned) {
    add(rank, wants(speeds, turns, *behavior, true), wants(speeds, turns, *behavior, false));
    rank = 4;
  }
  if (speeds.empty() && !guarded && scene_.behaviors->limit_reason.empty()) {
    // The rest of an earlier speed decreases by itself.
    add(rank, std::abs(told_speed()) >= kNoSpeed
                  ? "it slows down, no behavior wants a speed any more"
                  : "no behavior wants a speed");
  }
  add_purpose(sentence, mentioned);
  Cause cause = wheels(what);
  if (const std::string way = detour(); !way.empty()) {
    sentence.add(1, "; " + way);
    cause.because.push_back({"zone", way});
  }
  add_troubles(sentence);
  return finish(sentence, std::move(cause));
}

Explanation Reason::known_so_far() {
  if (nothing_known()) {
    Sentence sentence;
    sentence.add(0, "Nothing is known of this cycle");
    // Without the bridge's robot the other programs wait as well.
    const Condition bridge = condition(scene_, "bridge");
    if (!scene_.past)
      if (const std::string wrong = trouble(scene_); !wrong.empty())
        sentence.add(0, ": " + wrong, bridge.words.empty() ? "" : ": bridge " + bridge.words);
    return finish(sentence, {"wheels", "nothing is known"});
  }
  if (scene_.grant && scene_.grant->role == v1::ROLE_NONE)
    return stopped();
  if (!by_behaviors())
    return by_hand();
  return scene_.behaviors ? by_behaviors_known() : by_behaviors_unknown();
}

Explanation Reason::why() {
  // A bridge that looks for its robot anew grants cycles of no robot: the newest is not known then.
  const bool heard_before = scene_.robot || scene_.grant || scene_.now > 0;
  if (!scene_.past && scene_.silence > kSilence && heard_before)
    return silent();
  return known_so_far();
}

Explanation why(const Situation& situation) {
  return Reason(situation).why();
}

Explanation why_not(const Situation& situation, Wish wish) {
  return Reason(situation).why_not(wish);
}

std::optional<Wish> parse_wish(const std::vector<std::string>& words) {
  const std::string text = listed(words, " ");
  if (text == "turn left")
    return Wish::turn_left;
  if (text == "turn right")
    return Wish::turn_right;
  if (text == "faster")
    return Wish::faster;
  if (text == "slower")
    return Wish::slower;
  return std::nullopt;
}

std::string to_text(const Explanation& explanation) {
  std::string text = explanation.sentence + "\n\n" + "cycle " + std::to_string(explanation.cycle) +
                     ": " + explanation.cause.text + "\n";
  draw(explanation.cause, "", text);
  return text;
}

std::string to_json(const Explanation& explanation) {
  nlohmann::ordered_json json;
  json["epoch"] = explanation.epoch;
  json["cycle"] = explanation.cycle;
  json["sentence"] = explanation.sentence;
  json["tree"] = json_of(explanation.cause);
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace saphira::situation

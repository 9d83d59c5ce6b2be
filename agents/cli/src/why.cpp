#include "saphira/cli/why.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "saphira/cli/words.hpp"
#include "why_reason.hpp"

namespace saphira::cli {
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

Explanation Reason::finish(std::string sentence, Cause cause) const {
  Explanation result;
  result.cycle = scene_.cycle;
  if (scene_.behaviors)
    result.epoch = scene_.behaviors->stamp().epoch();
  else if (scene_.grant)
    result.epoch = scene_.grant->stamp().epoch();
  result.sentence = std::move(sentence) + ".";
  result.cause = std::move(cause);
  return result;
}

Explanation Reason::stopped() const {
  const v1::Grant& grant = *scene_.grant;
  const std::string idle = idle_reason();
  std::string sentence = "The robot stands because nobody drives it: " + grant.reason();
  Cause cause{"wheels", "The robot is told to stand", {grant_cause()}};
  if (grant.waits_for_hand_back() && grant.reason().find("hand-back") == std::string::npos)
    sentence += "; " + latched(grant);
  if (auto age = age_cause()) {
    if (!scene_.behaviors->limit_reason().empty())
      sentence += "; " + age->text;
    cause.because.push_back(std::move(*age));
  }
  if (!idle.empty()) {
    sentence += "; " + idle;
    cause.because.front().because.push_back({"goal", idle, {}});
  }
  return finish(std::move(sentence), std::move(cause));
}

Explanation Reason::by_hand() const {
  const v1::Grant& grant = *scene_.grant;
  std::string sentence;
  if (grant.role() == v1::ROLE_ESTOP)
    sentence = "The robot is told to stop: " + latched(grant);
  else
    sentence = "The robot is told to drive at " + speed_text(grant.velocity()) + " because " +
               grant.source() + " drives it (" + cli::name_of(grant.role()) + ")";
  Cause cause{"wheels", sentence, {grant_cause()}};
  if (auto guard = guard_cause()) {
    sentence += "; " + guard->text;
    cause.because.push_back(std::move(*guard));
  }
  return finish(std::move(sentence), std::move(cause));
}

Explanation Reason::why() {
  if (!scene_.robot && !scene_.grant && !scene_.behaviors)
    return finish("Nothing is known of this cycle" +
                      (scene_.missing.empty() ? "" : ": not on the bus: " + scene_.missing),
                  {"wheels", "nothing is known", {}});
  if (scene_.grant && scene_.grant->role() == v1::ROLE_NONE)
    return stopped();
  if (scene_.grant && scene_.grant->role() != v1::ROLE_BEHAVIORS)
    return by_hand();
  if (!scene_.behaviors)
    return finish("What the behaviors computed in this cycle is not known",
                  {"wheels", "not known",
                   scene_.grant ? std::vector<Cause>{grant_cause()} : std::vector<Cause>{}});

  const std::string what = told();
  std::string sentence = what;
  std::vector<const v1::BehaviorState*> mentioned;
  const auto mention = [&](const Say& say) {
    if (std::find(mentioned.begin(), mentioned.end(), say.behavior) == mentioned.end())
      mentioned.push_back(say.behavior);
  };
  std::vector<std::string> reasons;
  const bool guarded = scene_.grant && scene_.grant->guard() != v1::GUARD_NONE;
  if (guarded)
    reasons.push_back(guard_cause()->text);
  if (!scene_.behaviors->limit_reason().empty())
    reasons.push_back(age_cause()->text);
  const double turn = scene_.behaviors->turning() ? scene_.behaviors->turn() : 0.0;
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
  // Going straight on needs no reason unless somebody wanted something else.
  std::erase_if(turns, [](const Say& say) { return std::abs(say.behavior->turn()) < kNoTurn; });
  if (std::abs(turn) < kNoTurn && turns.size() < 2)
    turns.clear();
  for (const Say& say : speeds)
    mention(say);
  for (const Say& say : turns)
    mention(say);
  for (const v1::BehaviorState* behavior : mentioned)
    reasons.push_back(wants(speeds, turns, *behavior));
  if (speeds.empty() && !guarded)
    reasons.emplace_back("no behavior wants a speed");
  sentence += ", because " + listed(reasons, ", and ");
  if (const std::string what_for = purpose(mentioned); !what_for.empty())
    sentence += "; " + what_for;
  return finish(std::move(sentence), wheels(what));
}

Explanation why(const Scene& scene) {
  return Reason(scene).why();
}

Explanation why_not(const Scene& scene, Wish wish) {
  return Reason(scene).why_not(wish);
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

}  // namespace saphira::cli

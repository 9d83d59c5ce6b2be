#include "saphira/situation/situation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "saphira/idl/goal_words.hpp"
#include "saphira/situation/words.hpp"
#include "why_words.hpp"

namespace saphira::situation {
namespace {

constexpr std::array kMakeItGo{"bridge", "behaviors", "intentions"};
constexpr std::array kPrograms{"bridge", "behaviors", "intentions", "interpretation",
                               "registration"};

constexpr std::uint64_t kLateCycles = 3;   // behind: worth mentioning
constexpr std::uint64_t kHungCycles = 10;  // behind: no more samples come
constexpr double kListened = 1.0;          // [s] of listening after which silence counts
constexpr double kFresh = 5.0;             // [s] after its start
constexpr double kNoStep = 3.0;            // [s] the status is published once a second
constexpr std::uint64_t kNoSteps = 30;     // [cycles] in single step a robot may stand for any time
constexpr std::uint64_t kLongRun = 100;    // [cycles] of the robot: a fresh program is late

/// The newest instance that is heard, rather not the copy of a second deployment, which only waits;
/// otherwise the one that was heard last.
const Program* find(const std::vector<Program>& programs, const std::string& name) {
  const Program* found = nullptr;
  const auto better = [](const Program& a, const Program& b) {
    const bool heard = a.age <= kLostAge;
    if (heard != (b.age <= kLostAge))
      return heard;
    if (heard && a.namesake != b.namesake)
      return b.namesake;
    return heard ? a.status.uptime < b.status.uptime : a.age < b.age;
  };
  for (const Program& program : programs)
    if (program.status.name == name && (found == nullptr || better(program, *found)))
      found = &program;
  return found;
}

std::string of_several(const std::string& words, std::size_t count) {
  if (count > 1 && words.starts_with("is "))
    return "are " + words.substr(3);
  if (count > 1 && words.starts_with("has "))
    return "have " + words.substr(4);
  return words;
}

struct Expected {
  Known known;
  std::uint64_t cycle = 0;  ///< the expected sample
  bool there = false;
};

/// The cyclic topic of a program; nothing: unknown for this one.
std::optional<Expected> expected(const Situation& s, const std::string& program) {
  if (program == "behaviors")
    return Expected{s.behaviors_known, s.cycle, s.behaviors.has_value()};
  if (program == "intentions")
    return Expected{s.intentions_known, s.cycle > 0 ? s.cycle - 1 : 0, s.intentions.has_value()};
  return std::nullopt;
}

/// The evidence of others that a program is gone, in words: their last word from it, or the samples
/// that they miss. It needs nothing that the program keeps itself. Empty: nobody misses it.
std::string missed(const Situation& s, const std::string& name) {
  if (name == "intentions" && s.behaviors && s.behaviors->input_age >= kListened)
    return "behaviors has heard nothing of it for " + seconds_text(s.behaviors->input_age);
  if (name == "behaviors" && s.behaviors_drove > 0)
    return "it last drove " + seconds_text(seconds_of(s.now - std::min(s.now, s.behaviors_drove))) +
           " ago";
  if (name == "bridge") {
    for (const Program& other : s.programs)
      if (other.age <= kLostAge && other.status.state == v1::SERVICE_WAITING &&
          other.status.reason.starts_with("waits for robot/state"))
        return other.status.name + " " + other.status.reason;
    return {};
  }
  const std::string topic = name == "interpretation" ? "perception"
                            : name == "behaviors"    ? "behaviors/state"
                                                     : name;
  for (const Program& other : s.programs)
    for (const char* const runs : {"runs without ", "runs on an old sample of "})
      if (other.age <= kLostAge && other.status.state == v1::SERVICE_DEGRADED &&
          other.status.reason.find(runs + topic) != std::string::npos)
        return other.status.name + " " + other.status.reason;
  return {};
}

/// In a past cycle only the samples of that time count.
Condition past_condition(const Situation& s, const std::string& program) {
  const auto wanted = expected(s, program);
  if (!wanted)
    return program == "bridge" && !s.grant
               ? Condition{Health::unknown, "has left nothing of this cycle"}
               : Condition{};
  if (wanted->there)
    return {};
  const auto& [oldest, newest] = wanted->known;
  if (const Program* const now = find(s.programs, program))
    if (now->age <= kLostAge &&
        now->status.uptime < seconds_of(s.now - std::min(s.now, wanted->cycle)))
      return {Health::unknown, "was started again " + seconds_text(now->status.uptime) +
                                   " ago: its record of cycle " + std::to_string(wanted->cycle) +
                                   " is gone with that"};
  if (newest == 0)
    return {Health::unknown,
            "has left nothing of the last minute: it was not there, or ended since"};
  if (wanted->cycle < oldest)
    return {Health::unknown, "has kept nothing from before cycle " + std::to_string(oldest) +
                                 ": it was not there then, or was started again since"};
  if (wanted->cycle > newest)
    return {Health::hung, "has said nothing since cycle " + std::to_string(newest)};
  return {Health::late, "left this cycle out"};
}

/// The samples of a program come, though its status may be late.
bool steps(const Situation& s, const Known& known) {
  return known.newest > 0 && s.now < known.newest + kHungCycles && s.silence <= kListened;
}

constexpr const char* kSlow = " (it hangs, or the network is slow)";

bool is_found(const Situation& s, const std::string& name) {
  return std::ranges::find(s.found, name) != s.found.end();
}

/// That of one instance. The cyclic samples have no mark of their writer: they count for the
/// instance that `counts`.
Condition present_condition(const Situation& s, const Program& program, bool counts) {
  const auto wanted = counts ? expected(s, program.status.name) : std::nullopt;
  if (program.age > kLostAge && is_found(s, program.status.name))
    return {Health::late, "has not reported for " + seconds_text(program.age) + kSlow};
  if (program.age > kLostAge && !(wanted && steps(s, wanted->known)))
    return {Health::lost, "has not been heard for " + seconds_text(program.age) +
                              " (it is dead, hangs, or is cut off)"};
  const v1::ServiceStatus& status = program.status;
  if (status.state == v1::SERVICE_STARTING || status.state == v1::SERVICE_WAITING)
    return {Health::waiting, std::string("is ") + name_of(status.state) +
                                 (status.reason.empty() ? "" : ": " + status.reason)};
  if (wanted && s.now > 0 && s.listened >= kListened) {
    if (wanted->known.newest == 0)
      return {Health::hung, "is on the bus, and says nothing (it hangs, or is cut off)"};
    const std::uint64_t behind = s.now - std::min(s.now, wanted->known.newest);
    if (behind >= kHungCycles)
      return {Health::hung, "has said nothing for " + seconds_text(seconds_of(behind)) +
                                " (it hangs, or is cut off)"};
    if (behind >= kLateCycles)
      return {Health::late, "is " + seconds_text(seconds_of(behind)) + " behind"};
  } else if (const v1::Stamp& newest = status.stamp; newest.cycle > 0 &&
                                                     s.robot_epoch() == newest.epoch &&
                                                     s.now >= newest.cycle + kNoSteps) {
    const double silence = s.pace > 0.0 ? static_cast<double>(s.now - newest.cycle) / s.pace : 0.0;
    if (silence >= kNoStep)
      return {Health::hung, "has taken no step for " + seconds_text(silence) +
                                " (it hangs, or waits for its inputs)"};
  }
  if (status.uptime < kFresh && status.stamp.cycle > kLongRun)
    return {Health::fresh, "was started " + seconds_text(status.uptime) + " ago"};
  return {};
}

Condition present_condition(const Situation& s, const std::string& name) {
  const Program* const program = find(s.programs, name);
  if (program != nullptr)
    return present_condition(s, *program, true);
  // A present program may not have published yet.
  if (s.listened < kListened)
    return {};
  if (is_found(s, name))
    return {Health::late, std::string("is on the bus, and has not reported yet") + kSlow};
  const auto wanted = expected(s, name);
  if (wanted && steps(s, wanted->known))
    return {};
  const std::uint64_t newest = wanted ? wanted->known.newest : 0;
  std::string evidence =
      newest == 0
          ? missed(s, name)
          : "its last was " + seconds_text(seconds_of(s.now - std::min(s.now, newest))) + " ago";
  if (evidence.empty())
    evidence = "listened for " + seconds_text(s.listened);
  return {Health::absent, "is not heard (not running, hung, or cut off; " + evidence + ")"};
}

/// The programs of the robot with their conditions, without those that a deployment may leave out:
/// a robot can do without interpretation and registration, unless others miss them.
std::vector<std::pair<std::string, Condition>> conditions(const Situation& s) {
  std::vector<std::pair<std::string, Condition>> all;
  for (const char* const name : kPrograms) {
    const Condition how = condition(s, name);
    const bool needed = std::ranges::find(kMakeItGo, std::string_view(name)) != kMakeItGo.end();
    if (needed || how.health == Health::hung || how.health == Health::lost ||
        (how.health == Health::absent && !missed(s, name).empty()))
      all.emplace_back(name, how);
  }
  return all;
}

nlohmann::ordered_json json_of(const Situation& s, const Program& program) {
  const v1::ServiceStatus& status = program.status;
  const bool counts = &program == find(s.programs, status.name);
  const Condition how =
      s.past ? past_condition(s, status.name) : present_condition(s, program, counts);
  nlohmann::ordered_json json;
  json["name"] = status.name;
  json["state"] = program.age > kLostAge ? "lost" : name_of(status.state);
  json["reason"] = status.reason;
  json["condition"] = how.words;
  json["age"] = program.age;
  json["epoch"] = status.stamp.epoch;
  json["cycle"] = status.stamp.cycle;
  json["late_cycles"] = status.late_cycles;
  json["step_ms_mean"] = status.step_ms_mean;
  json["step_ms_max"] = status.step_ms_max;
  json["cpu_percent"] = status.cpu_percent;
  json["rss_mb"] = status.rss_mb;
  json["uptime"] = status.uptime;
  json["host"] = status.host;
  json["clock_behind"] = program.clock_behind;
  json["pid"] = status.pid;
  return json;
}

}  // namespace

std::string clocks_apart(const std::vector<Program>& programs) {
  constexpr double kApart = 1.5;  // [s] a status may be a second old
  std::map<std::string, double> machines;
  for (const Program& program : programs)
    if (std::abs(program.clock_behind) > kApart)
      machines.emplace(program.status.host, program.clock_behind);
  std::string text;
  for (const auto& [host, behind] : machines)
    text += "clock: that of " + host + " is " + seconds_text(std::abs(behind)) +
            (behind > 0.0 ? " behind" : " ahead of") +
            " this machine's: times of logs and of certificates do not fit; a time server (NTP) on "
            "both sides helps\n";
  return text;
}

bool is_doubtful(const v1::Registration& registration) {
  constexpr double kDoubtful = 0.5;  // the confidence of an unconfirmed place is no greater
  return registration.state == v1::REGISTRATION_TRACKING && registration.confidence < kDoubtful;
}

Condition condition(const Situation& situation, const std::string& program) {
  return situation.past ? past_condition(situation, program)
                        : present_condition(situation, program);
}

bool is_lost(const Situation& situation) {
  if (situation.past || !situation.registration)
    return false;
  const v1::RegistrationState state = situation.registration->state;
  return state == v1::REGISTRATION_LOST || state == v1::REGISTRATION_UNPLACED;
}

std::string doubt(const Situation& situation) {
  if (situation.past || !situation.registration || !is_doubtful(*situation.registration))
    return {};
  const v1::Registration& place = *situation.registration;
  const std::uint64_t since = situation.doubtful_since;
  return format("the robot is %.0f %% sure of its place on the map", 100.0 * place.confidence) +
         (since == 0
              ? ""
              : ", in doubt for " + seconds_text(seconds_of(place.stamp.cycle -
                                                            std::min(place.stamp.cycle, since)))) +
         (place.reason.empty() ? "" : ": " + place.reason);
}

std::string place_trouble(const Situation& situation) {
  if (!is_lost(situation))
    return doubt(situation);
  const v1::Registration& place = *situation.registration;
  return format("the robot does not know where it is on the map, %.0f %% sure",
                100.0 * place.confidence) +
         (place.reason.empty() ? "" : " (" + place.reason + ")") + ": saphira map place X Y TH" +
         (place.state == v1::REGISTRATION_LOST ? ", or saphira map find" : "");
}

std::string trouble(const Situation& situation) {
  // The same trouble of several programs is stated once.
  std::vector<std::pair<std::string, std::vector<std::string>>> all;
  for (const auto& [name, how] : conditions(situation)) {
    if (how.health == Health::running || how.health == Health::fresh)
      continue;
    if (all.empty() || all.back().first != how.words)
      all.push_back({how.words, {}});
    all.back().second.push_back(name);
  }
  std::string text;
  for (const auto& [words, names] : all)
    text += (text.empty() ? "" : "; ") + listed(names) + " " + of_several(words, names.size());
  return text;
}

std::string all_trouble(const Situation& situation) {
  std::string text = trouble(situation);
  if (const std::string place = place_trouble(situation); !place.empty())
    text += (text.empty() ? "" : "; ") + place;
  return text;
}

std::vector<std::string> unheard(const Situation& situation) {
  std::vector<std::string> all;
  for (const auto& [name, how] : conditions(situation))
    if (how.health == Health::hung || how.health == Health::lost || how.health == Health::absent)
      all.push_back(name);
  return all;
}

bool misses(const Situation& situation) {
  return std::ranges::any_of(kPrograms, [&](const char* const name) {
    return find(situation.programs, name) == nullptr && !missed(situation, name).empty();
  });
}

bool is_heard(const std::vector<Program>& programs, const std::string& name) {
  const Program* const program = find(programs, name);
  return program != nullptr && program->age <= kLostAge;
}

std::string suspended(const Situation& situation) {
  std::string text;
  for (const v1::ProcessSet& service : situation.processes)
    for (const v1::Process& process : service.processes)
      // A task that was suspended later was not suspended then; one resumed since cannot be told
      // apart.
      if (process.state == v1::PROCESS_SUSPENDED &&
          (!situation.past || process.since <= situation.cycle))
        text += (text.empty() ? "" : ", ") + process.name + " of " + service.service;
  return text;
}

std::string driver(const Situation& situation) {
  const Condition bridge = condition(situation, "bridge");
  const std::string why = bridge.words.empty() ? "" : ": bridge " + bridge.words;
  if (!situation.grant)
    return "which program drives is not known" + why;
  if (situation.silence > kListened && bridge.health >= Health::waiting)
    return "which program drives is not known any more" + why;
  v1::Grant grant = *situation.grant;
  // The bridge hears commands alone, and does not know who would give some.
  if (grant.role == v1::ROLE_NONE && grant.reason == "nothing asks the robot to move")
    if (const std::string missing = trouble(situation); !missing.empty())
      grant.reason = missing;
  return describe(grant);
}

std::string to_json(const Situation& situation) {
  nlohmann::ordered_json json;
  json["programs"] = nlohmann::ordered_json::array();
  for (const Program& program : situation.programs)
    json["programs"].push_back(json_of(situation, program));
  json["drive"] = {{"known", situation.grant.has_value()}, {"text", driver(situation)}};
  if (situation.grant) {
    const v1::Grant& grant = *situation.grant;
    json["drive"]["role"] = name_of(grant.role);
    json["drive"]["source"] = grant.source;
    json["drive"]["reason"] = grant.reason;
    json["drive"]["velocity"] = grant.velocity;
    json["drive"]["rotation_velocity"] = grant.rotation_velocity;
    json["drive"]["estopped"] = grant.estopped;
    json["drive"]["waits_for_hand_back"] = grant.waits_for_hand_back;
  }
  json["goals"] = nlohmann::ordered_json::array();
  for (const v1::GoalStatus& status : situation.statuses)
    json["goals"].push_back({{"functor", status.functor},
                             {"requester", status.requester},
                             {"state", word_of(status.state)},
                             {"reason", status.reason},
                             {"step", status.step},
                             {"progress", status.progress}});
  json["missing"] = listed(unheard(situation));
  json["trouble"] = all_trouble(situation);
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace saphira::situation

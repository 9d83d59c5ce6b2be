#include "table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "office.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/situation/sentence.hpp"
#include "saphira/situation/why.hpp"

namespace saphira::situation::test {
namespace {

std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts)
    text += (text.empty() ? "" : "<br>") + part;
  return text.empty() ? "-" : text;
}

std::uint64_t cycles(double seconds) {
  return static_cast<std::uint64_t>(std::lround(seconds * 10.0));
}

/// The words of a change, and the rest of its line.
class Words {
 public:
  explicit Words(const std::string& line) : in_(line) { in_ >> name; }
  std::string word() {
    std::string next;
    in_ >> next;
    return next;
  }
  double number() {
    const std::string next = word();
    std::size_t end = 0;
    const double value = next.empty() ? 0.0 : std::stod(next, &end);
    if (next.empty() || end != next.size())
      throw std::invalid_argument(name + ": expected a number, not \"" + next + "\"");
    return value;
  }
  std::string rest() {
    std::string text;
    std::getline(in_ >> std::ws, text);
    return text;
  }
  std::string name;

 private:
  std::istringstream in_;
};

template <class Enum>
Enum one_of(Words& words, const std::vector<std::pair<const char*, Enum>>& all) {
  const std::string word = words.word();
  for (const auto& [name, value] : all)
    if (word == name)
      return value;
  throw std::invalid_argument(words.name + ": \"" + word + "\" is none of its words");
}

v1::GoalState goal_state(Words& words) {
  return one_of<v1::GoalState>(words, {{"underway", v1::GOAL_UNDERWAY},
                                       {"succeeded", v1::GOAL_SUCCEEDED},
                                       {"failed", v1::GOAL_FAILED},
                                       {"refused", v1::GOAL_REFUSED},
                                       {"canceled", v1::GOAL_CANCELED},
                                       {"waiting", v1::GOAL_WAITING},
                                       {"suspended", v1::GOAL_SUSPENDED}});
}

/// The samples of the program that are known, and its sample of the cycle.
Known& known(Situation& s, const std::string& program) {
  return program == "behaviors" ? s.behaviors_known : s.intentions_known;
}
void forget(Situation& s, const std::string& program, Known recalled) {
  if (program == "behaviors") {
    s.behaviors.reset();
  } else {
    s.intentions.reset();
    s.statuses_known = s.statuses_known && !s.past;
  }
  known(s, program) = recalled;
}

/// A program stopped `time` [s] before the command began: no sample of it comes, not even a latched
/// one. The samples of other programs stay, and the goals of the requesters.
void stopped_before(Situation& s, const std::string& program, double time) {
  remove(s, program);
  if (program == "intentions") {
    forget(s, program, {});
    s.statuses.clear();
    s.statuses_known = false;
    s.behaviors->input_age = time;
    s.behaviors->speed_limit = -1.0;
    s.behaviors->limit_reason = "no newer intent has come for " + std::to_string(cycles(time)) +
                                " cycles: intentions, or the network to it, is gone";
    return;
  }
  v1::ServiceStatus& other = find(s, "intentions").status;
  other.state = v1::SERVICE_DEGRADED;
  other.reason = "runs on an old sample of " + program;
  if (program == "interpretation")
    other.reason = "runs on an old sample of perception";
  if (program == "behaviors") {
    forget(s, program, {});
    other.reason += "/state";
    s.behaviors_drove = s.now - cycles(time);
  }
}

void place(Situation& s, v1::RegistrationState state, double confidence,
           const std::string& reason) {
  s.registration.emplace();
  s.registration->stamp = s.robot->stamp;
  s.registration->state = state;
  s.registration->confidence = confidence;
  s.registration->reason = reason;
}

using Change = void (*)(Situation&, Words&);
const std::map<std::string, Change>& changes() {
  static const std::map<std::string, Change> all{
      // The robot and its driver.
      {"velocity", [](Situation& s, Words& w) { s.robot->velocity = w.number(); }},
      {"turning", [](Situation& s, Words& w) { s.robot->rotation_velocity = radians(w.number()); }},
      {"told", [](Situation& s, Words& w) { s.grant->velocity = w.number(); }},
      {"stand", [](Situation& s, Words& w) { stand(s, w.rest()); }},
      {"keyboard",
       [](Situation& s, Words& w) {
         const double velocity = w.number();
         by_keyboard(s, velocity, radians(w.number()));
       }},
      {"heading",
       [](Situation& s, Words& w) {
         s.grant->rotation = v1::ROTATION_HEADING;
         s.grant->heading = radians(w.number());
         s.robot->pose_in_odom.th = radians(w.number());
       }},
      {"direct",
       [](Situation& s, Words& w) {
         s.grant->role = v1::ROLE_DIRECT;
         s.grant->source = w.rest();
       }},
      {"estop",
       [](Situation& s, Words& w) {
         s.grant->role = v1::ROLE_ESTOP;
         s.grant->estopped = true;
         s.grant->estop_source = w.rest();
       }},
      {"estop-age", [](Situation& s, Words& w) { s.estopped_since = s.now - cycles(w.number()); }},
      {"stall-age", [](Situation& s, Words& w) { s.stalled_since = s.now - cycles(w.number()); }},
      {"host",
       [](Situation& s, Words& w) {
         Program& program = find(s, w.word());
         program.status.host = w.word();
       }},
      {"stopped-by",
       [](Situation& s, Words& w) {
         s.grant->stop.number = 1;
         s.grant->stop_source = w.rest();
       }},
      {"waits-for-hand-back", [](Situation& s, Words&) { s.grant->waits_for_hand_back = true; }},
      {"refused",
       [](Situation& s, Words& w) {
         v1::Refusal refusal;
         refusal.role = v1::ROLE_BEHAVIORS;
         refusal.source = "behaviors";
         refusal.reason = w.rest();
         s.grant->refused.push_back(refusal);
       }},
      {"guard",
       [](Situation& s, Words& w) {
         const auto action = one_of<v1::GuardAction>(
             w, {{"stop", v1::GUARD_STOP}, {"slow", v1::GUARD_SLOW}, {"limit", v1::GUARD_LIMIT}});
         const double velocity = w.number();
         guard(s, action, w.rest(), velocity);
       }},
      {"limit",
       [](Situation& s, Words& w) {
         s.behaviors->speed_limit = w.number();
         s.behaviors->limit_reason = w.rest();
         if (s.behaviors->speed_limit < 0.0)
           return;
         s.behaviors->speed = s.grant->velocity = s.robot->velocity = s.behaviors->speed_limit;
       }},
      {"ages",
       [](Situation& s, Words& w) {
         s.behaviors->input_age = w.number();
         s.grant->command_age = w.number();
       }},
      {"motors-off",
       [](Situation& s, Words&) {
         s.robot->status = v1::MOTORS_NO_POWER;
         s.robot->velocity = 0.0;
         find(s, "bridge").status.state = v1::SERVICE_DEGRADED;
         find(s, "bridge").status.reason =
             "the robot's motors are off (its own button, or: saphira device motors on)";
       }},
      {"stalled",
       [](Situation& s, Words& w) {
         (w.word() == "left" ? s.robot->left_stalled : s.robot->right_stalled) = true;
       }},
      {"no-robot",
       [](Situation& s, Words& w) {
         s.grant->stamp.epoch = 0;
         s.grant->reason = w.rest();
       }},
      // Behaviors, intentions and goals.
      {"straight",
       [](Situation& s, Words&) {
         auto& behaviors = s.behaviors->behaviors;
         behaviors.erase(behaviors.begin());
         behaviors[0].recommends_turn = false;
         s.behaviors->turning = false;
       }},
      {"no-behaviors",
       [](Situation& s, Words&) {
         s.behaviors->behaviors.clear();
         s.behaviors->turning = false;
         s.behaviors->moving = false;
       }},
      {"no-intended",
       [](Situation& s, Words&) {
         s.intentions->behaviors.clear();
         s.intentions->nodes.clear();
       }},
      {"follows-path",
       [](Situation& s, Words&) {
         v1::IntentionNode& node = s.intentions->nodes[0];
         node.schema = "follow-path";
         node.label = "TROUBLE";
         node.step = "waits until the leg is done";
       }},
      {"control-off", [](Situation& s, Words&) { s.intentions->behavior_control = false; }},
      {"suspend", [](Situation& s, Words& w) { suspend(s, std::stoul(w.word())); }},
      {"goal",
       [](Situation& s, Words& w) {
         s.goals = driving().goals;
         const v1::GoalState state = goal_state(w);
         s.statuses = {goal_status(state, w.rest())};
       }},
      {"functor", [](Situation& s, Words& w) { s.statuses[0].functor = w.rest(); }},
      {"requester",
       [](Situation& s, Words& w) {
         s.goals.clear();
         s.statuses[0].requester = w.rest();
       }},
      {"step", [](Situation& s, Words& w) { s.statuses[0].step = w.rest(); }},
      {"goal-age",
       [](Situation& s, Words& w) { s.statuses[0].stamp.cycle = s.now - cycles(w.number()); }},
      {"goal-epoch",
       [](Situation& s, Words& w) { s.statuses[0].stamp.epoch = std::stoul(w.word()); }},
      {"goals-unknown",
       [](Situation& s, Words&) {
         s.goals.clear();
         s.statuses.clear();
         s.statuses_known = false;
       }},
      {"long-names",
       [](Situation& s, Words&) {
         s.goals[0].functor = "go-to-place";
         s.goals[0].arguments[0].kind = v1::ARGUMENT_TEXT;
         s.goals[0].arguments[0].text = std::string(200, 'x');
         s.goals[0].requester = "the calendar of the third floor";
       }},
      // Programs: their samples ended some seconds ago; their status is so old; and so on.
      {"silent",
       [](Situation& s, Words& w) {
         const std::string program = w.word();
         forget(s, program, {known(s, program).oldest, s.now - cycles(w.number())});
       }},
      {"forgotten",
       [](Situation& s, Words& w) {
         const std::string program = w.word();
         forget(s, program, {});
         if (program == "intentions") {
           s.statuses.clear();
           s.goals.clear();
           s.statuses_known = false;
         }
       }},
      {"stopped-before-we-came",
       [](Situation& s, Words& w) {
         const std::string program = w.word();
         stopped_before(s, program, w.number());
       }},
      {"status-late", [](Situation& s, Words& w) { remove(s, w.word()); }},
      {"goal-asked-by-one-who-left", [](Situation& s, Words&) { s.goals.clear(); }},
      {"just-forgotten",
       [](Situation& s, Words& w) {
         forget(s, w.word(), {s.now, s.now});
       }},
      {"recalls",
       [](Situation& s, Words& w) {
         const std::string program = w.word();
         const std::uint64_t oldest = std::stoul(w.word());
         forget(s, program, {oldest, std::stoul(w.word())});
       }},
      {"lost",
       [](Situation& s, Words& w) {
         Program& program = find(s, w.word());
         program.age = w.number();
       }},
      {"absent", [](Situation& s, Words& w) { remove(s, w.word()); }},
      {"uptime",
       [](Situation& s, Words& w) {
         Program& program = find(s, w.word());
         program.status.uptime = w.number();
       }},
      {"no-step",
       [](Situation& s, Words& w) {
         Program& program = find(s, w.word());
         program.status.stamp.cycle = s.now - cycles(w.number());
       }},
      {"state",
       [](Situation& s, Words& w) {
         Program& program = find(s, w.word());
         program.status.state = one_of<v1::ServiceState>(
             w, {{"waiting", v1::SERVICE_WAITING}, {"degraded", v1::SERVICE_DEGRADED}});
         program.status.reason = w.rest();
       }},
      {"searching",
       [](Situation& s, Words&) {
         for (const char* const name : {"bridge", "behaviors", "intentions"}) {
           Program one = program(name);
           one.status.state = v1::SERVICE_WAITING;
           one.status.reason = "waits for robot/state of cycle 162";
           s.programs.push_back(one);
         }
         find(s, "bridge").status.reason =
             "waits for the robot to answer SYNC0 (is it switched on, and the cable in?)";
       }},
      // Place, time and listening.
      {"place-known", [](Situation& s, Words&) { place(s, v1::REGISTRATION_TRACKING, 0.97, ""); }},
      {"place-lost",
       [](Situation& s, Words&) {
         place(s, v1::REGISTRATION_LOST, 0.0, "nothing that it hears fits the map");
       }},
      {"place-doubtful",
       [](Situation& s, Words& w) {
         place(s, v1::REGISTRATION_TRACKING, 0.3, "the readings hardly fit the map");
         const std::uint64_t since = cycles(w.number());
         s.doubtful_since = since == 0 ? 0 : s.now - since;
       }},
      {"past",
       [](Situation& s, Words& w) {
         s.past = true;
         s.cycle = std::stoul(w.word());
       }},
      {"now", [](Situation& s, Words& w) { s.now = std::stoul(w.word()); }},
      {"silence", [](Situation& s, Words& w) { s.silence = w.number(); }},
      {"listened", [](Situation& s, Words& w) { s.listened = w.number(); }}};
  return all;
}

Situation base(const std::string& name) {
  if (name == "driving")
    return driving();
  if (name == "resting")
    return resting();
  if (name != "nothing")
    throw std::invalid_argument("expected driving, resting or nothing, not \"" + name + "\"");
  Situation nothing;
  nothing.listened = 3.0;
  return nothing;
}

/// A line of the file: its keyword, and what follows.
struct Line {
  int number = 0;
  std::string keyword;
  std::string rest;
};

std::vector<Line> read_lines(const std::string& text) {
  std::vector<Line> lines;
  std::istringstream in(text);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t space = std::min(line.find(' '), line.size());
    if (!line.empty() && line.front() != '#')
      lines.push_back(
          {number, line.substr(0, space), line.substr(std::min(space + 1, line.size()))});
  }
  return lines;
}

std::string with_values(std::string text, const std::map<std::string, std::string>& values) {
  for (const auto& [name, value] : values)
    for (std::size_t at = 0; (at = text.find("$" + name, at)) != std::string::npos;
         at += value.size())
      text.replace(at, name.size() + 1, value);
  return text;
}

/// The cases of one situation.
void make(const std::vector<Line>& lines, const std::map<std::string, std::string>& values,
          const std::string& file, std::vector<Case>& all) {
  Situation made;
  std::string words;
  bool asked = false;
  for (const Line& line : lines) {
    try {
      const std::string rest = with_values(line.rest, values);
      if (line.keyword == "situation") {
        words = rest;
      } else if (line.keyword == "is") {
        made = base(rest);
      } else if (line.keyword == "with") {
        Words change(rest);
        const auto found = changes().find(change.name);
        if (found == changes().end())
          throw std::invalid_argument("there is no change \"" + change.name + "\"");
        found->second(made, change);
      } else if (line.keyword == "ask") {
        all.push_back({asked ? "the same" : words, rest, made, {}, {}});
        asked = true;
      } else if (asked && line.keyword == "must") {
        all.back().must.push_back(rest);
      } else if (asked && line.keyword == "never") {
        all.back().never.push_back(rest);
      } else if (line.keyword != "each") {
        throw std::invalid_argument("expected situation, each, is, with, ask, must or never");
      }
    } catch (const std::exception& error) {
      throw std::invalid_argument(file + ":" + std::to_string(line.number) + ": " + error.what());
    }
  }
}

/// With each value of the first of its lists, and so on.
void make_each(const std::vector<Line>& lines, std::size_t list,
               std::map<std::string, std::string> values, const std::string& file,
               std::vector<Case>& all) {
  while (list < lines.size() && lines[list].keyword != "each")
    ++list;
  if (list == lines.size())
    return make(lines, values, file, all);
  std::istringstream in(lines[list].rest);
  std::string name;
  in >> name;
  for (std::string value; std::getline(in >> std::ws, value, ',');) {
    values[name] = value;
    make_each(lines, list + 1, values, file, all);
  }
}

}  // namespace

std::vector<Case> read_cases(const std::string& text, const std::string& file) {
  std::vector<Case> all;
  const std::vector<Line> lines = read_lines(text);
  const auto begins = [](const Line& line) { return line.keyword == "situation"; };
  for (auto from = lines.begin(); from != lines.end();) {
    const auto to = std::find_if(from + 1, lines.end(), begins);
    make_each({from, to}, 0, {}, file, all);
    from = to;
  }
  return all;
}

std::string answer(const Case& one) {
  if (one.question == "why")
    return why(one.situation).sentence;
  if (one.question == "why tree")
    return to_text(why(one.situation));
  if (one.question == "drive")
    return driver(one.situation);
  if (one.question == "trouble")
    return trouble(one.situation);
  std::istringstream words(one.question.substr(std::string("why not ").size()));
  std::vector<std::string> wish;
  for (std::string word; words >> word;)
    wish.push_back(word);
  return why_not(one.situation, parse_wish(wish).value()).sentence;
}

Faults faults(const Case& one) {
  Faults found;
  const std::string said = answer(one);
  for (const std::string& part : one.must)
    if (said.find(part) == std::string::npos)
      found.lacks.push_back(part);
  for (const std::string& part : one.never)
    if (said.find(part) != std::string::npos)
      found.says.push_back(part);
  if (one.question.starts_with("why") && one.question != "why tree" &&
      said.size() >= kLongestSentence)
    found.says.push_back(std::to_string(said.size()) + " characters");
  return found;
}

std::string to_markdown(const std::vector<Case>& cases) {
  std::string text =
      "# Situations, and what is said in them\n\n"
      "`saphira why`, `why not`, `status`, and what `goal`, `drive` and `map` say when nobody "
      "answers, take\ntheir words from one model of the situation (`agents/situation`). The test "
      "`saphira_situation_test`\nmakes each of these situations, asks, and compares; it also "
      "writes this table:\n`SAPHIRA_WRITE_TABLE=1 saphira_situation_test`. `drive` is the line of "
      "`status` about "
      "which program\ndrives, `trouble` its line about the programs. Sentences are shorter than "
      "200 characters; the "
      "rest is in the tree below them.\n\n"
      "| | situation | question | must be said | must not be said | answer |\n"
      "|---|---|---|---|---|---|\n";
  int number = 0;
  for (const Case& one : cases) {
    std::string said = answer(one);
    if (one.question == "why tree")
      said = "(the tree)";
    for (std::size_t at = 0; (at = said.find('|', at)) != std::string::npos; at += 2)
      said.insert(at, "\\");
    text += "| " + std::to_string(++number) + " | " + one.words + " | " + one.question + " | " +
            listed(one.must) + " | " + listed(one.never) + " | " +
            (said.empty() ? "(nothing)" : said) + " |\n";
  }
  return text;
}

}  // namespace saphira::situation::test

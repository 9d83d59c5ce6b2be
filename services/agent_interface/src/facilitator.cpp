#include "saphira/agent_interface/facilitator.hpp"

#include <algorithm>
#include <sstream>
#include <tuple>

#include "saphira/base/guess.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"
#include "slots.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kUsualDeadline = 10.0;  // [s] of a request that names none
constexpr double kAgain = 0.3;           // [s] until a silent agent is asked again
constexpr std::size_t kOpenOfOne = 64;   // requests of one asker at a time
constexpr std::size_t kEnded = 256;      // ends that are remembered
constexpr std::size_t kBegun = 256;      // actions that are remembered, besides open ones
constexpr std::size_t kParts = 8;        // of a conjunction
constexpr std::size_t kMostTold = 64;    // results of an answer
constexpr std::size_t kTries = 1000;     // requests for the parts of a conjunction
constexpr std::size_t kStrangers = 64;   // that are warned of
constexpr const char* kName = "facilitator";

Arguments without(Arguments arguments, const std::string& name) {
  std::erase_if(arguments, [&](const Argument& one) { return one.name == name; });
  return arguments;
}

/// Nothing was done: another agent may get the same request.
bool untouched(AnswerCode code) {
  return code == AnswerCode::refused || code == AnswerCode::unknown_functor ||
         code == AnswerCode::bad_argument || code == AnswerCode::nobody;
}

std::string counted(std::size_t number) {
  return std::to_string(number) + (number == 1 ? " answer" : " answers");
}

}  // namespace

const Capability* Facilitator::capability(std::uint64_t agent, const std::string& functor) const {
  const auto found = agents_.find(agent);
  if (found == agents_.end())
    return nullptr;
  for (const Capability& one : found->second.capabilities)
    if (one.functor.name == functor)
      return &one;
  return nullptr;
}

/// True where the member may speak for the agent: whoever has announced it.
bool Facilitator::may_speak_for(const AgentInfo& agent, const Checked& by) {
  if (!agent.member || !by || agent.member->name == by->name)
    return true;
  const std::string what = "to speak for agent " + agent.name + " of " + agent.member->text();
  if (strangers_.size() < kStrangers && strangers_.insert(by->text() + what).second) {
    out_.warnings.push_back(by->text() + " is refused " + what);
    out_.audit.push_back({.act = v1::AUDIT_REFUSED, .who = by->text(), .text = what});
  }
  return false;
}

bool Facilitator::announce(const AgentInfo& agent) {
  const auto found = agents_.find(agent.id);
  const bool known = found != agents_.end();
  if (known && !may_speak_for(found->second, agent.member))
    return false;
  agents_[agent.id] = agent;
  if (!known)
    out_.notes.push_back("agent " + agent.name + " came");
  std::vector<Id> waiting;
  for (const auto& [id, open] : open_)
    if (open.unmatched)
      waiting.push_back(id);
  for (const Id& id : waiting)
    match(id, now_);
  return true;
}

void Facilitator::leave(std::uint64_t agent, const Checked& by) {
  const auto found = agents_.find(agent);
  if (found == agents_.end() || !may_speak_for(found->second, by))
    return;
  const std::string name = found->second.name;
  agents_.erase(found);
  out_.notes.push_back("agent " + name + " left");
  std::vector<Id> concerned;
  for (auto& [id, open] : open_) {
    std::erase(open.left, agent);
    for (const Asked& asked : open.asked)
      if (asked.agent == agent)
        concerned.push_back(id);
  }
  for (const Id& id : concerned) {
    Open& open = open_.at(id);
    const auto asked = std::find_if(open.asked.begin(), open.asked.end(),
                                    [&](const Asked& one) { return one.agent == agent; });
    const bool acts = asked->acts;
    open.asked.erase(asked);
    open.troubler = name;
    open.trouble = {AnswerCode::lost, "agent " + name + " left before it answered" +
                                          (acts ? "; whether it was done is not known" : "")};
    if (acts && open.wanted == 1)
      end(id, name, Answer(open.trouble));
    else
      advance(id, now_);
  }
}

std::optional<Answer> Facilitator::candidates(const Request& request, bool may_act,
                                              std::vector<std::uint64_t>& agents) const {
  if (const auto agent = begun({request.asker, request.number})) {
    if (!agents_.contains(*agent))
      return Answer{AnswerCode::lost,
                    "the agent that was asked is gone; whether it was done is not known"};
    agents.push_back(*agent);
    return std::nullopt;
  }
  std::string wrong;
  std::vector<std::string> known;
  bool named = request.service.empty();
  std::vector<std::tuple<double, std::string, std::uint64_t>> fit;
  for (const auto& [id, agent] : agents_) {
    if (!request.service.empty() && request.service != agent.name &&
        request.service != agent.address)
      continue;
    named = true;
    for (const Capability& one : agent.capabilities) {
      known.push_back(one.functor.name);
      if (one.functor.name != request.functor)
        continue;
      if (const std::string bad = misfit(one.functor, request.arguments); !bad.empty())
        wrong = bad;
      else if (one.acts && !may_act)
        wrong = request.functor +
                " is an action: only the last part of a conjunction may be one, and is done once";
      else
        fit.emplace_back(one.cost, agent.name, id);
    }
  }
  if (fit.empty()) {
    if (!named)
      return Answer{AnswerCode::nobody, "there is no agent " + quoted(request.service)};
    if (!wrong.empty())
      return Answer{AnswerCode::bad_argument, wrong};
    return Answer{AnswerCode::nobody,
                  "no agent " + (request.service.empty() ? "" : request.service + " ") + "can do " +
                      quoted(request.functor) + did_you_mean(request.functor, known)};
  }
  std::sort(fit.begin(), fit.end());
  for (const auto& one : fit)
    agents.push_back(std::get<std::uint64_t>(one));
  return std::nullopt;
}

/// The same for an open request: into `left`.
std::optional<Answer> Facilitator::candidates(Open& open) const {
  const Open* const whole = open.whole ? &open_.at(*open.whole) : nullptr;
  const bool may_act =
      whole == nullptr || (whole->at + 1 == whole->parts.size() && whole->wanted == 1);
  return candidates(open.request, may_act, open.left);
}

void Facilitator::ask(const Request& request, double now) {
  now_ = now;
  const Id id{request.asker, request.number};
  const bool withdraws = request.functor == kWithdraw;
  if (open_.contains(id)) {
    if (withdraws && may_end(request.person, open_.at(id).request.person))
      withdraw(request.asker, request.number);
    else if (withdraws)
      deny(request.source, "to withdraw a request of " + open_.at(id).request.source);
    return;
  }
  for (const auto& [known, solved] : ended_)
    if (known == id) {
      out_.solved.push_back(solved);
      return;
    }
  if (request.functor == kLiveTriggers)
    return list_triggers(request);
  // An action of before a restart is its asker's, whoever asks for it again or withdraws it.
  if (const Checked asker = asker_of_begun(id); !may_end(request.person, asker))
    return deny(request.source, "to " + std::string(withdraws ? "withdraw" : "take over") +
                                    " a request of " + asker->text());
  if (!withdraws || begun(id))
    begin(request, std::nullopt, now);
}

bool Facilitator::may_change(const Id& trigger, const Checked& who) {
  const Trigger* const found = triggers_.find(trigger);
  if (found == nullptr || may_end(who, found->person))
    return true;
  deny(who->text(), "to change or take back a trigger of " + found->source);
  return false;
}

void Facilitator::deny(const std::string& who, const std::string& what) {
  out_.warnings.push_back(who + " is refused " + what + "; who asked for it may, or an operator");
  out_.audit.push_back({.act = v1::AUDIT_REFUSED, .who = who, .text = what});
}

void Facilitator::list_triggers(const Request& request) {
  Arguments told{text("live", "")};
  for (const Trigger* const trigger : triggers_.live()) {
    std::ostringstream name;
    name << std::hex << trigger->id.first << ':' << std::dec << trigger->id.second;
    told[0].text += (told[0].text.empty() ? "" : " ") + name.str();
    if (const std::string missing = missing_for(*trigger);
        !missing.empty() && told.size() < kMostTold)
      told.push_back(text(name.str(), missing));
  }
  out_.solved.push_back({request.asker, request.number, kName, {AnswerCode::done, "", told}});
}

/// No agent can do its action, or answer its condition: in words.
std::string Facilitator::missing_for(const Trigger& trigger) const {
  const bool looks = trigger.kind == TriggerKind::data;
  for (const std::string& functor : {looks ? trigger.condition : trigger.action, trigger.action}) {
    Request request;
    request.functor = functor;
    std::vector<std::uint64_t> agents;
    if (const auto none = candidates(request, true, agents);
        none && none->code == AnswerCode::nobody)
      return none->text;
  }
  return {};
}

void Facilitator::withdraw(std::uint64_t asker, std::uint64_t number, const std::string& why) {
  const Id id{asker, number};
  const auto found = open_.find(id);
  if (found == open_.end())
    return;
  Open& open = found->second;
  open.withdrawn = true;
  open.why = why;
  if (!open.parts.empty()) {
    if (!open.reply)
      withdraw(open.part.first, open.part.second, why);
    return;
  }
  open.left.clear();
  std::erase_if(open.asked, [](const Asked& one) { return !one.acts; });
  if (open.asked.empty() && begun(id))
    return;  // of before a restart: the agent may come yet
  if (open.asked.empty() && open.got > 0)
    return end(id, kName, {AnswerCode::done, counted(open.got) + "; withdrawn"});
  if (open.asked.empty())
    return end(id, kName, {AnswerCode::refused, "withdrawn; nothing was done"});
  for (const Asked& asked : open.asked)
    tell(open, asked.agent);
}

void Facilitator::begin(const Request& request, std::optional<Id> trigger, double now) {
  const Id id{request.asker, request.number};
  Open open{request};
  open.trigger = trigger;
  open.withdrawn = request.functor == kWithdraw;
  if (const Argument* const wanted = find(request.arguments, "answers")) {
    open.wanted = static_cast<std::size_t>(std::clamp(wanted->number, 0.0, 1e6));
    open.request.arguments = without(request.arguments, "answers");
  }
  open.end = now + (request.deadline > 0.0 ? request.deadline : kUsualDeadline);
  const auto same = std::count_if(open_.begin(), open_.end(), [&](const auto& one) {
    return one.first.first == id.first && one.second.request.source == request.source;
  });
  std::optional<Answer> none;
  if (static_cast<std::size_t>(same) >= kOpenOfOne)
    none = Answer{AnswerCode::refused, request.source + " has " + std::to_string(same) +
                                           " requests open: ask again when one has ended"};
  // An action that may have been begun before a restart is not begun anew.
  if (!none && !open.withdrawn && !begun(id))
    none = take_apart(open);
  const bool whole = !open.parts.empty();
  open_[id] = std::move(open);
  if (none)
    end(id, kName, *none);
  else if (whole)
    pose(id, now);
  else
    match(id, now);
}

/// Finds the parts of a conjunction. The answer: the mistake in it.
std::optional<Answer> Facilitator::take_apart(Open& open) const {
  Request& request = open.request;
  if (find(request.arguments, kAnd) == nullptr)
    return std::nullopt;
  std::vector<Part> parts{{request.functor}};
  for (const Argument& argument : request.arguments) {
    if (argument.name != kAnd)
      parts.back().arguments.push_back(argument);
    else if (argument.kind == ArgumentKind::text && !argument.text.empty())
      parts.push_back({argument.text});
    else
      return Answer{AnswerCode::bad_argument,
                    "argument \"and\": expected the functor of the next part, as a text"};
  }
  if (parts.size() > kParts)
    return Answer{AnswerCode::refused,
                  "a conjunction has " + std::to_string(kParts) + " parts at most"};
  open.parts = std::move(parts);
  return std::nullopt;
}

/// Asks for the part at work of a conjunction.
void Facilitator::pose(const Id& id, double now) {
  Open& open = open_.at(id);
  const Part& part = open.parts[open.at];
  Open one{open.request};
  one.request.functor = part.functor;
  one.request.arguments =
      with_values(part.arguments, open.at == 0 ? Arguments{} : open.parts[open.at - 1].bound);
  one.request.asker = self_;
  one.request.number = ++number_;
  one.whole = id;
  one.left = part.rest;
  const bool limited = open.request.deadline > 0.0;
  one.end = limited ? open.end : now + kUsualDeadline;
  open.part = {self_, number_};
  if (++open.tries > kTries || (limited && now >= open.end)) {
    const bool late = open.tries <= kTries;
    open.reply = Reply{kName,
                       {late ? AnswerCode::too_late : AnswerCode::given_up,
                        late ? "no time is left" : "too many answers of the parts before it"},
                       {},
                       true};
    return;
  }
  const Id part_id = open.part;
  const bool known = !one.left.empty();
  open_[part_id] = std::move(one);
  if (known)
    advance(part_id, now);
  else
    match(part_id, now);
}

/// Finds the newest part with a further answer. False: there is none.
bool Facilitator::go_back(Open& open) const {
  while (true) {
    Part& part = open.parts[open.at];
    std::erase_if(part.rest, [this](std::uint64_t agent) { return !agents_.contains(agent); });
    if (!part.rows.empty() || !part.rest.empty())
      return true;
    if (open.at == 0)
      return false;
    --open.at;
  }
}

/// The part at work of a conjunction has ended.
void Facilitator::go_on(const Id& id, double now) {
  Open& open = open_.at(id);
  const Reply reply = *std::exchange(open.reply, std::nullopt);
  Part& part = open.parts[open.at];
  const bool last = open.at + 1 == open.parts.size();
  const Arguments before = open.at == 0 ? Arguments{} : open.parts[open.at - 1].bound;
  part.rest = reply.rest;
  part.rows.clear();
  std::string failed;
  if (well(reply.answer.code)) {
    part.rows = rows_of(part.arguments, before, reply.answer.results);
    if (part.rows.empty())
      failed = "the values of a variable differ";
  } else {
    failed = reply.answer.text.empty() ? "it was not answered" : reply.answer.text;
  }
  if (!failed.empty() && open.at >= open.failed) {
    Request asked;
    asked.functor = part.functor;
    asked.arguments = with_values(part.arguments, before);
    open.failed = open.at;
    open.troubler = reply.service;
    open.trouble = {well(reply.answer.code) ? AnswerCode::refused : reply.answer.code,
                    "part " + std::to_string(open.at + 1) + " of " +
                        std::to_string(open.parts.size()) + ", " + describe(asked) + ": " + failed};
  }
  if (last) {
    for (const Arguments& row : std::exchange(part.rows, {})) {
      Answer answer = reply.answer;
      answer.results = row;
      for (const Argument& result : reply.answer.results)
        if (std::none_of(part.arguments.begin(), part.arguments.end(), [&](const Argument& slot) {
              return is_variable(slot) && slot.name == result.name;
            }))
          answer.results.push_back(result);
      ++open.got;
      if (open.wanted == 1)
        return end(id, reply.service, answer);
      answer.code = AnswerCode::underway;
      give(id, reply.service, answer);
      if (open.got == open.wanted)
        return end(id, kName, {AnswerCode::done, counted(open.got)});
    }
  }
  const bool over = reply.begun || open.withdrawn;
  if (!over)
    forget_begun(id);
  if (over || !go_back(open)) {
    if (open.got > 0)
      end(id, kName, {AnswerCode::done, counted(open.got) + (open.withdrawn ? "; withdrawn" : "")});
    else if (open.withdrawn && !reply.begun)
      end(id, kName, {AnswerCode::refused, "withdrawn; nothing was done"});
    else
      end(id, std::string(open.troubler), Answer(open.trouble));
    return;
  }
  Part& next = open.parts[open.at];
  if (!next.rows.empty()) {
    next.bound = std::move(next.rows.front());
    next.rows.erase(next.rows.begin());
    open.parts[++open.at].rest.clear();
  }
  pose(id, now);
}

/// Finds the agents of a request, and asks the first ones.
void Facilitator::match(const Id& id, double now) {
  Open& open = open_.at(id);
  const std::optional<Answer> none = candidates(open);
  open.unmatched =
      none && (none->code == AnswerCode::nobody || none->code == AnswerCode::lost) && now < known_;
  if (open.unmatched)
    return;
  if (none)
    end(id, kName, *none);
  else
    advance(id, now);
}

void Facilitator::send(Open& open, std::uint64_t agent, double now) {
  const Id id{open.request.asker, open.request.number};
  const Capability* const can = capability(agent, open.request.functor);
  const bool acts = begun(id) || (can != nullptr && can->acts);
  open.asked.push_back({agent, acts, now + kAgain});
  if (acts && !open.acts)
    out_.audit.push_back(
        {.act = v1::AUDIT_ASKED, .who = open.request.source, .text = describe(open.request)});
  open.acts = open.acts || acts;
  // Requests of triggers and for parts are of one run of this program. So its agent does not know
  // the action of a conjunction again after a restart: agent 0, which is none, was asked.
  if (acts && open.wanted == 1 && id.first != self_)
    note_begun(id, agent);
  else if (acts && open.whole && open.whole->first != self_)
    note_begun(*open.whole, 0);
  tell(open, agent);
}

/// Sends the request, or its withdrawal.
void Facilitator::tell(const Open& open, std::uint64_t agent) {
  Request request = open.request;
  request.service = agents_.at(agent).address;
  if (request.deadline > 0.0)
    request.deadline = open.end - now_;  // the rest of it
  if (open.withdrawn) {
    request.functor = kWithdraw;
    request.arguments.clear();
    if (!open.why.empty())
      request.arguments.push_back(text(kWhy, open.why));
  }
  out_.requests.push_back(std::move(request));
}

/// Asks the next agents, or ends the request.
void Facilitator::advance(const Id& id, double now) {
  Open& open = open_.at(id);
  if (open.wanted == 1 ? open.asked.empty() : true) {
    while (!open.left.empty() && (open.wanted != 1 || open.asked.empty())) {
      const std::uint64_t agent = open.left.front();
      open.left.erase(open.left.begin());
      send(open, agent, now);
    }
  }
  if (!open.asked.empty() && (open.wanted == 0 || open.got < open.wanted))
    return;
  if (open.got > 0)
    end(id, kName, {AnswerCode::done, counted(open.got)});
  else
    end(id, open.troubler.empty() ? kName : open.troubler, Answer(open.trouble));
}

void Facilitator::hear(const std::string& address, std::uint64_t asker, std::uint64_t number,
                       const Answer& given, double now, const Checked& by) {
  now_ = now;
  const Id id{asker, number};
  const auto found = open_.find(id);
  if (found == open_.end())
    return;
  Open& open = found->second;
  const auto asked = std::find_if(open.asked.begin(), open.asked.end(), [&](const Asked& one) {
    const auto agent = agents_.find(one.agent);
    return agent != agents_.end() && agent->second.address == address;
  });
  if (asked == open.asked.end()) {
    if (std::none_of(agents_.begin(), agents_.end(),
                     [&](const auto& one) { return one.second.address == address; }) &&
        strangers_.size() < kStrangers && strangers_.insert(address).second)
      out_.warnings.push_back("an answer of " + quoted(address) + " to " + describe(open.request) +
                              " does not count: no agent has that address; expected the service of "
                              "the request, such as 1f3a/calendar");
    return;
  }
  if (!may_speak_for(agents_.at(asked->agent), by))
    return;
  asked->heard = true;
  // An agent that knows no withdrawals does the action to its end.
  if (open.withdrawn && given.code == AnswerCode::unknown_functor)
    return;
  if (!ended(given.code)) {
    // An agent that says again and again that it is at work has the time that it needs.
    if (open.request.deadline <= 0.0)
      open.end = now + kUsualDeadline;
    if (open.wanted == 1)
      give(id, agents_.at(asked->agent).name, given);
    return;
  }
  const std::string name = agents_.at(asked->agent).name;
  const bool acts = asked->acts;
  Answer answer = given;
  if (const Capability* const declared = capability(asked->agent, open.request.functor))
    if (const std::string wrong = contradiction(declared->functor, answer); !wrong.empty())
      // An action is done, whatever is said of it.
      answer = {acts || !well(answer.code) ? answer.code : AnswerCode::refused,
                "the answer of agent " + name + " is not as it has declared: " + wrong};
  open.asked.erase(asked);
  if (well(answer.code)) {
    ++open.got;
    if (open.wanted == 1)
      return end(id, name, answer);
    Answer one = answer;
    one.code = AnswerCode::underway;
    give(id, name, one);
  } else {
    if (!open.troubler.empty())  // each reason counts
      answer.text += " (" + open.troubler + ": " + open.trouble.text + ")";
    open.trouble = answer;
    open.troubler = name;
    if (acts && open.wanted == 1 && !untouched(answer.code))
      return end(id, name, answer);
    forget_begun(id);
  }
  advance(id, now);
}

void Facilitator::give(const Id& id, const std::string& service, const Answer& answer) {
  if (const auto whole = open_.at(id).whole)
    return give(*whole, service, answer);
  if (!open_.at(id).trigger && id.first != self_)
    out_.solved.push_back({id.first, id.second, service, answer});
}

void Facilitator::end(const Id& id, const std::string& service, const Answer& answer) {
  const Open open = std::move(open_.at(id));
  open_.erase(id);
  if (open.whole) {
    open_.at(*open.whole).reply =
        Reply{service, answer, open.left, open.acts && !untouched(answer.code)};
    return;
  }
  if (open.trigger) {
    if (const auto firing = triggers_.looked(*open.trigger, answer))
      fire(*firing);
    return;
  }
  if (id.first == self_) {
    if (!well(answer.code))
      out_.notes.push_back(open.request.source + " asked for " + describe(open.request) + ": " +
                           answer.text);
    return;
  }
  out_.solved.push_back({id.first, id.second, service, answer});
  ended_.emplace_back(id, out_.solved.back());
  if (ended_.size() > kEnded)
    ended_.erase(ended_.begin());
}

void Facilitator::set(const Trigger& trigger, double now) {
  const Trigger* const known = triggers_.find(trigger.id);
  if (known != nullptr && *known == trigger)
    return;
  if (known != nullptr)
    take_back(trigger.id);
  if (const std::string wrong = triggers_.set(trigger, now); !wrong.empty())
    out_.notes.push_back("a trigger of " + trigger.source + " for " + quoted(trigger.action) +
                         " is not set: " + wrong);
}

void Facilitator::take_back(const Id& trigger) {
  triggers_.take_back(trigger);
  stop_action(trigger, "its trigger was withdrawn");
}

void Facilitator::miss(const Id& trigger) {
  triggers_.miss(trigger);
  stop_action(trigger, "the program that set its trigger is gone");
}

void Facilitator::call_off(const Id& trigger) {
  stop_action(trigger, "its trigger was withdrawn");
  triggers_.call_off(trigger);
}

void Facilitator::happened(const std::string& functor, const Arguments& arguments, double now) {
  now_ = now;
  for (const Firing& firing : triggers_.happened(functor, arguments))
    fire(firing);
}

void Facilitator::stop_action(const Id& trigger, const std::string& why) {
  std::vector<Id> caused;
  for (const auto& [id, open] : open_)
    if (open.cause == trigger)
      caused.push_back(id);
  for (const Id& id : caused)
    withdraw(id.first, id.second, why);
}

/// Asks for the condition of a data trigger.
void Facilitator::look(const Trigger& trigger) {
  Request condition = request_of(trigger, trigger.condition);
  condition.arguments = trigger.condition_arguments;
  begin(condition, trigger.id, now_);
}

/// Asks for the action of a trigger that has fired.
void Facilitator::fire(const Firing& firing) {
  Request action = request_of(*firing.trigger, firing.trigger->action);
  action.arguments = firing.arguments;
  begin(action, std::nullopt, now_);
  if (const auto begun = open_.find({self_, action.number}); begun != open_.end())
    begun->second.cause = firing.trigger->id;
}

Request Facilitator::request_of(const Trigger& trigger, const std::string& functor) {
  Request request;
  request.functor = functor;
  request.source = "a trigger of " + trigger.source;
  request.person = trigger.person;
  request.asker = self_;
  request.number = ++number_;
  return request;
}

Facilitator::Outputs Facilitator::step(double now) {
  now_ = now;
  for (const Trigger* const trigger : triggers_.take_due(now))
    if (trigger->kind == TriggerKind::data)
      look(*trigger);
    else if (const auto firing = triggers_.fire(trigger->id, {}))
      fire(*firing);
  std::vector<Id> late;
  std::vector<Id> waiting;
  for (auto& [id, open] : open_) {
    if (open.unmatched && now >= known_) {
      waiting.push_back(id);
      continue;
    }
    if (!open.parts.empty())
      continue;  // its part at work has the same end
    if (now >= open.end) {
      late.push_back(id);
      continue;
    }
    for (Asked& asked : open.asked)
      if (!asked.heard && now >= asked.again) {
        asked.again = now + kAgain;
        tell(open, asked.agent);
      }
  }
  for (const Id& id : waiting)
    match(id, now);
  for (const Id& id : late) {
    Open& open = open_.at(id);
    if (open.unmatched) {
      end(id, kName, candidates(open).value_or(Answer{AnswerCode::too_late, "no time is left"}));
      continue;
    }
    const std::string names =
        joined(open.asked, ", ", [&](const Asked& asked) { return agents_.at(asked.agent).name; });
    Answer answer{AnswerCode::done, counted(open.got) + "; not in time: " + names};
    if (open.got == 0)
      answer = {AnswerCode::too_late, names + " did not answer in time"};
    end(id, kName, answer);
  }
  while (true) {
    const auto next =
        std::find_if(open_.begin(), open_.end(), [](const auto& one) { return one.second.reply; });
    if (next == open_.end())
      break;
    go_on(Id(next->first), now);
  }
  out_.changed = triggers_.take_changed() || out_.changed;
  return std::exchange(out_, {});
}

std::optional<double> Facilitator::due() const {
  std::optional<double> soonest;
  const auto consider = [&](double when) {
    if (!soonest || when < *soonest)
      soonest = when;
  };
  for (const auto& [id, open] : open_) {
    if (!open.parts.empty())
      continue;
    consider(open.unmatched ? std::min(open.end, known_) : open.end);
    for (const Asked& asked : open.asked)
      if (!asked.heard)
        consider(asked.again);
  }
  if (const auto next = triggers_.due())
    consider(*next);
  return soonest;
}

std::optional<std::uint64_t> Facilitator::begun(const Id& id) const {
  for (const auto& [known, agent] : begun_)
    if (known == id)
      return agent;
  return std::nullopt;
}

void Facilitator::note_begun(const Id& id, std::uint64_t agent) {
  if (begun(id) == agent)
    return;
  forget_begun(id);
  begun_.emplace_back(id, agent);
  if (const auto open = open_.find(id); open != open_.end() && open->second.request.person)
    askers_[id] = *open->second.request.person;
  out_.changed = true;
  if (begun_.size() <= kBegun)
    return;
  const auto over = std::find_if(begun_.begin(), begun_.end(),
                                 [this](const auto& one) { return !open_.contains(one.first); });
  if (over == begun_.end())
    return;
  askers_.erase(over->first);
  begun_.erase(over);
}

void Facilitator::forget_begun(const Id& id) {
  askers_.erase(id);
  if (std::erase_if(begun_, [&](const auto& one) { return one.first == id; }) > 0)
    out_.changed = true;
}

Checked Facilitator::asker_of_begun(const Id& id) const {
  const auto found = askers_.find(id);
  return found == askers_.end() ? std::nullopt : Checked(found->second);
}

}  // namespace saphira::agent_interface

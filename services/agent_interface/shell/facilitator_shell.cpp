#include "agent_interface/shell/facilitator_shell.hpp"

#include <algorithm>
#include <chrono>

#include "agent_interface/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/namesakes.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira::agent_interface {
namespace {

// Agents that are there are found within this time after the start, also with security.
constexpr double kKnown = 2.0;                   // [s]
constexpr std::chrono::microseconds kSpin{500};  // after a request: most agents answer within that

template <class Key>
void note(std::multimap<bus::WriterId, Key>& of, const bus::WriterId& writer, const Key& key) {
  const auto [begin, end] = of.equal_range(writer);
  if (std::none_of(begin, end, [&](const auto& one) { return one.second == key; }))
    of.emplace(writer, key);
}

}  // namespace

FacilitatorShell::FacilitatorShell(bus::Node& node, double now, std::string memory)
    : node_(node),
      agents_(node.reader(bus::topics::kAgents)),
      triggers_(node.reader(bus::topics::kTriggers)),
      events_(node.reader(bus::topics::kAgentEvents)),
      asked_(node.reader<v1::Request>(bus::topics::kSolve)),
      answers_(node.reader(bus::topics::kAgentAnswers)),
      requests_(node.writer<v1::Request>(bus::topics::kAgentRequest)),
      solved_(node.writer(bus::topics::kSolved)),
      begun_(now),
      memory_(std::move(memory)),
      facilitator_(node.instance(), now + kKnown),
      robot_(node) {
  if (memory_.empty())
    return;
  const Files files = node_.options().files();
  const std::string trouble = read_or_set_aside(
      memory_, [this](const std::string& text) { restore(unsealed(text, memory_), facilitator_); },
      files);
  if (!trouble.empty())
    node_.warn(trouble);
  if (files == Files::kStay)
    memory_.clear();
}

void FacilitatorShell::take_agents() {
  for (const auto& sample : agents_.take()) {
    if (sample.info.disposed) {
      facilitator_.leave(sample.data.id, bus::asker_of(sample.info));
      continue;
    }
    AgentInfo agent = from_bus(sample.data);
    agent.member = bus::asker_of(sample.info);
    if (facilitator_.announce(agent))
      note(agents_of_, sample.info.writer, agent.id);
  }
  for (const bus::WriterId& writer : agents_.take_lost()) {
    const auto [begin, end] = agents_of_.equal_range(writer);
    for (auto one = begin; one != end; ++one)
      facilitator_.leave(one->second);
    agents_of_.erase(writer);
  }
}

/// Several programs may hold a trigger: it lasts as long as one of them, in the form of the newest.
void FacilitatorShell::take_triggers(double now) {
  const auto release = [&](const bus::WriterId& writer, const Trigger& trigger, bool lost) {
    auto& holders = holders_[trigger.id];
    const bool unknown = holders.empty();
    const bool held =
        std::erase_if(holders, [&](const auto& one) { return one.first == writer; }) > 0;
    if (!holders.empty() && held)
      return facilitator_.set(holders.back().second, now);
    holders_.erase(trigger.id);
    if (lost)
      facilitator_.miss(trigger.id);
    else if (held || unknown)
      facilitator_.take_back(trigger.id);
    else
      facilitator_.call_off(trigger.id);
  };
  for (const auto& sample : triggers_.take()) {
    Trigger trigger = from_bus(sample.data);
    trigger.person = bus::asker_of(sample.info);
    trigger.source = named(trigger.source, trigger.person);
    if (!facilitator_.may_change(trigger.id, trigger.person))
      continue;
    if (sample.info.disposed) {
      release(sample.info.writer, trigger, false);
      continue;
    }
    auto& holders = holders_[trigger.id];
    std::erase_if(holders, [&](const auto& one) { return one.first == sample.info.writer; });
    holders.emplace_back(sample.info.writer, trigger);
    facilitator_.set(trigger, now);
  }
  for (const bus::WriterId& writer : triggers_.take_lost()) {
    std::vector<Trigger> held;
    for (const auto& [id, holders] : holders_)
      for (const auto& [holder, trigger] : holders)
        if (holder == writer)
          held.push_back(trigger);
    for (const Trigger& trigger : held)
      release(writer, trigger, true);
  }
}

void FacilitatorShell::take_requests(double now) {
  std::erase_if(requests_of_, [this](const auto& one) {
    return !facilitator_.is_open(one.second.first, one.second.second);
  });
  for (const auto& sample : asked_.take())
    if (!sample.info.disposed) {
      const RequestId id{sample.data.asker, sample.data.number};
      note(requests_of_, sample.info.writer, id);
      facilitator_.ask(saphira::from_bus(sample), now);
    }
  for (const bus::WriterId& writer : asked_.take_lost()) {
    const auto [begin, end] = requests_of_.equal_range(writer);
    const std::multimap<bus::WriterId, RequestId> orphans(begin, end);
    requests_of_.erase(begin, end);
    // An asker whose network has changed repeats its requests by a new writer.
    for (const auto& [gone, id] : orphans)
      if (std::none_of(requests_of_.begin(), requests_of_.end(),
                       [&](const auto& other) { return other.second == id; }))
        facilitator_.withdraw(id.first, id.second);
  }
}

void FacilitatorShell::step(double now) {
  take_agents();
  take_triggers(now);
  for (const auto& sample : answers_.take())
    if (!sample.info.disposed)
      facilitator_.hear(sample.data.service, sample.data.asker, sample.data.number,
                        saphira::from_bus(sample.data), now, bus::asker_of(sample.info));
  // The bus repeats older events to a new reader: triggers fired on them before.
  for (const auto& sample : events_.take())
    if (!sample.info.disposed && sample.info.age <= now - begun_)
      facilitator_.happened(sample.data.functor, saphira::from_bus(sample.data.arguments), now);
  take_requests(now);
  const auto robot_says = [&](const Request& request, const Answer& answer) {
    facilitator_.hear(robot_.address(), request.asker, request.number, answer, now);
  };
  for (const RobotAgent::Report& report : robot_.step(now))
    robot_says(report.request, report.answer);

  const Facilitator::Outputs out = facilitator_.step(now);
  awaits_ = !out.requests.empty();
  if (out.changed && !memory_.empty() && !replace_file(memory_, sealed(saved(facilitator_))))
    node_.warn(cannot_be(memory_, "written") + "; after a restart an action may be done again");
  for (const Request& request : out.requests)
    if (request.service == robot_.address())
      robot_says(request, robot_.begin(request, now));
    else
      requests_.write(to_bus(request));
  for (const Solved& solved : out.solved) {
    v1::Answer answer = to_bus(solved.answer);
    answer.asker = solved.asker;
    answer.number = solved.number;
    answer.service = solved.service;
    solved_.write(answer);
  }
  for (const v1::AuditEntry& entry : out.audit)
    audit_.write(entry);
  for (const std::string& text : out.notes)
    node_.info(text);
  for (const std::string& text : out.warnings)
    node_.warn(text);
}

double FacilitatorShell::seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void FacilitatorShell::run(const bus::Stop& stop) {
  constexpr double kStatusTime = 0.45;  // [s] twice a second
  bus::Namesakes others(node_);
  while (!stop.requested() && !others.superseded()) {
    const double now = seconds();
    const double due = facilitator_.due().value_or(now + kStatusTime);
    const double wait = std::clamp(due - now, 0.001, kStatusTime);
    if (awaits_)
      node_.spin(kSpin);
    node_.wait(std::chrono::milliseconds(static_cast<int>(1000.0 * wait) + 1), &stop);
    if (!others.poll() && !others.superseded()) {
      others.act();
      node_.status().state = v1::SERVICE_RUNNING;
      node_.status().reason.clear();
      step(seconds());
    }
    node_.publish_status();
  }
}

}  // namespace saphira::agent_interface

#include "saphira/bus/agent.hpp"

#include <algorithm>
#include <stdexcept>

#include "saphira/base/format.hpp"

namespace saphira::bus {
namespace {

v1::CapabilityParameter slot(const std::string& name, const std::string& meaning, bool required,
                             v1::ArgumentKind kind) {
  return {.name = name, .kind = kind, .meaning = meaning, .required = required};
}

const v1::Argument* find(const std::vector<v1::Argument>& arguments, const std::string& name) {
  const auto found = std::find_if(arguments.begin(), arguments.end(),
                                  [&](const v1::Argument& one) { return one.name == name; });
  return found == arguments.end() ? nullptr : &*found;
}

}  // namespace

Agent::Agent(Node& node, std::string name, std::string summary)
    : node_(node),
      self_{.id = next_request_number() ^ node.instance(),  // several agents may share a node
            .name = std::move(name),
            .summary = std::move(summary)},
      announcements_(node.writer(topics::kAgents)),
      triggers_(node.writer(topics::kTriggers)),
      events_(node.writer(topics::kAgentEvents)),
      requests_(node.reader<v1::Request>(topics::kAgentRequest)),
      answers_(node.writer(topics::kAgentAnswers)),
      server_(
          agent_address(self_.id, self_.name), true,
          [this](const v1::Answer& answer) { answers_.write(answer); },
          [this](const std::string& text) { node_.warn(text); }),
      solver_(node, topics::kSolve, self_.name, &topics::kAgentAnswers) {}

Agent::~Agent() {
  if (!answerers_.empty())
    announcements_.dispose(self_);
}

void Agent::can(const v1::Capability& capability, Answerer answerer) {
  answerers_[capability.functor] = std::move(answerer);
  auto& all = self_.capabilities;
  const auto same = std::find_if(all.begin(), all.end(), [&](const v1::Capability& one) {
    return one.functor == capability.functor;
  });
  if (same == all.end())
    all.push_back(capability);
  else
    *same = capability;
  if (!announcements_.write(self_))
    throw std::runtime_error("the bus refused the capabilities of agent " + self_.name);
}

void Agent::poll() {
  if (answering_)
    return;
  if (node_.status().state == v1::SERVICE_STARTING)
    node_.status().state = v1::SERVICE_RUNNING;
  answering_ = true;
  for (const auto& sample : requests_.take())
    if (!sample.info.disposed && server_.hear(sample.data, sample.info.sender.get()))
      answer(sample.data, begin(sample.data));
  answering_ = false;
}

v1::Answer Agent::begin(const v1::Request& request) {
  const auto answerer = answerers_.find(request.functor);
  if (answerer == answerers_.end())
    return {.code = v1::ANSWER_UNKNOWN_FUNCTOR,
            .text = "agent " + self_.name + " cannot do " + request.functor};
  try {
    return answerer->second(request);
  } catch (const std::exception& error) {
    return refused(error.what());
  }
}

v1::Answer Agent::ask(const v1::Request& request, double patience, const Stop* stop) {
  return solver_.ask(request, patience, stop, [this] { poll(); });
}

v1::GoalId Agent::set(v1::Trigger trigger) {
  trigger.id.writer = node_.instance();
  trigger.id.number = next_request_number();
  if (trigger.source.empty())
    trigger.source = self_.name;
  if (!triggers_.write(trigger))
    throw std::runtime_error("the bus did not take a trigger of agent " + self_.name);
  return trigger.id;
}

void Agent::take_back(const v1::GoalId& trigger) {
  triggers_.dispose({.id = trigger});
}

void Agent::tell(const std::string& functor, std::vector<v1::Argument> arguments) {
  events_.write({.source = self_.name, .functor = functor, .arguments = std::move(arguments)});
}

std::string agent_address(std::uint64_t id, const std::string& name) {
  return format("%llx/", static_cast<unsigned long long>(id)) + name;
}

v1::Capability capability(const std::string& functor, const std::string& summary,
                          std::vector<v1::CapabilityParameter> parameters) {
  return {.functor = functor, .summary = summary, .parameters = std::move(parameters)};
}

v1::Capability action(const std::string& functor, const std::string& summary,
                      std::vector<v1::CapabilityParameter> parameters) {
  v1::Capability result = capability(functor, summary, std::move(parameters));
  result.acts = true;
  return result;
}

v1::CapabilityParameter text_slot(const std::string& name, const std::string& meaning,
                                  bool required) {
  return slot(name, meaning, required, v1::ARGUMENT_TEXT);
}

v1::CapabilityParameter number_slot(const std::string& name, const std::string& meaning,
                                    bool required) {
  return slot(name, meaning, required, v1::ARGUMENT_NUMBER);
}

v1::Answer done(std::vector<v1::Argument> results, const std::string& text) {
  return {.code = v1::ANSWER_DONE, .text = text, .results = std::move(results)};
}

v1::Answer refused(const std::string& text) {
  return {.code = v1::ANSWER_REFUSED, .text = text};
}

std::string text_of(const std::vector<v1::Argument>& arguments, const std::string& name) {
  const v1::Argument* const found = find(arguments, name);
  return found == nullptr ? std::string() : found->text;
}

double number_of(const std::vector<v1::Argument>& arguments, const std::string& name) {
  const v1::Argument* const found = find(arguments, name);
  return found == nullptr ? 0.0 : found->number;
}

v1::Argument open(const std::string& name) {
  return {.name = name, .kind = v1::ARGUMENT_UNBOUND};
}

}  // namespace saphira::bus

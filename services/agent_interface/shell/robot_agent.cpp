#include "agent_interface/shell/robot_agent.hpp"

#include <utility>

#include "requests/shell/convert.hpp"
#include "saphira/agent_interface/facilitator.hpp"
#include "saphira/agent_interface/tasks.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira::agent_interface {
namespace {

constexpr double kReport = 2.0;             // [s] between reports of a goal that is underway
constexpr std::size_t kMostArguments = 16;  // of a goal

std::string meaning_of(const v1::ActivityParameter& parameter) {
  static const char* const kinds[] = {"a value", "a number", "a text", "a point"};
  std::string text = kinds[parameter.kind];
  if (!parameter.unit.empty())
    text += " [" + parameter.unit + "]";
  if (!parameter.usual.empty())
    text += ", usually " + parameter.usual;
  return text;
}

}  // namespace

RobotAgent::RobotAgent(bus::Node& node)
    : announcements_(node.writer(bus::topics::kAgents)),
      goals_(node, "robot"),
      schemas_(node.reader(bus::topics::kActivitySchemas)) {
  self_.id = bus::next_request_number() ^ node.instance();
  self_.name = "robot";
  self_.summary = "pursues goals";
  address_ = bus::agent_address(self_.id, self_.name);
}

void RobotAgent::announce(const v1::ActivitySchemas& schemas) {
  self_.capabilities.clear();
  for (const v1::ActivitySchema& schema : schemas.schemas) {
    std::vector<v1::CapabilityParameter> parameters;
    for (const v1::ActivityParameter& one : schema.parameters) {
      v1::CapabilityParameter parameter{.name = one.name};
      parameter.kind = v1::ARGUMENT_UNBOUND;  // the intentions check it
      parameter.meaning = meaning_of(one);
      parameter.required = one.required;
      parameters.push_back(std::move(parameter));
    }
    self_.capabilities.push_back(bus::action(schema.name, schema.summary, std::move(parameters)));
  }
  announcements_.write(self_);
}

Answer RobotAgent::begin(const Request& request, double now) {
  if (request.functor == kWithdraw) {
    for (const Begun& one : begun_)
      if (one.request.asker == request.asker && one.request.number == request.number) {
        const Argument* const why = find(request.arguments, kWhy);
        goals_.cancel(one.goal, why == nullptr ? "" : why->text);
        return {AnswerCode::underway, "withdrawn"};
      }
    return {AnswerCode::given_up, "withdrawn"};
  }
  if (request.arguments.size() > kMostArguments)
    return {AnswerCode::refused,
            "a goal has " + std::to_string(kMostArguments) + " arguments at most"};
  v1::Goal goal{.requester = request.source,
                .functor = request.functor,
                .arguments = to_bus(request.arguments),
                .deadline = goal_deadline(request.deadline),
                .writer_lost = v1::WRITER_LOST_CANCEL};
  goal.person = bus::to_bus(request.person);
  begun_.push_back({request, goals_.ask(std::move(goal)), now, now});
  return {AnswerCode::underway, ""};
}

std::vector<RobotAgent::Report> RobotAgent::step(double now) {
  if (const auto schemas = schemas_.take_newest())
    announce(*schemas);
  goals_.poll();
  std::vector<Report> reports;
  std::erase_if(begun_, [&](Begun& one) {
    const auto status = goals_.status(one.goal);
    Answer answer{AnswerCode::underway, status ? status->reason : ""};
    if (status && bus::ended(status->state)) {
      answer.code = status->state == v1::GOAL_SUCCEEDED ? AnswerCode::done
                    : status->state == v1::GOAL_REFUSED ? AnswerCode::refused
                                                        : AnswerCode::given_up;
    } else if (!status && now >= one.when + kTakenUp) {
      goals_.cancel(one.goal);
      answer = {AnswerCode::refused, kNotTakenUp};
    } else if (now < one.reported + kReport) {
      return false;
    }
    one.reported = now;
    reports.push_back({one.request, answer});
    return answer.code != AnswerCode::underway;
  });
  return reports;
}

}  // namespace saphira::agent_interface

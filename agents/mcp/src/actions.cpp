#include "saphira/mcp/actions.hpp"

#include "saphira/bus/goal_client.hpp"

namespace saphira::mcp {

namespace {

v1::GoalState state_of(const v1::Answer& answer, bool withdrawn) {
  switch (answer.code) {
    case v1::ANSWER_UNDERWAY:
      return v1::GOAL_UNDERWAY;
    case v1::ANSWER_DONE:
    case v1::ANSWER_SENT:
      return v1::GOAL_SUCCEEDED;
    case v1::ANSWER_REFUSED:
    case v1::ANSWER_UNKNOWN_FUNCTOR:
    case v1::ANSWER_BAD_ARGUMENT:
    case v1::ANSWER_NOBODY:
      return withdrawn ? v1::GOAL_CANCELED : v1::GOAL_REFUSED;
    case v1::ANSWER_GIVEN_UP:
      return withdrawn ? v1::GOAL_CANCELED : v1::GOAL_FAILED;
    case v1::ANSWER_TOO_LATE:
    case v1::ANSWER_LOST:
      break;
  }
  return v1::GOAL_FAILED;
}

}  // namespace

Action action_of(const v1::GoalId& id, const v1::Request& request) {
  Action action;
  action.status.id = id;
  action.status.functor = request.functor;
  action.status.requester = request.source;
  action.status.state = v1::GOAL_WAITING;
  action.status.reason = "no agent has answered yet; without saphira-facilitator none does";
  return action;
}

void take_answer(Action& action, const v1::Answer& answer, bool withdrawn,
                 const std::vector<v1::CapabilityParameter>& declared) {
  action.status.state = state_of(answer, withdrawn);
  const bool silent = answer.text.empty() && !bus::well(answer.code);
  const bool late = answer.code == v1::ANSWER_TOO_LATE;
  const std::string text = (silent ? "no reason was given" : answer.text) +
                           (late ? "; whether it was done is not known" : "");
  action.status.reason =
      (answer.service.empty() || text.empty() ? "" : answer.service + ": ") + text;
  if (bus::ended(answer.code))
    action.results = values_of(answer.results, declared);
}

Json json_of(const Action& action) {
  Json json = json_of(action.status);
  json.erase("progress");
  json["results"] = action.results;
  return json;
}

std::string words_of(const Action& action) {
  const v1::GoalStatus& status = action.status;
  return bus::describe(status.state) + (status.reason.empty() ? "" : ": " + status.reason) +
         (action.results.empty()
              ? ""
              : "; results " + action.results.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace saphira::mcp

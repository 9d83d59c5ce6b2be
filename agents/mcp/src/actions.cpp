#include "saphira/mcp/actions.hpp"

#include "saphira/bus/goal_client.hpp"

namespace saphira::mcp {

namespace {

constexpr std::size_t kMostKept = 64;  // actions that are remembered

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

bool is_over(const Action& action) {
  return bus::ended(action.status.state);
}

}  // namespace

void Actions::begin(const v1::GoalId& id, const v1::Request& request,
                    std::vector<v1::CapabilityParameter> declared) {
  for (auto each = asked_.begin(); each != asked_.end() && asked_.size() >= kMostKept;)
    each = is_over(each->second.action) ? asked_.erase(each) : std::next(each);
  Asked& asked = asked_[id.number];
  asked.declared = std::move(declared);
  v1::GoalStatus& status = asked.action.status;
  status.id = id;
  status.functor = request.functor;
  status.requester = request.source;
  status.state = v1::GOAL_WAITING;
  status.reason = "no agent has answered yet; without saphira-facilitator none does";
}

void Actions::hear(const v1::Answer& answer) {
  const auto found = asked_.find(answer.number);
  if (found == asked_.end())
    return;
  Asked& asked = found->second;
  v1::GoalStatus& status = asked.action.status;
  if (is_over(asked.action))
    return;
  status.state = state_of(answer, asked.withdrawn);
  const bool silent = answer.text.empty() && !bus::well(answer.code);
  const bool late = answer.code == v1::ANSWER_TOO_LATE;
  const std::string text = (silent ? "no reason was given" : answer.text) +
                           (late ? "; whether it was done is not known" : "");
  status.reason = (answer.service.empty() || text.empty() ? "" : answer.service + ": ") + text;
  if (is_over(asked.action))
    asked.action.results = values_of(answer.results, asked.declared);
}

void Actions::withdraw(const v1::GoalId& id) {
  if (const auto found = asked_.find(id.number); found != asked_.end())
    found->second.withdrawn = true;
}

const Action* Actions::find(const v1::GoalId& id) const {
  const auto found = asked_.find(id.number);
  return found == asked_.end() || found->second.action.status.id != id ? nullptr
                                                                       : &found->second.action;
}

std::vector<Action> Actions::all() const {
  std::vector<Action> all;
  for (const auto& [number, asked] : asked_)
    all.push_back(asked.action);
  return all;
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

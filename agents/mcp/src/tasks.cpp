// Calls that outlast their request: the extension io.modelcontextprotocol/tasks. A task is a call
// that is not answered yet, under the id of its goal.
#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol.hpp"
#include "saphira/base/format.hpp"

namespace saphira::mcp {

namespace {

constexpr double kKept = 900.0;  // [s] from a task's beginning
constexpr std::size_t kMostTasks = 64;
constexpr int kPoll = 500;  // [ms] a goal ends 1.5 s after the last sign of its client

/// Such as 2026-11-26T12:30:07.250Z.
std::string stamp_of(double date) {
  const auto milliseconds = static_cast<long long>(std::llround(date * 1000.0));
  return utc_text(milliseconds / 1000, "%Y-%m-%dT%H:%M:%S") +
         format(".%03dZ", static_cast<int>(milliseconds % 1000));
}

}  // namespace

bool Session::has_tasks(const Json& parameters) {
  const Json declared = member(member(parameters, "_meta"), kMeta + "clientCapabilities");
  return member(member(declared, "extensions"), kTasks).is_object();
}

/// True where the client has not declared tasks, and gets an error.
bool Session::lacks_tasks(const Request& request, const Json& parameters) {
  if (has_tasks(parameters))
    return false;
  Json needed;
  needed["requiredCapabilities"]["extensions"][kTasks] = Json::object();
  error(request, kNoCapability, "the client has not declared the extension " + kTasks,
        std::move(needed));
  return true;
}

void Session::begin_task(std::uint64_t call, const std::string& id, const std::string& text) {
  const auto found = open_.find(call);
  if (found == open_.end())
    return;
  found->second.task = id;
  const Request request = found->second.request;
  Task& task = tasks_[id];
  task = {{{"taskId", id},
           {"status", "working"},
           {"statusMessage", text},
           {"createdAt", stamp_of(date_)},
           {"lastUpdatedAt", stamp_of(date_)},
           {"ttlMs", static_cast<int>(kKept * 1000.0)},
           {"pollIntervalMs", kPoll}},
          call,
          time_};
  Json result = task.state;
  result["resultType"] = "task";
  reply(request, std::move(result));
}

void Session::forget_tasks() {
  std::erase_if(tasks_, [this](const auto& each) {
    return each.second.call == 0 && time_ >= each.second.begun + kKept;
  });
  while (tasks_.size() > kMostTasks) {
    const auto oldest = std::ranges::min_element(tasks_, [](const auto& a, const auto& b) {
      return std::pair(a.second.call != 0, a.second.begun) <
             std::pair(b.second.call != 0, b.second.begun);
    });
    if (oldest->second.call != 0)
      return;
    tasks_.erase(oldest);
  }
}

void Session::ask_task(const std::string& method, const Request& request, const Json& parameters) {
  if (lacks_tasks(request, parameters))
    return;
  const Json id = member(parameters, "taskId");
  const auto found = id.is_string() ? tasks_.find(id.get<std::string>()) : tasks_.end();
  if (found == tasks_.end())
    return error(request, kBadParameters,
                 "there is no task " + id.dump().substr(0, 70) + ", or not any more");
  Task& task = found->second;
  if (method == "tasks/get")
    return reply(request, task.state);
  if (const Json asked = member(task.state, "inputRequests");
      method == "tasks/update" && !asked.is_null()) {
    const std::string name = asked.begin().key();  // one question at a time
    if (const Json response = member(member(parameters, "inputResponses"), name);
        !response.is_null()) {
      task.state.erase("inputRequests");
      take_response(question_of(name), response);
      change_task(task.state["taskId"], "working", "answered");
    }
  }
  if (method == "tasks/cancel" && task.call != 0 && !std::exchange(task.withdrawn, true))
    given_up_.push_back(task.call);
  reply(request, Json::object());
}

void Session::change_task(const std::string& id, const std::string& status,
                          const std::string& text) {
  Json& state = tasks_[id].state;
  const bool asks = status == "working" && state.contains("inputRequests");
  state["status"] = asks ? "input_required" : status;
  state["statusMessage"] = text;
  state["lastUpdatedAt"] = stamp_of(date_);
  for (const Listener& listener : listeners_)
    if (listener.tasks.contains(id))
      tell(listener, "notifications/tasks", state);
}

/// result: of the call; json: as the client gets it.
void Session::end_task(const std::string& id, Json json, const Result& result) {
  Task& task = tasks_[id];
  task.call = 0;
  task.state.erase("inputRequests");
  const bool canceled = task.withdrawn && result.is_error;
  if (!canceled)
    task.state["result"] = std::move(json);
  change_task(id, canceled ? "cancelled" : "completed", result.text);
}

}  // namespace saphira::mcp

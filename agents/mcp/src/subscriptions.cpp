// Changes that a client wants to hear of: of tools, resources and tasks.
#include <algorithm>
#include <utility>

#include "protocol.hpp"

namespace saphira::mcp {

namespace {

constexpr std::size_t kMostListeners = 16;
constexpr double kPause = 1.0;  // [s] between two notifications of one thing

}  // namespace

void Session::set_tools(std::vector<Tool> tools) {
  std::ranges::sort(tools, [](const Tool& a, const Tool& b) { return a.name < b.name; });
  if (tools == tools_)
    return;
  tools_ = std::move(tools);
  news_ = news_ || !waits_;  // while they wait, no client has a list
  tell_tools();
}

void Session::tell_tools() {
  if (!news_ || time_ < told_ + kPause)
    return;
  news_ = false;
  for (const Listener& listener : listeners_)
    if (listener.tools) {
      tell(listener, "notifications/tools/list_changed", Json::object());
      told_ = time_;
    }
}

void Session::turn(double time, double date) {
  time_ = time;
  date_ = date;
  tell_tools();
  std::erase_if(watched_, [this](const auto& each) {
    return std::ranges::none_of(listeners_, [&](const Listener& listener) {
      return listener.resources.contains(each.first);
    });
  });
  for (const auto& [uri, watched] : watched_)
    watch(uri);
  forget_tasks();
}

/// Reads a resource for those who listen, if that is due.
void Session::watch(const std::string& uri) {
  Watched& watched = watched_[uri];
  const Tool* const tool = resource(uri);
  if (watched.is_read || time_ < watched.next || tool == nullptr)
    return;
  watched.is_read = true;
  const std::uint64_t number = ++count_;
  Open& open = open_[number];
  open.tool = tool->name;
  open.uri = uri;
  open.watches = true;
  calls_.push_back({number, tool->name, Json::object(), false, true});
}

/// The text of a watched resource. The first one is only remembered.
void Session::see(const std::string& uri, const std::string& text) {
  const auto found = watched_.find(uri);
  if (found == watched_.end())
    return;
  Watched& watched = found->second;
  watched.is_read = false;
  watched.next = time_ + kPause;
  const std::optional<std::string> before = std::exchange(watched.text, text);
  if (!before || *before == text)
    return;
  for (const Listener& listener : listeners_)
    if (listener.resources.contains(uri))
      tell(listener, "notifications/resources/updated", {{"uri", uri}});
}

void Session::tell(const Listener& listener, const std::string& method, Json parameters) {
  if (listener.request.modern)
    parameters["_meta"][kMeta + "subscriptionId"] = listener.request.id;
  Json message{{"jsonrpc", "2.0"}, {"method", method}};
  if (!parameters.empty())
    message["params"] = std::move(parameters);
  send(message, listener.request.exchange);
}

/// The listener of the older era.
Session::Listener& Session::older() {
  const auto found =
      std::ranges::find_if(listeners_, [](const Listener& each) { return !each.request.modern; });
  return found == listeners_.end() ? listeners_.emplace_back() : *found;
}

void Session::subscribe(const Request& request, const Json& uri, bool wanted) {
  if (wanted && resource(uri) == nullptr)
    return no_resource(request, uri);
  if (wanted) {
    older().resources.insert(uri.get<std::string>());
    watch(uri.get<std::string>());
  } else if (uri.is_string()) {
    older().resources.erase(uri.get<std::string>());
  }
  reply(request, Json::object());
}

/// A request that stays open: it receives the changes.
void Session::listen(const Request& request, const Json& parameters) {
  if (listeners_.size() >= kMostListeners)
    return error(request, kBadRequest, "too many subscriptions are open");
  const Json wanted = member(parameters, "notifications");
  const Json tasks = member(wanted, "taskIds");
  if (!tasks.is_null() && lacks_tasks(request, parameters))
    return;
  Listener listener{request, member(wanted, "toolsListChanged") == true};
  Json honoured = Json::object();
  if (listener.tools)
    honoured["toolsListChanged"] = true;
  for (const Json& uri : member(wanted, "resourceSubscriptions"))
    if (resource(uri) != nullptr && listener.resources.insert(uri.get<std::string>()).second)
      honoured["resourceSubscriptions"].push_back(uri);
  for (const Json& id : tasks)
    if (id.is_string() && tasks_.contains(id.get<std::string>()) &&
        listener.tasks.insert(id.get<std::string>()).second)
      honoured["taskIds"].push_back(id);
  tell(listener, "notifications/subscriptions/acknowledged",
       {{"notifications", std::move(honoured)}});
  for (const std::string& uri : listener.resources)
    watch(uri);
  listeners_.push_back(std::move(listener));
}

void Session::end() {
  for (const Listener& listener : std::exchange(listeners_, {})) {
    if (!listener.request.modern)
      continue;
    const Json& id = listener.request.id;
    tell(listener, "notifications/cancelled", {{"requestId", id}});
    reply(listener.request, {{"_meta", {{kMeta + "subscriptionId", id}}}});
  }
}

}  // namespace saphira::mcp

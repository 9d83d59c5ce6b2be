#include "saphira/mcp/clients.hpp"

#include <algorithm>
#include <tuple>

namespace saphira::mcp {

std::optional<std::string> Clients::place() const {
  if (all_.size() - all_.count(kNobody) < kMost)
    return "";
  const auto rank = [](const auto& each) {
    return std::tuple(each.first == kNobody || each.second.state.busy, each.second.state.waits,
                      each.second.asked);
  };
  const auto first = std::ranges::min_element(
      all_, [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return std::get<0>(rank(*first)) ? std::nullopt : std::optional(first->first);
}

std::string Clients::begin(const std::string& id, const std::string& name, double now) {
  all_[id] = {.asked = now, .seen = now};
  return (name.empty() ? "" : name + " ") + std::to_string(++count_);
}

void Clients::came(const std::string& id, bool hidden, double now) {
  Client& client = all_.at(id);
  client.hidden = hidden;
  client.asked = now;
  client.seen = now;
  client.lost = false;
}

void Clients::see(const std::string& id, const State& state, double now) {
  Client& client = all_.at(id);
  const bool closes = state.connections < client.state.connections;
  client.state = state;
  client.lost = client.lost && state.busy;
  if (state.silent)
    client.seen = now;
  const bool by_messages = state.busy && (client.hidden || (client.answers && state.streams));
  if (!by_messages && (closes || state.connections > 0))
    client.seen = std::max(client.seen, closes ? now : std::min(state.heard, now));
}

bool Clients::loses_goals(const std::string& id, double now) {
  Client& client = all_.at(id);
  if (client.lost || !client.state.busy || now - client.seen < kAbsent)
    return false;
  client.lost = true;
  return true;
}

bool Clients::is_gone(const std::string& id, double now) const {
  return now - all_.at(id).seen >= kSilent;
}

bool Clients::is_pinged(const std::string& id, double now) {
  Client& client = all_.at(id);
  if (!client.state.busy || !client.state.streams || now - client.pinged < kPing)
    return false;
  client.pinged = now;
  return true;
}

bool Clients::may_begin(const std::string& id) const {
  return id != kNobody &&
         static_cast<std::size_t>(std::ranges::count_if(all_, [&](const auto& each) {
           return each.first != id && each.second.state.busy;
         })) < kMostBusy;
}

}  // namespace saphira::mcp

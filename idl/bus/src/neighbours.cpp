#include "neighbours.hpp"

#include <algorithm>

#include "saphira/bus/status_words.hpp"

namespace saphira::bus::internal {

namespace {

// [s] A program that serves for less is a newcomer, which may not have known of the other.
constexpr double kMoment = 3.0;
// Statuses come once a second.
constexpr std::chrono::seconds kBreak{3};

bool yields(const v1::ServiceStatus& own, const v1::ServiceStatus& other) {
  if (!serves(other) || other.instance == own.instance)
    return false;
  if (!serves(own))
    return true;
  const bool own_newcomer = own.uptime < kMoment;
  const bool other_newcomer = other.uptime < kMoment;
  return own_newcomer == other_newcomer ? other.instance < own.instance : own_newcomer;
}

}  // namespace

void Neighbours::update(const WriterId& writer, const v1::ServiceStatus& status, Time now) {
  const auto [known, is_new] = all_.try_emplace(writer, Neighbour{status, now, now});
  Neighbour& neighbour = known->second;
  if (!is_new && neighbour.status.stamp != status.stamp) {
    if (now - neighbour.changed > kBreak)
      neighbour.began = now;
    neighbour.changed = now;
  }
  neighbour.status = status;
}

void Neighbours::lose(const WriterId& writer) {
  all_.erase(writer);
}

std::optional<std::string> Neighbours::serves_instead(const v1::ServiceStatus& own) const {
  for (const auto& [writer, neighbour] : all_) {
    const v1::ServiceStatus& other = neighbour.status;
    if (other.name == own.name && yields(own, other))
      return another(other) + " serves this robot; waits until that is gone";
  }
  return std::nullopt;
}

bool Neighbours::knows(const Peers::Program& program) const {
  return std::ranges::any_of(
      all_, [&](const auto& item) { return Peers::program_of(item.first) == program; });
}

bool Neighbours::stepping_since(Time since, Time now) const {
  return std::any_of(all_.begin(), all_.end(), [&](const auto& item) {
    const Neighbour& neighbour = item.second;
    return serves(neighbour.status) && neighbour.began <= since && now - neighbour.changed < kBreak;
  });
}

}  // namespace saphira::bus::internal

#include "saphira/authority/arbiter.hpp"

#include <algorithm>
#include <cstdio>

namespace saphira::authority {

namespace {

constexpr std::size_t kMaxRefused = 16;    // the sequence in Grant
constexpr std::size_t kMaxWriters = 1024;  // bounds the memory that strangers can take
constexpr double kTick = 1e-9;             // [s] 3 cycles x 0.1 s are not over after 3 cycles

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", value);
  return text;
}

}  // namespace

const char* name(Role role) {
  switch (role) {
    case Role::estop:
      return "estop";
    case Role::teleop:
      return "teleop";
    case Role::direct:
      return "direct";
    case Role::behaviors:
      return "behaviors";
    case Role::none:
      break;
  }
  return "none";
}

void Arbiter::let_go() {
  for (Player& p : players_)
    p.held = p.held && p.newest.role == Role::estop;
}

void Arbiter::connect(std::uint64_t epoch) {
  epoch_ = epoch;
  deaf_cycle_ = 0;
  deaf_until_ = -1e300;
  let_go();
}

void Arbiter::forget(std::uint64_t cycle, double until) {
  deaf_cycle_ = cycle;
  deaf_until_ = until;
  let_go();
}

void Arbiter::refuse(Role role, const std::string& source, const std::string& reason) {
  ++refused_count_;
  Refusal refusal{role, source, reason};
  if (refused_.size() < kMaxRefused &&
      std::find(refused_.begin(), refused_.end(), refusal) == refused_.end())
    refused_.push_back(std::move(refusal));
}

bool Arbiter::offer(const Command& command, std::uint64_t cycle) {
  const auto no = [&](const std::string& reason) {
    refuse(command.role, command.source, reason);
    return false;
  };
  if (command.role == Role::none)
    return no("no role");
  const auto key = std::make_pair(command.role, command.writer);
  auto known = numbers_.find(key);
  // A button that says the same again is still pressed.
  if (known != numbers_.end() && command.number <= known->second.newest &&
      command.role != Role::estop)
    return no("repeated command number");
  if (known == numbers_.end()) {
    if (numbers_.size() >= kMaxWriters)
      numbers_.erase(std::min_element(numbers_.begin(), numbers_.end(), [](auto& a, auto& b) {
        return a.second.used < b.second.used;
      }));
    known = numbers_.try_emplace(key).first;
  }
  known->second = {command.number, ++offers_};

  Player& p = player(command.role);
  const bool holds = p.held && p.newest.writer == command.writer;
  // A release is never refused to the one who drives: whatever is wrong with it, it means stop.
  if (!command.active) {
    if (holds) {
      p.newest.active = false;
      p.newest.number = command.number;
      p.newest.received = command.received;
    } else if (!p.held) {
      p.held = true;
      p.newest = command;
    }
    return true;
  }
  // An emergency stop is heard whatever it answers, and its age is that of its arrival.
  if (command.role == Role::estop) {
    p.held = true;
    p.newest = command;
    p.newest.cycle = 0;
    return true;
  }
  if (epoch_ == 0)
    return no("no robot is connected");
  if (command.epoch != epoch_ && (command.epoch != 0 || command.cycle != 0))
    return no("answers another epoch");
  if (command.received < deaf_until_)
    return no("received while the robot was silent, or the bridge caught up after a gap");
  if (command.cycle != 0) {
    if (command.cycle > cycle)
      return no("answers a cycle that has not been");
    if (command.cycle <= deaf_cycle_)
      return no("answers a cycle from before a gap");
    if (cycle - command.cycle > settings_.intent_cycles)
      return no("answers an old cycle");
  }
  if (p.held && !holds && p.newest.active &&
      command.received - p.newest.received <= settings_.lease + kTick)
    return no("the role is held by " + p.newest.source);
  p.held = true;
  p.newest = command;
  return true;
}

void Arbiter::lost(Role role, const WriterId& writer, double now) {
  Player& p = player(role);
  if (p.held && p.newest.writer == writer && p.newest.active) {
    p.newest.active = false;
    p.newest.received = now;
  }
}

bool Arbiter::live(const Player& p, double now, std::uint64_t cycle) const {
  // What came later than now came before the cycles began anew.
  return p.held && p.newest.active && now >= p.newest.received - kTick &&
         now - p.newest.received <= settings_.lease + kTick &&
         (p.newest.cycle == 0 || cycle - p.newest.cycle <= settings_.intent_cycles);
}

std::string Arbiter::why_not(const Player& p, double now, std::uint64_t cycle) const {
  const std::string who = p.newest.source + " (" + name(p.newest.role) + ")";
  if (!p.newest.active)
    return who + " does not want to drive";
  if (now - p.newest.received > settings_.lease + kTick)
    return "the lease of " + who + " ran out: its newest command is " +
           seconds(now - p.newest.received) + " old";
  return who + " answers an old cycle: " + std::to_string(cycle - p.newest.cycle) + " ago";
}

Grant Arbiter::decide(double now, std::uint64_t cycle) {
  Grant grant;
  Role strongest = Role::none;
  for (const Role role : kRoles) {
    if (live(player(role), now, cycle)) {
      strongest = role;
      break;
    }
  }
  // The end of a person's driving, by release or by silence, begins the quiet time. By silence it
  // counts from the end of the lease, however late that is noticed.
  if (is_person(person_) && !is_person(strongest)) {
    const Player& p = player(person_);
    const bool released = p.held && !p.newest.active;
    quiet_after_ = person_;
    quiet_until_ = (released ? p.newest.received : std::min(now, person_seen_)) + settings_.quiet;
  }
  person_ = is_person(strongest) ? strongest : Role::none;
  if (person_ != Role::none)
    person_seen_ = player(person_).newest.received + settings_.lease;

  if (strongest != Role::none && !is_person(strongest) && now < quiet_until_ - kTick) {
    grant.reason = std::string("quiet after ") + name(quiet_after_) + ": " +
                   seconds(quiet_until_ - now) + " left";
    for (const Role role : kRoles) {
      if (live(player(role), now, cycle))
        refuse(role, player(role).newest.source, std::string("quiet after ") + name(quiet_after_));
    }
    return grant;
  }
  if (strongest == Role::none) {
    for (const Role role : kRoles) {
      const Player& p = player(role);
      if (p.held && (grant.reason.empty() || p.newest.active))
        grant.reason = why_not(p, now, cycle);
    }
    if (epoch_ == 0)
      grant.reason = "no robot is connected";
    else if (grant.reason.empty())
      grant.reason = "nobody asked to drive";
    return grant;
  }

  const Player& p = player(strongest);
  grant.role = strongest;
  grant.writer = p.newest.writer;
  grant.source = p.newest.source;
  grant.command_age = now - p.newest.received;
  grant.expires_in = settings_.lease - grant.command_age;
  grant.reason = std::string(name(strongest)) + " is the strongest role with a live command";
  for (const Role role : kRoles) {
    if (role > strongest && live(player(role), now, cycle))
      refuse(role, player(role).newest.source,
             std::string(name(strongest)) + " is stronger and drives");
  }
  return grant;
}

std::vector<Refusal> Arbiter::take_refused() {
  std::vector<Refusal> out;
  out.swap(refused_);
  return out;
}

}  // namespace saphira::authority

#include "saphira/authority/arbiter.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "saphira/base/cycle.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/base/format.hpp"

namespace saphira::authority {

namespace {

constexpr std::size_t kMaxRefused = 16;    // the sequence in Grant
constexpr std::size_t kMaxWriters = 1024;  // bounds the memory that unknown writers can take
constexpr std::size_t kMaxStopped = 24;    // the same for a file
constexpr std::size_t kMaxPressed = 64;    // the same for emergency stops
constexpr double kTick = 1e-9;             // [s] 3 cycles x 0.1 s are not over after 3 cycles
constexpr double kNever = -1e300;          // [s]
constexpr double kTriesAgain = 5.0;        // [s] the longest pause of a program between two tries

/// [s] since the cycle that a command answers.
double age_of(const Command& command, std::uint64_t cycle) {
  return seconds_of(cycle - command.cycle);
}

constexpr std::array kDriving{Role::teleop, Role::direct, Role::behaviors};
constexpr const char* kInterrupted = "the link to the robot was interrupted while a person drove";
constexpr const char* kHandBack = "saphira drive hand-back";

bool is_autonomy(Role role) {
  return role == Role::direct || role == Role::behaviors;
}

std::string seconds(double value) {
  return format("%.2f s", value);
}

}  // namespace

const char* name(Role role) {
  return word_of(role, {"none", "estop", "teleop", "direct", "behaviors"});
}

void Arbiter::let_go() {
  for (Player& p : players_)
    p.held = false;
  // The person's program counts as alive when it is heard again.
  quiet_heard_ = kNever;
}

void Arbiter::connect(std::uint64_t epoch) {
  epoch_ = epoch;
  stop_cycle_ = 0;
  deaf_cycle_ = 0;
  deaf_until_ = kNever;
  if (const Player& person = player(Role::teleop); person.held && person.newest.active)
    must_let_go(person.newest.writer, kInterrupted);
  let_go();
}

void Arbiter::forget(std::uint64_t cycle, double until, std::string why) {
  deaf_cycle_ = cycle;
  deaf_until_ = until;
  deaf_why_ = std::move(why);
  let_go();
}

void Arbiter::refuse(Role role, const std::string& source, const std::string& reason) {
  ++refused_count_;
  Refusal refusal{role, source, reason};
  if (refused_.size() < kMaxRefused &&
      std::find(refused_.begin(), refused_.end(), refusal) == refused_.end())
    refused_.push_back(std::move(refusal));
}

void Arbiter::press(const Command& command) {
  if (!latches_.estopped) {
    latches_.estopped = true;
    latches_.estop_source = last_stopper_ = command.source;
    // Goals that do not hear of it now have to heed it later. The epoch differs over a restart.
    Fnv1a asker;
    for (const std::uint8_t byte : command.writer)
      asker.add(byte);
    latches_.stop = {asker.value(), epoch_ + command.number};
    latches_.stop_source = command.source;
  }
  if (pressed_.size() >= kMaxPressed && !pressed_.contains(command.writer))
    pressed_.erase(std::min_element(pressed_.begin(), pressed_.end(), [](auto& a, auto& b) {
      return a.second.received < b.second.received;
    }));
  pressed_[command.writer] = {command.source, command.received};
}

bool Arbiter::offer(const Command& command, std::uint64_t cycle) {
  const auto no = [&](const std::string& reason) {
    refuse(command.role, command.source, reason);
    return false;
  };
  if (command.role == Role::none)
    return no("no role");
  // An emergency stop is heard with any number, and for any cycle.
  if (command.role == Role::estop) {
    if (command.active)
      press(command);
    else
      pressed_.erase(command.writer);
    return true;
  }
  const auto key = std::make_pair(command.role, command.writer);
  auto known = numbers_.find(key);
  if (known != numbers_.end() && command.number <= known->second.newest)
    return no("repeated command number");
  if (known == numbers_.end()) {
    if (numbers_.size() >= kMaxWriters)
      numbers_.erase(std::min_element(numbers_.begin(), numbers_.end(), [](auto& a, auto& b) {
        return a.second.used < b.second.used;
      }));
    known = numbers_.try_emplace(key).first;
    // First heard of now, it drove before the stop.
    if (command.cycle != 0 && command.epoch == epoch_ && command.cycle <= stop_cycle_)
      must_heed(known->second);
  }
  Numbers& said = known->second;
  said.newest = command.number;
  said.used = ++offers_;
  said.source = command.source;
  if (!command.active) {
    said.newest_at = said.drove = kNever;
    said.must_let_go.clear();
    if (std::exchange(said.stopped, false))
      keep_stopped();
    return release(command, cycle);
  }
  if (command.role == Role::direct && latches_.estopped && said.newest_at == kNever)
    began_pressed_ = command.received;
  said.newest_at = command.received;

  if (const std::string wrong = stale(command, cycle); !wrong.empty()) {
    if (command.role == Role::teleop &&
        (epoch_ == 0 || (command.epoch != 0 && command.epoch != epoch_)))
      said.must_let_go = kInterrupted;  // drove before this connection began
    return no(wrong);
  }
  Player& p = player(command.role);
  // A driver that has to let go first holds nothing.
  const bool heard =
      p.held && p.newest.active && fresh(p, command.received) && why_to_let_go(p.newest).empty();
  const bool another = heard && p.newest.writer != command.writer;
  if (another)
    return no(command.role == Role::teleop
                  ? p.newest.source + " drives: stop first (space), then drive"
                  : "the role is held by " + p.newest.source);
  if (command.role == Role::teleop)
    quiet_heard_ = kNever;
  if (!heard || another || command.cycle == 0 || command.cycle > p.newest.cycle)
    p.moved_on = command.received;
  p.held = true;
  p.newest = command;
  if (said.stopped && command.heeds == latches_.stop) {
    said.must_let_go.clear();
    said.stopped = false;
    keep_stopped();
  }
  return true;
}

/// A release by the present driver is never refused: even a faulty one means stop.
bool Arbiter::release(const Command& command, std::uint64_t cycle) {
  Player& p = player(command.role);
  const bool held = p.held && p.newest.active && fresh(p, command.received);
  const bool holds = p.held && p.newest.writer == command.writer;
  if (holds || !held) {
    p.held = true;
    p.newest = command;
    p.newest.active = false;
  }
  if (command.role != Role::teleop)
    return true;
  if (command.writer == person_) {
    if (command.received - quiet_heard_ > settings_.lease + kTick)
      quiet_since_ = command.received;
    quiet_heard_ = command.received;
  }
  if (!command.hand_back || latches_.wait == Wait::none)
    return true;
  std::string wrong = stale(command, cycle);
  if (latches_.estopped)
    wrong = "an emergency stop is latched: saphira estop reset comes before handing back";
  else if (held && !holds)
    wrong = "cannot hand back what " + p.newest.source + " drives";
  if (wrong.empty())
    latches_.wait = Wait::none;
  else
    refuse(command.role, command.source, wrong);
  return true;
}

/// The reason why a command that asks for motion is stale; empty where it is not.
std::string Arbiter::stale(const Command& command, std::uint64_t cycle) const {
  if (epoch_ == 0)
    return "no robot is connected";
  if (command.epoch != epoch_ && (command.epoch != 0 || command.cycle != 0))
    return "answers another epoch";
  if (command.received < deaf_until_)
    return deaf_why_.empty()
               ? "received while the robot was silent, or the bridge caught up after a gap"
               : deaf_why_;
  if (command.cycle != 0) {
    if (command.cycle > cycle)
      return "answers a cycle that has not been";
    if (command.cycle <= deaf_cycle_)
      return "answers a cycle from before a gap";
    if (age_of(command, cycle) > settings_.oldest + kTick)
      return "answers an old cycle";
  }
  return {};
}

void Arbiter::lost(Role role, const WriterId& writer, double now) {
  if (role == Role::estop)
    pressed_.erase(writer);
  if (role == Role::teleop && writer == person_)
    quiet_heard_ = kNever;
  Player& p = player(role);
  if (p.held && p.newest.writer == writer && p.newest.active) {
    if (role == Role::teleop)
      must_let_go(writer, kInterrupted);  // it may come back
    p.newest.active = false;
    p.newest.received = now;
  }
}

void Arbiter::must_heed(Numbers& said) const {
  said.must_let_go = "stopped by " + latches_.stop_source;
  said.stopped = true;
}

std::vector<std::string> Arbiter::stop(const v1::StopId& id, const std::string& source, double now,
                                       std::uint64_t cycle) {
  latches_.stop = id;
  latches_.stop_source = last_stopper_ = source;
  stop_cycle_ = cycle;
  std::vector<std::string> stopped;
  for (const Role role : kDriving) {
    for (auto& [key, said] : numbers_) {
      if (key.first != role || said.newest_at == kNever)
        continue;
      must_heed(said);
      if (now - said.newest_at <= settings_.lease + kTick)
        stopped.push_back(said.source + " (" + name(role) + ")");
    }
  }
  keep_stopped();
  return stopped;
}

/// The stopped drivers, for a restart: those heard last.
void Arbiter::keep_stopped() {
  std::vector<std::pair<std::uint64_t, Stopped>> all;
  for (const auto& [key, said] : numbers_)
    if (said.stopped)
      all.emplace_back(said.used, Stopped{key.first, key.second});
  std::ranges::sort(all, std::greater(), [](const auto& one) { return one.first; });
  all.resize(std::min(all.size(), kMaxStopped));
  latches_.stopped.clear();
  for (const auto& [used, one] : all)
    latches_.stopped.push_back(one);
}

void Arbiter::restore(const Latches& latches) {
  latches_ = latches;
  last_stopper_ = latches.stop_source;
  for (const Stopped& one : latches.stopped)
    must_heed(numbers_[{one.role, one.writer}]);
}

/// The reason why the writer has to let go, or to heed the newest stop, before it drives; empty: it
/// need not.
std::string Arbiter::why_to_let_go(const Command& command) const {
  const auto said = numbers_.find({command.role, command.writer});
  if (said != numbers_.end() && !said->second.must_let_go.empty())
    return said->second.must_let_go + ": let go first, then drive";
  if (command.role == Role::behaviors && command.heeds != latches_.stop &&
      latches_.stop != v1::StopId{})
    return "stopped by " + latches_.stop_source + ": the goals of before have not ended yet";
  return {};
}

std::string Arbiter::reset(const std::string& source, double now) {
  if (!latches_.estopped)
    return "no emergency stop is latched";
  for (const auto& [writer, press] : pressed_) {
    if (now >= press.received - kTick && now - press.received <= settings_.lease + kTick) {
      std::string why = press.source + " still presses the emergency stop: let it go first";
      refuse(Role::estop, source, why);
      return why;
    }
  }
  pressed_.clear();
  latches_.estopped = false;
  latches_.estop_source.clear();
  // Only a driver that was at rest before the reset, and was heard to be, may begin again by
  // itself. The behaviors come to rest when their goals end, which an emergency stop causes. A
  // driver that was not heard may not know of the stop.
  const Player& behaviors = player(Role::behaviors);
  const Player& direct = player(Role::direct);
  const bool rests = behaviors.held && !behaviors.newest.active && fresh(behaviors, now) &&
                     !(direct.held && direct.newest.active) && now - began_pressed_ > kTriesAgain;
  if (!rests && latches_.wait == Wait::none)
    latches_.wait = Wait::reset;
  const Player& person = player(Role::teleop);
  if (person.held && person.newest.active && fresh(person, now))
    must_let_go(person.newest.writer, "the emergency stop was reset while a person drove");
  for (auto& [key, said] : numbers_)
    if (key.first == Role::direct && said.newest_at != kNever)
      said.must_let_go = "the emergency stop was reset while it asked to drive";
  quiet_heard_ = kNever;
  return {};
}

/// Heard within its lease. A receipt later than now is from before the cycles began anew.
bool Arbiter::fresh(const Player& p, double now) const {
  return now >= p.newest.received - kTick && now - p.newest.received <= settings_.lease + kTick;
}

bool Arbiter::live(const Player& p, double now, std::uint64_t cycle) const {
  return p.held && p.newest.active && fresh(p, now) &&
         now - p.moved_on <= settings_.lease + kTick &&
         (p.newest.cycle == 0 || age_of(p.newest, cycle) <= settings_.oldest + kTick);
}

std::string Arbiter::why_not(const Player& p, double now, std::uint64_t cycle) const {
  const std::string who = p.newest.source + " (" + name(p.newest.role) + ")";
  if (now - p.newest.received > settings_.lease + kTick)
    return "the lease of " + who + " ran out: its newest command is " +
           seconds(now - p.newest.received) + " old";
  if (now - p.moved_on > settings_.lease + kTick)
    return who + " repeats what it answered " + seconds(now - p.moved_on) +
           " ago: it hangs, or does not hear the robot";
  return who + " answers a state of " + seconds(age_of(p.newest, cycle)) + " ago, which is too old";
}

/// A stopped program that drives on does not keep weaker roles from driving. A person does, whose
/// hand is at the robot.
Role Arbiter::strongest(double now, std::uint64_t cycle) const {
  Role stopped = Role::none;
  for (const Role role : kDriving) {
    if (!live(player(role), now, cycle))
      continue;
    if (role == Role::teleop || why_to_let_go(player(role).newest).empty())
      return role;
    if (stopped == Role::none)
      stopped = role;
  }
  return stopped;
}

/// The reason why a role with a live command may not drive; empty where it may.
std::string Arbiter::why_to_stand(Role role) const {
  if (latches_.estopped)
    return "an emergency stop is latched, pressed by " + latches_.estop_source +
           ": saphira estop reset releases it";
  if (std::string why = why_to_let_go(player(role).newest); role != Role::none && !why.empty())
    return why;
  if (!is_autonomy(role))
    return {};
  switch (latches_.wait) {
    case Wait::driven:
      return std::string("a person drove last: autonomy waits until the robot is handed back (") +
             kHandBack + ")";
    case Wait::reset:
      return std::string(
                 "an emergency stop was reset, and earlier goals do not go "
                 "on by themselves: autonomy waits until the robot is handed back (") +
             kHandBack + ")";
    case Wait::none:
      break;
  }
  return {};
}

/// With the option `quiet`, the quiet time of a person whose program is alive hands the robot back.
void Arbiter::end_wait(double now) {
  if (latches_.wait == Wait::driven && now - quiet_heard_ <= settings_.lease + kTick &&
      now - quiet_since_ >= settings_.quiet - kTick)
    latches_.wait = Wait::none;
}

void Arbiter::must_let_go(const WriterId& person, const char* why) {
  if (const auto known = numbers_.find({Role::teleop, person}); known != numbers_.end())
    known->second.must_let_go = why;
}

/// A short gap costs no more than its time. After a longer one the person may not look any more.
void Arbiter::watch_person(double now, std::uint64_t cycle) {
  const Player& p = player(Role::teleop);
  const auto known = numbers_.find({Role::teleop, p.newest.writer});
  if (known == numbers_.end() || !live(p, now, cycle))
    return;
  double& drove = known->second.drove;
  if (drove != kNever && now - drove > settings_.interruption + kTick)
    must_let_go(p.newest.writer, kInterrupted);
  drove = now;
}

Grant Arbiter::decide(double now, std::uint64_t cycle) {
  watch_person(now, cycle);
  const Role role = strongest(now, cycle);
  if (!latches_.estopped)
    end_wait(now);
  Grant grant;
  grant.estopped = latches_.estopped;
  grant.estop_source = latches_.estop_source;
  grant.stop = latches_.stop;
  grant.stop_source = last_stopper_;
  const std::string why = why_to_stand(role);
  if (role != Role::none && !why.empty()) {
    for (const Role other : kDriving) {
      if (!live(player(other), now, cycle))
        continue;
      const std::string own = why_to_let_go(player(other).newest);
      refuse(other, player(other).newest.source, own.empty() ? why : own);
    }
  }
  if (role == Role::teleop && why.empty()) {
    latches_.wait = Wait::driven;
    person_ = player(role).newest.writer;
  }
  grant.waits_for_hand_back = latches_.wait != Wait::none && role != Role::teleop;
  if (latches_.estopped) {
    grant.role = Role::estop;
    grant.source = latches_.estop_source;
    grant.reason = "the emergency stop is latched: saphira estop reset releases it";
    return grant;
  }
  if (!why.empty()) {
    grant.reason = why;
    return grant;
  }
  if (role == Role::none) {
    for (const Role each : kDriving) {
      const Player& p = player(each);
      // A driver that has let go is no reason to wait, least of all a person who drove minutes ago.
      if (p.held && p.newest.active)
        grant.reason = why_not(p, now, cycle);
    }
    if (epoch_ == 0)
      grant.reason = "no robot is connected";
    else if (grant.reason.empty())
      grant.reason = "nothing asks the robot to move";
    return grant;
  }

  const Player& p = player(role);
  grant.role = role;
  grant.writer = p.newest.writer;
  grant.source = p.newest.source;
  if (p.newest.cycle != 0)
    grant.answers = {p.newest.epoch, p.newest.cycle};
  grant.number = p.newest.number;
  grant.command_age = p.newest.cycle == 0 ? now - p.newest.received : age_of(p.newest, cycle);
  grant.expires_in = settings_.lease - (now - p.moved_on);
  grant.reason = "no stronger driver sends commands";
  for (const Role other : kDriving) {
    if (other == role || !live(player(other), now, cycle))
      continue;
    const std::string own = why_to_let_go(player(other).newest);
    refuse(other, player(other).newest.source,
           own.empty() ? std::string(name(role)) + " is stronger and drives" : own);
  }
  return grant;
}

std::vector<Refusal> Arbiter::take_refused() {
  std::vector<Refusal> out;
  out.swap(refused_);
  return out;
}

}  // namespace saphira::authority

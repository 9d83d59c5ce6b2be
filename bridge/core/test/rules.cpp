#include "rules.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace saphira::bridge::test {

namespace {

using authority::Role;

constexpr double kLate = 2e-4;  // [s] a lease ends at the next check of the clock

template <class... Kinds>
bool is_any(const protocol::Command& command) {
  return (std::holds_alternative<Kinds>(command) || ...);
}

bool is_usable(double number) {
  return std::isfinite(number) && std::abs(number) <= 1e4;
}

}  // namespace

void Rules::wrong(const std::string& what) {
  if (played_.wrong.empty())
    played_.wrong = what + ", at " + std::to_string(now_) + " s, cycle " +
                    std::to_string(stamp_.cycle) + " of epoch " + std::to_string(stamp_.epoch);
}

double Rules::time() const {
  return settings_.lockstep ? 0.1 * static_cast<double>(stamp_.cycle) : now_;
}

// ---- Events.

void Rules::command(const DriveCommand& in) {
  const authority::Command& command = in.command;
  if (command.role == Role::behaviors && command.epoch == stamp_.epoch &&
      command.cycle == stamp_.cycle)
    answered_ = true;
  if (command.role == Role::estop) {
    if (command.active) {
      latched_ = true;
      ++played_.stops;
      pressed_[command.writer] = time();
    } else {
      pressed_.erase(command.writer);
    }
    return;
  }
  const bool sound = in.wrong.empty() && is_usable(in.motion.velocity) &&
                     is_usable(in.motion.rotation_velocity) && is_usable(in.motion.heading) &&
                     is_usable(in.motion.distance) && is_usable(in.contact_speed);
  if (command.active && !sound)
    return;
  Writer writer{command.role, command.writer};
  std::vector<Wish>& wishes = wishes_[writer];
  const auto [newest, is_new] = numbers_.try_emplace(writer, command.number);
  const bool repeated = !is_new && command.number <= newest->second;
  newest->second = std::max(newest->second, command.number);
  if (repeated)
    return;
  if (!command.active || command.heeds == stop_)
    must_heed_.erase(writer);
  if (!command.active) {
    wishes.clear();
    return;
  }
  const bool heeds = command.heeds == stop_ || command.role != Role::behaviors;
  if (heeds && !must_heed_.contains(writer))
    wishes.push_back({time(), command.epoch, command.cycle});
}

void Rules::writer_lost(Role role, const authority::WriterId& writer) {
  wishes_.erase({role, writer});
  if (role == Role::estop)
    pressed_.erase(writer);
}

void Rules::released(bool latched_now) {
  if (latched_ && !latched_now) {
    ++played_.resets;
    for (const auto& [writer, when] : pressed_)
      if (time() >= when && time() - when <= settings_.lease)
        wrong("the emergency stop was released while it was pressed");
    pressed_.clear();
  }
  latched_ = latched_now;
}

void Rules::stopped(const v1::StopId& id) {
  ++played_.stopped;
  stop_ = id;
  for (auto& [writer, wishes] : wishes_)
    if (!std::exchange(wishes, {}).empty())
      must_heed_.insert(writer);
}

void Rules::gap() {
  if (settings_.lockstep || stamp_.epoch == 0)
    return;
  ++played_.gaps;
  good_after_ = now_ + 0.1;
  last_packet_ = now_;
  must_stop_ = true;
  zero_velocity_ = zero_turn_ = false;
}

void Rules::tick() {
  if (settings_.lockstep || stamp_.epoch == 0 || silent_ || now_ - last_packet_ <= 0.5)
    return;
  ++played_.silences;
  silent_ = true;
  must_stop_ = true;
  zero_velocity_ = zero_turn_ = false;
}

// ---- Outputs.

void Rules::begins(const v1::Stamp& stamp) {
  if (stamp.epoch <= last_epoch_)
    wrong("the epoch is not new");
  stamp_ = stamp;
  last_epoch_ = stamp.epoch;
  last_packet_ = now_;
  good_after_ = now_;
  silent_ = false;
  answered_ = false;
  for (auto& [writer, wishes] : wishes_)
    wishes.clear();
  ++played_.sessions;
}

void Rules::output(const Output& output) {
  if (const auto* const send = std::get_if<Send>(&output))
    packets(send->bytes);
  if (const auto* const session = std::get_if<SessionBegan>(&output))
    begins(session->stamp);
  if (const auto* const cycle = std::get_if<CycleBegan>(&output)) {
    if (cycle->stamp != v1::Stamp{stamp_.epoch, stamp_.cycle + 1})
      wrong("a cycle was left out");
    ++played_.cycles;
    stamp_ = cycle->stamp;
    last_packet_ = now_;
    stepping_ = answered_ = false;
    if (silent_)
      good_after_ = now_;
    silent_ = false;
  }
  if (const auto* const grant = std::get_if<GrantDecided>(&output)) {
    if (grant->grant.estopped != latched_)
      wrong("the grant does not tell whether an emergency stop is latched");
    const bool given = grant->grant.role != Role::none && grant->grant.role != Role::estop;
    if (given && !somebody_drives())
      wrong("a grant without a live command of a driver");
    if (latched_)  // an emergency stop is a stop, too
      stop_ = grant->grant.stop;
    if (given && silent_)
      wrong("a grant while the link is silent");
  }
  if (std::holds_alternative<CloseLink>(output)) {
    if (stamp_.epoch != 0 && !(velocity_is_zero_ && turn_is_zero_))
      wrong("the link is closed with a robot that was not told to stand");
    stamp_ = {};
    stepping_ = false;
    silent_ = false;
    must_stop_ = false;
  }
}

void Rules::packets(const protocol::Bytes& bytes) {
  protocol::PacketParser parser;
  parser.feed(bytes);
  int count = 0;
  while (const auto body = parser.next()) {
    ++count;
    command_sent(protocol::decode_command(*body));
  }
  if (count == 0 || parser.pending() || parser.counters().bad_packets() > 0 ||
      parser.counters().skipped_bytes > 0)
    wrong("a packet is not whole");
}

void Rules::command_sent(const protocol::Command& command) {
  using namespace protocol;
  if (command == protocol::Command(Open{}) || command == protocol::Command(Pulse{})) {
    // Either may also be a SYNC. The setpoints before a session are unknown.
    if (stamp_.epoch == 0)
      zero_velocity_ = zero_turn_ = velocity_is_zero_ = turn_is_zero_ = false;
  } else if (const auto* const velocity = std::get_if<Velocity>(&command)) {
    velocity_is_zero_ = velocity->value == 0.0;
    if (velocity_is_zero_)
      zero_velocity_ = true;
    else
      moves("a velocity");
  } else if (const auto* const turn = std::get_if<RotationVelocity>(&command)) {
    turn_is_zero_ = turn->value == 0.0;
    if (turn_is_zero_)
      zero_turn_ = true;
    else
      moves("a rotation velocity");
  } else if (std::holds_alternative<Heading>(command)) {
    turn_is_zero_ = false;
    moves("a heading");
  } else if (command == protocol::Command(protocol::Step{})) {
    ++played_.steps;
    if (!settings_.lockstep || stepping_ || (stamp_.cycle > 0 && !answered_) ||
        (!settings_.free_step && permit_ <= stamp_.cycle))
      wrong("the simulator steps without a permit, or an answer of the behaviors");
    stepping_ = true;
  } else if (is_any<DeltaHeading, WheelVelocities, Move, Rotate, DeltaSetpoint, LateralVelocity,
                    Unknown>(command)) {
    wrong("a command that the bridge does not send");
  }
}

void Rules::moves(const std::string& what) {
  ++played_.motions;
  if (stamp_.epoch == 0)
    wrong(what + " without a session");
  if (!zero_velocity_ || !zero_turn_)
    wrong(what + " before zero setpoints");
  if (latched_)
    wrong(what + " while an emergency stop is latched");
  if (silent_)
    wrong(what + " while the link is silent");
  if (!somebody_drives())
    wrong(what + " without a live command of a driver");
}

bool Rules::somebody_drives() const {
  if (stamp_.epoch == 0)
    return false;
  const auto live = [&](const Wish& wish) {
    const bool ours = wish.epoch == stamp_.epoch || (wish.epoch == 0 && wish.cycle == 0);
    // In lockstep the world stands still in a gap.
    return ours && wish.cycle <= stamp_.cycle &&
           time() - wish.received <= settings_.lease + kLate &&
           (settings_.lockstep || wish.received >= good_after_);
  };
  return std::any_of(wishes_.begin(), wishes_.end(), [&](const auto& of_writer) {
    return std::any_of(of_writer.second.begin(), of_writer.second.end(), live);
  });
}

void Rules::settled(const Core& core) {
  if (core.stamp() != stamp_)
    wrong("the stamp of the core is another");
  if (core.latches().estopped != latched_)
    wrong("what is latched is another");
  if (!std::isfinite(core.due(now_)))
    wrong("it is never due");
}

void Rules::answered(const Core& core) {
  settled(core);
  if (stamp_.epoch == 0 || settings_.lockstep)
    return;
  if (must_stop_ && !(zero_velocity_ && zero_turn_))
    wrong("no zero setpoints after a silence or a gap");
  must_stop_ = false;
  if (latched_ && !(velocity_is_zero_ && turn_is_zero_))
    wrong("an emergency stop is latched, and the robot was not told to stand");
}

}  // namespace saphira::bridge::test

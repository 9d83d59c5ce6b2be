// The driver, and the commands to the robot.

#include <cmath>

#include "limits.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bridge/core.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::bridge {

namespace {

using authority::Role;

constexpr std::size_t kMostRefusedDrivers = 64;  // in the audit, under one driver

std::uint64_t driver_of(const authority::WriterId& writer) {
  Fnv1a hash;
  for (const std::uint8_t byte : writer)
    hash.add(byte);
  return hash.value();
}

/// Setpoints that keep a robot with this heading where it is.
bool stand(const reflector::Setpoints& told, double heading_in_odom) {
  return told.velocity == 0.0 &&
         (told.turn_to_heading
              ? std::abs(norm2_angle(told.heading_in_odom - heading_in_odom)) < kRestHeading
              : told.rotation_velocity == 0.0);
}

/// [m] No robot's odometry goes farther.
bool is_usable(const Edge& edge) {
  constexpr double most = 1e6;
  return std::abs(edge.from.x()) < most && std::abs(edge.from.y()) < most &&
         std::abs(edge.to.x()) < most && std::abs(edge.to.y()) < most;
}

bool drives(Role role) {
  return role != Role::none && role != Role::estop;
}

}  // namespace

std::string trouble(const reflector::Motion& motion, double contact_speed) {
  const struct {
    const char* name;
    double value;
  } numbers[] = {{"velocity", motion.velocity},
                 {"distance", motion.distance},
                 {"rotation_velocity", motion.rotation_velocity},
                 {"heading", motion.heading},
                 {"contact_speed", contact_speed}};
  for (const auto& number : numbers) {
    // Beyond any real robot and angle; also keeps the packet's integers in range.
    if (!std::isfinite(number.value) || std::abs(number.value) > 1e4)
      return std::string(number.name) + " is no usable number";
  }
  return {};
}

void Core::command(const DriveCommand& in, double now) {
  authority::Command command = in.command;
  command.received = time(now);
  // Even a wrong command is an answer: lockstep could wait for ever for a better one.
  if (command.role == Role::behaviors && command.epoch == session_.stamp.epoch &&
      command.cycle == session_.stamp.cycle)
    session_.answered = true;
  // A release and an emergency stop mean stop, whatever their other fields are.
  if (command.active && command.role != Role::estop) {
    const std::string wrong = in.wrong.empty() ? trouble(in.motion, in.contact_speed) : in.wrong;
    if (!wrong.empty())
      return arbiter_.refuse(command.role, command.source, wrong);
  }
  if (!arbiter_.offer(command, session_.stamp.cycle))
    return;
  if (command.role == Role::behaviors && command.epoch == session_.stamp.epoch &&
      std::ranges::all_of(in.edges, is_usable)) {
    session_.edges = in.edges;
    session_.edges_cycle = session_.stamp.cycle;
  }
  pressed_ = pressed_ || (command.active && command.role == Role::estop);
  driver_spoke_ = driver_spoke_ || (command.role == grant_.role && command.writer == grant_.writer);
  if (!command.active || !drives(command.role))
    return;
  driver(command.role) = {in.motion, command.cycle != 0, in.contact_speed};
  driver(command.role).motion.driver = driver_of(command.writer);
}

void Core::writer_lost(Role role, const authority::WriterId& writer, double now) {
  arbiter_.lost(role, writer, time(now));
}

std::optional<v1::AuditEntry> Reports::take(v1::AuditEntry entry, const Checked& writer,
                                            double now) {
  if (!writer || writer->role == "services" || writer->role == "robot")
    return entry;
  if (entry.act != v1::AUDIT_LET_IN && entry.act != v1::AUDIT_REFUSED)
    return std::nullopt;
  std::erase_if(minutes_, [&](const auto& one) { return now - one.second.began >= kMinute; });
  const auto [minute, is_first] = minutes_.try_emplace(writer->text(), Minute{now, 0});
  if (minute->second.entries > kMost)
    return std::nullopt;
  if (++minute->second.entries > kMost)
    return v1::AuditEntry{.act = v1::AUDIT_REFUSED,
                          .who = writer->text(),
                          .text = "more than " + std::to_string(kMost) + " reports a minute"};
  entry.who = named(entry.who, writer);
  return entry;
}

std::optional<Answer> Core::request(const Request& request, double now) {
  return request.functor == "stop"    ? stop(request, now)
         : request.functor == "reset" ? reset_estop(request.source, now)
                                      : device(request);
}

Answer Core::stop(const Request& request, double now) {
  const v1::StopId id{request.asker, request.number != 0 ? request.number : ++numberless_stops_};
  const Argument* const by = find(request.arguments, "by");
  const std::string source =
      by == nullptr || by->text.empty() ? request.source : by->text + ", through " + request.source;
  std::string stopped = joined(arbiter_.stop(id, source, time(now), session_.stamp.cycle));
  stopped = stopped.empty() ? "nobody drove" : "stopped: " + stopped;
  info("stop by " + source + ": " + stopped);
  put(v1::AuditEntry{.act = v1::AUDIT_STOPPED, .who = source, .text = stopped});
  grant_changed_ = true;
  if (!in_session()) {
    grant_ = arbiter_.decide(time(now), session_.stamp.cycle);
    publish_grant();
    return {AnswerCode::done, stopped + "; no robot is connected"};
  }
  stops_.push_back({request.asker, request.number, stopped, session_.stamp.cycle, now});
  if (!settings_.lockstep) {
    decide(now);
    flush(now);
  }
  if (session_.silent)
    stopped += "; " + robot_condition(now).reason + ": whether it stands is not known";
  return {AnswerCode::underway, stopped};
}

void Core::end_stops(AnswerCode code, const std::string& how, std::uint64_t age) {
  std::erase_if(stops_, [&](const Stopping& each) {
    if (session_.stamp.cycle < each.cycle + age)
      return false;
    put(LaterAnswer{each.asker, each.number, {code, each.stopped + "; " + how}});
    return true;
  });
}

/// A packet came, and the driver was selected.
void Core::mind_stops() {
  if (stops_.empty() || session_.stamp.cycle < stops_.front().cycle + kStopCycles)
    return;
  const protocol::Information& shown = reflector_.state().information;
  if (drives(grant_.role) && !stand(told_.setpoints, reflector_.state().pose_in_odom.th))
    end_stops(AnswerCode::done, grant_.source + " has begun to drive since", kStopCycles);
  else if (std::abs(shown.velocity) <= kRestVelocity &&
           std::abs(shown.rotation_velocity) <= kRestRotation)
    end_stops(AnswerCode::done, "the robot is at rest", kStopCycles);
  else if (session_.stamp.cycle >= stops_.front().cycle + kMostStopCycles)
    end_stops(AnswerCode::given_up,
              format("the robot is told to stand and still moves after %.0f s, at %.2f m/s: is it "
                     "pushed?",
                     kCycle * kMostStopCycles, shown.velocity),
              kMostStopCycles);
}

Answer Core::reset_estop(const std::string& source, double now) {
  if (!arbiter_.latches().estopped)
    return {AnswerCode::done, "no emergency stop is latched"};
  const std::string why = arbiter_.reset(source, time(now));
  info(why.empty() ? "emergency stop reset by " + source
                   : "emergency stop not reset by " + source + ": " + why);
  put(why.empty()
          ? v1::AuditEntry{.act = v1::AUDIT_RESET, .who = source, .text = "the emergency stop"}
          : v1::AuditEntry{.act = v1::AUDIT_REFUSED,
                           .who = source,
                           .text = "to reset the emergency stop: " + why});
  if (!why.empty())
    return {AnswerCode::refused, why};
  const bool waits = arbiter_.latches().wait != authority::Wait::none;
  return {AnswerCode::done, std::string("the emergency stop is reset; the robot stands until ") +
                                (waits ? "autonomy is handed back: saphira drive hand-back"
                                       : "a new command: saphira goal ..., or saphira drive")};
}

void Core::answer(double now) {
  const bool spoke = std::exchange(driver_spoke_, false);
  if (in_session() && !settings_.lockstep) {
    const authority::Grant before = grant_;
    decide(now);
    if (spoke || !grant_.same_driver(before))
      flush(now);
  }
  keep_latches(now);
  tell_devices();
}

/// Puts out changed latches, for the file and for the bus. Neither waits for a cycle of the robot:
/// there may be none.
void Core::keep_latches(double now) {
  const authority::Latches& latches = arbiter_.latches();
  const bool estop = latches.estopped != kept_.estopped;
  const bool pressed = std::exchange(pressed_, false);
  if (estop && latches.estopped) {
    put(v1::AuditEntry{
        .act = v1::AUDIT_STOPPED, .who = latches.estop_source, .text = "the emergency stop"});
    warn("emergency stop, pressed by " + latches.estop_source +
         ": the robot stands until saphira estop reset" +
         (settings_.keeps_latches ? "" : " (without --state a restart forgets it)"));
  }
  if (latches != kept_) {
    kept_ = latches;
    put(KeepLatches{latches});
  }
  // A stop button waits for a grant, at each press.
  if (in_session() ? !estop || !settings_.lockstep : !estop && !pressed)
    return;
  grant_ = arbiter_.decide(time(now), session_.stamp.cycle);
  told_ = {};
  guarded_ = {};
  publish_grant();
}

void Core::decide(double now) {
  const double t = time(now);
  authority::Grant grant = arbiter_.decide(t, session_.stamp.cycle);
  const bool changed = !grant.same_driver(grant_);
  grant_ = std::move(grant);
  // Loss, release and change of driver are a stop: no wish of one driver passes to the next.
  if (changed || !drives(grant_.role))
    reflector_.stop();
  if (drives(grant_.role))
    reflector_.set(driver(grant_.role).motion);
  reflector::Setpoints wanted = reflector_.motion().setpoints();
  told_ = {wanted, reflector_.motion().distance_left()};
  guard(wanted);
  // A stop, and a robot that is not heard any more, need the hardest brakes.
  const bool stopping =
      !stops_.empty() && stand(told_.setpoints, reflector_.state().pose_in_odom.th);
  if (grant_.role == Role::estop || session_.silent || stopping)
    reflector_.emergency_stop();
  else
    reflector_.hold(wanted);
  // A latched stop does not expire.
  expires_at_ = grant_.role == Role::estop ? kForEver : t + grant_.expires_in + 1e-4;
  if (changed && grant_.role != Role::estop) {
    words_.info(grant_.role == Role::none
                    ? "nobody drives: " + grant_.reason
                    : grant_.source + " drives (" + authority::name(grant_.role) + ")");
    if (drives(grant_.role))
      audit_.push_back(
          {.act = v1::AUDIT_DROVE, .who = grant_.source, .text = authority::name(grant_.role)});
    refused_drivers_.clear();
  }
  grant_changed_ = grant_changed_ || changed;
}

/// Limits the setpoints to safe ones.
void Core::guard(reflector::Setpoints& wanted) {
  const authority::GuardAction before = guarded_.action;
  guarded_ = {wanted.velocity, wanted.rotation_velocity, authority::GuardAction::none, {}};
  if (drives(grant_.role)) {
    const authority::GuardSettings& settings = guards_[static_cast<std::size_t>(grant_.role)];
    if (wanted.velocity != 0.0)
      session_.body.covered = session_.coverage.way(wanted.velocity > 0.0);
    guarded_ =
        authority::guard(settings, session_.body, session_.echoes.spots(), wanted.velocity,
                         wanted.rotation_velocity, reflector_.state().information.rotation_velocity,
                         driver(grant_.role).contact_speed, session_.echoes.edges());
    if (guarded_.obstacle)
      if (const auto echo = session_.echoes.heard(*guarded_.obstacle))
        guarded_.reason += format("; sonar %d ", echo->sonar) +
                           (echo->ago == 0 ? "hears it"
                                           : format("heard it %.1f s ago",
                                                    kCycle * static_cast<double>(echo->ago)));
    guarded_ =
        authority::slow_for_age(std::move(guarded_), grant_.command_age + session_.delay, kCycle);
  }
  session_.moved = session_.moved || moves();
  wanted.velocity = guarded_.velocity;
  wanted.rotation_velocity = guarded_.rotation_velocity;
  session_.sweep.step(
      session_.stamp.cycle, guarded_.sweep,
      wanted.velocity < 0.0 ? session_.body.sweep_behind : session_.body.sweep_ahead, wanted);
  if (guarded_.action == authority::GuardAction::stop && guarded_.action != before)
    words_.info("guard: " + guarded_.reason);
}

void Core::flush(double now) {
  flush_at_ = 0.0;
  protocol::Bytes bytes;
  for (const protocol::Command& command : reflector_.due(time(now), room_)) {
    const auto* const question = std::get_if<protocol::Integer>(&command);
    if (question != nullptr && question->number == protocol::Number::kConfigRequest) {
      session_.config_asked = now;
      session_.measures = false;
    }
    const protocol::Bytes packet = protocol::encode(command, reflector_.parameters());
    bytes.insert(bytes.end(), packet.begin(), packet.end());
  }
  if (!bytes.empty()) {
    send(std::move(bytes));
    if (!std::exchange(session_.reacted, true))
      put(Answered{});
  }
  // After the packets: nothing waits for the log.
  const Notes words = std::exchange(words_, {});
  for (const Note& line : words.lines())
    put(line);
  for (v1::AuditEntry& entry : std::exchange(audit_, {}))
    put(std::move(entry));
  if (grant_changed_ && !settings_.lockstep)
    publish_grant();
}

void Core::answered(double now) {
  const double reaction = now - session_.last_packet;
  reaction_sum_ += reaction;
  reaction_max_ = std::max(reaction_max_, reaction);
  ++reactions_;
}

void Core::step(double now) {
  const std::uint64_t cycle = session_.stamp.cycle;
  if (!settings_.lockstep || !in_session() || session_.stepping)
    return;
  if (cycle > 0 && !session_.stepped) {
    if (!session_.answered)
      return;
    session_.stepped = true;
    decide(now);
    mind_stops();
    flush(now);
    publish_grant();
  }
  if (!settings_.free_step && permit_ <= cycle)
    return;
  session_.stepping = true;
  session_.last_packet = now;
  send(protocol::encode(protocol::Step{}));
}

void Core::publish_grant() {
  grant_changed_ = false;
  std::vector<authority::Refusal> refused = arbiter_.take_refused();
  std::vector<v1::AuditEntry> entries;
  for (const authority::Refusal& one : refused)
    if (const std::string what = std::string("to drive (") + authority::name(one.role) + ")";
        refused_drivers_.size() < kMostRefusedDrivers &&
        refused_drivers_.insert(one.source + what).second)
      entries.push_back(
          {.act = v1::AUDIT_REFUSED, .who = one.source, .text = what + ": " + one.reason});
  put(GrantDecided{grant_, told_, guarded_, std::move(refused), session_.stamp});
  for (v1::AuditEntry& entry : entries)
    put(std::move(entry));
}

}  // namespace saphira::bridge

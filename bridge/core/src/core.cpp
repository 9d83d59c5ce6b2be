#include "saphira/bridge/core.hpp"

#include <algorithm>
#include <cstdio>

#include "limits.hpp"
#include "saphira/authority/robot.hpp"
#include "saphira/base/age.hpp"
#include "saphira/base/format.hpp"
#include "saphira/protocol/impossible.hpp"

namespace saphira::bridge {

namespace {

using authority::Role;
using State = reflector::Connection::State;

/// The commands that stop a robot in a session at once: zero setpoints, and the server's emergency
/// stop where it should have one. Both, since some servers of that generation lack the emergency
/// stop.
protocol::Bytes stop_packets(const protocol::RobotParameters& robot) {
  protocol::Bytes out = protocol::encode(protocol::Velocity{0.0});
  const protocol::Bytes turn = protocol::encode(protocol::RotationVelocity{0.0});
  out.insert(out.end(), turn.begin(), turn.end());
  if (protocol::has_emergency_stop(robot)) {
    const protocol::Bytes stop = protocol::encode(protocol::EmergencyStop{});
    out.insert(out.end(), stop.begin(), stop.end());
  }
  return out;
}

}  // namespace

Core::Core(const CoreSettings& settings)
    : settings_(settings), arbiter_({settings.lease, settings.quiet}) {
  for (authority::GuardSettings& each : guards_) {
    each.enabled = settings_.guard;
    each.max_contact_velocity = settings_.contact_speed;
    each.margin = std::max(settings_.guard_margin, each.anything.least);
    for (authority::Clearance* const from : {&each.person, &each.anything, &each.edge})
      from->reach = std::min(from->reach, each.margin);
  }
}

void Core::restore(const authority::Latches& latches) {
  arbiter_.restore(latches);
  kept_ = latches;
  if (latches.estopped)
    warn("an emergency stop is latched from before the start, pressed by " + latches.estop_source +
         ": saphira estop reset releases it");
}

void Core::remember(const reflector::OdometryMemory& memory) {
  memory_ = memory;
  last_odom_ = memory.odom;
}

/// The clock of authority and reflector: the caller's live, cycles in lockstep.
double Core::time(double now) const {
  return settings_.lockstep ? static_cast<double>(session_.stamp.cycle) * kCycle : now;
}

// ---- The session.

void Core::tend_session(double now, const Surroundings& around) {
  if (connection_.state() == State::closed) {
    // No session begins beside another bridge of this name: two robots would share one name.
    if (!around.namesake.empty())
      return;
    parser_.reset();
    last_bytes_ = now;
    for (protocol::Bytes& packet : connection_.begin(now, around.serial))
      send(std::move(packet));
    return;
  }
  if (parser_.pending() && now - last_bytes_ >= kPacketPause) {
    parser_.gap();
    while (work(now)) {
    }
  }
  if (connection_.open())
    return mind_silence(now);
  // A serial line is the same line when it is opened anew. A socket may have another server, or a
  // server another client.
  if (!around.serial && connection_.is_hopeless(now))
    return lost("no answer from " + around.address + ": connected anew", now);
  for (protocol::Bytes& packet : connection_.tick(now))
    send(std::move(packet));
}

/// The age of the link.
void Core::mind_silence(double now) {
  if (!in_session())
    return;
  const double silence = now - session_.last_packet;
  if (settings_.lockstep) {
    if (session_.stepping && silence > kDeadStep)
      lost("the simulator did not make a step within 10 s", now);
    return;
  }
  if (now - std::max(session_.last_packet, session_.last_heard) > kDead)
    return lost(robot_condition(now).reason, now);
  // The link may live, as with a simulator whose time stands.
  if (session_.silent && !stops_.empty() &&
      now - std::max(session_.last_packet, stops_.front().asked) > kDead)
    end_stops(AnswerCode::lost, robot_condition(now).reason +
                                    ": the robot is told to stand and is not seen at rest; stop it "
                                    "by its own switch");
  if (silence <= kSilent || session_.silent)
    return;
  session_.silent = true;
  if (session_.stamp.cycle == 0)
    send(protocol::encode(protocol::Open{}));  // the first one may have been lost
  line_.damage(bad_packets());
  arbiter_.forget(session_.stamp.cycle, kForEver);
  reflector_.zero_first();
  decide(now);
  flush(now);
  warn(now - session_.last_heard > kSilent
           ? "robot link silent for 0.5 s: the robot is told to stop"
           : "no packet for 0.5 s that can be true: the robot is told to stop");
}

void Core::link_closed(const std::string& why, double now) {
  if (connection_.state() != State::closed)
    lost(why, now);
}

void Core::open(const protocol::RobotParameters& parameters, std::uint64_t epoch, double now) {
  if (!connection_.open() || in_session())
    return;
  const protocol::RobotIdentity& robot = connection_.identity();
  robot_trouble_.clear();
  for (const std::string& warning : parameters.warnings)
    warn(warning);
  reflector_.configure(parameters);
  last_epoch_ = std::max(epoch, last_epoch_ + 1);
  session_ = Session();
  session_.stamp = {last_epoch_, 0};
  session_.body = authority::body_of(reflector_.parameters());
  session_.echoes = authority::EchoMap(session_.body.sonar_range);
  session_.coverage = authority::Coverage(session_.body.radius, session_.body.sonar_range);
  session_.bad_before = parser_.counters().bad_packets();
  line_.begin();
  // Until the robot reports its configuration: it may not accept the values that it is given.
  own_deceleration_ = parameters.deceleration;
  session_.body.deceleration = own_deceleration_;
  set_delay(connection_.round_trip());
  session_.last_packet = now;
  reflector_.open(time(now), memory_, std::max(last_epoch_, last_odom_ + 1), slack_);
  arbiter_.connect(last_epoch_);
  if (now < line_.stands_until())
    arbiter_.forget(0, line_.stands_until(), line_.why_it_stands(now));
  grant_ = {};
  told_ = {};
  guarded_ = {};
  if (arbiter_.latches().estopped)
    reflector_.emergency_stop();
  flush(now);  // the zero setpoints
  // The world of a single-stepped simulator stands still by itself.
  if (!settings_.lockstep)
    put(WatchLink{stop_packets(reflector_.parameters())});
  put(SessionBegan{session_.stamp, robot});
  info("connected to " + name_of(robot) + ", " + reflector_.parameters().file);
  step(now);
}

void Core::refuse_robot(const std::string& why, double now) {
  if (!connection_.open() || in_session())
    return;
  if (robot_trouble_ != why)
    put(Note{Note::Level::error, why});
  robot_trouble_ = why;
  send(protocol::encode(protocol::Close{}));
  lost(why, now);
  hold_off_ = now + kHoldOff;
}

void Core::lost(const std::string& why, double now, Note::Level level) {
  if (in_session()) {
    // The server may hear us although we do not hear it, and would continue the last command.
    send(stop_packets(reflector_.parameters()));
    send(protocol::encode(protocol::Close{}));
    put(Note{level, "connection to the robot ended: " + why});
    if (session_.stamp.cycle > 0) {
      memory_ = reflector_.odometry();
      slack_ = reflector_.slack();
    }
  }
  if (in_session() && !settings_.lockstep)
    line_.end(now - session_.last_packet, session_.moved, now);
  put(CloseLink{why});
  connection_.end();
  arbiter_.connect(0);
  grant_ = arbiter_.decide(time(now), session_.stamp.cycle);
  told_ = {};
  guarded_ = {};
  if (in_session())
    publish_grant();
  end_stops(AnswerCode::lost, "the link to the robot was lost before it was seen at rest");
  reflector_.devices().connect();
  tell_devices();
  session_ = Session();
  flush_at_ = 0.0;
}

void Core::end(double now) {
  if (in_session())
    lost("the bridge ends", now, Note::Level::info);
}

// ---- Packets.

void Core::received(protocol::ByteView bytes, double now) {
  last_bytes_ = now;
  // Packets that waited while the bridge stood still give an old state of the robot.
  if (now >= stale_until_)
    parser_.feed(bytes);
}

bool Core::work(double now) {
  if (session_.odom_before) {
    finish_cycle(now);
    return true;
  }
  const std::optional<protocol::Bytes> body = parser_.next();
  if (body)
    packet(*body, now);
  return body.has_value();
}

void Core::packet(const protocol::Bytes& body, double now) {
  if (!connection_.open()) {
    for (protocol::Bytes& answer : connection_.packet(body, now))
      send(std::move(answer));
    if (connection_.open())
      put(Identified{connection_.identity()});
    return;
  }
  if (!in_session())
    return;
  protocol::ServerPacket any = protocol::decode_packet(body);
  if (const auto* in = std::get_if<protocol::InformationPacket>(&any);
      in != nullptr && reflector_.recognize(*in))
    warn(reflector_.parameters().file +
         " gives no Protocol, and the robot's packets have fields that ARCOS alone sends: it is "
         "driven as arcos. The line \"Protocol arcos\" in the file prevents this warning");
  if (const auto impossible = protocol::take_out_impossible(any, reflector_.parameters())) {
    session_.doubts.add(*impossible, now);
    if (const auto words = session_.doubts.take_words(now))
      warn(*words);
    if (impossible->whole) {
      if (protocol::is_information(body[0]))
        session_.last_heard = now;
      return;
    }
  }
  if (const auto* in = std::get_if<protocol::InformationPacket>(&any))
    begin_cycle(*in, now);
  else
    other(std::move(any), body[0], now);
}

void Core::other(protocol::ServerPacket any, std::uint8_t type, double now) {
  if (type == static_cast<std::uint8_t>(protocol::PacketType::kReset1) ||
      type == static_cast<std::uint8_t>(protocol::PacketType::kReset2))
    return lost("the robot's controller was reset", now);
  if (const auto* const set = std::get_if<protocol::ConfigPacket>(&any))
    heed(*set, now);
  if (std::holds_alternative<protocol::SimStatusPacket>(any))  // a simulator whose time stands
    session_.last_heard = now;
  reflect(any, type);
  put(OtherPacket{std::move(any), session_.stamp});
}

/// Of this session.
std::uint64_t Core::bad_packets() const {
  return parser_.counters().bad_packets() - session_.bad_before;
}

/// The reported deceleration counts, not the one that was asked for.
void Core::heed(const protocol::ConfigPacket& set, double now) {
  if (std::exchange(session_.measures, false) && session_.delay > 0.0)
    set_delay(std::min(session_.delay, now - session_.config_asked));
  const bool first = !std::exchange(session_.configured, true);
  const double asked = reflector_.parameters().deceleration;
  const double brakes = set.deceleration * 0.001;
  if (brakes <= 0.0)
    return;
  const double before = std::exchange(session_.body.deceleration, std::min(brakes, asked));
  if (brakes <= 0.95 * asked && (first || brakes < before)) {
    warn(format("the robot brakes with %.2f m/s2, not with %.2f as asked for", brakes, asked));
  }
}

/// A robot that does not report its configuration counts with the deceleration of its parameter
/// file.
void Core::mind_brakes() {
  const double asked = reflector_.parameters().deceleration;
  if (session_.stamp.cycle != kConfigCycles || session_.configured || own_deceleration_ >= asked)
    return;
  warn(
      format("the robot does not say how it brakes (CONFIG): it is reckoned to brake with %.2f "
             "m/s2, as its parameter file says, not with %.2f as asked for",
             own_deceleration_, asked));
}

/// The time of a packet and its answer. On a slow line a stop takes effect that much later.
void Core::set_delay(double round_trip) {
  const double before = session_.delay;
  session_.delay = settings_.lockstep || round_trip <= kSlowLine ? 0.0 : round_trip;
  if (session_.delay == before)
    return;
  session_.body.reaction = authority::body_of(reflector_.parameters()).reaction +
                           std::max(session_.delay - kUsualLine, 0.0);
  if (session_.delay > 0.0 && before == 0.0)
    warn(delay_words());
}

std::string Core::delay_words() const {
  return format(
      "the line to the robot is slow: an answer takes %.1f s, so it drives at %.2f m/s at "
      "the most",
      session_.delay, speed_for_age(session_.delay - kCycle));
}

/// A machine that was busy when the session began makes a line look slow. So the delay is measured
/// again where the robot answers such a question, when no answer to an earlier question can be on
/// its way: that one would come too soon.
void Core::mind_delay(double now) {
  if (session_.delay == 0.0 || session_.stamp.cycle == 0 ||
      reflector_.parameters().protocol == protocol::Protocol::kPsos ||
      now - session_.config_asked < kMeasureDelay + session_.delay)
    return;
  session_.config_asked = now;
  session_.measures = true;
  send(protocol::encode(protocol::ConfigRequest{1}));
}

void Core::begin_cycle(const protocol::InformationPacket& packet, double now) {
  session_.odom_before = reflector_.state().odom;
  ++session_.stamp.cycle;
  const reflector::State& state =
      reflector_.packet(packet, time(now), std::max(session_.stamp.epoch, last_odom_ + 1));
  put(CycleBegan{session_.stamp, state, bad_packets() + session_.doubts.count()});
  session_.unheard = line_.packet(bad_packets(), now - session_.last_packet,
                                  session_.moved && !settings_.lockstep, now);
  session_.moved = moves();
  session_.last_packet = now;
}

/// The part of a cycle that the services need not wait for.
void Core::finish_cycle(double now) {
  const reflector::State& state = reflector_.state();
  const std::uint64_t odom_before = *std::exchange(session_.odom_before, std::nullopt);
  if (std::exchange(session_.silent, false) || session_.unheard)
    arbiter_.forget(session_.stamp.cycle - 1, std::max(now, line_.stands_until()),
                    now < line_.stands_until() ? line_.why_it_stands(now) : "");
  mind_brakes();
  session_.reacted = false;
  session_.stepping = false;
  session_.stepped = false;
  session_.answered = false;
  ++steps_;
  last_odom_ = std::max(last_odom_, state.odom);
  if (state.cycle == 1) {
    info(memory_ && memory_->odom == state.odom ? "goes on in the odom frame of before"
                                                : "a new odom frame begins");
  } else if (state.odom != odom_before) {
    warn("the robot's position jumped: a new odom frame begins");
    arbiter_.forget(session_.stamp.cycle - 1, time(now));  // targets were in the old frame
    session_.echoes.clear();
    session_.coverage.clear();
    session_.edges.clear();
  }
  if (session_.stamp.cycle > session_.edges_cycle + kEdgesKept)
    session_.edges.clear();
  const std::vector<authority::Reading> readings =
      authority::readings_of(state.information.sonars, reflector_.parameters());
  session_.echoes.update(session_.stamp.cycle, state.pose_in_odom, readings, session_.edges);
  session_.coverage.update(session_.stamp.cycle, state.pose_in_odom, readings);
  session_.body.knows_edges = !session_.edges.empty();
  session_.body.sees_ahead = session_.echoes.sees(session_.stamp.cycle, true);
  session_.body.sees_behind = session_.echoes.sees(session_.stamp.cycle, false);
  session_.low_battery = has_low_battery() ? session_.low_battery + 1 : 0;
  if (settings_.lockstep) {
    put(KeepOdometry{reflector_.odometry()});
    step(now);
    return tell_devices();
  }
  decide(now);
  mind_stops();
  // The driver that follows the cycles answers this packet in a moment, and there is one command a
  // cycle. So the bridge waits for the answer, unless the robot has to stand.
  const bool stops = guarded_.velocity == 0.0 && reflector_.sent_velocity() != 0.0;
  if (!driver(grant_.role).follows_cycles || stops)
    flush(now);
  else
    flush_at_ = now + kWaitForDriver;
  publish_grant();
  put(KeepOdometry{reflector_.odometry()});
  tell_devices();
}

// ---- Time.

void Core::loop(double now) {
  const double gap = now - last_loop_.value_or(now);
  last_loop_ = now;
  if (gap <= kGap || settings_.lockstep || !in_session())
    return;
  char text[96];
  std::snprintf(text, sizeof text,
                "the bridge stood still for %.2f s: the robot is stopped, a new grant is needed",
                gap);
  // A silent link stays silent.
  arbiter_.forget(session_.stamp.cycle, session_.silent ? kForEver : now + kSettle);
  session_.last_packet = now;  // the bridge was silent, not the link
  stale_until_ = now + kSettle;
  parser_.reset();
  reflector_.zero_first();
  decide(now);
  flush(now);
  warn(text);
}

void Core::tick(double now, const Surroundings& around) {
  mind_keeper(now, around);
  if (around.link_open && may_connect(now))
    tend_session(now, around);
  if (!settings_.lockstep && in_session()) {
    mind_delay(now);
    const bool waited = flush_at_ > 0.0 && now >= flush_at_;
    if (waited && grant_.role == Role::behaviors)
      ++late_;
    if (waited || (grant_.role != Role::none && now >= expires_at_)) {
      decide(now);
      flush(now);
    } else if (now - session_.last_packet > 1.5 * kCycle && reflector_.pending(now)) {
      flush(now);  // no packets come, so no cycle keeps the beat
    }
  }
  report(now, around);
}

double Core::due(double now) const {
  double until = now + kCycle;
  if (!settings_.lockstep && in_session()) {
    if (flush_at_ > 0.0)
      until = std::min(until, flush_at_);
    if (grant_.role != Role::none)
      until = std::min(until, expires_at_);
  }
  if (may_connect(now) && connection_.state() != State::closed && !connection_.open())
    until = std::min(until, connection_.due());
  if (parser_.pending())
    until = std::min(until, last_bytes_ + kPacketPause);
  return until;
}

}  // namespace saphira::bridge

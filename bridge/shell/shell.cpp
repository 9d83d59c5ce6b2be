#include "shell.hpp"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "convert.hpp"
#include "saphira/authority/age.hpp"
#include "saphira/authority/robot.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/bus/program.hpp"

namespace saphira::bridge {

namespace {

using authority::Role;

constexpr double kSilent = 0.5;     // [s] without a packet: the link is silent, the robot stands
constexpr double kDead = 2.0;       // [s] then the link is given up
constexpr double kDeadStep = 10.0;  // [s] for the simulator to make a step
constexpr double kForEver = 1e300;
constexpr double kGap = 0.25;    // [s] the bridge's own loop was not heard for so long
constexpr double kSettle = 0.1;  // [s] after a gap: what comes now waited in some queue
constexpr double kWaitForDriver =
    0.05;  // [s] from a packet until what is due goes without its answer
constexpr std::chrono::microseconds kSpin{500};
constexpr double kBeat = 0.05;         // [s] of the keeper
constexpr double kTellKeeper = 10.0;   // [s] that a new keeper is told of in the status
constexpr double kPacketPause = 0.05;  // [s] no packet pauses so long within itself
// [s] from the start until the robot is asked: who may stop it, and another bridge that has it, are
// found by then, in two announcements of a program (idl/bus).
double look_around(bus::Profile profile) {
  return profile == bus::Profile::host ? 0.3 : profile == bus::Profile::lan ? 0.6 : 1.2;
}
constexpr double kHoldOff = 2.0;  // [s] until a robot that could not be served is tried again
constexpr std::uint64_t kMotorsCycles = 10;  // then the motors should be on
constexpr double kCycle = 0.1;               // [s] manual 2.1.1
constexpr double kMostContact = 0.15;        // [m/s] that a robot may touch with

std::uint64_t milliseconds_since_1970() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

/// What stops a robot in a session at once: zero setpoints, and the server's emergency stop where
/// it should have one. Both, since some servers of that generation do not know it.
std::vector<std::uint8_t> stop_packets(const protocol::RobotParameters& robot) {
  std::vector<std::uint8_t> out = protocol::encode(protocol::Velocity{0.0});
  const protocol::Bytes turn = protocol::encode(protocol::RotationVelocity{0.0});
  out.insert(out.end(), turn.begin(), turn.end());
  if (protocol::has_emergency_stop(robot)) {
    const protocol::Bytes stop = protocol::encode(protocol::EmergencyStop{});
    out.insert(out.end(), stop.begin(), stop.end());
  }
  return out;
}

/// The parameter files of a robot, in words.
std::string looked_for(const protocol::RobotIdentity& robot) {
  std::string names;
  for (const std::string& name : protocol::parameter_file_names(robot.robot_class, robot.subclass))
    names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "nothing (the robot names no class)" : names;
}

std::uint64_t driver_of(const authority::WriterId& writer) {
  Fnv1a hash;
  for (const std::uint8_t byte : writer)
    hash.add(byte);
  return hash.value();
}

std::unique_ptr<transport::Keeper> make_keeper(bool wanted) {
  return wanted ? std::make_unique<transport::Keeper>() : nullptr;
}

/// Checks what a person gave before anything is made of it.
BridgeOptions checked(BridgeOptions options) {
  transport::parse_address(options.robot_port);
  if (!std::filesystem::is_directory(options.robots_folder))
    throw std::invalid_argument("--robots " + options.robots_folder +
                                ": expected a folder with robot parameter files");
  if (!(options.contact_speed >= 0.0) || options.contact_speed > kMostContact)
    throw std::invalid_argument("--contact-speed: expected 0 (never) to 0.15 m/s");
  if (!(options.lease > 0.0) || !(options.quiet >= 0.0))
    throw std::invalid_argument("--lease-ms: expected more than 0; --quiet-ms: 0 or more");
  return options;
}

}  // namespace

Shell::Shell(const bus::NodeOptions& node, BridgeOptions options,
             std::shared_ptr<bus::MemoryBus> memory)
    : in_memory_(memory != nullptr),
      options_(checked(std::move(options))),
      lockstep_(node.lockstep),
      keeper_(make_keeper(options_.keeper)),
      node_(memory ? bus::Node(node, std::move(memory)) : bus::Node(node)),
      state_writer_(node_.writer(bus::topics::kRobotState)),
      description_writer_(node_.writer(bus::topics::kRobotDescription)),
      grant_writer_(node_.writer(bus::topics::kGrant)),
      state_recall_(node_.writer(bus::topics::kRecallRobot)),
      grant_recall_(node_.writer(bus::topics::kRecallGrant)),
      resets_(node_.reader(bus::topics::kEstopReset)),
      permits_(node_.reader(bus::topics::kStepPermit)),
      other_programs_(node_),
      link_(transport::parse_address(options_.robot_port)),
      devices_(node_, reflector_),
      arbiter_({options_.lease, options_.quiet}),
      position_file_(options_.state_file),
      latch_file_(options_.state_file.empty() ? "" : options_.state_file + ".latched"),
      kept_(latch_file_.read()) {
  drives_.push_back({Role::estop, node_.reader(bus::topics::kDriveEstop), {}, false});
  drives_.push_back({Role::teleop, node_.reader(bus::topics::kDriveTeleop), {}, false});
  drives_.push_back({Role::direct, node_.reader(bus::topics::kDriveDirect), {}, false});
  drives_.push_back({Role::behaviors, node_.reader(bus::topics::kDriveBehaviors), {}, false});
  if (!options_.vision.empty())
    camera_.emplace(node_, options_.vision);
  for (authority::GuardSettings& settings : guards_) {
    settings.enabled = options_.guard;
    settings.max_contact_velocity = options_.contact_speed;
  }
  if (!lockstep_ && !in_memory_)
    hold_off_ = BootClock::seconds() + look_around(node.profile);

  arbiter_.restore(kept_);
  if (kept_.estopped)
    node_.warn("an emergency stop is latched from before the start, pressed by " +
               kept_.estop_source + ": saphira estop reset releases it");

  memory_ = position_file_.found();
  if (memory_)
    last_odom_ = memory_->odom;
  if (!position_file_.trouble().empty())
    node_.warn(position_file_.trouble());
}

double Shell::time() const {
  return lockstep_ ? static_cast<double>(stamp_.cycle()) * kCycle : BootClock::seconds();
}

int Shell::run(const bus::Stop& stop) {
  node_.info("robot at " + link_.address().text());
  last_loop_ = BootClock::seconds();
  while (!stop.requested()) {
    double now = BootClock::seconds();
    mind_gap(now);
    tend_link(now);
    if (!lockstep_ && epoch_ != 0) {
      if (flush_at_ > 0.0 && now >= flush_at_) {
        if (grant_.role == Role::behaviors)
          ++late_;
        decide();
        flush(now);
      } else if (grant_.role != Role::none && now >= expires_at_) {
        decide();
        flush(now);
      } else if (now - last_packet_ > 1.5 * kCycle && reflector_.pending(now)) {
        flush(now);  // no packets come, so no cycle makes the beat
      }
    }
    publish_status(now);

    pollfd fds[3] = {{stop.fd(), POLLIN, 0}, {node_.wake_fd(), POLLIN, 0}, {-1, 0, 0}};
    fds[2].fd = link_.fd();  // poll ignores what is negative
    fds[2].events = link_.poll_events();
    const int n = ::poll(fds, 3, timeout_ms(BootClock::seconds()));
    now = BootClock::seconds();
    mind_gap(now);
    if (n <= 0)
      continue;
    bool woken = fds[1].revents != 0;
    if (fds[2].revents != 0) {
      receive(now);
      // The answer to a packet is a fraction of a millisecond away.
      if (flush_at_ > 0.0 && !woken) {
        woken = node_.spin(kSpin);
        now = BootClock::seconds();
      }
    }
    if (woken) {
      node_.clear_wake();
      take_all(now);
    }
  }

  node_.status().state(v1::SERVICE_STOPPING);
  node_.status().reason("asked to stop");
  if (epoch_ != 0) {
    const double now = BootClock::seconds();
    lost("the bridge ends", now);
  }
  node_.publish_status();
  return bus::kExitOk;
}

int Shell::timeout_ms(double now) const {
  double until = now + kCycle;
  if (flush_at_ > 0.0)
    until = std::min(until, flush_at_);
  if (!lockstep_ && grant_.role != Role::none)
    until = std::min(until, expires_at_);
  if (connection_.state() != reflector::Connection::State::closed && !connection_.open())
    until = std::min(until, connection_.due());
  if (hold_off_ <= now)
    until = std::min(until, link_.due());
  if (parser_.pending())
    until = std::min(until, last_bytes_ + kPacketPause);
  // Rounded up: a timer that wakes too early would spin.
  return std::clamp(static_cast<int>(std::ceil((until - now) * 1000.0)), 0, 100);
}

// ---- The robot's side.

void Shell::tend_link(double now) {
  if (keeper_ && now - last_beat_ >= kBeat)
    beat(now);
  if (now < hold_off_)
    return;
  // A link that a write found dead, before it is opened again.
  const bool session = connection_.state() != reflector::Connection::State::closed;
  if (session && link_.state() != transport::Link::State::open)
    lost(link_.trouble(), now);
  link_.advance(now);
  if (link_.state() != transport::Link::State::open) {
    if (connection_.state() != reflector::Connection::State::closed)
      lost(link_.trouble(), now);
    return;
  }
  if (connection_.state() == reflector::Connection::State::closed) {
    if (other_programs_.has_namesake())
      return;
    parser_.reset();
    last_bytes_ = now;
    for (const protocol::Bytes& packet :
         connection_.begin(now, link_.address().kind == transport::Address::Kind::serial))
      send(packet, now);
    return;
  }
  if (parser_.pending() && now - last_bytes_ >= kPacketPause) {
    parser_.gap();
    while (auto body = parser_.next())
      packet(*body, now);
  }
  if (!connection_.open()) {
    // A serial line is the same line when it is opened anew; a socket has another server, or a
    // server another client.
    if (link_.address().kind != transport::Address::Kind::serial && connection_.is_hopeless(now))
      return lost("no answer from " + link_.address().text() + ": connected anew", now);
    for (const protocol::Bytes& packet : connection_.tick(now))
      send(packet, now);
    return;
  }
  const double silence = now - last_packet_;
  if (lockstep_) {
    if (stepping_ && silence > kDeadStep)
      lost("the simulator did not make a step within 10 s", now);
    return;
  }
  if (now - std::max(last_packet_, last_heard_) > kDead) {
    lost("robot link silent", now);
  } else if (silence > kSilent && !link_silent_) {
    // The age of the link: nobody drives what nobody sees.
    link_silent_ = true;
    if (stamp_.cycle() == 0)
      send(protocol::encode(protocol::Open{}), now);  // it may have been lost
    arbiter_.forget(stamp_.cycle(), kForEver);
    reflector_.zero_first();
    decide();
    flush(now);
    node_.warn(now - last_heard_ > kSilent
                   ? "robot link silent for 0.5 s: the robot is told to stop"
                   : "no packet for 0.5 s that can be true: the robot is told to stop");
  }
}

void Shell::beat(double now) {
  last_beat_ = now;
  const bool alive = keeper_->alive();
  const int restarts = keeper_->restarts();
  keeper_->beat();
  if (alive && !keeper_->alive())
    node_.warn("the keeper died or hangs: another one is started");
  if (keeper_->restarts() > restarts)
    keeper_new_until_ = now + kTellKeeper;
}

void Shell::receive(double now) {
  if (link_.state() != transport::Link::State::open)
    return;  // a connection that is coming about: tend_link
  input_.clear();
  const bool alive = link_.read(input_, now);
  if (!input_.empty()) {
    last_bytes_ = now;
    parser_.feed(input_);
    while (auto body = parser_.next())
      packet(*body, now);
  }
  if (!alive)
    lost(link_.trouble(), now);
}

void Shell::packet(const protocol::Bytes& body, double now) {
  if (!connection_.open()) {
    for (const protocol::Bytes& answer : connection_.packet(body, now))
      send(answer, now);
    if (connection_.open())
      opened(now);
    return;
  }
  if (epoch_ == 0)
    return;
  protocol::ServerPacket any = protocol::decode_packet(body);
  if (const auto impossible = protocol::take_out_impossible(any, reflector_.parameters())) {
    doubts_.add(*impossible, now);
    if (const auto words = doubts_.take_words(now))
      node_.warn(*words);
    if (impossible->whole) {
      last_heard_ = protocol::is_information(body[0]) ? now : last_heard_;
      return;
    }
  }
  if (const auto* in = std::get_if<protocol::InformationPacket>(&any))
    information(*in, now);
  else
    other(any, body[0], now);
}

void Shell::other(const protocol::ServerPacket& any, std::uint8_t type, double now) {
  if (type == static_cast<std::uint8_t>(protocol::PacketType::kReset1) ||
      type == static_cast<std::uint8_t>(protocol::PacketType::kReset2))
    return lost("the robot's controller was reset", now);
  if (const auto* const set = std::get_if<protocol::ConfigPacket>(&any))
    heed(*set);
  const auto* const seen = std::get_if<protocol::VisionPacket>(&any);
  if (seen == nullptr || !camera_)
    devices_.packet(any, type, stamp_);
  else if (stamp_.cycle() > 0)  // before, the robot's place is not known
    camera_->packet(*seen, newest_state_);
}

/// The robot brakes as it says that it is set, whatever it was asked for.
void Shell::heed(const protocol::ConfigPacket& set) {
  const double asked = reflector_.parameters().deceleration;
  const double brakes = set.deceleration * 0.001;
  if (brakes <= 0.0 || brakes > 0.95 * asked)
    return;
  if (body_.deceleration > brakes) {
    char text[96];
    std::snprintf(text, sizeof text, "the robot brakes with %.2f m/s2, not with %.2f as asked for",
                  brakes, asked);
    node_.warn(text);
  }
  body_.deceleration = brakes;
}

bool Shell::send(const protocol::Bytes& packet, double now) {
  return link_.write(packet, now);
}

void Shell::opened(double now) {
  const protocol::RobotIdentity& robot = connection_.identity();
  const std::string who =
      "robot \"" + robot.name + "\" (" + robot.robot_class + ", " + robot.subclass + ")";
  try {
    const std::optional<std::string> path =
        protocol::find_parameter_file(options_.robots_folder, robot.robot_class, robot.subclass);
    if (!path)
      throw std::runtime_error("no parameter file for " + who + ": looked for " +
                               looked_for(robot) + " in " + options_.robots_folder);
    const protocol::RobotParameters parameters = protocol::load_parameters(*path);
    for (const std::string& warning : parameters.warnings)
      node_.warn(warning);
    reflector_.configure(parameters);
  } catch (const std::exception& error) {
    if (robot_trouble_ != error.what())
      node_.error(error.what());
    robot_trouble_ = error.what();
    send(protocol::encode(protocol::Close{}), now);
    lost(robot_trouble_, now);
    hold_off_ = now + kHoldOff;
    return;
  }
  robot_trouble_.clear();

  // What was said before there was a robot is heard, and refused, before there is one.
  take_all(now);
  epoch_ = std::max(milliseconds_since_1970(), last_epoch_ + 1);
  last_epoch_ = epoch_;
  stamp_.epoch(epoch_);
  stamp_.cycle(0);
  if (camera_)
    camera_->connect();
  body_ = authority::body_of(reflector_.parameters());
  echoes_.clear();
  reflector_.open(time(), memory_, std::max(epoch_, last_odom_ + 1), slack_);
  arbiter_.connect(epoch_);
  grant_ = {};
  guarded_ = {};
  if (arbiter_.latches().estopped)
    reflector_.emergency_stop();
  bad_before_ = parser_.counters().bad_packets();
  doubts_.reset();
  last_packet_ = now;
  link_silent_ = false;
  answered_ = 0;
  stepping_ = false;
  stepped_ = false;
  flush(now);  // the zero setpoints
  // The world of a single-stepped simulator stands still by itself.
  if (keeper_ && !lockstep_)
    keeper_->watch(link_.fd(), stop_packets(reflector_.parameters()));
  description_writer_.write(
      to_bus(reflector_.parameters(), robot, stamp_, link_.address().text(), lockstep_));
  node_.info("connected to " + who + ", " + reflector_.parameters().file);
  step(now);
}

void Shell::information(const protocol::InformationPacket& packet, double now) {
  const std::uint64_t odom_before = reflector_.state().odom;
  stamp_.cycle(stamp_.cycle() + 1);
  const reflector::State& state =
      reflector_.packet(packet, time(), std::max(epoch_, last_odom_ + 1));
  newest_state_ =
      to_bus(state, stamp_, parser_.counters().bad_packets() - bad_before_ + doubts_.count());
  std::vector<protocol::Bytes> to_camera;
  if (camera_) {
    to_camera = camera_->begin(stamp_.cycle());
    newest_state_.vision_packets_per_s(camera_->packets_per_s());
  }
  state_writer_.write(newest_state_);
  for (const protocol::Bytes& words : to_camera)
    send(words, now);

  last_packet_ = now;
  if (std::exchange(link_silent_, false))
    arbiter_.forget(stamp_.cycle() - 1, now);
  reacted_ = false;
  stepping_ = false;
  stepped_ = false;
  ++steps_;
  last_odom_ = std::max(last_odom_, state.odom);
  if (state.cycle == 1) {
    node_.info(memory_ && memory_->odom == state.odom ? "goes on in the odom frame of before"
                                                      : "a new odom frame begins");
  } else if (state.odom != odom_before) {
    node_.warn("the robot's position jumped: a new odom frame begins");
    arbiter_.forget(stamp_.cycle() - 1, time());  // what was meant in the old frame
    echoes_.clear();
  }
  echoes_.update(stamp_.cycle(), state.pose_in_odom,
                 authority::readings_of(state.information.sonars, reflector_.parameters()));
  body_.sees_ahead = echoes_.sees(stamp_.cycle(), true);
  body_.sees_behind = echoes_.sees(stamp_.cycle(), false);
  devices_.publish(stamp_);

  if (lockstep_) {
    remember();
    return step(now);
  }
  decide();
  // The driver that follows the cycles answers this packet in a moment, and there is one command a
  // cycle: so it is waited for. Not where the robot is to stand.
  const bool follows = std::any_of(drives_.begin(), drives_.end(), [&](const Drive& drive) {
    return drive.role == grant_.role && drive.follows_cycles;
  });
  if (!follows || (guarded_.velocity == 0.0 && reflector_.sent_velocity() != 0.0))
    flush(now);
  else
    flush_at_ = now + kWaitForDriver;
  publish_grant();
  remember();
}

void Shell::lost(const std::string& why, double now) {
  // The server may hear us where we do not hear it, and would go on with what it was told last.
  if (epoch_ != 0 && link_.state() == transport::Link::State::open) {
    send(stop_packets(reflector_.parameters()), now);
    send(protocol::encode(protocol::Close{}), now);
  }
  if (epoch_ != 0) {
    node_.log(node_.status().state() == v1::SERVICE_STOPPING ? v1::LOG_INFO : v1::LOG_WARNING,
              "connection to the robot ended: " + why);
    if (stamp_.cycle() > 0) {
      memory_ = reflector_.odometry();
      slack_ = reflector_.slack();
    }
  }
  if (keeper_)
    keeper_->unwatch();
  link_.close(why, now);
  connection_.end();
  arbiter_.connect(0);
  grant_ = arbiter_.decide(time(), stamp_.cycle());
  guarded_ = {};
  if (epoch_ != 0)
    publish_grant();
  reflector_.devices().connect();
  devices_.publish(stamp_);
  epoch_ = 0;
  stamp_ = {};
  flush_at_ = 0.0;
}

void Shell::mind_gap(double now) {
  const double gap = now - last_loop_;
  last_loop_ = now;
  if (gap <= kGap || lockstep_ || epoch_ == 0)
    return;
  char text[96];
  std::snprintf(text, sizeof text,
                "the bridge stood still for %.2f s: the robot is stopped, a new grant is needed",
                gap);
  arbiter_.forget(stamp_.cycle(), now + kSettle);
  last_packet_ = now;  // it was the bridge that was silent, not the link
  reflector_.zero_first();
  decide();
  flush(now);
  node_.warn(text);
}

void Shell::remember() {
  if (const std::string trouble = position_file_.write(reflector_.odometry()); !trouble.empty())
    node_.error(trouble);
}

// ---- The bus's side.

void Shell::take_all(double now) {
  other_programs_.take();
  bool driver = false;
  for (Drive& drive : drives_)
    driver = take_drive(drive, now) || driver;
  take_resets();
  if (const auto permit = permits_.take_newest())
    permit_ = permit->until_cycle();
  if (epoch_ != 0 && !lockstep_) {
    const authority::Grant before = grant_;
    decide();
    if (driver || !grant_.same_driver(before))
      flush(now);
  }
  keep_latches();
  devices_.take(stamp_, epoch_ != 0);  // nothing waits for them
  if (epoch_ != 0 && lockstep_)
    step(now);
}

bool Shell::take_drive(Drive& drive, double now) {
  bool driver = false;
  for (const auto& sample : drive.reader.take()) {
    if (sample.info.disposed)
      continue;
    const v1::MotorCommand& in = sample.data;
    // Whatever it says: a lockstep that waited for a better answer would wait for ever.
    if (drive.role == Role::behaviors && epoch_ != 0 && in.stamp().epoch() == epoch_)
      answered_ = in.stamp().cycle();
    // A release and an emergency stop mean stop, whatever else they say.
    const std::string wrong = in.active() && drive.role != Role::estop ? trouble(in) : "";
    if (!wrong.empty()) {
      ++malformed_;
      arbiter_.refuse(drive.role, source_of(in), wrong);
      continue;
    }
    const authority::Command command =
        to_command(in, drive.role, sample.info.writer, lockstep_ ? time() : now);
    if (!arbiter_.offer(command, stamp_.cycle()))
      continue;
    driver = driver || (drive.role == grant_.role && sample.info.writer == grant_.writer);
    if (command.active) {
      drive.motion = to_motion(in);
      drive.motion.driver = driver_of(sample.info.writer);
      drive.contact_speed = in.contact_speed();
      drive.follows_cycles = in.stamp().cycle() != 0;
    }
  }
  for (const bus::WriterId& writer : drive.reader.take_lost())
    arbiter_.lost(drive.role, writer, lockstep_ ? time() : now);
  return driver;
}

void Shell::take_resets() {
  for (const auto& sample : resets_.take()) {
    if (sample.info.disposed || !arbiter_.latches().estopped)
      continue;
    const std::string source = source_of(sample.data);
    const std::string why = arbiter_.reset(source, time());
    node_.info(why.empty() ? "emergency stop reset by " + source
                           : "emergency stop not reset by " + source + ": " + why);
  }
}

/// What is latched, onto the disk and to everybody, when it has changed. Neither waits for a cycle
/// of the robot: there may be none.
void Shell::keep_latches() {
  const authority::Latches& now = arbiter_.latches();
  if (now == kept_)
    return;
  if (now.estopped && !kept_.estopped)
    node_.warn("emergency stop, pressed by " + now.estop_source +
               ": the robot stands until saphira estop reset" +
               (latch_file_.path().empty() ? " (without --state a restart forgets it)" : ""));
  const bool estop = now.estopped != kept_.estopped;
  kept_ = now;
  if (const std::string trouble = latch_file_.write(now); !trouble.empty())
    node_.error("what is latched is not kept over a restart: " + trouble);
  if (!estop || (epoch_ != 0 && !lockstep_))
    return;
  grant_ = arbiter_.decide(time(), stamp_.cycle());
  guarded_ = {};
  publish_grant();
}

// ---- Between the two.

void Shell::decide() {
  const double t = time();
  authority::Grant grant = arbiter_.decide(t, stamp_.cycle());
  const bool changed = !grant.same_driver(grant_);
  // Loss, release and change of hands are a stop: nothing of one driver's wishes is left to the
  // next.
  if (changed || grant.role == Role::none || grant.role == Role::estop)
    reflector_.stop();
  if (grant.role != Role::none && grant.role != Role::estop) {
    for (const Drive& drive : drives_) {
      if (drive.role == grant.role)
        reflector_.set(drive.motion);
    }
  }
  reflector::Setpoints wanted = reflector_.motion().setpoints();
  const authority::GuardAction action_before = guarded_.action;
  guarded_ = {wanted.velocity, wanted.rotation_velocity, authority::GuardAction::none, {}};
  if (grant.role != Role::none && grant.role != Role::estop) {
    guarded_ = authority::guard(guards_[static_cast<std::size_t>(grant.role)], body_,
                                echoes_.spots(), wanted.velocity, wanted.rotation_velocity,
                                reflector_.state().information.rotation_velocity,
                                contact_speed_of(grant.role));
    guarded_ = authority::slow_for_age(std::move(guarded_), grant.command_age, kCycle);
  }
  wanted.velocity = guarded_.velocity;
  wanted.rotation_velocity = guarded_.rotation_velocity;
  // Who presses an emergency stop, and a robot that is not heard any more, want the hardest stop.
  if (grant.role == Role::estop || link_silent_)
    reflector_.emergency_stop();
  else
    reflector_.hold(wanted);
  if (guarded_.action == authority::GuardAction::stop && guarded_.action != action_before)
    words_.push_back("guard: " + guarded_.reason);
  grant_ = std::move(grant);
  // What is latched does not expire.
  expires_at_ = grant_.role == Role::estop ? kForEver : t + grant_.expires_in + 1e-4;
  if (changed && grant_.role != Role::estop) {
    words_.push_back(grant_.role == Role::none
                         ? "nobody drives: " + grant_.reason
                         : grant_.source + " drives (" + authority::name(grant_.role) + ")");
  }
  grant_changed_ = grant_changed_ || changed;
}

double Shell::contact_speed_of(Role role) const {
  for (const Drive& drive : drives_)
    if (drive.role == role)
      return drive.contact_speed;
  return 0.0;
}

void Shell::flush(double now) {
  flush_at_ = 0.0;
  bool sent = false;
  for (const protocol::Command& command : reflector_.due(time(), link_.room())) {
    if (!send(protocol::encode(command, reflector_.parameters()), now))
      return;  // the link is closed now: the loop sees it
    sent = true;
  }
  if (sent && !reacted_) {
    reacted_ = true;
    const double reaction = BootClock::seconds() - last_packet_;
    reaction_sum_ += reaction;
    reaction_max_ = std::max(reaction_max_, reaction);
    ++reactions_;
  }
  // After the packets: nobody waits for these words.
  for (const std::string& text : std::exchange(words_, {}))
    node_.info(text);
  if (grant_changed_ && !lockstep_)
    publish_grant();
}

void Shell::step(double now) {
  const std::uint64_t cycle = stamp_.cycle();
  if (!lockstep_ || epoch_ == 0 || stepping_)
    return;
  if (cycle > 0 && !stepped_) {
    if (answered_ != cycle)
      return;
    stepped_ = true;
    decide();
    flush(now);
    publish_grant();
  }
  if (!options_.free_step && permit_ <= cycle)
    return;
  stepping_ = true;
  last_packet_ = now;
  send(protocol::encode(protocol::Step{}), now);
}

void Shell::publish_grant() {
  grant_changed_ = false;
  const v1::Grant grant = to_bus(grant_, guarded_, arbiter_.take_refused(), stamp_);
  grant_writer_.write(grant);
  if (epoch_ == 0)
    return;
  // With the grant, not with the state: the services wait for that.
  grant_recall_.write(grant);
  if (recalled_ != stamp_ && newest_state_.stamp() == stamp_) {
    recalled_ = stamp_;
    state_recall_.write(newest_state_);
  }
}

bool Shell::motors_off() const {
  const protocol::Information& in = reflector_.state().information;
  return !in.motors_on.value_or(in.motors != protocol::Motors::kNoPower);
}

Shell::Condition Shell::condition(double now) const {
  if (!robot_trouble_.empty())
    return {v1::SERVICE_WAITING, robot_trouble_};
  if (other_programs_.has_namesake())
    return {epoch_ != 0 ? v1::SERVICE_DEGRADED : v1::SERVICE_WAITING,
            "another bridge, " + other_programs_.namesake() + ", has a robot of this name"};
  if (link_.state() != transport::Link::State::open)
    return {v1::SERVICE_WAITING, "robot link: " + link_.trouble()};
  if (!connection_.open())
    return {v1::SERVICE_WAITING, "waits for " + connection_.waiting_for()};
  const std::string doubt = doubts_.newest(now);
  if (link_silent_ && !doubt.empty())
    return {v1::SERVICE_WAITING, doubt};
  if (link_silent_)
    return {v1::SERVICE_WAITING, stamp_.cycle() > 0
                                     ? "robot link silent"
                                     : "robot link silent: no packet has come (a simulator in "
                                       "single step needs --lockstep here)"};
  if (lockstep_ && !stepping_)
    return {v1::SERVICE_WAITING,
            stepped_ || stamp_.cycle() == 0
                ? "waits for a permit to step"
                : "waits for the behaviors' command for cycle " + std::to_string(stamp_.cycle())};
  if (arbiter_.latches().estopped)
    return {v1::SERVICE_DEGRADED, "emergency stop, pressed by " + arbiter_.latches().estop_source +
                                      ": saphira estop reset releases it"};
  if (epoch_ != 0 && !doubt.empty())
    return {v1::SERVICE_DEGRADED, doubt};
  if (epoch_ != 0 && reflector_.state().information.emergency_stop.value_or(false))
    return {v1::SERVICE_DEGRADED, "the robot's own emergency stop is pressed"};
  if (epoch_ != 0 && stamp_.cycle() > kMotorsCycles && motors_off())
    return {v1::SERVICE_DEGRADED,
            "the robot's motors are off (its own button, or: saphira device motors on)"};
  if (keeper_ && !keeper_->alive())
    return {v1::SERVICE_DEGRADED,
            "the keeper is gone: nobody stops the robot when the bridge hangs"};
  if (keeper_ && last_beat_ < keeper_new_until_)
    return {v1::SERVICE_DEGRADED, "the keeper died or hung; another one was started (" +
                                      std::to_string(keeper_->restarts()) + " so far)"};
  return {};
}

void Shell::publish_status(double now) {
  if (now - status_at_ < kCycle)
    return;
  status_at_ = now;
  if (epoch_ == 0) {
    // Without a robot there are no cycles; what is latched is told all the same.
    grant_ = arbiter_.decide(time(), 0);
    publish_grant();
  }
  v1::ServiceStatus& status = node_.status();
  const Condition condition = this->condition(now);
  status.state(condition.state);
  status.reason(condition.reason);
  status.stamp(stamp_);
  status.lockstep(lockstep_);
  status.steps(steps_);
  status.late_cycles(late_);
  status.refused_samples(arbiter_.refused_count() + malformed_ + devices_.refused());
  // A step of the bridge is its reaction: from a packet to the commands that answer it.
  if (now - reaction_at_ >= 1.0) {
    status.step_ms_mean(reactions_ > 0 ? reaction_sum_ / reactions_ * 1000.0 : 0.0);
    status.step_ms_max(reaction_max_ * 1000.0);
    reaction_sum_ = 0.0;
    reaction_max_ = 0.0;
    reactions_ = 0;
    reaction_at_ = now;
  }
  node_.publish_status();
}

}  // namespace saphira::bridge

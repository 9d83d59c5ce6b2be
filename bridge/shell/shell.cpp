#include "shell.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <variant>

#include "convert.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/audit.hpp"
#include "saphira/bus/notes.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira::bridge {

namespace {

using authority::Role;

constexpr std::chrono::microseconds kSpin{500};
constexpr double kBeat = 0.05;         // [s] of the keeper
constexpr double kTend = 1.0;          // [s]
constexpr double kMostContact = 0.15;  // [m/s] that a robot may touch with

// [s] from the start to the first contact with the robot. By then programs that may stop the robot,
// and another bridge that has it, are found, in two announcements of a program (idl/bus).
double look_around(bus::Profile profile) {
  return profile == bus::Profile::host ? 0.3 : profile == bus::Profile::lan ? 0.6 : 1.2;
}

std::uint64_t milliseconds_since_1970() {
  return static_cast<std::uint64_t>(unix_time() * 1e3);
}

/// A program that stands for the robot has to know the robot's file.
transport::Address address_of(const BridgeOptions& options, bool lockstep) {
  transport::Address address = transport::parse_address(options.robot_port);
  if (address.kind != transport::Address::Kind::ros2)
    return address;
  if (lockstep)
    throw std::invalid_argument("--lockstep: only a simulator can be stepped");
  address.arguments.push_back("--robots=" + options.robots_folder);
  if (!options.parameter_file.empty())
    address.arguments.push_back("--robot-file=" + options.parameter_file);
  return address;
}

std::unique_ptr<transport::Keeper> make_keeper(bool wanted) {
  return wanted ? std::make_unique<transport::Keeper>() : nullptr;
}

}  // namespace

BridgeOptions checked(BridgeOptions options) {
  transport::parse_address(options.robot_port);
  if (!std::filesystem::is_directory(options.robots_folder))
    throw std::invalid_argument("--robots " + options.robots_folder +
                                ": expected a folder with robot parameter files");
  if (!options.parameter_file.empty())
    options.parameter_file = find_file(options.robots_folder, options.parameter_file, ".p");
  if (!(options.contact_speed >= 0.0) || options.contact_speed > kMostContact)
    throw std::invalid_argument("--contact-speed: expected 0 (never) to 0.15 m/s");
  if (!(options.lease > 0.0) || !(options.quiet >= 0.0))
    throw std::invalid_argument("--lease-ms: expected more than 0; --quiet-ms: 0 or more");
  return options;
}

namespace {

CoreSettings settings_of(const BridgeOptions& options, bool lockstep) {
  return {lockstep,
          options.free_step,
          options.lease,
          options.quiet,
          options.guard,
          options.contact_speed,
          options.guard_margin,
          !options.state_file.empty(),
          !options.vision.empty()};
}

}  // namespace

Shell::Shell(const bus::NodeOptions& node, BridgeOptions options,
             std::shared_ptr<bus::MemoryBus> memory)
    : options_(checked(std::move(options))),
      lockstep_(node.lockstep),
      keeper_(make_keeper(options_.keeper)),
      node_(memory ? bus::Node(node, memory) : bus::Node(node)),
      stops_(node_, bus::topics::kDriveStop,
             {{"stop",
               "ends whatever moves the robot, in every role; done once the robot is at rest",
               {optional(text_parameter("by", "the person or agent behind the program"))}}},
             answers_),
      resets_(node_, bus::topics::kEstopReset, {{"reset", "releases the emergency stop"}},
              answers_),
      other_programs_(node_),
      link_(address_of(options_, lockstep_)),
      core_(settings_of(options_, lockstep_)),
      position_file_(options_.state_file, node_.options().files()),
      latch_file_(options_.state_file.empty() ? "" : options_.state_file + ".latched") {
  // In the order of reflector::Device.
  const bus::RequestTopic* const topics[] = {
      &bus::topics::kServo,       &bus::topics::kGripper, &bus::topics::kDigitalOutput,
      &bus::topics::kAnalog,      &bus::topics::kTimer,   &bus::topics::kSonar,
      &bus::topics::kSound,       &bus::topics::kServer,  &bus::topics::kSerial,
      &bus::topics::kVisionSystem};
  static_assert(std::size(topics) == kEnumerators<reflector::Device>.size());
  for (const reflector::Device device : kEnumerators<reflector::Device>)
    devices_.emplace_back(node_, *topics[static_cast<std::size_t>(device)],
                          reflector::functors(device), answers_);
  if (!options_.vision.empty())
    camera_.emplace(node_, options_.vision);
  if (!options_.state_file.empty() && node_.options().files() == Files::kChange)
    try {
      audit_file_.emplace(options_.state_file + ".audit");
    } catch (const std::exception& error) {  // the robot is worth more than its audit
      node_.error(std::string("no audit is kept: ") + error.what());
    }
  const double now = BootClock::seconds();
  begun_ = now;
  if (!lockstep_ && !memory)
    core_.hold_off(now + look_around(node.profile));
  core_.restore(latch_file_.read());
  if (position_file_.found())
    core_.remember(*position_file_.found());
  if (!position_file_.trouble().empty())
    node_.warn(position_file_.trouble());
  node_.info("robot at " + link_.address().text());
  deliver(now);
}

int Shell::run(const bus::Stop& stop) {
  advance({false, false});
  while (!stop.requested()) {
    const auto [link, bus] = descriptors();
    pollfd fds[] = {link, bus, {stop.fd(), POLLIN, 0}};
    const int n = ::poll(fds, 3, timeout_ms());
    advance({n > 0 && fds[0].revents != 0, n > 0 && fds[1].revents != 0});
  }
  end();
  return bus::kExitOk;
}

std::array<pollfd, 2> Shell::descriptors() const {
  return {{{link_.fd(), link_.poll_events(), 0}, {node_.wake_fd(), POLLIN, 0}}};
}

int Shell::timeout_ms() const {
  const double now = BootClock::seconds();
  double until = core_.due(now);
  if (core_.may_connect(now))
    until = std::min(until, link_.due());
  // Rounded up: a timer that wakes too early would spin.
  return std::clamp(static_cast<int>(std::ceil((until - now) * 1000.0)), 0, 100);
}

void Shell::advance(Ready ready) {
  core_.loop(BootClock::seconds());
  deliver(BootClock::seconds());
  if (ready.link)
    receive();
  // The answer to a packet comes within a fraction of a millisecond.
  if (ready.link && !ready.bus && core_.awaits_answer())
    ready.bus = node_.spin(kSpin);
  if (ready.bus) {
    node_.clear_wake();
    take_all(BootClock::seconds());
  }
  tend_link();
}

void Shell::end() {
  node_.status().state = v1::SERVICE_STOPPING;
  node_.status().reason = "asked to stop";
  const double now = BootClock::seconds();
  core_.end(now);
  deliver(now);
  node_.publish_status();
}

// ---- The robot's side.

void Shell::tend_link() {
  const double now = BootClock::seconds();
  core_.loop(now);
  deliver(now);
  if (keeper_ && now - last_beat_ >= kBeat) {
    last_beat_ = now;
    keeper_->beat();
  }
  if (core_.may_connect(now)) {
    // A link that a write found dead, before it is opened again.
    if (!link_is_open()) {
      core_.link_closed(link_.trouble(), now);
      deliver(now);
    }
    link_.advance(now);
    if (!link_is_open())
      core_.link_closed(link_.trouble(), now);
  }
  core_.tick(now, surroundings());
  work(now);
}

Surroundings Shell::surroundings() const {
  Surroundings around{.link_open = link_is_open(), .link_trouble = link_.trouble()};
  if (!core_.in_session())
    around.address = link_.address().text();
  around.serial = link_.address().kind == transport::Address::Kind::serial;
  if (other_programs_.has_namesake())
    around.namesake = other_programs_.namesake();
  around.has_keeper = keeper_ != nullptr;
  around.keeper_alive = keeper_ && keeper_->alive();
  around.keeper_restarts = keeper_ ? keeper_->restarts() : 0;
  return around;
}

void Shell::receive() {
  if (!link_is_open())
    return;  // a connection in progress: tend_link
  const double now = BootClock::seconds();
  input_.clear();
  const bool alive = link_.read(input_, now);
  if (!input_.empty())
    core_.received(input_, now);
  work(now);
  if (!alive) {
    core_.link_closed(link_.trouble(), now);
    deliver(now);
  }
}

// ---- The bus's side.

void Shell::take_all(double now) {
  other_programs_.take();
  take_drives(Role::estop, estop_, now);
  take_drives(Role::teleop, teleop_, now);
  take_drives(Role::direct, direct_, now);
  take_drives(Role::behaviors, behaviors_, now);
  take_requests(stops_);
  take_requests(resets_);
  if (const auto permit = permits_.take_newest())
    core_.permit(permit->until_cycle);
  core_.answer(now);
  deliver(now);
  take_audit(now);
  for (Desk& device : devices_)  // nothing waits for them
    take_requests(device);
  core_.step(now);
  deliver(now);
}

void Shell::take_requests(Desk& desk) {
  for (const Request& request : desk.take(core_.stamp()))
    desk.answer(request, core_.request(request, BootClock::seconds()));
}

void Shell::take_drives(Role role, bus::Reader<v1::MotorCommand>& reader, double now) {
  for (auto& sample : reader.take()) {
    sample.data.source = named(sample.data.source, bus::asker_of(sample.info));
    if (!sample.info.disposed)
      core_.command(to_drive(sample.data, role, sample.info.writer), now);
  }
  for (const bus::WriterId& writer : reader.take_lost())
    core_.writer_lost(role, writer, now);
}

// ---- The outputs of the core.

void Shell::work(double now) {
  deliver(now);
  while (core_.work(now))
    deliver(now);
}

void Shell::deliver(double now) {
  for (std::vector<Output> outputs = core_.take(); !outputs.empty(); outputs = core_.take()) {
    for (const Output& output : outputs)
      std::visit([&](const auto& what) { perform(what, now); }, output);
  }
  if (link_is_open())
    core_.room(link_.room());
}

void Shell::perform(const Send& send, double now) {
  link_.write(send.bytes, now);
}

void Shell::perform(const Identified& identified, double now) {
  protocol::RobotParameters parameters;
  try {
    parameters =
        protocol::parameters_of(identified.robot, options_.robots_folder, options_.parameter_file);
  } catch (const std::exception& error) {
    return core_.refuse_robot(error.what(), now);
  }
  // Requests from before the connection are taken, and refused, before there is a robot.
  take_all(now);
  core_.open(parameters, milliseconds_since_1970(), now);
}

void Shell::perform(const Answered&, double) {
  core_.answered(BootClock::seconds());
}

void Shell::perform(const LaterAnswer& later, double) {
  Desk& desk = later.device ? devices_[static_cast<std::size_t>(*later.device)] : stops_;
  desk.answer(later.asker, later.number, later.answer);
}

void Shell::perform(const DevicesChanged& changed, double) {
  devices_writer_.write(
      to_bus(changed.requests, changed.reports, changed.information, changed.stamp));
}

void Shell::perform(const VisionSet& set, double) {
  camera_->keep(set.text);
}

void Shell::perform(const SessionBegan& session, double) {
  if (camera_)
    camera_->connect();
  v1::RobotDescription description =
      to_bus(core_.parameters(), session.robot, session.stamp, link_.address().text(), lockstep_);
  description.instance = node_.instance();
  description_writer_.write(description);
}

void Shell::perform(const CycleBegan& cycle, double now) {
  newest_state_ = to_bus(cycle.state, cycle.stamp, cycle.bad_packets);
  std::vector<protocol::Bytes> to_camera;
  if (camera_) {
    to_camera = camera_->begin(cycle.stamp.cycle);
    newest_state_.vision_packets_per_s = camera_->packets_per_s();
  }
  state_writer_.write(newest_state_);
  if (!cycle.state.information.sonars.empty())
    buckets_writer_.write(to_bus(cycle.state.buckets, cycle.state.odom, cycle.stamp));
  for (const protocol::Bytes& words : to_camera)
    link_.write(words, now);
}

void Shell::perform(const OtherPacket& other, double) {
  if (const auto* const aux = std::get_if<protocol::AuxPacket>(&other.packet))
    serial_writer_.write({.stamp = other.stamp, .port = aux->line, .data = aux->bytes});
  const auto* const seen = std::get_if<protocol::VisionPacket>(&other.packet);
  if (seen != nullptr && camera_ && other.stamp.cycle > 0)  // before, the robot's place is unknown
    camera_->packet(*seen, newest_state_);
}

void Shell::perform(const GrantDecided& decided, double) {
  const v1::Grant grant =
      to_bus(decided.grant, decided.told, decided.guarded, decided.refused, decided.stamp);
  grant_writer_.write(grant);
  if (decided.stamp.epoch == 0)
    return;
  // With the grant, not with the state: services wait for the state.
  grant_recall_.write(grant);
  if (recalled_ != decided.stamp && newest_state_.stamp == decided.stamp) {
    recalled_ = decided.stamp;
    state_recall_.write(newest_state_);
  }
}

void Shell::perform(const WatchLink& watch, double) {
  if (keeper_)
    keeper_->watch(link_.fd(), watch.stop);
}

void Shell::perform(const CloseLink& close, double now) {
  if (keeper_)
    keeper_->unwatch();
  link_.close(close.why, now);
}

void Shell::perform(const KeepLatches& keep, double) {
  if (const std::string trouble = latch_file_.write(keep.latches); !trouble.empty())
    node_.error("the emergency stop is not kept over a restart: " + trouble);
}

void Shell::perform(const KeepOdometry& keep, double) {
  if (const std::string trouble = position_file_.write(keep.memory); !trouble.empty())
    node_.error(trouble);
}

/// Keeps what a full disk has not taken.
void Shell::tend_files(double now) {
  if (now - tended_ < kTend)
    return;
  tended_ = now;
  if (node_.options().files() == Files::kChange)
    latch_file_.tend();
  if (audit_file_)
    tell_audit(audit_file_->tend(unix_time()));
}

void Shell::perform(const StatusReport& report, double now) {
  tend_files(now);
  v1::ServiceStatus& status = node_.status();
  status.state = report.condition.health;
  status.reason = report.condition.reason;
  status.stamp = report.stamp;
  status.lockstep = lockstep_;
  status.steps = report.steps;
  status.late_cycles = report.late;
  status.refused_samples = report.refused + stops_.refused() + resets_.refused();
  for (const Desk& device : devices_)
    status.refused_samples += device.refused();
  if (report.reaction) {
    status.step_ms_mean = report.reaction->mean * 1000.0;
    status.step_ms_max = report.reaction->max * 1000.0;
  }
  node_.publish_status();
}

void Shell::perform(const Note& note, double) {
  bus::log(node_, note);
}

// ---- The audit.

void Shell::take_audit(double now) {
  // The bus repeats older entries to a new reader: they were taken before a restart.
  for (const auto& sample : audit_reader_.take())
    if (!sample.info.disposed && sample.info.age <= now - begun_)
      if (const auto entry = reports_.take(sample.data, bus::asker_of(sample.info), now))
        perform(*entry, now);
  for (const std::string& text : node_.take_refused())
    perform(v1::AuditEntry{.act = v1::AUDIT_REFUSED, .who = "somebody on the bus", .text = text},
            now);
}

void Shell::perform(const v1::AuditEntry& entry, double) {
  if (audit_file_)
    tell_audit(audit_file_->write(entry, unix_time()));
}

void Shell::tell_audit(const std::string& trouble) {
  if (trouble != audit_trouble_ && !trouble.empty())
    node_.error("the audit cannot be written: " + trouble);
  audit_trouble_ = trouble;
}

}  // namespace saphira::bridge

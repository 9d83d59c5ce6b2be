#include "saphira/sim/server.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace saphira::sim {

using namespace protocol;

namespace {

// A packet's bytes come within a few milliseconds of each other on any line that we serve.
constexpr int kGapTicks = 5;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

std::int16_t to_word(double value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -32768.0, 32767.0)));
}

// 15 bits, always positive, rolling over (manual 5.5.1).
std::uint16_t to_position(double position, double unit) {
  return static_cast<std::uint16_t>(static_cast<std::uint64_t>(std::llround(position / unit)) &
                                    0x7FFFU);
}

std::uint16_t to_range(const SonarEcho& echo, double unit) {
  const double counts = echo.range ? std::round(*echo.range / unit) : std::ceil(kNoEcho / unit);
  return static_cast<std::uint16_t>(std::clamp(counts, 0.0, 65535.0));
}

}  // namespace

Server::Server(Scene& scene, const RobotParameters& parameters, const Pose& start_in_world,
               const ServerOptions& options)
    : parameters_(parameters),
      options_(options),
      scene_(scene),
      robot_(scene.add_robot(parameters, start_in_world, options.seed)),
      sonars_(scene, robot_.number(), parameters, options.sonar, options.seed),
      single_step_(options.single_step) {}

void Server::receive(ByteView bytes) {
  quiet_ticks_ = 0;
  parser_.feed(bytes);
  drain();
}

void Server::gap() {
  parser_.gap();
  drain();
}

void Server::drain() {
  while (!step_asked_) {
    const auto body = parser_.next();
    if (!body)
      return;
    handle(*body);
    if (step_asked_ && options_.keeps_time)
      step();
  }
}

void Server::step() {
  for (int i = 0; i < kTicksPerPacket; ++i)
    tick();
  step_asked_ = false;
}

void Server::end_step() {
  step_asked_ = false;
  drain();
}

void Server::advance(int ticks) {
  for (int i = 0; i < ticks && runs(); ++i) {
    quiet_tick();
    tick();
  }
}

void Server::disconnect() {
  parser_.reset();
  output_.clear();
  close();
}

Bytes Server::take_output() {
  return std::exchange(output_, {});
}

std::vector<TraceRow> Server::take_trace() {
  return std::exchange(trace_, {});
}

ServerCounters Server::counters() const {
  ServerCounters counters = counters_;
  counters.bad_packets = parser_.counters().bad_packets();
  return counters;
}

void Server::send(const Bytes& packet) {
  output_.insert(output_.end(), packet.begin(), packet.end());
}

void Server::handle(const Bytes& body) {
  if (state_ != State::kOpen && synchronize(body))
    return;
  if (state_ != State::kSynchronized && state_ != State::kOpen)
    return;  // nobody is connected yet
  silent_ticks_ = 0;
  if (watchdog_) {
    // Revived by any command, before it acts (manual 5.4.4).
    watchdog_ = false;
    robot_.brake(false);
  }
  ++counters_.commands;
  act(decode_command(body, parameters_.vel2_unit));
}

// The dialogue of manual 5.4.1, in which 0, 1 and 2 are SYNC packets. An echo may get lost on the
// way, so a packet that comes again is echoed again; SYNC0 begins anew at any time before OPEN.
bool Server::synchronize(const Bytes& body) {
  const auto number = sync_number(body);
  if (!number)
    return false;
  if (*number == 0) {
    send(encode_sync(0));
    state_ = State::kSync1;
    return true;
  }
  if (*number == 1 && state_ != State::kSync0) {
    if (state_ == State::kSynchronized)
      return false;  // OPEN
    send(encode_sync(1));
    state_ = State::kSync2;
    return true;
  }
  if (*number == 2 && (state_ == State::kSync2 || state_ == State::kSynchronized)) {
    send(encode_sync2_reply({options_.name, parameters_.robot_class, parameters_.subclass}));
    state_ = State::kSynchronized;
    return true;
  }
  return true;
}

void Server::act(const Command& command) {
  const bool opened = is_open();
  std::visit(Overloaded{
                 [](const Pulse&) {},
                 [this](const Open&) { open(); },
                 [this](const Close&) { close(); },
                 [this](const SetOrigin&) { robot_.set_origin(); },
                 [this](const Polling& c) { sonars_.set_polling(c.sonars); },
                 [this](const DigitalOutput& c) { digital_output_ = c.bits; },
                 [](const Timer&) {},  // no pin ever triggers: the reading stays 0
                 [this](const Gripper& c) { gripper_ = c.state; },
                 [this](const Ptu& c) { ptu_ = c.width; },
                 [this, opened](const Velocity& c) {
                   if (opened)
                     robot_.set_velocity(c.velocity);
                 },
                 [this, opened](const Heading& c) {
                   if (opened)
                     robot_.set_heading(c.heading);
                 },
                 [this, opened](const DeltaHeading& c) {
                   if (opened)
                     robot_.turn_by(c.delta);
                 },
                 [this, opened](const RotationVelocity& c) {
                   if (opened)
                     robot_.set_rotation_velocity(c.velocity);
                 },
                 [this, opened](const WheelVelocities& c) {
                   if (opened)
                     robot_.set_wheel_velocities(c.left, c.right);
                 },
                 [this, opened](const Step&) {
                   single_step_ = true;
                   step_asked_ = opened;
                 },
                 [this](const auto&) { ++counters_.unknown_commands; },
             },
             command);
}

void Server::open() {
  if (is_open())
    return;  // some clients say it again and again
  state_ = State::kOpen;
  cycle_ = 0;
  phase_ = 0;
  first_row_ = true;
  silent_ticks_ = 0;
  rest_asked_ = false;
  readings_.clear();
  robot_.stop();
  robot_.brake(false);
}

void Server::close() {
  state_ = State::kSync0;
  watchdog_ = false;
  readings_.clear();
  robot_.stop();
  sonars_.set_default_polling();
  // Nobody will say STEP any more: the robot comes to rest now.
  step_asked_ = false;
  rest_asked_ = single_step_;
  while (options_.keeps_time && rest_asked())
    tick();
  single_step_ = options_.single_step;
}

void Server::tick() {
  begin_tick();
  scene_.tick();
  end_tick();
}

void Server::quiet_tick() {
  if (++quiet_ticks_ == kGapTicks && parser_.pending())
    gap();
}

void Server::begin_tick() {
  if (is_open() && ++silent_ticks_ == kWatchdogTicks) {
    watchdog_ = true;
    ++counters_.watchdog_stops;
    robot_.brake(true);
  }
}

void Server::end_tick() {
  if (is_open()) {
    if (const auto echo = sonars_.tick(robot_.pose_in_world()))
      readings_.push_back({echo->number, to_range(*echo, parameters_.range_unit)});
  }
  if (++phase_ == kTicksPerPacket)
    finish_cycle();
}

void Server::finish_cycle() {
  phase_ = 0;
  ++cycle_;
  if (is_open()) {
    send(encode(information()));
    readings_.clear();
  }
  robot_.clear_stalls();
  if (!options_.trace)
    return;
  const bool heading = robot_.controls_heading();
  trace_.push_back(
      {first_row_, cycle_, robot_.pose_in_world(), robot_.velocity(), robot_.rotation_velocity(),
       robot_.target_velocity(), heading ? robot_.target_heading() : kNone,
       heading ? kNone : robot_.target_rotation_velocity(), robot_.clearance(), robot_.contacts()});
  first_row_ = false;
}

InformationPacket Server::information() const {
  const RobotParameters& p = parameters_;
  InformationPacket packet;
  packet.motors = robot_.moving() ? Motors::kMoving : Motors::kStopped;
  packet.x = to_position(robot_.pose_in_odom().x, p.distance_unit);
  packet.y = to_position(robot_.pose_in_odom().y, p.distance_unit);
  packet.th = to_word(robot_.pose_in_odom().th / p.angle_unit);
  packet.left_velocity = to_word(robot_.left_velocity() / p.velocity_unit);
  packet.right_velocity = to_word(robot_.right_velocity() / p.velocity_unit);
  packet.battery = static_cast<std::uint8_t>(std::lround(p.battery * 10.0));
  packet.left_stall = robot_.left_stalled() ? 1 : 0;
  packet.right_stall = robot_.right_stalled() ? 1 : 0;
  packet.control = to_word(robot_.target_heading() / p.angle_unit);
  packet.ptu = ptu_;
  packet.sonars = readings_;
  packet.digital_output = digital_output_;
  return packet;
}

}  // namespace saphira::sim

#include "saphira/sim/server.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saphira/base/overloaded.hpp"

namespace saphira::sim {

using namespace protocol;

namespace {

// A packet's bytes come within a few milliseconds of each other on every supported line.
constexpr int kGapTicks = 5;

constexpr int kSonarsInArray = 8;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

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
      single_step_(options.single_step),
      devices_(parameters, options.name),
      start_in_world_(start_in_world),
      watchdog_ticks_(static_cast<int>(std::lround(parameters.watchdog / kTick))),
      later_(parameters.protocol != Protocol::kPsos) {
  set_default_polling();
}

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

void Server::measure(const Measured& body) {
  measured_ = true;
  robot_.measure(body);
}

void Server::hear(const std::vector<SonarEcho>& echoes) {
  for (const SonarEcho& echo : echoes) {
    if (!is_open() || std::ranges::find(firing_, echo.number) == firing_.end())
      continue;
    std::erase_if(readings_, [&](const RawSonar& old) { return old.number == echo.number; });
    readings_.push_back({echo.number, to_range(echo, parameters_.range_unit)});
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

// The dialogue of manual 5.4.1, in which 0, 1 and 2 are SYNC packets. An echo may get lost, so a
// repeated packet is echoed again; SYNC0 begins anew at any time before OPEN.
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
  if (std::holds_alternative<Unknown>(command)) {
    ++counters_.unknown_commands;
    return;
  }
  if (drive(command) || simulate(command))
    return;
  const bool session = std::visit(
      Overloaded{
          [this](const Bare& c) {
            switch (c.number) {
              case Number::kPulse:
                return true;
              case Number::kOpen:
                open();
                return true;
              case Number::kClose:
                close();
                return true;
              case Number::kStep:
                single_step_ = true;
                step_asked_ = is_open();
                return true;
              case Number::kReset:
              case Number::kMaintenance:
                close();  // the controller starts anew; a client has to synchronize again
                return later_;
              default:
                return false;
            }
          },
          [this](const Polling& c) {
            polling_ = c.sonars;
            set_sonars();
            return true;
          },
          [this](const SonarSwitch& c) {
            const auto bits =
                static_cast<std::uint8_t>(c.array == 0 ? 0xFFU : 1U << ((c.array - 1U) & 7U));
            sonar_arrays_on_ = static_cast<std::uint8_t>(c.on ? sonar_arrays_on_ | bits
                                                              : sonar_arrays_on_ & ~bits);
            set_sonars();
            return later_;
          },
          [this](const Text& c) {
            return c.number == Number::kVision &&
                   vision_.act(std::string(c.text.begin(), c.text.end()));
          },
          [](const auto&) { return false; },
      },
      command);
  if (!session && devices_.act(command, robot_, output_) != Devices::Answer::kTaken)
    ++counters_.unsupported_commands;
}

// The commands that move the robot or set its motion; true for one that the robot has.
bool Server::drive(const Command& command) {
  const RobotParameters& p = parameters_;
  // Without a client the robot does not move.
  Robot* robot = is_open() ? &robot_ : nullptr;
  const auto move = [this, robot](const auto& how) {
    emergency_ = false;
    if (robot != nullptr)
      how(*robot);
    return true;
  };
  const auto set = [](bool settable, const auto& how) {
    if (settable)
      how();
    return settable;
  };
  return std::visit(
      Overloaded{
          [&](const Velocity& c) { return move([&](Robot& r) { r.set_velocity(c.value); }); },
          [&](const Heading& c) { return move([&](Robot& r) { r.set_heading(c.heading); }); },
          [&](const DeltaHeading& c) { return move([&](Robot& r) { r.turn_by(c.value); }); },
          [&](const RotationVelocity& c) {
            return move([&](Robot& r) { r.set_rotation_velocity(c.value); });
          },
          [&](const WheelVelocities& c) {
            return move([&](Robot& r) { r.set_wheel_velocities(c.left, c.right); });
          },
          [&](const Rotate& c) {
            return later_ && move([&](Robot& r) { r.set_rotation_velocity(c.value); });
          },
          [&](const DeltaSetpoint& c) {
            return later_ && move([&](Robot& r) { r.set_heading(r.target_heading() + c.value); });
          },
          [&](const Move& c) {
            return p.move_command && move([&](Robot& r) { r.move_by(c.value); });
          },
          [&](const Bare& c) {
            switch (c.number) {
              case Number::kStop:
                return move([](Robot& r) {
                  r.set_velocity(0.0);
                  r.set_rotation_velocity(0.0);
                });
              case Number::kEmergencyStop:
              case Number::kEmergencyStop2:
                robot_.emergency_stop();
                emergency_ = true;
                return true;
              case Number::kSetOrigin:
                robot_.set_origin();
                return true;
              default:
                return false;
            }
          },
          [&](const Enable& c) {
            robot_.enable(c.on);
            return true;
          },
          [&](const MaxVelocity& c) {
            return set(p.settable_velocities, [&] { robot_.set_max_velocity(c.value); });
          },
          [&](const MaxRotationVelocity& c) {
            return set(p.settable_velocities, [&] { robot_.set_max_rotation_velocity(c.value); });
          },
          [&](const Acceleration& c) {
            return set(p.settable_accelerations, [&] {
              if (c.value >= 0.0)
                robot_.set_acceleration(c.value);
              else
                robot_.set_deceleration(-c.value);
            });
          },
          [&](const RotationAcceleration& c) {
            return set(p.settable_accelerations, [&] {
              if (c.value >= 0.0)
                robot_.set_rotation_acceleration(c.value);
              else
                robot_.set_rotation_deceleration(-c.value);
            });
          },
          [](const auto&) { return false; },
      },
      command);
}

// The commands that only simulators have.
bool Server::simulate(const Command& command) {
  return std::visit(Overloaded{
                        [this](const TruePose& c) {
                          robot_.place(c.pose_in_world);
                          return true;
                        },
                        [this](const Bare& c) {
                          if (c.number != Number::kTrueOrigin && c.number != Number::kSimReset)
                            return false;
                          robot_.place(start_in_world_);
                          if (c.number == Number::kSimReset)
                            robot_.set_origin();
                          return true;
                        },
                        [this](const Integer& c) {
                          switch (c.number) {
                            case Number::kTrueHeading: {
                              const Vec2 at = robot_.pose_in_world().position();
                              robot_.place({at.x(), at.y(), norm2_angle(radians(c.value))});
                              return true;
                            }
                            case Number::kSimStatus:
                              sim_status_with_each_ = c.value == 2;
                              if (c.value == 1)
                                send(encode(sim_status()));
                              return true;
                            case Number::kBatteryTest:
                              robot_.set_battery(c.value / 10.0);
                              return true;
                            default:
                              return false;
                          }
                        },
                        [](const Text& c) { return c.number == Number::kSimMessage; },
                        [](const auto&) { return false; },
                    },
                    command);
}

// The sonars that fire: the polling sequence without the arrays that are off.
void Server::set_sonars() {
  std::vector<std::uint8_t> sequence;
  for (const std::uint8_t number : polling_)
    if ((sonar_arrays_on_ >> std::min(number / kSonarsInArray, 7) & 1) != 0)
      sequence.push_back(number);
  sonars_.set_polling(sequence);
  firing_ = sequence;
}

void Server::set_default_polling() {
  polling_ = default_polling(parameters_.sonars.size(), parameters_.sonar_arrays);
  sonar_arrays_on_ = 0xFF;
  set_sonars();
}

SimStatusPacket Server::sim_status() const {
  const auto millimetres = [](double value) {
    return static_cast<std::int32_t>(std::lround(value * 1000.0));
  };
  const Pose& at = robot_.pose_in_world();
  const Pose odom_in_world = compose(start_in_world_, robot_.pose_in_odom());
  SimStatusPacket packet;
  packet.sim_interval = packet.real_interval = packet.last_interval = 100;
  packet.true_x = millimetres(at.x);
  packet.true_y = millimetres(at.y);
  packet.true_th = static_cast<std::int32_t>(std::lround(degrees(at.th)));
  packet.odometry_error_x = millimetres(odom_in_world.x - at.x);
  packet.odometry_error_y = millimetres(odom_in_world.y - at.y);
  packet.odometry_error_th =
      static_cast<std::int32_t>(std::lround(degrees(norm2_angle(odom_in_world.th - at.th))));
  return packet;
}

void Server::tell_status() {
  if (is_open())
    send(encode(sim_status()));
}

void Server::open() {
  if (is_open())
    return;  // some clients repeat it
  state_ = State::kOpen;
  cycle_ = 0;
  phase_ = 0;
  first_row_ = true;
  silent_ticks_ = 0;
  rest_asked_ = false;
  readings_.clear();
  robot_.stop();
  robot_.brake(false);
  robot_.enable(!later_);
}

void Server::close() {
  state_ = State::kSync0;
  watchdog_ = false;
  readings_.clear();
  newest_.clear();
  robot_.stop();
  set_default_polling();
  devices_.disconnect();
  vision_.disconnect();
  sim_status_with_each_ = false;
  emergency_ = false;
  // No further STEP will come: the robot comes to rest now.
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
  if (is_open() && ++silent_ticks_ == watchdog_ticks_) {
    watchdog_ = true;
    ++counters_.watchdog_stops;
    robot_.brake(true);
  }
}

void Server::end_tick() {
  if (is_open()) {
    devices_.tick();
    if (const auto echo = measured_ ? std::nullopt : sonars_.tick(robot_.pose_in_world()))
      readings_.push_back({echo->number, to_range(*echo, parameters_.range_unit)});
    if (!readings_.empty())
      newest_[readings_.back().number] = readings_.back().range;
  }
  if (++phase_ == kTicksPerPacket)
    finish_cycle();
}

std::vector<std::pair<Pose, double>> Server::beams() const {
  std::vector<std::pair<Pose, double>> beams;
  for (const protocol::SonarUnit& unit : parameters_.sonars)
    if (const auto found = newest_.find(unit.number); found != newest_.end())
      beams.emplace_back(unit.pose_in_robot, std::min(found->second * parameters_.range_unit,
                                                      parameters_.sonar_max_range));
  return beams;
}

void Server::finish_cycle() {
  phase_ = 0;
  ++cycle_;
  if (is_open()) {
    devices_.cycle();
    send(encode(information()));
    devices_.add_packets(robot_, output_);
    if (vision_.on())
      send(encode(vision_.look(scene_, robot_.number())));
    if (sim_status_with_each_)
      send(encode(sim_status()));
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
  const double decivolts = std::round(robot_.battery() * 10.0);
  packet.battery = static_cast<std::uint8_t>(std::clamp(decivolts, 0.0, 255.0));
  packet.left_stall = robot_.left_stalled() ? 1 : 0;
  packet.right_stall = robot_.right_stalled() ? 1 : 0;
  packet.control = to_word(robot_.target_heading() / p.angle_unit);
  packet.sonars = readings_;
  devices_.reflect(packet);
  if (later_)
    add_later_fields(packet);
  return packet;
}

// The additional fields of P2OS and ARCOS packets.
void Server::add_later_fields(InformationPacket& packet) const {
  const RobotParameters& p = parameters_;
  const unsigned front = robot_.bumpers(p.front_bumpers, false);
  const unsigned rear = robot_.bumpers(p.rear_bumpers, true);
  const auto stalls = static_cast<unsigned>(devices_.bump_stall());
  const unsigned bumped = ((stalls & 1U) != 0 && front != 0) || ((stalls & 2U) != 0 && rear != 0);
  packet.left_stall = static_cast<std::uint8_t>(packet.left_stall | bumped | rear << 1U);
  packet.right_stall = static_cast<std::uint8_t>(packet.right_stall | bumped | front << 1U);

  unsigned flags = 0;
  if (robot_.enabled())
    flags |= kFlagMotors;
  if (emergency_)
    flags |= kFlagEmergencyStop;
  for (int array = 0; array < std::min(p.sonar_arrays, 4); ++array)
    if ((sonar_arrays_on_ >> array & 1) != 0)
      flags |= 1U << static_cast<unsigned>(array + 1);
  packet.ptu = static_cast<std::uint16_t>(flags);

  if (p.compass) {
    // 0 is along the world's x; the reading counts two degrees.
    const double bearing = degrees(norm_angle(robot_.pose_in_world().th));
    packet.say = static_cast<std::uint8_t>(std::lround(bearing / 2.0) % 180);
  }
  if (p.protocol != Protocol::kArcos)
    return;
  TrailingFields& more = packet.trailing;
  const double voltage = robot_.battery();
  more.battery = static_cast<std::uint16_t>(std::lround(std::clamp(voltage, 0.0, 6000.0) * 10.0));
  more.charge_state = 0;
  more.rotation = to_word(degrees(robot_.rotation_velocity()) * 10.0);
  more.faults = 0;
  more.lateral = 0;
  more.temperature = -128;
  const double charge =
      (voltage - p.shutdown_voltage) / std::max(p.battery - p.shutdown_voltage, 0.1) * 100.0;
  more.state_of_charge = static_cast<std::uint8_t>(std::lround(std::clamp(charge, 1.0, 100.0)));
  more.time = static_cast<std::uint32_t>(cycle_ * 100'000U);
  more.flags3 = 0;
}

}  // namespace saphira::sim

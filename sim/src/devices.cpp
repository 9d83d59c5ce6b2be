#include "saphira/sim/devices.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "saphira/base/overloaded.hpp"
#include "saphira/protocol/vision_setting.hpp"

namespace saphira::sim {

using namespace protocol;

namespace {

// The paddles take 1.5 s from stop to stop, the lift 3 s: about as long as the Pioneers' gripper.
constexpr double kPaddleStep = 0.1 / 1.5;
constexpr double kLiftStep = 0.1 / 3.0;
constexpr int kSoundUnitsInCycle = 5;  // of 20 ms
constexpr int kTimerTick = 10;         // [ms]

// PeopleBots have infrared sensors that look up at tables, on their digital inputs: a clear bit
// means a table. The first PeopleBot (p2pb) has none.
bool has_table_sensors(const RobotParameters& parameters) {
  constexpr std::array kPeopleBots{"p2pp", "perfpb", "perfpb+", "peoplebot-sh"};
  return std::ranges::find(kPeopleBots, parameters.subclass) != kPeopleBots.end();
}

}  // namespace

void Gripper::Axis::cycle(double step) {
  position = std::clamp(position + direction * step, 0.0, 1.0);
  if (position == 0.0 || position == 1.0)
    direction = 0;
}

void Gripper::act(int action) {
  struct Move {
    GripperAction action;
    std::optional<int> paddles;  ///< direction
    std::optional<int> lift;
  };
  using enum GripperAction;
  static constexpr Move kMoves[]{{kOpen, 1, {}},   {kClose, -1, {}},    {kStop, 0, {}},
                                 {kLiftUp, {}, 1}, {kLiftDown, {}, -1}, {kLiftStop, {}, 0},
                                 {kStore, -1, 1},  {kDeploy, 1, -1},    {kHalt, 0, 0}};
  action_ = action;
  for (const Move& move : kMoves)
    if (static_cast<int>(move.action) == action) {
      paddles_.direction = move.paddles.value_or(paddles_.direction);
      lift_.direction = move.lift.value_or(lift_.direction);
    }
}

void Gripper::cycle() {
  paddles_.cycle(kPaddleStep);
  lift_.cycle(kLiftStep);
}

std::uint8_t Gripper::bits() const {
  const auto bit = [](bool on, unsigned place) { return on ? 1U << place : 0U; };
  return static_cast<std::uint8_t>(bit(paddles_.position == 1.0, 0) |
                                   bit(paddles_.position == 0.0, 1) |
                                   bit(paddles_.direction != 0, 2) | bit(lift_.position == 1.0, 4) |
                                   bit(lift_.position == 0.0, 5) | bit(lift_.direction != 0, 6));
}

bool FastTrack::act(const std::string& text) {
  on_ = true;
  using What = VisionSetting::What;
  try {
    const VisionSetting set = parse_vision_setting(text);
    Channel& channel = channels_.at(static_cast<std::size_t>(set.channel));
    switch (set.what) {
      case What::mode:
        channel.mode = static_cast<VisionChannel::Mode>(set.value);
        break;
      case What::color:
        channel.color = set.color;
        break;
      case What::bottom_row:
        lines_.bottom = set.value;
        break;
      case What::slices:
        lines_.slices = set.value;
        break;
      case What::slice_size:
        lines_.size = set.value;
        break;
      case What::minimum_mass:
        lines_.mass = set.value;
        break;
    }
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

// A blob is a rectangle here, with the same number of pixels in each row.
void FastTrack::find_line(const Blob& blob, const Camera& camera, VisionChannel& channel) const {
  // Rows count from the bottom of the picture.
  const int bottom = std::max(blob.y - blob.height / 2 + camera.rows / 2, 0);
  const int top = std::min(bottom + blob.height, camera.rows);
  const double in_row = static_cast<double>(blob.area) / std::max(blob.height, 1);
  for (int slice = 0; slice < lines_.slices; ++slice) {
    const int from = lines_.bottom + slice * lines_.size;
    const int rows = std::min(top, from + lines_.size) - std::max(bottom, from);
    if (rows <= 0 || rows * in_row < lines_.mass) {
      if (channel.count > 0)
        break;
      continue;
    }
    if (channel.count == 0)
      channel.first = static_cast<std::uint16_t>(slice);
    ++channel.count;
  }
}

VisionPacket FastTrack::look(const Scene& scene, RobotNumber robot) const {
  const Camera camera;
  VisionPacket packet;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& from = channels_[i];
    VisionChannel& channel = packet.channels[i];
    channel.mode = from.mode;
    const auto blob = see_blob(scene, robot, camera, from.color);
    if (!blob)
      continue;
    channel.x = static_cast<std::int16_t>(blob->x);
    if (from.mode == VisionChannel::Mode::kLine) {
      find_line(*blob, camera, channel);
      continue;
    }
    channel.y = static_cast<std::int16_t>(blob->y);
    channel.area = static_cast<std::uint16_t>(blob->area);
    if (from.mode == VisionChannel::Mode::kBlobWithBox) {
      channel.height = static_cast<std::uint16_t>(blob->height);
      channel.width = static_cast<std::uint16_t>(blob->width);
    }
  }
  return packet;
}

Devices::Devices(const RobotParameters& parameters, const std::string& name)
    : parameters_(parameters),
      name_(name),
      later_(parameters.protocol != Protocol::kPsos),
      digital_input_(has_table_sensors(parameters) ? 0xFF : 0) {
  if (parameters.head_reach > 0.0)
    servo_ = ptu_ = pulse_of_head(parameters, 0.0);
}

Devices::Answer Devices::act(const Command& command, const Robot& robot, Bytes& out) {
  const auto taken = [](bool have) { return have ? Answer::kTaken : Answer::kMissing; };
  return std::visit(
      Overloaded{
          [&](const DigitalOutput& c) {
            // PSOS has no mask; a client of that time sends none, and means all bits.
            const std::uint8_t mask = later_ && c.mask != 0 ? c.mask : std::uint8_t{0xFF};
            digital_output_ =
                static_cast<std::uint8_t>((digital_output_ & ~mask) | (c.bits & mask));
            return Answer::kTaken;
          },
          [&](const protocol::Timer& c) {
            timer_ = 0;
            timer_pin_ = c.pin;
            return Answer::kTaken;
          },
          [&](const protocol::Gripper& c) {
            gripper_.act(c.state);
            return taken(!later_ || parameters_.gripper);
          },
          [&](const Ptu& c) {
            ptu_ = c.width;
            return Answer::kTaken;
          },
          [&](const Text& c) {
            if (c.number != Number::kSay)
              return Answer::kNotMine;
            sounding_ = 0;
            for (std::size_t i = 0; i < c.text.size(); i += 2)
              sounding_ += c.text[i];
            return Answer::kTaken;
          },
          [&](const Integer& c) { return act(c, robot, out); },
          [](const auto&) { return Answer::kNotMine; },
      },
      command);
}

Devices::Answer Devices::act(const Integer& c, const Robot& robot, Bytes& out) {
  const auto taken = [](bool have) { return have ? Answer::kTaken : Answer::kMissing; };
  switch (c.number) {
    case Number::kGripperValue:
      return taken(parameters_.gripper);
    case Number::kAnalogSelect:
      if (later_)
        analog_port_ = static_cast<std::uint8_t>(c.value & 0xFF);
      return taken(later_);
    case Number::kBumpStall:
      if (later_)
        bump_stall_ = c.value & 3;
      return taken(later_);
    case Number::kHostBaud:
      return taken(later_);
    case Number::kConfigRequest:
      return ask(kConfig, 1, robot, out);
    case Number::kEncoderRequest:
      return ask(kEncoder, c.value, robot, out);
    case Number::kIoRequest:
      return ask(kIo, c.value, robot, out);
    case Number::kGripperRequest:
      return ask(Request::kGripper, c.value, robot, out);
    case Number::kGyroRequest:
      return ask(kGyro, c.value != 0 ? 2 : 0, robot, out);  // here 1 means "from now on"
    case Number::kJoystickRequest:
      return ask(kJoystick, c.value, robot, out);
    case Number::kBatteryRequest:
      return ask(kBattery, c.value, robot, out);
    default:
      return Answer::kNotMine;
  }
}

bool Devices::has(Request request) const {
  if (request == kEncoder)
    return parameters_.encoder_unit > 0.0;
  if (request == kGyro)
    return parameters_.gyro;
  return later_;
}

Devices::Answer Devices::ask(Request request, int mode, const Robot& robot, Bytes& out) {
  if (!has(request))
    return Answer::kMissing;
  with_each_[request] = mode == 2;
  if (mode == 1) {
    const Bytes bytes = packet(request, robot);
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
  return Answer::kTaken;
}

Bytes Devices::packet(Request request, const Robot& robot) const {
  const auto count = [this](double way) {
    // Rolls over like the controller's register.
    return static_cast<std::int32_t>(
        static_cast<std::uint32_t>(std::llround(way / parameters_.encoder_unit)));
  };
  switch (request) {
    case kConfig: {
      // The present settings, not those of the file.
      RobotParameters set = parameters_;
      set.acceleration = robot.acceleration();
      set.deceleration = robot.deceleration();
      set.rotation_acceleration = robot.rotation_acceleration();
      set.rotation_deceleration = robot.rotation_deceleration();
      return encode(config_of(set, name_, "0"));
    }
    case kEncoder:
      return encode(EncoderPacket{count(robot.left_way()), count(robot.right_way())});
    case kIo:
      return encode(IoPacket{{digital_input_},
                             {digital_output_},
                             {static_cast<std::uint16_t>(analog(analog_port_) << 2U)}});
    case Request::kGripper:
      return encode(
          GripperPacket{static_cast<std::uint8_t>(parameters_.gripper ? 2 : 0),
                        static_cast<std::uint8_t>(parameters_.gripper ? gripper_.bits() : 0), 0});
    case kGyro: {
      // Full scale of the 10-bit reading is 300 degrees a second to either side.
      const double rate = 512.0 + degrees(robot.rotation_velocity()) * 512.0 / 300.0;
      const auto counts = static_cast<std::uint16_t>(std::lround(std::clamp(rate, 0.0, 1023.0)));
      return encode(GyroPacket{{{counts, 128}}});
    }
    case kJoystick:
      return encode(JoystickPacket{});
    case kBattery: {
      const auto decivolts =
          static_cast<unsigned>(std::lround(std::max(0.0, robot.battery() * 10.0)));
      return encode(BatteryPacket{1,
                                  2,
                                  {static_cast<std::uint8_t>(decivolts & 0xFFU),
                                   static_cast<std::uint8_t>(decivolts >> 8U & 0xFFU)}});
    }
    case kRequests:
      break;
  }
  return {};
}

void Devices::set_digital_input(std::uint8_t bits) {
  if (timer_pin_ && ((bits ^ digital_input_) >> *timer_pin_ & 1) != 0)
    timer_pin_.reset();
  digital_input_ = bits;
}

double Devices::head() const {
  return parameters_.head_reach == 0.0
             ? 0.0
             : (servo_ - parameters_.head_center) / parameters_.head_pulse;
}

void Devices::tick() {
  if (parameters_.head_reach > 0.0 && ptu_ != 0) {
    const double step = kTick * parameters_.head_speed * std::abs(parameters_.head_pulse);
    const double way = parameters_.head_reach * std::abs(parameters_.head_pulse);
    const double target =
        std::clamp<double>(ptu_, parameters_.head_center - way, parameters_.head_center + way);
    servo_ += std::clamp(target - servo_, -step, step);
  }
  if (timer_pin_)
    timer_ = static_cast<std::uint16_t>(std::min(timer_ + kTimerTick, 0xFFFF));
}

void Devices::cycle() {
  gripper_.cycle();
  sounding_ = std::max(0, sounding_ - kSoundUnitsInCycle);
}

void Devices::add_packets(const Robot& robot, Bytes& out) const {
  for (int i = 0; i < kRequests; ++i) {
    const auto request = static_cast<Request>(i);
    if (!with_each_[request])
      continue;
    const Bytes bytes = packet(request, robot);
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
}

void Devices::reflect(InformationPacket& packet) const {
  packet.digital_input = digital_input_;
  packet.digital_output = digital_output_;
  packet.analog = analog(analog_port_);
  if (!later_) {
    packet.ptu =
        parameters_.head_reach > 0.0 ? static_cast<std::uint16_t>(std::lround(servo_)) : ptu_;
    packet.timer = timer_;
    packet.say = sounding_ > 0 ? 1 : 0;
    return;
  }
  const unsigned gripper = parameters_.gripper ? gripper_.bits() : 0U;
  const unsigned low = parameters_.protocol == Protocol::kArcos ? analog_port_ : 0U;
  packet.timer = static_cast<std::uint16_t>(gripper << 8U | low);
}

void Devices::disconnect() {
  with_each_ = {};
  sounding_ = 0;
  timer_pin_.reset();
}

}  // namespace saphira::sim

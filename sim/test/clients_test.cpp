// The cases of clients.txt: the test is a client of the server, without a line between them.
#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "lines.hpp"
#include "process.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/protocol/server_packet.hpp"
#include "saphira/sim/server.hpp"

namespace saphira::sim {
namespace {

using protocol::Bytes;
using protocol::ServerPacket;

std::string told(const Pose& at) {
  return format("%.2f %.2f %.0f", at.x, at.y, degrees(at.th));
}

/// One case.
class Client : public saphira::test::LinePlayer {
 public:
  Client() {
    events_ = {
      {"robot",
       [this](auto& in) {
         const auto name = read<std::string>(in);
         begin(
             "width 20000 height 20000 0 0 20000 0 20000 0 20000 20000 20000 20000 0 "
             "20000 0 20000 0 0",
             name, rest(in));
         open();
       }},
      ON("office", const std::string name = rest(in);
         begin(read_file(test::source("config/worlds/office.wld")), name.empty() ? "pioneer" : name,
               "")),
      ON("colors", begin("width 20000 height 20000 position 10000 10000 0 "
                         "post can 12000 10000 100 color red tall 700 "
                         "post box 12000 10500 100 color green tall 700",
                         "pioneer", "");
         open()),
      ON("open", open()),
      ON("SYNC", server_->receive(protocol::encode_sync(read<int>(in)))),
      ON("bytes", bytes(in)),
      {"damaged",
       [this](auto&) {
         Bytes bad = protocol::encode(protocol::Velocity{0.3});
         bad[5] ^= 1U;
         server_->receive(bad);
       }},
      ON("disconnect", server_->disconnect()),
      ON("ticks", server_->advance(read<int>(in))),
      ON("seconds", seconds(read<double>(in))),
      ON("forget", pump(); packets_.clear()),
      ON("inputs", server_->devices().set_digital_input(byte(in))),
      ON("analog", const std::uint8_t value = byte(in);
         server_->devices().set_analog(value, byte(in)))
    };
    for (const protocol::CommandRule& rule : protocol::rules())
      events_[std::string(rule.name)] = [this, &rule](auto& in) { send(rule, in); };
    facts_ = {IS("echoes", echoes()),
              IS("open", yes(server_->is_open())),
              IS("single step", yes(server_->single_step())),
              IS("packets", std::to_string(all<protocol::InformationPacket>().size())),
              IS("motors", std::to_string(static_cast<int>(newest().motors))),
              IS("power", yes(told_now().motors != protocol::Motors::kNoPower)),
              IS("stopped", yes(told_now().emergency_stop.value_or(false))),
              IS("battery", format("%.1f", told_now().battery)),
              IS("speed", format("%.2f", told_now().velocity)),
              IS("heading", format("%.0f", degrees(told_now().th))),
              IS("control", format("%.0f", degrees(told_now().control))),
              IS("gripper bits", std::to_string(told_now().gripper_bits & 7U)),
              IS("bumpers", format("%d %d", told_now().front_bumpers, told_now().rear_bumpers)),
              IS("stalled", yes(told_now().left_stalled)),
              IS("arrays", std::to_string((newest().ptu & protocol::kFlagSonars) >> 1U)),
              IS("trailing", yes(newest().trailing.flags3.has_value())),
              IS("way", format("%.2f", newest().x * parameters_.distance_unit)),
              IS("x", std::to_string(newest().x)),
              IS("output", std::to_string(newest().digital_output)),
              IS("servo", std::to_string(newest().ptu)),
              IS("sonars", sonars()),
              IS("gripper", gripper()),
              IS("gripper action", std::to_string(server_->devices().gripper().action())),
              IS("head", format("%.0f", degrees(server_->devices().head()))),
              IS("moves", yes(server_->robot().moving())),
              IS("goes", format("%.3f", server_->robot().velocity())),
              IS("turns", format("%.0f", degrees(server_->robot().rotation_velocity()))),
              IS("in odom", told(server_->robot().pose_in_odom())),
              IS("in world", told(server_->robot().pose_in_world())),
              IS("unknown", std::to_string(server_->counters().unknown_commands)),
              IS("unsupported", std::to_string(server_->counters().unsupported_commands)),
              IS("bad", std::to_string(server_->counters().bad_packets)),
              IS("watchdog stops", std::to_string(server_->counters().watchdog_stops)),
              IS("rows", rows()),
              IS("config", config()),
              IS("encoders", encoders()),
              IS("io", io()),
              IS("batteries", std::to_string(all<protocol::BatteryPacket>().size())),
              IS("status", status()),
              IS("camera", camera())};
  }

 private:
  void begin(const std::string& world, const std::string& robot, const std::string& watchdog) {
    world_ = parse_world(world, "client.wld");
    parameters_ = protocol::load_parameters(test::source("config/robots/" + robot + ".p"));
    if (!watchdog.empty())
      parameters_.watchdog = std::stod(watchdog);
    scene_.emplace(world_);
    ServerOptions options;
    options.trace = true;
    server_.emplace(*scene_, parameters_, world_.start.value_or(Pose{10.0, 10.0, 0.0}), options);
  }
  void open() {
    for (int i = 0; i < 3; ++i)
      server_->receive(protocol::encode_sync(i));
    server_->receive(protocol::encode(protocol::Open{}));
    pump();
    packets_.clear();
  }
  /// "VEL 300"; of a string its text, of POLLING its sonars.
  void send(const protocol::CommandRule& rule, std::istringstream& in) {
    protocol::Command command = protocol::Bare{rule.number};
    const std::string argument = rest(in);
    if (rule.number == protocol::Number::kPolling)
      command = argument.empty() ? protocol::Polling{} : protocol::Polling{{byte(argument)}};
    else if (rule.number == protocol::Number::kTruePose)
      command = protocol::TruePose{{3.0, 4.0, radians(90.0)}};
    else if (rule.form == protocol::ArgumentForm::kString)
      command = protocol::Text{rule.number, Bytes(argument.begin(), argument.end())};
    else if (!argument.empty())
      command = protocol::Integer{rule.number, std::stoi(argument)};
    server_->receive(protocol::encode(command, parameters_));
  }
  static std::uint8_t byte(const std::string& text) {
    return static_cast<std::uint8_t>(std::stoul(text, nullptr, 0));
  }
  static std::uint8_t byte(std::istringstream& in) { return byte(read<std::string>(in)); }
  /// "bytes 0xFA 0xFB 50"; "bytes body 14" is a whole packet.
  void bytes(std::istringstream& in) {
    Bytes all;
    bool whole = false;
    for (std::string word; in >> word;)
      if (word == "body")
        whole = true;
      else
        all.push_back(byte(word));
    server_->receive(whole ? protocol::frame(all) : all);
  }
  /// With pulses of its client.
  void seconds(double time) {
    for (int left = static_cast<int>(std::lround(time * 10.0)); left > 0; --left) {
      server_->receive(protocol::encode(protocol::Pulse{}));
      server_->advance(kTicksPerPacket);
    }
  }

  void pump() {
    parser_.feed(server_->take_output());
    while (const auto body = parser_.next())
      packets_.push_back(protocol::decode_packet(*body));
  }
  /// Since the last "forget".
  template <class Packet>
  std::vector<Packet> all() {
    pump();
    std::vector<Packet> found;
    for (const ServerPacket& packet : packets_)
      if (const auto* const is = std::get_if<Packet>(&packet))
        found.push_back(*is);
    return found;
  }
  template <class Packet = protocol::InformationPacket>
  Packet newest() {
    const std::vector<Packet> found = all<Packet>();
    return found.empty() ? Packet{} : found.back();
  }
  protocol::Information told_now() { return protocol::interpret(newest(), parameters_); }

  std::string echoes() {
    parser_.feed(server_->take_output());
    std::string text;
    while (const auto body = parser_.next()) {
      text += (text.empty() ? "" : " ") + std::to_string((*body)[0]);
      if (const auto robot = protocol::decode_sync2_reply(*body))
        text += " " + robot->name + " " + robot->robot_class + " " + robot->subclass;
    }
    return text;
  }
  /// The numbers of those that have fired since the last "forget".
  std::string sonars() {
    std::set<int> numbers;
    for (const auto& packet : all<protocol::InformationPacket>())
      for (const auto& sonar : packet.sonars)
        numbers.insert(sonar.number);
    return joined(numbers, " ", [](int number) { return std::to_string(number); });
  }
  /// Kind and state.
  std::string gripper() {
    const auto packet = newest<protocol::GripperPacket>();
    return format("%d %d", packet.kind, packet.state & 7);
  }
  std::string config() {
    const auto is = newest<protocol::ConfigPacket>();
    return is.robot_class + " " + is.subclass + " " +
           format("%d %d %d", is.velocity_max, is.rotation_velocity_max, is.acceleration) +
           (is.serial == "SIM" ? " SIM" : "");
  }
  /// How many, and the newest [m].
  std::string encoders() {
    const auto packets = all<protocol::EncoderPacket>();
    return std::to_string(packets.size()) +
           (packets.empty() ? ""
                            : format(" %.1f %.1f", packets.back().left * parameters_.encoder_unit,
                                     packets.back().right * parameters_.encoder_unit));
  }
  /// How many; outputs, inputs and analogs of the newest.
  std::string io() {
    const auto packets = all<protocol::IoPacket>();
    std::string text = std::to_string(packets.size());
    if (packets.empty())
      return text;
    for (const Bytes& bytes : {packets.back().digital_outputs, packets.back().digital_inputs})
      text += " " + joined(bytes, " ", [](std::uint8_t byte) { return std::to_string(byte); });
    return text + " " + joined(packets.back().analogs, " ", [](std::uint16_t value) {
             return std::to_string(value);
           });
  }
  std::string status() {
    const auto is = newest<protocol::SimStatusPacket>();
    return format("%d %d, off by %d", is.true_x, is.true_th, is.odometry_error_x);
  }
  /// How many pictures; of each channel of the newest its mode and x, its area and box, its line.
  std::string camera() {
    const auto packets = all<protocol::VisionPacket>();
    std::string text = std::to_string(packets.size());
    if (!packets.empty())
      for (const protocol::VisionChannel& channel : packets.back().channels)
        text += format(" | %d %d, %d of %d x %d, %d %d", static_cast<int>(channel.mode), channel.x,
                       channel.area, channel.width, channel.height, channel.first, channel.count);
    return text;
  }
  /// Of the trace since the last time: how many, the number of the last, its speed.
  std::string rows() {
    const std::vector<TraceRow> rows = server_->take_trace();
    return rows.empty() ? "0"
                        : format("%d %d%s %.2f", static_cast<int>(rows.size()),
                                 static_cast<int>(rows.back().cycle),
                                 rows.front().first ? " new" : "", rows.back().velocity);
  }

  World world_;
  protocol::RobotParameters parameters_;
  std::optional<Scene> scene_;
  std::optional<Server> server_;
  protocol::PacketParser parser_;
  std::vector<ServerPacket> packets_;
};

TEST(Server, AnswersItsClientsAsWritten) {
  EXPECT_EQ(saphira::test::play<Client>("sim/test/clients.txt"), 27);
}

}  // namespace
}  // namespace saphira::sim

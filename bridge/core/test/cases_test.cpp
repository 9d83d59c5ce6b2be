// The cases of cases.txt: the test is the shell, the robot and the drivers.
#include <gtest/gtest.h>

#include "arguments.hpp"
#include "lines.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/idl/members.hpp"
#include "scene.hpp"

namespace saphira::bridge::test {
namespace {

using authority::Role;

template <class E>
std::string named(E value) {
  return std::string(kEnumeratorNames<E>.at(static_cast<std::size_t>(value)));
}
template <class E>
E valued(const std::string& name) {
  const auto& names = kEnumeratorNames<E>;
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? throw std::invalid_argument("no " + name)
                              : kEnumerators<E>.at(static_cast<std::size_t>(found - names.begin()));
}

/// "name=value"; without "=" the value is empty.
std::pair<std::string, std::string> split(const std::string& word) {
  const std::size_t sign = std::min(word.find('='), word.size());
  return {word.substr(0, sign), word.substr(std::min(sign + 1, word.size()))};
}

std::string in_words(const Answer& answer) {
  return named(answer.code) + ", " + answer.text;
}

/// One case.
class Bridge : public saphira::test::LinePlayer {
 public:
  Bridge() {
    events_ = {
      ON("lockstep", begin({.lockstep = true, .free_step = !rest(in).empty()})),
      ON("anew", begin({})),
      ON("vision", begin({.vision = true})),
      ON("robot", each(in, &Bridge::set_robot)),
      ON("shows", each(in, &Bridge::show)),
      ON("around", around(in)),
      ON("parameters", s_->has_parameters = rest(in) == "yes"),
      ON("mute", s_->mute = true),
      ON("connect", s_->connect()),
      ON("driven", driven(rest(in))),
      ON("pass", s_->pass(read<double>(in))),
      ON("slowly", s_->pass_slowly(read<double>(in))),
      ON("cycle", s_->cycle()),
      ON("cycles", cycles(in)),
      ON("hears", s_->say(packet(read<std::string>(in), in))),
      ON("receives", s_->core.received(std::exchange(s_->to_bridge, {}), s_->now)),
      ON("drive", s_->tell(wish(in))),
      ON("late", late_ = wish(in)),
      ON("comes", s_->tell(late_)),
      ON("command", s_->core.command(wish(in), s_->now)),
      ON("answer", s_->answer()),
      ON("leave", s_->core.writer_lost(valued<Role>(rest(in)), {}, s_->now); s_->answer()),
      ON("reset",
         s_->core.request({.functor = "reset", .arguments = {}, .source = rest(in)}, s_->now);
         s_->deliver()),
      ON("restore", s_->core.restore({.estopped = true, .estop_source = rest(in)}); s_->deliver()),
      ON("request", request(in)),
      ON("karen-requests", request(in, Identity{"karen", "operator"})),
      ON("turns-servo", EXPECT_TRUE(s_->was_sent(protocol::Ptu{read<std::uint16_t>(in)}))),
      ON("permit", s_->core.permit(read<std::uint64_t>(in)); s_->answer()),
      ON("lose", s_->core.link_closed(rest(in), s_->now); s_->deliver()),
      ON("end", s_->core.end(s_->now); s_->deliver()),
      ON("forget", s_->forget()),
      ON("noted", EXPECT_GT(times_noted(rest(in)), 0) << notes()),
      ON("noted-once", EXPECT_EQ(times_noted(rest(in)), 1) << notes()),
      ON("not-noted", EXPECT_EQ(times_noted(rest(in)), 0) << notes())
    };
    facts_ = {IS("drives", named(s_->core.grant().role)),
              IS("age", format("%g", s_->core.grant().command_age)),
              IS("stopped by", stopped()),
              IS("granted", granted()),
              IS("guarded", guarded()),
              IS("refused", refused()),
              IS("session", yes(s_->core.in_session())),
              IS("stamp", stamp()),
              IS("link", std::string(s_->around.link_open ? "open" : "closed")),
              IS("protocol", named(s_->core.parameters().protocol)),
              IS("may connect in 1.8", yes(s_->core.may_connect(s_->now + 1.8))),
              IS("may connect in 2", yes(s_->core.may_connect(s_->now + 2.0))),
              IS("awaits", yes(s_->core.awaits_answer())),
              IS("due soon", yes(s_->core.due(s_->now) <= s_->now + 0.05)),
              IS("latched", yes(s_->core.latches().estopped)),
              IS("kept", joined(s_->all<KeepLatches>(), " ",
                                [](const auto& kept) { return yes(kept.latches.estopped); })),
              IS("sent", sent()),
              IS("commands", commands()),
              IS("speeds", speeds()),
              IS("steps", std::to_string(s_->times_sent(protocol::Step{}))),
              IS("keeper", keeper()),
              IS("outputs", outputs(s_->said)),
              IS("piece", s_->core.work(s_->now) ? outputs(s_->core.take()) : "none"),
              IS("other packets", std::to_string(s_->all<OtherPacket>().size())),
              IS("bad packets", std::to_string(newest<CycleBegan>().bad_packets)),
              IS("motors on", yes(information().motors_on.value_or(true))),
              IS("battery", format("%g", information().battery)),
              {"status",
               [this] {
                 const Condition is = s_->condition();
                 return name_of(is.health) + (is.reason.empty() ? "" : ", " + is.reason);
               }},
              IS("done steps", std::to_string(newest<StatusReport>().steps)),
              IS("late", std::to_string(newest<StatusReport>().late)),
              IS("refused in all", std::to_string(newest<StatusReport>().refused)),
              IS("notes", notes()),
              IS("warnings", notes(Note::Level::warning)),
              IS("stop", stop({})),
              IS("stop by karen", stop({{"by", std::string("karen")}})),
              IS("ends", joined(s_->all<LaterAnswer>(), " | ",
                                [](const LaterAnswer& later) { return in_words(later.answer); })),
              IS("answered", answer_ ? in_words(*answer_) : "later"),
              IS("later", joined(s_->all<LaterAnswer>(), " | ",
                                 [](const LaterAnswer& later) {
                                   return std::to_string(later.number) +
                                          (later.device ? " device " : " ") +
                                          in_words(later.answer);
                                 })),
              IS("devices", std::to_string(s_->all<DevicesChanged>().size())),
              IS("device asked by", newest<DevicesChanged>().requests.at(0).source),
              IS("devices at", std::to_string(newest<DevicesChanged>().stamp.cycle)),
              IS("unread", std::to_string(newest<DevicesChanged>().reports.unread.at(0x9A))),
              IS("vision set", newest<VisionSet>().text),
              IS("audited", audited())};
  }

 private:
  void begin(const CoreSettings& settings) { s_ = std::make_unique<Scene>(settings); }
  void driven(const std::string& role) {
    s_->connect();
    s_->cycles(12, role.empty() ? Role::behaviors : valued<Role>(role));
    s_->forget();
  }
  void each(std::istringstream& in,
            void (Bridge::*use)(const std::string& name, const std::string& value)) {
    for (std::string word; in >> word;) {
      const auto [name, value] = split(word);
      (this->*use)(name, value);
    }
  }
  void set_robot(const std::string& name, const std::string& value) {
    protocol::RobotParameters& robot = s_->robot;
    if (name == "protocol")
      robot.protocol = valued<protocol::Protocol>(value);
    else if (name == "file")
      robot.file = value;
    else if (name == "assumed")
      robot.protocol_is_assumed = true;
    else if (name == "deceleration")
      robot.deceleration = std::stod(value);
    else if (name == "stop_deceleration")
      robot.stop_deceleration = std::stod(value);
    else
      throw std::invalid_argument("not understood: " + name);
  }
  /// In the next packets. The speed is in mm/s; a sonar's range in m.
  void show(const std::string& name, const std::string& value) {
    protocol::InformationPacket& shown = s_->shown;
    if (name == "x") {
      shown.x = static_cast<std::uint16_t>(std::stoul(value));
    } else if (name == "speed") {
      shown.left_velocity = shown.right_velocity = static_cast<std::int16_t>(std::stoi(value));
    } else if (name == "motors") {
      shown.motors = valued<protocol::Motors>(value);
    } else if (name == "flags") {
      shown.ptu = static_cast<std::uint16_t>(std::stoul(value));
    } else if (name == "battery") {
      shown.trailing.battery = static_cast<std::uint16_t>(std::stoul(value));
    } else if (name == "charge") {  // its packets end behind it, without a gap
      shown.trailing.charge_state = shown.trailing.charge_state.value_or(0);
      shown.trailing.rotation = shown.trailing.lateral = 0;
      shown.trailing.faults = 0;
      shown.trailing.temperature = 20;
      shown.trailing.state_of_charge = static_cast<std::uint8_t>(std::stoul(value));
    } else if (name == "charges") {
      shown.trailing.charge_state = 1;
    } else if (name == "sonar") {
      shown.sonars.clear();
      if (const std::size_t at = value.find('@'); at != std::string::npos)
        shown.sonars = {
            {static_cast<std::uint8_t>(std::stoul(value)),
             static_cast<std::uint16_t>(std::stod(value.substr(at + 1)) / s_->robot.range_unit)}};
    } else {
      throw std::invalid_argument("not understood: " + name);
    }
  }
  void around(std::istringstream& in) {
    Surroundings& around = s_->around;
    const auto what = read<std::string>(in);
    if (what == "serial")
      around.serial = true;
    else if (what == "namesake")
      around.namesake = rest(in);
    else if (what == "trouble")
      around.link_trouble = rest(in);
    else if (what == "address")
      around.address = rest(in);
    else if (what == "keeper")
      around.has_keeper = true;
    else if (what == "new-keeper")
      ++around.keeper_restarts;
    else
      throw std::invalid_argument("not understood: " + what);
    if (around.has_keeper)
      around.keeper_alive = rest(in) == "alive";
  }
  /// "request NUMBER FUNCTOR arguments"; the number 0 is of an asker that does not count.
  void request(std::istringstream& in, const Checked& person = {}) {
    Request asked;
    asked.person = person;
    asked.source = "a person";
    asked.number = read<std::uint64_t>(in);
    asked.functor = read<std::string>(in);
    asked.arguments = saphira::test::arguments_of(rest(in));
    answer_ = s_->core.request(asked, s_->now);
    s_->answer();
  }
  /// "cycles COUNT ROLE [SPEED]".
  void cycles(std::istringstream& in) {
    const int count = read<int>(in);
    const Role role = valued<Role>(read<std::string>(in));
    double speed = 0.1;
    in >> speed;
    s_->cycles(count, role, speed);
  }
  protocol::Bytes packet(const std::string& what, std::istringstream& in) const {
    protocol::Bytes bytes = protocol::encode(s_->shown);
    if (what == "config") {
      protocol::ConfigPacket set{.deceleration = read<std::uint16_t>(in)};
      return protocol::encode(set);
    }
    if (what == "impossible") {  // a speed that the robot does not have
      protocol::InformationPacket fast;
      fast.motors = protocol::Motors::kMoving;
      fast.left_velocity = fast.right_velocity = 30000;
      return protocol::encode(fast);
    }
    if (what == "simulator")
      return protocol::encode(protocol::SimStatusPacket{});
    if (what == "unread")
      return protocol::frame(protocol::Bytes{0x9A, 0});
    if (what == "serial") {
      protocol::ConfigPacket set{.serial = "P3", .cycle = 50};
      return protocol::encode(set);
    }
    if (what == "reset")
      return protocol::frame(protocol::Bytes{0xFE});
    if (what == "half")
      return {protocol::kHeader0, protocol::kHeader1, 150};
    if (what == "damaged")
      bytes.back() ^= 0x55U;
    else if (what != "packet")
      throw std::invalid_argument("not understood: " + what);
    return bytes;
  }
  /// "ROLE SPEED [released] [blind] [turning] [writer=5] [cycle=-7] ...": it turns as fast.
  DriveCommand wish(std::istringstream& in) {
    const Role role = valued<Role>(read<std::string>(in));
    DriveCommand made = s_->wish(role, std::stod(read<std::string>(in)));
    for (std::string word; in >> word;) {
      const auto [name, value] = split(word);
      if (name == "released")
        made.command.active = false;
      else if (name == "blind")
        made.command.epoch = made.command.cycle = 0;
      else if (name == "turning")
        made.motion.translation = reflector::Translation::none;
      else if (name == "writer")
        made.command.writer[0] = static_cast<std::uint8_t>(std::stoul(value));
      else if (name == "cycle")
        made.command.cycle += static_cast<std::uint64_t>(std::stoll(value));
      else if (name == "epoch")
        made.command.epoch = std::stoull(value);
      else if (name == "number")
        made.command.number = std::stoull(value);
      else if (name == "contact")
        made.contact_speed = std::stod(value);
      else if (name == "wrong")
        made.wrong = "unknown translation mode";
      else
        throw std::invalid_argument("not understood: " + name);
    }
    return made;
  }

  template <class What>
  What newest() const {
    const std::vector<What> all = s_->all<What>();
    return all.empty() ? What{} : all.back();
  }
  reflector::State state() const { return newest<CycleBegan>().state; }
  protocol::Information information() const { return state().information; }
  int times_noted(const std::string& part) const {
    const std::vector<Note> notes = s_->all<Note>();
    return static_cast<int>(std::ranges::count_if(
        notes, [&](const Note& note) { return note.text.find(part) != std::string::npos; }));
  }
  std::string notes(Note::Level least = Note::Level::info) const {
    std::vector<Note> notes = s_->all<Note>();
    std::erase_if(notes, [&](const Note& note) { return note.level < least; });
    return joined(notes, " | ", &Note::text);
  }
  std::string stamp() const {
    return format("%d.%d", static_cast<int>(s_->core.stamp().epoch),
                  static_cast<int>(s_->core.stamp().cycle));
  }
  std::string granted() const {
    return s_->has<GrantDecided>() ? named(newest<GrantDecided>().grant.role) : "nothing";
  }
  std::string stopped() const {
    const authority::Grant& grant = s_->core.grant();
    return grant.stop_source + format(", %d:%d", static_cast<int>(grant.stop.asker),
                                      static_cast<int>(grant.stop.number));
  }
  std::string guarded() const {
    const authority::Guarded is = newest<GrantDecided>().guarded;
    return named(is.action) + format(" %.3f, ", is.velocity) + is.reason;
  }
  std::string refused() const {
    std::vector<std::string> reasons;
    for (const GrantDecided& grant : s_->all<GrantDecided>())
      for (const authority::Refusal& refusal : grant.refused)
        reasons.push_back(refusal.reason);
    return joined(reasons, " | ");
  }
  std::string sent() const {
    std::vector<std::string> what;
    if (s_->was_stopped())
      what.emplace_back("zeros");
    if (s_->was_moved())
      what.emplace_back("motion");
    if (s_->was_sent(protocol::EmergencyStop{}))
      what.emplace_back("emergency stop");
    for (int closes = s_->times_sent(protocol::Close{}); closes > 0; --closes)
      what.emplace_back("close");
    return joined(what);
  }
  static std::string name(const protocol::Command& command) {
    return std::string(protocol::rule(protocol::encode(command)[3])->name);
  }
  std::string commands() const { return joined(s_->sent, " ", name); }
  std::string keeper() const {
    const std::vector<WatchLink> watched = s_->all<WatchLink>();
    if (watched.size() != 1)
      return std::to_string(watched.size());
    s_->forget();
    s_->hear(watched[0].stop);
    EXPECT_TRUE(s_->was_stopped());
    return commands();
  }
  std::string speeds() const {
    std::vector<double> all;
    for (const protocol::Command& command : s_->sent)
      if (const auto* const velocity = std::get_if<protocol::Velocity>(&command))
        all.push_back(velocity->value);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return joined(all, " ", [](double speed) { return format("%g", speed); });
  }
  static std::string outputs(const std::vector<Output>& outputs) {
    constexpr std::array<const char*, std::variant_size_v<Output>> names{
        "send",    "answered", "identified", "session", "cycle", "other",
        "later",   "devices",  "vision",     "grant",   "watch", "close",
        "latches", "odometry", "status",     "note",    "audit"};
    return joined(outputs, " ", [&](const Output& output) { return names.at(output.index()); });
  }
  std::string stop(const Arguments& arguments) {
    const auto answer = s_->core.request({.functor = "stop",
                                          .arguments = arguments,
                                          .source = "a person",
                                          .asker = 7,
                                          .number = ++asked_},
                                         s_->now);
    s_->deliver();
    return in_words(answer.value());
  }
  std::string audited() const {
    return joined(s_->all<v1::AuditEntry>(), " | ", [](const v1::AuditEntry& entry) {
      return name_of(entry.act) + (" " + entry.who);
    });
  }

  std::unique_ptr<Scene> s_ = std::make_unique<Scene>();
  DriveCommand late_;
  std::uint64_t asked_ = 0;
  std::optional<Answer> answer_;  ///< to the newest request
};

TEST(Bridge, IsAsWritten) {
  EXPECT_EQ(saphira::test::play<Bridge>("bridge/core/test/cases.txt"), 85);
}

}  // namespace
}  // namespace saphira::bridge::test

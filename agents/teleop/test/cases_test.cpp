// The cases of pages.txt, keys.txt, sticks.txt and pilot.txt: the test is the operators' pages, the
// keyboard, the joystick, and the bridge.
#include <gtest/gtest.h>
#include <linux/joystick.h>

#include <cmath>
#include <cstring>

#include "lines.hpp"
#include "pages.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/teleop/control.hpp"
#include "saphira/teleop/key_drive.hpp"
#include "saphira/teleop/pilot.hpp"
#include "saphira/teleop/stick_drive.hpp"

namespace saphira::teleop {
namespace {

/// Two operators, of whom one at a time drives.
class Pages : public saphira::test::LinePlayer {
 public:
  Pages() {
    control_.join(1, "ann");
    control_.join(2, "bob");
    events_ = {
      ON("pass", now_ += read<double>(in)),
      ON("clock", ahead_ += read<double>(in)),
      ON("ann", page(1, in)),
      ON("bob", page(2, in)),
      ON("holds", samples(true, read<double>(in))),
      ON("lets-go", samples(false, read<double>(in))),
      ON("waits", waiting_.push_back(sample(read<std::string>(in), in))),
      ON("arrives", refused_ = control_.drive(1, waiting_.front(), now_);
         waiting_.erase(waiting_.begin())),
      ON("sample", refused_ = control_.drive(1, sample(read<std::string>(in), in), now_))
    };
    facts_ = {IS("moves", yes(control_.order(now_).active)),
              IS("moved", format("%g", moved_)),
              IS("order", order()),
              IS("refused", refused_),
              IS("holder", control_.state().name),
              IS("let go", control_.state().let_go),
              IS("note", control_.state().note),
              IS("asked", joined(control_.state().asked, " ", &Control::Operator::name))};
  }

 private:
  /// "held", "again" (the number of the one before), "free", or "v=nan" or "r=inf" for its
  /// velocity or rotation; and how late it is [s].
  Control::Sample sample(const std::string& what, std::istringstream& in) {
    double late = 0.0;
    in >> late;
    if (what == "again")
      --number_;
    const bool held = what != "free";
    Control::Sample made{++number_, now_ + ahead_ - late, held, held ? 0.2 : 0.0, 0.0, 100};
    if (what.starts_with("v="))
      made.velocity = std::stod(what.substr(2));
    if (what.starts_with("r="))
      made.rotation = std::stod(what.substr(2));
    return made;
  }
  /// Samples 20 times a second, each without delay.
  void samples(bool held, double duration) {
    for (const double end = now_ + duration; now_ < end; now_ += 0.05) {
      std::istringstream none;
      refused_ = control_.drive(1, sample(held ? "held" : "free", none), now_);
      control_.order(now_);
    }
  }
  void page(Control::OperatorId id, std::istringstream& in) {
    const auto what = read<std::string>(in);
    if (what == "takes")
      refused_ = control_.take(id, false, now_);
    else if (what == "takes-by-force")
      refused_ = control_.take(id, true, now_);
    else if (what == "asks")
      refused_ = control_.ask(id);
    else if (what == "gives-to-bob")
      refused_ = control_.give(id, 2, now_);
    else if (what == "releases")
      control_.release(id);
    else if (what == "leaves")
      control_.leave(id);
    else if (what == "is-silent")
      silence(read<double>(in));
    else
      refused_ = control_.drive(id, sample(what, in), now_);
  }
  void silence(double duration) {
    const double begin = now_;
    moved_ = 0.0;
    for (const double end = now_ + duration; now_ < end; now_ += 0.01)
      if (control_.order(now_).active)
        moved_ = std::round(100.0 * (now_ - begin)) / 100.0;
  }
  std::string order() {
    const Order order = control_.order(now_);
    return format("%s %g %d", order.source.c_str(), order.velocity, static_cast<int>(order.cycle));
  }

  Control control_;
  double now_ = 1000.0;
  double ahead_ = -777.0;  // [s] the operator's clock
  std::uint64_t number_ = 0;
  std::string refused_;
  double moved_ = 0.0;  // [s] of the newest silence, from its beginning
  std::vector<Control::Sample> waiting_;
};

/// Keys of a terminal; times are seconds from the start.
class Keyboard : public saphira::test::LinePlayer {
 public:
  Keyboard() {
    events_ = {ON("limit", drive_.set_max_velocity(read<double>(in))),
               ON("pass", now_ += read<double>(in)), ON("at", now_ = read<double>(in)),
               ON("release", drive_.release()),
               ON("type", input_ += saphira::test::replaced(
                              saphira::test::replaced(rest(in), "ESC", "\x1b"), "CTRL-C", "\x03"))};
    for (std::size_t i = 0; i < kEnumerators<DriveKey>.size(); ++i)
      events_[std::string(kEnumeratorNames<DriveKey>.at(i))] = [this, i](auto&) {
        drive_.press(kEnumerators<DriveKey>.at(i), now_);
      };
    facts_ = {
        {"drives",
         [this] {
           const Order order = drive_.order(now_);
           return order.active ? format("%.3g", order.velocity) : "no";
         }},
        IS("active", yes(drive_.order(now_).active)),
        IS("turn", format("%g, move %d", drive_.order(now_).turn->by,
                          static_cast<int>(drive_.order(now_).turn->move))),
        IS("keys", joined(take_keys(input_), " ",
                          [](DriveKey key) {
                            return kEnumeratorNames<DriveKey>.at(static_cast<std::size_t>(key));
                          })),
        IS("left", std::to_string(input_.size()))};
  }

 private:
  KeyDrive drive_;
  double now_ = 0.0;
  std::string input_;
};

std::string event(unsigned type, unsigned number, int value) {
  js_event made{};
  made.type = static_cast<std::uint8_t>(type);
  made.number = static_cast<std::uint8_t>(number);
  made.value = static_cast<std::int16_t>(value);
  std::string bytes(sizeof made, '\0');
  std::memcpy(bytes.data(), &made, sizeof made);
  return bytes;
}

/// A gamepad whose shoulder buttons are 4 to 7; axis 0 is X, axis 1 is Y.
class Stick : public saphira::test::LinePlayer {
 public:
  Stick() {
    set_gamepad();
    const auto take = [this](unsigned type, unsigned number, int value) {
      stick_.take(event(type, number, value), now_);
    };
    events_ = {
        ON("at", now_ = read<double>(in)),
        ON("limit", stick_.set_max_velocity(read<double>(in))),
        {"down", [take](auto& in) { take(JS_EVENT_BUTTON, read<unsigned>(in), 1); }},
        {"up", [take](auto& in) { take(JS_EVENT_BUTTON, read<unsigned>(in), 0); }},
        {"is-down",
         [take](auto& in) { take(JS_EVENT_BUTTON | JS_EVENT_INIT, read<unsigned>(in), 1); }},
        {"x", [take](auto& in) { take(JS_EVENT_AXIS, 0, read<int>(in)); }},
        {"y", [take](auto& in) { take(JS_EVENT_AXIS, 1, read<int>(in)); }},
        {"is-y", [take](auto& in) { take(JS_EVENT_AXIS | JS_EVENT_INIT, 1, read<int>(in)); }},
        ON("new", stick_ = {}),
        ON("gamepad", set_gamepad()),
        ON("nameless", stick_.set_layout({}, {})),
        ON("lost", stick_.lost()),
        ON("let-go", stick_.let_go())};
    facts_ = {{"drives",
               [this] {
                 const Order order = stick_.order(now_);
                 // + 0.0: no "-0"
                 return order.active
                            ? format("%.3g %.3g", order.velocity + 0.0, order.rotation + 0.0)
                            : "no";
               }},
              IS("silent", yes(stick_.is_silent(now_))),
              IS("dead man", stick_.dead_man())};
  }

 private:
  void set_gamepad() {
    stick_.set_layout({ABS_X, ABS_Y}, {BTN_SOUTH, BTN_EAST, BTN_NORTH, BTN_WEST, BTN_TL, BTN_TR,
                                       BTN_TL2, BTN_TR2, BTN_SELECT});
  }
  StickDrive stick_;
  double now_ = 1.0;
};

/// The orders of ann, the grants of the bridge, and the commands from both.
class Piloted : public saphira::test::LinePlayer {
 public:
  Piloted() {
    events_ = {
      ON("holds", order_ = {true, read<double>(in), 0, {}, 90, "ann"}),
      ON("frees", order_ = {}),
      ON("rotates", order_.rotation = read<double>(in)),
      ON("turns", const auto by = read<double>(in); order_.turn = {by, read<std::uint64_t>(in)}),
      ON("drive", command_ = pilot_.drive(order_, {.epoch = 7, .cycle = read<std::uint64_t>(in)})),
      ON("hand-back", pilot_.hand_back()),
      ON("press", pilot_.press("ann")),
      ON("latched", command_ = pilot_.stop(rest(in) == "yes")),
      ON("at", now_ = read<double>(in)),
      {"refused",
       [this](auto& in) {
         v1::Grant grant;
         const auto source = read<std::string>(in);
         grant.refused = {{.role = v1::ROLE_TELEOP, .source = source, .reason = rest(in)}};
         pilot_.heard(grant, now_);
       }}
    };
    facts_ = {IS("command", command()), IS("number", std::to_string(command_->number)),
              IS("motion", motion()), IS("refusal", pilot_.refusal(now_))};
  }

 private:
  std::string command() const {
    if (!command_)
      return "none";
    return (command_->active ? "active" : "free") + (" of " + command_->source) +
           format(", cycle %d.%d", static_cast<int>(command_->stamp.epoch),
                  static_cast<int>(command_->stamp.cycle)) +
           (command_->hand_back ? ", handed back" : "");
  }
  std::string motion() const {
    return std::string(name_of(command_->translation)) + format(" %g, ", command_->velocity) +
           name_of(command_->rotation) +
           format(" %g %g %d", command_->rotation_velocity, command_->heading,
                  static_cast<int>(command_->move));
  }
  template <class E>
  static std::string name_of(E value) {
    return std::string(kEnumeratorNames<E>.at(static_cast<std::size_t>(value)));
  }

  Pilot pilot_{"console"};
  Order order_;
  std::optional<v1::MotorCommand> command_;
  double now_ = 0.0;
};

TEST(Teleop, IsAsWritten) {
  EXPECT_EQ(saphira::test::play<Pages>("agents/teleop/test/pages.txt"), 15);
  EXPECT_EQ(saphira::test::play<Keyboard>("agents/teleop/test/keys.txt"), 15);
  EXPECT_EQ(saphira::test::play<Stick>("agents/teleop/test/sticks.txt"), 7);
  EXPECT_EQ(saphira::test::play<Piloted>("agents/teleop/test/pilot.txt"), 6);
}

std::string button(unsigned number, bool down) {
  return event(JS_EVENT_BUTTON, number, down);
}
std::string axis(unsigned number, int value) {
  return event(JS_EVENT_AXIS, number, value);
}

struct Device {
  const char* name;
  std::vector<std::uint8_t> axes;
  std::vector<std::uint16_t> buttons;
  std::set<unsigned> hold;  ///< numbers of the buttons
  const char* dead_man;
};

TEST(StickDrive, TheButtonToHoldIsFoundByTheKernelsNames) {
  const std::vector<Device> devices{
      {"gamepad with analog triggers",
       {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ},
       {BTN_SOUTH, BTN_EAST, BTN_NORTH, BTN_WEST, BTN_TL, BTN_TR, BTN_SELECT, BTN_START, BTN_MODE},
       {4, 5},
       "a shoulder button (4 or 5)"},
      {"gamepad with four shoulder buttons, and axes the other way round",
       {ABS_Y, ABS_X},
       {BTN_SOUTH, BTN_C, BTN_EAST, BTN_NORTH, BTN_WEST, BTN_Z, BTN_TL, BTN_TR, BTN_TL2, BTN_TR2},
       {6, 7, 8, 9},
       "a shoulder button (6 or 7 or 8 or 9)"},
      {"joystick",
       {ABS_X, ABS_Y, ABS_RZ, ABS_THROTTLE},
       {BTN_TRIGGER, BTN_THUMB, BTN_THUMB2, BTN_TOP, BTN_TOP2, BTN_PINKIE, BTN_BASE},
       {0},
       "the trigger (0)"},
      {"joystick whose sixteenth button has the name of a dead-man by its number alone",
       {ABS_X, ABS_Y},
       {BTN_THUMB, BTN_TRIGGER, BTN_DEAD},
       {1},
       "the trigger (1)"},
      {"a box with a dead-man", {ABS_X, ABS_Y}, {BTN_0, BTN_DEAD}, {1}, "the dead-man button (1)"},
      {"buttons without names", {ABS_X, ABS_Y}, {BTN_0, BTN_1, BTN_2}, {}, ""},
      {"face buttons alone", {ABS_X, ABS_Y}, {BTN_SOUTH, BTN_EAST, BTN_NORTH, BTN_WEST}, {}, ""},
      {"no first stick", {ABS_Z, ABS_RZ}, {BTN_TL, BTN_TR}, {}, ""},
      {"half a stick", {ABS_X, ABS_HAT0Y}, {BTN_TRIGGER}, {}, ""},
  };
  for (const Device& device : devices) {
    const auto number_of = [&](std::uint8_t code) {
      const auto found = std::ranges::find(device.axes, code);
      return static_cast<unsigned>(found - device.axes.begin());
    };
    for (unsigned i = 0; i < device.buttons.size(); ++i) {
      StickDrive stick;
      stick.set_layout(device.axes, device.buttons);
      EXPECT_EQ(stick.dead_man(), device.dead_man) << device.name;
      stick.take(axis(number_of(ABS_Y), -32767) + axis(number_of(ABS_X), 16384), 1.0);
      stick.take(button(i, true), 1.0);
      const Order setpoint = stick.order(1.0);
      EXPECT_EQ(setpoint.active, device.hold.contains(i)) << device.name << ", button " << i;
      if (!setpoint.active)
        continue;
      EXPECT_GT(setpoint.velocity, 0.3) << device.name;
      EXPECT_LT(setpoint.rotation, 0.0) << device.name;
    }
  }
}

TEST(StickDrive, EventsMayComeInPieces) {
  StickDrive stick;
  stick.set_layout({ABS_X, ABS_Y}, {BTN_TL});
  const std::string bytes = button(0, true) + axis(1, -32767);
  for (const char byte : bytes) {
    EXPECT_LT(stick.order(1.0).velocity, 0.1);
    stick.take(std::string(1, byte), 1.0);
  }
  EXPECT_NEAR(stick.order(1.0).velocity, 0.4, 1e-9);
}

}  // namespace
}  // namespace saphira::teleop

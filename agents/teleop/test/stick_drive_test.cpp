#include "saphira/teleop/stick_drive.hpp"

#include <gtest/gtest.h>
#include <linux/joystick.h>

#include <algorithm>
#include <cstring>

namespace saphira::teleop {
namespace {

std::string event(unsigned type, unsigned number, int value) {
  js_event made{};
  made.type = static_cast<std::uint8_t>(type);
  made.number = static_cast<std::uint8_t>(number);
  made.value = static_cast<std::int16_t>(value);
  std::string bytes(sizeof made, '\0');
  std::memcpy(bytes.data(), &made, sizeof made);
  return bytes;
}
std::string button(unsigned number, bool down) {
  return event(JS_EVENT_BUTTON, number, down);
}
std::string axis(unsigned number, int value) {
  return event(JS_EVENT_AXIS, number, value);
}

/// A gamepad whose shoulder buttons are 4 to 7.
StickDrive gamepad() {
  StickDrive stick;
  stick.set_layout({ABS_X, ABS_Y}, {BTN_SOUTH, BTN_EAST, BTN_NORTH, BTN_WEST, BTN_TL, BTN_TR,
                                    BTN_TL2, BTN_TR2, BTN_SELECT});
  return stick;
}

TEST(StickDrive, DrivesWhileAShoulderButtonIsHeld) {
  StickDrive stick = gamepad();
  stick.set_max_velocity(0.8);
  stick.take(axis(1, -32767) + axis(0, -32767), 1.0);
  EXPECT_FALSE(stick.order(1.0).active) << "the stick alone does not drive";
  stick.take(button(5, true), 1.1);
  EXPECT_TRUE(stick.order(1.1).active);
  EXPECT_NEAR(stick.order(1.1).velocity, 0.8, 1e-9) << "pushed is ahead";
  EXPECT_NEAR(stick.order(1.1).rotation, 1.0, 1e-9) << "left is left";
  stick.take(axis(1, 16384) + axis(0, 0), 1.2);
  EXPECT_LT(stick.order(1.2).velocity, 0.0);
  EXPECT_GT(stick.order(1.2).velocity, -0.4) << "fine near the middle";
  stick.take(axis(1, 2000), 1.3);
  EXPECT_EQ(stick.order(1.3).velocity, 0.0) << "within the dead zone";
  EXPECT_TRUE(stick.order(1.3).active) << "held, and standing";
  stick.take(button(5, false), 1.4);
  EXPECT_FALSE(stick.order(1.4).active);
}

TEST(StickDrive, OtherButtonsDoNotDrive) {
  StickDrive stick = gamepad();
  for (const unsigned number : {0U, 3U, 8U, 11U, 200U})
    stick.take(button(number, true), 1.0);
  EXPECT_FALSE(stick.order(1.0).active);
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
      const auto found = std::find(device.axes.begin(), device.axes.end(), code);
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

TEST(StickDrive, ADeviceThatHasNotToldItsButtonsDoesNotDrive) {
  StickDrive stick;
  for (unsigned i = 0; i < 16; ++i)
    stick.take(button(i, true), 1.0);
  EXPECT_FALSE(stick.order(1.0).active);
  EXPECT_EQ(stick.dead_man(), "");
  stick = gamepad();
  stick.take(button(4, true), 1.0);
  stick.set_layout({}, {});  // another device, which tells nothing
  stick.take(button(4, true), 1.1);
  EXPECT_FALSE(stick.order(1.1).active);
  EXPECT_EQ(stick.dead_man(), "");
}

TEST(StickDrive, AButtonThatIsHeldAtTheStartHasToBePressedAgain) {
  StickDrive stick = gamepad();
  stick.take(event(JS_EVENT_BUTTON | JS_EVENT_INIT, 4, 1), 1.0);
  stick.take(event(JS_EVENT_AXIS | JS_EVENT_INIT, 1, -32767), 1.0);
  EXPECT_FALSE(stick.order(1.0).active);
  stick.take(button(4, false) + button(4, true), 1.5);
  EXPECT_GT(stick.order(1.5).velocity, 0.3);
}

TEST(StickDrive, OneThatSaysNothingMayBeOutOfReach) {
  StickDrive stick = gamepad();
  stick.take(button(4, true) + axis(1, -30000), 1.0);
  EXPECT_TRUE(stick.order(5.9).active);
  EXPECT_FALSE(stick.order(6.1).active);
  EXPECT_TRUE(stick.is_silent(6.1));
  stick.take(axis(1, -29000), 7.0);
  EXPECT_TRUE(stick.order(7.0).active);
}

TEST(StickDrive, AfterAStopTheButtonHasToBePressedAgain) {
  StickDrive stick = gamepad();
  stick.take(button(4, true) + axis(1, -32767), 1.0);
  stick.let_go();
  EXPECT_FALSE(stick.order(1.0).active);
  stick.take(axis(1, -32000), 1.1);
  EXPECT_FALSE(stick.order(1.1).active);
  stick.take(button(4, false) + button(4, true), 1.2);
  EXPECT_GT(stick.order(1.2).velocity, 0.3) << "where the stick is, is known";
}

TEST(StickDrive, ADeviceThatIsGoneHoldsNothing) {
  StickDrive stick = gamepad();
  stick.take(button(4, true) + axis(1, -30000), 1.0);
  stick.lost();
  EXPECT_FALSE(stick.order(1.0).active);
}

TEST(StickDrive, EventsMayComeInPieces) {
  StickDrive stick = gamepad();
  const std::string bytes = button(6, true) + axis(1, -32767);
  for (const char byte : bytes) {
    EXPECT_LT(stick.order(1.0).velocity, 0.1);
    stick.take(std::string(1, byte), 1.0);
  }
  EXPECT_NEAR(stick.order(1.0).velocity, 0.4, 1e-9);
}

}  // namespace
}  // namespace saphira::teleop

#include "saphira/cli/device_words.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace saphira::cli {
namespace {

template <class T>
T parsed(const std::vector<std::string>& words) {
  return std::get<T>(parse_device(words));
}

TEST(DeviceWords, AreCommands) {
  EXPECT_EQ(parsed<v1::ServoCommand>({"servo", "1500"}).width(), 1500);
  EXPECT_EQ(parsed<v1::GripperCommand>({"gripper", "down"}).action(), v1::GRIPPER_LIFT_DOWN);
  EXPECT_EQ(parsed<v1::GripperCommand>({"gripper", "carry", "50"}).value(), 50);
  const auto number = parsed<v1::GripperCommand>({"gripper", "5"});
  EXPECT_EQ(number.action(), v1::GRIPPER_NUMBER);
  EXPECT_EQ(number.value(), 5);
  const auto output = parsed<v1::DigitalOutputCommand>({"output", "0x5A"});
  EXPECT_EQ(output.bits(), 0x5A);
  EXPECT_EQ(output.mask(), 0xFF);
  EXPECT_EQ(parsed<v1::DigitalOutputCommand>({"output", "1", "0x01"}).mask(), 1);
  EXPECT_EQ(parsed<v1::AnalogCommand>({"analog", "3"}).port(), 3);
  EXPECT_EQ(parsed<v1::TimerCommand>({"timer", "7"}).pin(), 7);
  const auto sonar = parsed<v1::SonarCommand>({"sonar", "on", "3", "2", "3"});
  EXPECT_TRUE(sonar.on());
  EXPECT_EQ(sonar.polling(), (std::vector<std::uint8_t>{3, 2, 3}));
  EXPECT_FALSE(parsed<v1::SonarCommand>({"sonar", "off"}).on());
  EXPECT_EQ(parsed<v1::SoundCommand>({"sound", "4"}).stored(), 4);
  const auto tones = parsed<v1::SoundCommand>({"sound", "0.5:60", "0.1:0"});
  ASSERT_EQ(tones.tones().size(), 2U);
  EXPECT_EQ(tones.tones()[0].duration(), 0.5);
  EXPECT_EQ(tones.tones()[0].pitch(), 60);
  EXPECT_EQ(parsed<v1::ServerCommand>({"motors", "on"}).value(), 1);
  EXPECT_EQ(parsed<v1::ServerCommand>({"origin"}).action(), v1::SERVER_SET_ORIGIN);
  EXPECT_EQ(parsed<v1::ServerCommand>({"bumpers", "3"}).value(), 3);
  EXPECT_EQ(parsed<v1::ServerCommand>({"report", "io"}).value(), static_cast<int>(v1::REPORT_ONCE));
  EXPECT_EQ(parsed<v1::ServerCommand>({"report", "encoders", "always"}).value(),
            static_cast<int>(v1::REPORT_ALWAYS));
  const auto serial = parsed<v1::SerialCommand>({"serial", "2", "0x8130", "hi", "--answer", "9"});
  EXPECT_EQ(serial.port(), 2);
  EXPECT_EQ(serial.data(), (std::vector<std::uint8_t>{0x81, 0x30, 'h', 'i'}));
  EXPECT_EQ(serial.answer(), 9);
}

TEST(DeviceWords, SayWhatWasExpected) {
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"wheels"},
      {"servo"},
      {"servo", "fast"},
      {"servo", "70000"},
      {"servo", "1500", "1600"},
      {"gripper"},
      {"gripper", "wave"},
      {"gripper", "carry"},
      {"output", "256"},
      {"output", "1", "2", "3"},
      {"timer", "8"},
      {"timer", "-1"},
      {"sonar", "loud"},
      {"sonar", "off", "3"},
      {"sonar", "on", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13"},
      {"sound", "0:60"},
      {"sound", "6:60"},
      {"sound", "0.5:x"},
      {"sound", "0.5:60", "60"},
      {"motors"},
      {"motors", "1"},
      {"report", "weather"},
      {"report", "io", "often"},
      {"serial", "4", "x"},
      {"serial", "1"},
      {"serial", "1", "0x123"},
      {"origin", "now"}};
  for (const auto& words : wrong) {
    std::string all;
    for (const std::string& word : words)
      all += word + " ";
    try {
      parse_device(words);
      ADD_FAILURE() << all;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("expected "), std::string::npos) << all;
    }
  }
}

TEST(DeviceWords, RowsShowWhatTheRobotHas) {
  v1::RobotState robot;
  robot.battery(12.34);
  robot.digital_output(5);
  const auto find = [](const std::vector<std::vector<std::string>>& rows, const std::string& name) {
    for (const auto& row : rows)
      if (row[0] == name)
        return row[1];
    return std::string();
  };
  auto rows = device_rows(robot, {});
  EXPECT_EQ(find(rows, "battery"), "12.3 V");
  EXPECT_EQ(find(rows, "digital output"), "0b00000101");
  EXPECT_EQ(find(rows, "encoders"), "");
  v1::Devices devices;
  devices.has_flags(true);
  devices.emergency_stop(true);
  devices.has_encoders(true);
  devices.left_encoder(-3);
  devices.has_charge(true);
  devices.charge(0.5);
  devices.has_gripper(true);
  devices.gripper_state(0x12);
  devices.requests(std::vector<v1::DeviceRequest>(1));
  devices.requests()[0].text("servo 1500 us");
  devices.requests()[0].state(v1::REQUEST_REFUSED);
  devices.requests()[0].reason("why not");
  rows = device_rows(robot, devices);
  EXPECT_EQ(find(rows, "battery"), "12.3 V, 50 % charged");
  EXPECT_EQ(find(rows, "motors"), "off, EMERGENCY STOP PRESSED");
  EXPECT_EQ(find(rows, "encoders"), "-3 0 ticks");
  EXPECT_EQ(find(rows, "gripper"), "0b00010010 (closed, lift up)");
  EXPECT_EQ(find(rows, "request"), "servo 1500 us: refused; why not ()");
}

}  // namespace
}  // namespace saphira::cli

#include "saphira/cli/device_words.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "trouble.hpp"

namespace saphira::cli {
namespace {

/// The topic and the request: "device/servo: servo width=1500".
std::string parsed(const std::vector<std::string>& words) {
  const DeviceCommand command = parse_device(words);
  return std::string(command.topic->name) + ": " + describe(command.request);
}

TEST(DeviceWords, AreRequests) {
  EXPECT_EQ(parsed({"servo", "1500"}), "device/servo: servo width=1500");
  EXPECT_EQ(parsed({"gripper", "down"}), "device/gripper: gripper action=\"lift down\"");
  EXPECT_EQ(parsed({"gripper", "carry", "50"}),
            "device/gripper: gripper action=\"carry\" value=50");
  EXPECT_EQ(parsed({"gripper", "5"}), "device/gripper: gripper action=\"number\" value=5");
  EXPECT_EQ(parsed({"output", "0x5A"}), "device/output: output bits=90");
  EXPECT_EQ(parsed({"output", "1", "0x01"}), "device/output: output bits=1 mask=1");
  EXPECT_EQ(parsed({"analog", "3"}), "device/analog: analog port=3");
  EXPECT_EQ(parsed({"timer", "7"}), "device/timer: timer pin=7");
  EXPECT_EQ(parsed({"sonar", "on", "3", "2", "3"}),
            "device/sonar: sonar on=yes sonar=3 sonar=2 sonar=3");
  EXPECT_EQ(parsed({"sonar", "off"}), "device/sonar: sonar on=no");
  EXPECT_EQ(parsed({"sound", "4"}), "device/sound: sound stored=4");
  EXPECT_EQ(parsed({"sound", "0.5:60", "0.1:0"}),
            "device/sound: tones duration=0.5 pitch=60 duration=0.1 pitch=0");
  EXPECT_EQ(parsed({"motors", "on"}), "device/server: motors on=yes");
  EXPECT_EQ(parsed({"origin"}), "device/server: set_origin");
  EXPECT_EQ(parsed({"bumpers", "3"}), "device/server: bump_stall value=3");
  EXPECT_EQ(parsed({"report", "io"}), "device/server: report packet=\"io\" often=\"once\"");
  EXPECT_EQ(parsed({"report", "encoders", "always"}),
            "device/server: report packet=\"encoders\" often=\"always\"");
  EXPECT_EQ(parsed({"serial", "2", "0x8130", "hi", "--answer", "9"}),
            "device/serial: serial port=2 data=\"81306869\" answer=9");
  EXPECT_EQ(parsed({"vision", "pioneer_a_mode=1"}), "device/vision: say text=\"pioneer_a_mode=1\"");
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
    EXPECT_TRUE(test::has(test::trouble_of<std::invalid_argument>([&] { parse_device(words); }),
                          "expected "))
        << all;
  }
}

TEST(DeviceWords, RowsShowWhatTheRobotHas) {
  v1::RobotState robot{.battery = 12.34, .digital_output = 5};
  const auto find = [](const std::vector<std::vector<std::string>>& rows, const std::string& name) {
    for (const auto& row : rows)
      if (row[0] == name)
        return row[1];
    return std::string();
  };
  auto rows = device_rows(robot, nullptr);
  EXPECT_EQ(find(rows, "battery"), "12.3 V");
  EXPECT_EQ(find(rows, "digital output"), "0b00000101");
  EXPECT_EQ(find(rows, "encoders"), "");
  v1::Devices devices{.requests = std::vector<v1::DeviceRequest>(1),
                      .has_flags = true,
                      .emergency_stop = true,
                      .has_charge = true,
                      .charge = 0.5,
                      .has_encoders = true,
                      .left_encoder = -3,
                      .has_gripper = true,
                      .gripper_state = 0x12};
  devices.requests[0].source = "me";
  devices.requests[0].answer.text = "servo 1500 us: refused; why not";
  rows = device_rows(robot, &devices);
  EXPECT_EQ(find(rows, "battery"), "12.3 V, 50 % charged");
  EXPECT_EQ(find(rows, "motors"), "off, EMERGENCY STOP PRESSED");
  EXPECT_EQ(find(rows, "encoders"), "-3 0 ticks");
  EXPECT_EQ(find(rows, "gripper"), "0b00010010 (closed, lift up)");
  EXPECT_EQ(find(rows, "request"), "servo 1500 us: refused; why not (me)");
}

}  // namespace
}  // namespace saphira::cli

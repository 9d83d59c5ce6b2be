#include "device_topics.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"

namespace saphira::bridge {
namespace {

class DeviceTopicsTest : public testing::Test {
 protected:
  void ask(std::uint64_t number, std::uint16_t width) {
    v1::ServoCommand command;
    command.source("a person");
    command.request(number);
    command.width(width);
    servo.write(command);
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node bridge{test::memory_options("bridge"), memory};
  bus::Node person{test::memory_options("person"), memory};
  bus::Reader<v1::Devices> devices = person.reader(bus::topics::kDevices);
  bus::Reader<v1::SerialData> serial = person.reader(bus::topics::kSerialData);
  bus::Writer<v1::ServoCommand> servo = person.writer(bus::topics::kServo);
  reflector::Reflector reflector;
  DeviceTopics topics{bridge, reflector};
  v1::Stamp stamp;
};

TEST_F(DeviceTopicsTest, WhatIsAskedForIsUnderWay) {
  ask(4, 1500);
  topics.take(stamp, true);
  const auto told = devices.take_newest();
  ASSERT_TRUE(told);
  ASSERT_EQ(told->requests().size(), 1U);
  EXPECT_EQ(told->requests()[0].source(), "a person");
  EXPECT_EQ(told->requests()[0].request(), 4U);
  EXPECT_EQ(told->requests()[0].state(), v1::REQUEST_SENDING);
  EXPECT_EQ(topics.refused(), 0U);
}

TEST_F(DeviceTopicsTest, WithoutARobotItIsRefused) {
  ask(4, 1500);
  topics.take(stamp, false);
  const auto told = devices.take_newest();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->requests()[0].state(), v1::REQUEST_REFUSED);
  EXPECT_EQ(told->requests()[0].reason(), "no robot is connected");
  EXPECT_EQ(topics.refused(), 1U);
}

TEST_F(DeviceTopicsTest, BytesOfASerialPortAreHandedOn) {
  stamp.cycle(8);
  protocol::AuxPacket aux;
  aux.line = 2;
  aux.bytes = {1, 2, 3};
  topics.packet(aux, 0xB8, stamp);
  const auto data = serial.take_newest();
  ASSERT_TRUE(data);
  EXPECT_EQ(data->port(), 2);
  EXPECT_EQ(data->data(), aux.bytes);
  EXPECT_EQ(data->stamp(), stamp);
}

TEST_F(DeviceTopicsTest, PacketsThatNobodyReadsAreToldOnce) {
  topics.packet(protocol::OtherPacket{0x9A, {}}, 0x9A, stamp);
  topics.publish(stamp);
  ASSERT_TRUE(devices.take_newest());
  topics.packet(protocol::OtherPacket{0x9A, {}}, 0x9A, stamp);
  topics.publish(stamp);
  EXPECT_FALSE(devices.take_newest()) << "their number alone is no news";
}

}  // namespace
}  // namespace saphira::bridge

#include "device_topics.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"
#include "saphira/bus/request_client.hpp"

namespace saphira::bridge {
namespace {

class DeviceTopicsTest : public testing::Test {
 protected:
  void ask(std::uint64_t number, double width) {
    servo.write({.number = number,
                 .source = "a person",
                 .functor = "servo",
                 .arguments = {bus::number("width", width)}});
  }
  v1::Answer answer() { return answers.take_newest().value(); }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node bridge{test::memory_options("bridge"), memory};
  bus::Node person{test::memory_options("person"), memory};
  bus::Reader<v1::Devices> devices = person.reader(bus::topics::kDevices);
  bus::Reader<v1::SerialData> serial = person.reader(bus::topics::kSerialData);
  bus::Writer<v1::Request> servo = person.writer<v1::Request>(bus::topics::kServo);
  bus::Reader<v1::Answer> answers = person.reader(bus::topics::kRobotAnswers);
  reflector::Reflector reflector;
  DeviceTopics topics{bridge, reflector};
  v1::Stamp stamp;
};

TEST_F(DeviceTopicsTest, WhatIsAskedForIsUnderWay) {
  ask(4, 1500);
  topics.take({}, true);
  const auto told = devices.take_newest();
  ASSERT_TRUE(told);
  ASSERT_EQ(told->requests.size(), 1U);
  EXPECT_EQ(told->requests[0].source, "a person");
  EXPECT_EQ(told->requests[0].answer.number, 4U);
  EXPECT_EQ(told->requests[0].answer.code, v1::ANSWER_UNDERWAY);
  const v1::Answer first = answer();
  EXPECT_EQ(first.number, 4U);
  EXPECT_EQ(first.code, v1::ANSWER_UNDERWAY);
  EXPECT_EQ(first.text, "servo 1500 us: not shown yet");
  EXPECT_EQ(topics.refused(), 0U);
}

TEST_F(DeviceTopicsTest, WithoutARobotThereIsNobodyToDoIt) {
  ask(4, 1500);
  topics.take({}, false);
  EXPECT_FALSE(devices.take_newest()) << "the robot was not asked";
  const v1::Answer told = answer();
  EXPECT_EQ(told.code, v1::ANSWER_NOBODY);
  EXPECT_EQ(told.text, "no robot is connected");
  EXPECT_EQ(topics.refused(), 1U);
}

TEST_F(DeviceTopicsTest, WhatIsOutOfRangeIsRefused) {
  ask(4, 70000);
  topics.take({}, true);
  const v1::Answer told = answer();
  EXPECT_EQ(told.code, v1::ANSWER_BAD_ARGUMENT);
  EXPECT_NE(told.text.find("servo: argument \"width\": expected a whole number from 0 to 65535"),
            std::string::npos)
      << told.text;
  EXPECT_EQ(topics.refused(), 1U);
}

TEST_F(DeviceTopicsTest, AFunctorOfAnotherTopicIsUnknown) {
  auto server = person.writer<v1::Request>(bus::topics::kServer);
  server.write(
      {.source = "a person", .functor = "servo", .arguments = {bus::number("width", 1500)}});
  topics.take({}, true);
  EXPECT_EQ(answer().code, v1::ANSWER_UNKNOWN_FUNCTOR);
}

TEST_F(DeviceTopicsTest, ANewerRequestTakesThePlaceOfAnOlderOne) {
  ask(4, 1500);
  topics.take({}, true);
  ask(5, 1600);
  topics.take({}, true);
  const auto told = answers.take();
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[1].data.number, 4U);
  EXPECT_EQ(told[1].data.code, v1::ANSWER_LOST);
  EXPECT_EQ(told[1].data.text, "servo 1500 us: a request of a person took its place");
  EXPECT_EQ(told[2].data.number, 5U);
}

TEST_F(DeviceTopicsTest, BytesOfASerialPortAreHandedOn) {
  stamp.cycle = 8;
  protocol::AuxPacket aux;
  aux.line = 2;
  aux.bytes = {1, 2, 3};
  topics.packet(aux, 0xB8, stamp);
  const auto data = serial.take_newest();
  ASSERT_TRUE(data);
  EXPECT_EQ(data->port, 2);
  EXPECT_EQ(data->data, aux.bytes);
  EXPECT_EQ(data->stamp, stamp);
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

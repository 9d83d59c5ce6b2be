#include "camera.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"

namespace saphira::bridge {
namespace {

class CameraTest : public testing::Test {
 protected:
  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node bridge{test::memory_options("bridge"), memory};
  bus::Node other{test::memory_options("vision"), memory};
  bus::Reader<v1::VisionChannels> channels = other.reader(bus::topics::kVisionChannels);
  Camera camera{bridge, {"pioneer_a_mode=2", "pioneer_b_mode=2"}};
};

TEST_F(CameraTest, IsAskedUntilItsPacketsCome) {
  EXPECT_EQ(camera.begin(1).size(), 2U);
  EXPECT_TRUE(camera.begin(2).empty());
  EXPECT_TRUE(camera.begin(20).empty());
  EXPECT_EQ(camera.begin(21).size(), 2U) << "two seconds without a packet";
  v1::RobotState state{.stamp = {.cycle = 22}};
  camera.packet({}, state);
  for (std::uint64_t cycle = 23; cycle <= 32; ++cycle) {
    EXPECT_TRUE(camera.begin(cycle).empty());
    EXPECT_EQ(camera.packets_per_s(), 1U);
  }
  EXPECT_TRUE(camera.begin(33).empty());
  EXPECT_EQ(camera.packets_per_s(), 0U);
  EXPECT_EQ(camera.begin(41).size(), 2U) << "it has fallen silent";
}

TEST_F(CameraTest, IsAskedAgainInTheNextSession) {
  EXPECT_EQ(camera.begin(1).size(), 2U);
  camera.connect();
  EXPECT_EQ(camera.begin(1).size(), 2U);
}

TEST_F(CameraTest, ItsPacketsSayWhereTheRobotWas) {
  v1::RobotState state{.stamp = {3, 5}, .odom = 9, .pose_in_odom = {.x = 1.5}};
  protocol::VisionPacket packet;
  packet.channels[1].area = 300;
  camera.packet(packet, state);
  const auto seen = channels.take_newest();
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->stamp, state.stamp);
  EXPECT_EQ(seen->odom, 9U);
  EXPECT_EQ(seen->pose_in_odom.x, 1.5);
  EXPECT_EQ(seen->channels[1].area, 300U);
}

}  // namespace
}  // namespace saphira::bridge

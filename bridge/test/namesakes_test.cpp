#include "namesakes.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "node_options.hpp"

namespace saphira::bridge {
namespace {

class NamesakesTest : public testing::Test {
 protected:
  /// `node` says of itself that it is in that state.
  void say(bus::Node& node, v1::ServiceState state) {
    v1::ServiceStatus status = node.status();
    status.state(state);
    status.host("the attic");
    status.pid(12);
    said_ = node.writer(bus::topics::kStatus);
    said_->write(status);
    namesakes.take();
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node own{test::memory_options("bridge"), memory};
  bus::Node other{test::memory_options("bridge"), memory};
  Namesakes namesakes{own};

 private:
  std::optional<bus::Writer<v1::ServiceStatus>> said_;
};

TEST_F(NamesakesTest, AreBridgesThatServe) {
  EXPECT_FALSE(namesakes.any());
  say(other, v1::SERVICE_WAITING);
  EXPECT_FALSE(namesakes.any()) << "it has no robot";
  say(other, v1::SERVICE_RUNNING);
  ASSERT_TRUE(namesakes.any());
  EXPECT_EQ(namesakes.who(), "process 12 at the attic");
}

TEST_F(NamesakesTest, AreNotThisOneAndNoOtherService) {
  say(own, v1::SERVICE_RUNNING);
  EXPECT_FALSE(namesakes.any());
  bus::Node behaviors{test::memory_options("behaviors"), memory};
  say(behaviors, v1::SERVICE_RUNNING);
  EXPECT_FALSE(namesakes.any());
}

TEST_F(NamesakesTest, AreNoMoreWhenTheirProgramIsGone) {
  {
    auto status = other.status();
    auto writer = other.writer(bus::topics::kStatus);
    status.state(v1::SERVICE_DEGRADED);
    writer.write(status);
    namesakes.take();
    EXPECT_TRUE(namesakes.any());
  }
  namesakes.take();
  EXPECT_FALSE(namesakes.any());
}

}  // namespace
}  // namespace saphira::bridge

#include "other_programs.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "node_options.hpp"

namespace saphira::bridge {
namespace {

class NamesakesTest : public testing::Test {
 protected:
  /// Publishes a status of `node` with that state.
  void say(bus::Node& node, v1::ServiceState state) {
    v1::ServiceStatus status = node.status();
    status.state = state;
    status.host = "the attic";
    status.pid = 12;
    said_ = node.writer(bus::topics::kStatus);
    said_->write(status);
    programs.take();
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node own{test::memory_options("bridge"), memory};
  bus::Node other{test::memory_options("bridge"), memory};
  OtherPrograms programs{own};

 private:
  std::optional<bus::Writer<v1::ServiceStatus>> said_;
};

TEST_F(NamesakesTest, AreBridgesThatServe) {
  EXPECT_FALSE(programs.has_namesake());
  say(other, v1::SERVICE_WAITING);
  EXPECT_FALSE(programs.has_namesake()) << "it has no robot";
  say(other, v1::SERVICE_RUNNING);
  ASSERT_TRUE(programs.has_namesake());
  EXPECT_EQ(programs.namesake(), "process 12 at the attic");
}

TEST_F(NamesakesTest, AreNotThisOneAndNoOtherService) {
  say(own, v1::SERVICE_RUNNING);
  EXPECT_FALSE(programs.has_namesake());
  bus::Node behaviors{test::memory_options("behaviors"), memory};
  say(behaviors, v1::SERVICE_RUNNING);
  EXPECT_FALSE(programs.has_namesake());
}

TEST_F(NamesakesTest, AreNoMoreWhenTheirProgramIsGone) {
  {
    auto status = other.status();
    auto writer = other.writer(bus::topics::kStatus);
    status.state = v1::SERVICE_DEGRADED;
    writer.write(status);
    programs.take();
    EXPECT_TRUE(programs.has_namesake());
  }
  programs.take();
  EXPECT_FALSE(programs.has_namesake());
}

}  // namespace
}  // namespace saphira::bridge

#include "saphira/cli/running_bus.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

const RunningBus kUsual{"", "pioneer", 0, "host", {}, "", false};
const RunningBus kDemo{"the demo", "demo-17", 77, "host", {}, "", false};
const RunningBus kLaptop{"the deployment laptop",  "pioneer",  0,   "wan",
                         {"10.0.0.2", "10.0.0.3"}, "10.0.0.1", true};

TEST(RunningBus, IsKeptAsText) {
  const auto read = parse_running_bus(to_text(kLaptop));
  ASSERT_TRUE(read);
  EXPECT_EQ(to_text(*read), to_text(kLaptop));
  EXPECT_EQ(read->peers.size(), 2U);
  for (const char* const text : {"", "{", "[]", "{\"what\":1}", "pioneer 0"})
    EXPECT_FALSE(parse_running_bus(text)) << text;
}

TEST(RunningBus, TheNewestIsMeantWhereTheUsualOneDoesNotRun) {
  EXPECT_EQ(bus_meant(kUsual, {}), nullptr);
  const std::vector<RunningBus> one{kDemo};
  EXPECT_EQ(bus_meant(kUsual, one), &one.front());
  const std::vector<RunningBus> two{kDemo, kLaptop};
  EXPECT_EQ(bus_meant(kUsual, two), &two.back()) << "a deployment, though the demo is newer";
  const std::vector<RunningBus> three{
      kLaptop, kDemo, {"the deployment demo", "pioneer", 0, "host", {}, "", false}};
  EXPECT_EQ(bus_meant(kUsual, three), nullptr) << "the usual one runs";
}

TEST(RunningBus, SaysTheOptionsThatAPersonWouldGive) {
  EXPECT_EQ(options_of(kUsual, kUsual), "");
  EXPECT_EQ(options_of(kDemo, kUsual), "--robot demo-17 --domain 77");
  EXPECT_EQ(options_of(kLaptop, kUsual),
            "--profile wan --peer 10.0.0.2 --peer 10.0.0.3 --interface 10.0.0.1");
}

}  // namespace
}  // namespace saphira::cli

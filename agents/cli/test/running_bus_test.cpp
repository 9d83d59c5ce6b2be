#include "saphira/cli/running_bus.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

const RunningBus kUsual{"", "pioneer", 0, "host", {}, "", false};
const RunningBus kDemo{"the demo", "demo-17", 77, "host", {}, "", false};
const RunningBus kLaptop{"the deployment laptop",  "pioneer",  0,   "wan",
                         {"10.0.0.2", "10.0.0.3"}, "10.0.0.1", true};

std::string meant(const std::vector<RunningBus>& running, const RunningBus& usual = kUsual,
                  const GivenOptions& given = {}) {
  const auto bus = bus_meant(usual, running, given);
  return bus ? options_of(*bus, kUsual) : "the usual one";
}

TEST(RunningBus, TheNewestIsMeantWhereTheUsualOneDoesNotRun) {
  EXPECT_EQ(meant({}), "the usual one");
  EXPECT_EQ(meant({kDemo}), "--robot demo-17 --domain 77");
  EXPECT_EQ(meant({kDemo, kLaptop}),
            "--profile wan --peer 10.0.0.2 --peer 10.0.0.3 --interface 10.0.0.1")
      << "a deployment, though the demo is newer";
  EXPECT_EQ(meant({kLaptop, kDemo, {"the deployment demo", "pioneer", 0, "host", {}, "", false}}),
            "the usual one")
      << "it runs";
}

TEST(RunningBus, AGivenNameSelectsAndTheRestIsFilledIn) {
  const RunningBus fresh{"the deployment laptop", "fresh", 85, "lan", {}, "10.0.0.1", true};
  const std::vector<RunningBus> running{kDemo, kLaptop, fresh};
  RunningBus asked = kUsual;
  asked.robot = "fresh";
  EXPECT_EQ(meant(running, asked, {.robot = true}),
            "--robot fresh --domain 85 --profile lan --interface 10.0.0.1");
  asked.domain = 85;
  EXPECT_EQ(meant(running, asked, {.robot = true, .domain = true}),
            "--robot fresh --domain 85 --profile lan --interface 10.0.0.1");
  asked.robot = kUsual.robot;
  EXPECT_EQ(meant(running, asked, {.domain = true}),
            "--robot fresh --domain 85 --profile lan --interface 10.0.0.1");
  asked.domain = 86;
  EXPECT_EQ(meant(running, asked, {.domain = true}), "the usual one") << "it runs elsewhere";
}

TEST(RunningBus, GivenOptionsWin) {
  const RunningBus fresh{"the deployment laptop", "fresh", 85, "lan", {}, "10.0.0.1", true};
  RunningBus asked = kUsual;
  asked.robot = "fresh";
  asked.profile = "wan";
  asked.peers = {"10.0.0.9"};
  EXPECT_EQ(meant({fresh}, asked, {.robot = true, .network = true}),
            "--robot fresh --domain 85 --profile wan --peer 10.0.0.9");
  EXPECT_EQ(meant({fresh}, asked, {.network = true}), "the usual one") << "a network alone";
}

TEST(RunningBus, CredentialsAreThePersonsOwn) {
  RunningBus open = kUsual;
  open.what = "the deployment demo";
  open.security = "none";
  RunningBus secured = open;
  secured.security = "/etc/saphira/credentials";
  RunningBus person = kUsual;
  person.security = "/home/ann/credentials";
  EXPECT_EQ(bus_meant(person, {secured}), std::nullopt) << "the same bus, by other credentials";
  ASSERT_TRUE(bus_meant(person, {open}));
  EXPECT_EQ(bus_meant(person, {open})->security, "none");
  EXPECT_EQ(bus_meant(person, {open}, {.security = true}), std::nullopt);
  person.security = "none";
  ASSERT_TRUE(bus_meant(person, {secured}));
  EXPECT_EQ(bus_meant(person, {secured})->security, secured.security);
}

TEST(RunningBus, SaysTheOptionsThatAPersonWouldGive) {
  EXPECT_EQ(options_of(kUsual, kUsual), "");
  EXPECT_EQ(options_of(kDemo, kUsual), "--robot demo-17 --domain 77");
  EXPECT_EQ(options_of(kLaptop, kUsual),
            "--profile wan --peer 10.0.0.2 --peer 10.0.0.3 --interface 10.0.0.1");
}

}  // namespace
}  // namespace saphira::cli

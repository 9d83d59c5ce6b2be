// Which machines a program announces itself to.
#include "machines.hpp"

#include <gtest/gtest.h>

namespace saphira::bus::internal {
namespace {

using std::chrono::seconds;
using Addresses = Machines::Addresses;

/// The one at 10.0.0.2, that was given this peer.
struct Here : Machines {
  explicit Here(const std::string& peer) {
    be({"10.0.0.2"});
    if (!peer.empty())
      name(peer, peer);
  }
};

TEST(Machines, NamedOneIsAnnouncedToWhenItsAddressIsKnown) {
  Here machines("");
  machines.name("robot.local", "");
  EXPECT_TRUE(machines.others(seconds(1)).empty());
  EXPECT_EQ(machines.unknown(), std::vector<std::string>{"robot.local"});
  EXPECT_TRUE(machines.silent(seconds(1)).empty());
  machines.name("robot.local", "10.0.0.1");
  EXPECT_EQ(machines.others(seconds(2)), Addresses{"10.0.0.1"});
  EXPECT_EQ(machines.silent(seconds(2)), std::vector<std::string>{"robot.local"});
  machines.name("robot.local", "10.0.0.7");
  EXPECT_EQ(machines.others(seconds(3)), Addresses{"10.0.0.7"});
  machines.be({"10.0.0.7"});
  EXPECT_TRUE(machines.others(seconds(4)).empty()) << "it is this machine";
}

TEST(Machines, MachineThatAnotherProgramHearsIsAnnouncedTo) {
  Here machines("");
  machines.tell("robot", "10.0.0.2,10.0.0.1,10.0.0.3");
  EXPECT_EQ(machines.others(seconds(1)), (Addresses{"10.0.0.1", "10.0.0.3"}));  // not itself
  machines.tell("robot", "10.0.0.2");
  EXPECT_TRUE(machines.others(seconds(2)).empty());
  machines.tell("robot", "10.0.0.4");
  machines.forget("robot");
  EXPECT_TRUE(machines.others(seconds(2)).empty());
}

TEST(Machines, MachineThatIsHeardIsToldUntilItFallsSilent) {
  Here machines("10.0.0.1");
  machines.hear("10.0.0.2", seconds(1));
  machines.hear("127.0.0.1", seconds(1));
  EXPECT_EQ(machines.heard(seconds(1)), "");
  machines.hear("10.0.0.3", seconds(1));
  machines.hear("10.0.0.1", seconds(50));
  EXPECT_EQ(machines.heard(seconds(50)), "10.0.0.1,10.0.0.3");
  // Programs that are begun there later are found even when nobody tells of it any more.
  EXPECT_EQ(machines.others(seconds(50)), (Addresses{"10.0.0.1", "10.0.0.3"}));
  EXPECT_EQ(machines.heard(seconds(70)), "10.0.0.1");
  EXPECT_EQ(machines.others(seconds(70)), Addresses{"10.0.0.1"});
}

TEST(Machines, NamedMachineThatIsNotHeardIsSilent) {
  Here machines("10.0.0.1");
  machines.name("10.0.0.2", "10.0.0.2");
  EXPECT_EQ(machines.silent(seconds(1)), std::vector<std::string>{"10.0.0.1"});
  machines.hear("10.0.0.1", seconds(2));
  EXPECT_TRUE(machines.silent(seconds(3)).empty());
  EXPECT_EQ(machines.silent(seconds(80)).size(), 1U);
}

TEST(Machines, WhatIsMadeUpIsBounded) {
  Here machines("");
  std::string many = "x,,10.0.0,10.0.0.300,127.0.0.5,239.255.0.1,0.0.0.0,255.255.255.255";
  machines.tell("robot", many);
  EXPECT_TRUE(machines.others(seconds(1)).empty());
  for (int i = 1; i < 255; ++i)
    many += ",10.0.1." + std::to_string(i);
  machines.tell("robot", many);
  machines.tell("other", "10.0.2.1,10.0.2.2");
  EXPECT_EQ(machines.others(seconds(1)).size(), Machines::kMost);
  for (int i = 1; i < 255; ++i)
    machines.hear("10.0.3." + std::to_string(i), seconds(1));
  EXPECT_LE(machines.heard(seconds(1)).size(), Machines::kMost * std::string("10.0.3.255,").size());
}

}  // namespace
}  // namespace saphira::bus::internal

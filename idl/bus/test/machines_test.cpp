// Which machines a program announces itself to.
#include "machines.hpp"

#include <gtest/gtest.h>

namespace saphira::bus::internal {
namespace {

using std::chrono::seconds;
using Addresses = Machines::Addresses;

TEST(Machines, MachineThatAnotherProgramHearsIsAnnouncedTo) {
  Machines machines({"127.0.0.1", "10.0.0.2"}, {"10.0.0.1"});
  EXPECT_TRUE(machines.others(seconds(1)).empty());
  machines.tell("robot", "10.0.0.2,10.0.0.1,10.0.0.3");
  EXPECT_EQ(machines.others(seconds(1)), Addresses{"10.0.0.3"});  // not itself, nor the named one
  machines.tell("robot", "10.0.0.2");
  EXPECT_TRUE(machines.others(seconds(2)).empty());
  machines.tell("robot", "10.0.0.4");
  machines.forget("robot");
  EXPECT_TRUE(machines.others(seconds(2)).empty());
}

TEST(Machines, MachineThatIsHeardIsToldUntilItFallsSilent) {
  Machines machines({"127.0.0.1", "10.0.0.2"}, {"10.0.0.1"});
  machines.hear("10.0.0.2", seconds(1));
  machines.hear("127.0.0.1", seconds(1));
  EXPECT_EQ(machines.heard(seconds(1)), "");
  machines.hear("10.0.0.3", seconds(1));
  machines.hear("10.0.0.1", seconds(50));
  EXPECT_EQ(machines.heard(seconds(50)), "10.0.0.1,10.0.0.3");
  // Programs that are begun there later are found even when nobody tells of it any more.
  EXPECT_EQ(machines.others(seconds(50)), Addresses{"10.0.0.3"});
  EXPECT_EQ(machines.heard(seconds(70)), "10.0.0.1");
  EXPECT_TRUE(machines.others(seconds(70)).empty());
}

TEST(Machines, NamedMachineThatIsNotHeardIsSilent) {
  Machines machines({"10.0.0.2"}, {"10.0.0.1", "10.0.0.2"});
  EXPECT_EQ(machines.silent(seconds(1)), std::vector<std::string>{"10.0.0.1"});
  machines.hear("10.0.0.1", seconds(2));
  EXPECT_TRUE(machines.silent(seconds(3)).empty());
  EXPECT_EQ(machines.silent(seconds(80)).size(), 1U);
}

TEST(Machines, WhatIsMadeUpIsBounded) {
  Machines machines({"10.0.0.2"}, {});
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

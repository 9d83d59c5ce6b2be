#include "saphira/authority/arbiter.hpp"

#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::authority {
namespace {

using test::Scene;
using test::writer;

TEST(Arbiter, NobodyAskedNobodyDrives) {
  Scene s;
  const Grant grant = s.arbiter.decide(s.now, s.cycle);
  EXPECT_EQ(grant.role, Role::none);
  EXPECT_EQ(grant.reason, "nothing asks the robot to move");
}

// Every set of roles that want to drive: the strongest drives, the others get the reason.
TEST(Arbiter, TheStrongestLiveRoleDrives) {
  for (unsigned set = 1; set < 8; ++set) {
    Scene s;
    Role expected = Role::none;
    int weaker = -1;
    for (int i = 1; i < 4; ++i) {
      if ((set & (1U << (i - 1))) == 0)
        continue;
      const Role role = kRoles[static_cast<std::size_t>(i)];
      ASSERT_TRUE(s.offer(role, i));
      if (expected == Role::none)
        expected = role;
      ++weaker;
    }
    const Grant grant = s.arbiter.decide(s.now, s.cycle);
    EXPECT_EQ(grant.role, expected) << set;
    EXPECT_EQ(grant.source,
              std::string(name(expected)) + std::to_string(static_cast<int>(expected) - 1));
    EXPECT_EQ(s.arbiter.take_refused().size(), static_cast<std::size_t>(weaker));
  }
}

TEST(Arbiter, ALeaseEnds) {
  Scene s;
  s.offer(Role::direct, 1);
  Grant grant = s.arbiter.decide(s.now, s.cycle);
  EXPECT_DOUBLE_EQ(grant.expires_in, 0.3);
  s.now += 0.29;
  EXPECT_EQ(s.driver(), Role::direct);
  s.now += 0.02;
  grant = s.arbiter.decide(s.now, s.cycle);
  EXPECT_EQ(grant.role, Role::none);
  EXPECT_NE(grant.reason.find("lease of direct1 (direct) ran out"), std::string::npos);
}

// A person who drove is no reason for a robot to stand afterwards.
TEST(Arbiter, WhoHasLetGoIsNoReason) {
  Scene s;
  s.offer(Role::teleop, 1);
  ASSERT_EQ(s.driver(), Role::teleop);
  s.offer(Role::teleop, 1, false);
  EXPECT_EQ(s.grant().reason, "nothing asks the robot to move");
  s.wait(1000);
  s.offer(Role::behaviors, 2, false);
  EXPECT_EQ(s.grant().reason, "nothing asks the robot to move");
}

TEST(Arbiter, ThreeCyclesAreWithinALeaseOfThreeCycles) {
  for (int start = 0; start < 1000; ++start) {
    Scene s;
    s.now = 0.1 * start;
    s.offer(Role::behaviors, 1);
    s.now = 0.1 * (start + 3);
    ASSERT_EQ(s.driver(), Role::behaviors) << start;
    s.now = 0.1 * (start + 4);
    ASSERT_EQ(s.driver(), Role::none) << start;
  }
}

TEST(Arbiter, ReleaseEndsItAtOnce) {
  Scene s;
  s.offer(Role::direct, 1);
  EXPECT_EQ(s.driver(), Role::direct);
  EXPECT_TRUE(s.offer(Role::direct, 1, false));
  EXPECT_EQ(s.driver(), Role::none);
}

TEST(Arbiter, AWriterThatIsGoneReleases) {
  Scene s;
  s.offer(Role::teleop, 1);
  s.offer(Role::behaviors, 2);
  EXPECT_EQ(s.driver(), Role::teleop);
  s.arbiter.lost(Role::teleop, writer(3), s.now);
  EXPECT_EQ(s.driver(), Role::teleop);
  s.arbiter.lost(Role::teleop, writer(1), s.now);
  EXPECT_EQ(s.driver(), Role::none) << "and the behaviors wait";
}

TEST(Arbiter, RepeatedNumbersAreRefused) {
  Scene s;
  Command c = s.command(Role::direct, 1);
  EXPECT_TRUE(s.arbiter.offer(c, s.cycle));
  s.wait(2);
  c.received = s.now;
  c.cycle = s.cycle;
  EXPECT_FALSE(s.arbiter.offer(c, s.cycle));
  s.wait(2);
  EXPECT_EQ(s.driver(), Role::none);
  const auto refused = s.arbiter.take_refused();
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(refused[0].reason, "repeated command number");
}

TEST(Arbiter, ASecondWriterWaitsUntilTheFirstIsDone) {
  Scene s;
  EXPECT_TRUE(s.offer(Role::direct, 1));
  EXPECT_FALSE(s.offer(Role::direct, 2));
  EXPECT_EQ(s.arbiter.take_refused().at(0).reason, "the role is held by direct1");
  EXPECT_TRUE(s.offer(Role::direct, 2, false)) << "a bystander's release is no offence";
  EXPECT_EQ(s.driver(), Role::direct);
  s.offer(Role::direct, 1, false);
  EXPECT_TRUE(s.offer(Role::direct, 2));
  EXPECT_EQ(s.arbiter.decide(s.now, s.cycle).source, "direct2");
  s.wait(4);
  EXPECT_TRUE(s.offer(Role::direct, 1)) << "the lease of the second ended";
}

TEST(Arbiter, AnotherPersonDrivesOnlyAfterAStop) {
  Scene s;
  const auto both_drive = [&] {
    s.wait(1);
    s.offer(Role::teleop, 1);
    s.offer(Role::teleop, 2);
    return s.grant();
  };
  EXPECT_EQ(both_drive().source, "teleop1");
  EXPECT_EQ(s.arbiter.take_refused().at(0).reason,
            "teleop1 drives: stop first (space), then drive");
  s.arbiter.stop({7, 1}, "teleop2", s.now, s.cycle);
  EXPECT_EQ(both_drive().role, Role::none) << "nobody has let go";
  s.offer(Role::teleop, 2, false);
  EXPECT_EQ(both_drive().source, "teleop2");
}

TEST(Arbiter, ANewConnectionNeedsANewCommand) {
  Scene s;
  s.offer(Role::behaviors, 1);
  EXPECT_EQ(s.driver(), Role::behaviors);
  s.arbiter.connect(2);
  EXPECT_EQ(s.driver(), Role::none);
  EXPECT_FALSE(s.offer(Role::behaviors, 1)) << "answers the old epoch";
  EXPECT_EQ(s.arbiter.take_refused().at(0).reason, "answers another epoch");
  Command c = s.command(Role::behaviors, 1);
  c.epoch = 2;
  EXPECT_TRUE(s.arbiter.offer(c, s.cycle));
  EXPECT_EQ(s.driver(), Role::behaviors);
}

TEST(Arbiter, AWriterWithoutCyclesMayDriveAnyConnection) {
  Scene s;
  Command c = s.command(Role::teleop, 1);
  c.epoch = 0;
  c.cycle = 0;
  EXPECT_TRUE(s.arbiter.offer(c, s.cycle));
  EXPECT_EQ(s.driver(), Role::teleop);
  s.arbiter.connect(0);
  c.number = ++s.number;
  EXPECT_FALSE(s.arbiter.offer(c, s.cycle)) << "no robot";
  EXPECT_EQ(s.arbiter.decide(s.now, s.cycle).reason, "no robot is connected");
}

TEST(Arbiter, ADriverThatIsSlowDrivesForAsLongAsItMovesOn) {
  Scene s;
  // Over a slow network: each command answers a state 0.6 s old, and some are lost.
  for (int i = 0; i < 202; ++i) {
    s.wait(1);
    if (i % 7 == 3)
      continue;
    Command c = s.command(Role::behaviors, 1);
    c.cycle = s.cycle - 6;
    ASSERT_TRUE(s.arbiter.offer(c, s.cycle));
    const Grant grant = s.arbiter.decide(s.now, s.cycle);
    ASSERT_EQ(grant.role, Role::behaviors);
    ASSERT_NEAR(grant.command_age, 0.6, 1e-9);
  }
  // The link is cut: the lease ends as on a fast one.
  s.wait(3);
  EXPECT_EQ(s.driver(), Role::behaviors);
  s.wait(1);
  EXPECT_EQ(s.driver(), Role::none);
}

TEST(Arbiter, ADriverThatRepeatsWhatItAnsweredHasALeaseAndNoMore) {
  Scene s;
  Command c = s.command(Role::behaviors, 1);
  const std::uint64_t answered = c.cycle;
  EXPECT_TRUE(s.arbiter.offer(c, s.cycle));
  for (int i = 0; i < 3; ++i) {
    s.wait(1);
    c = s.command(Role::behaviors, 1);
    c.cycle = answered;
    EXPECT_TRUE(s.arbiter.offer(c, s.cycle));
    EXPECT_EQ(s.driver(), Role::behaviors);
  }
  s.wait(1);
  c = s.command(Role::behaviors, 1);
  c.cycle = answered;
  s.arbiter.offer(c, s.cycle);
  const Grant grant = s.arbiter.decide(s.now, s.cycle);
  EXPECT_EQ(grant.role, Role::none) << "young on the bus, but it answers what was 4 cycles ago";
  EXPECT_NE(grant.reason.find("does not hear the robot"), std::string::npos) << grant.reason;
}

/// A person drives, something happens, and the person holds on.
Role after(const std::function<void(Scene&)>& interruption, bool lets_go = false) {
  Scene s;
  s.offer(Role::teleop, 1);
  EXPECT_EQ(s.driver(), Role::teleop);
  interruption(s);
  for (int i = 0; i < 5; ++i) {
    s.wait(1);
    if (lets_go && i == 0)
      s.offer(Role::teleop, 1, false);
    s.offer(Role::teleop, 1);
    s.driver();
  }
  return s.driver();
}
void silence(Scene& s, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    s.wait(1);
    s.driver();
  }
}

TEST(Arbiter, APersonWhoseDrivingWasInterruptedLetsGoFirst) {
  const auto cut = [](Scene& s) { silence(s, 20); };
  EXPECT_EQ(after(cut), Role::none);
  EXPECT_EQ(after(cut, true), Role::teleop);
  EXPECT_EQ(after([](Scene& s) { silence(s, 6); }), Role::teleop) << "a few lost packets";
  const auto hung = [](int cycles) {
    return [cycles](Scene& s) {
      s.wait(cycles);
      s.arbiter.forget(s.cycle, s.now);
    };
  };
  EXPECT_EQ(after(hung(3)), Role::teleop) << "a busy machine";
  const auto bridge_hung = hung(20);
  EXPECT_EQ(after(bridge_hung), Role::none);
  EXPECT_EQ(after(bridge_hung, true), Role::teleop);
  const auto new_connection = [](Scene& s) {
    s.arbiter.connect(0);
    s.arbiter.connect(1);
  };
  EXPECT_EQ(after(new_connection), Role::none);
  EXPECT_EQ(after(new_connection, true), Role::teleop);
  const auto lost_and_found = [](Scene& s) { s.arbiter.lost(Role::teleop, writer(1), s.now); };
  EXPECT_EQ(after(lost_and_found), Role::none);
  const auto old_pictures = [](Scene& s) {
    const std::uint64_t seen = s.cycle;
    for (int i = 0; i < 10; ++i) {
      s.wait(1);
      Command c = s.command(Role::teleop, 1);
      c.cycle = seen;
      s.arbiter.offer(c, s.cycle);
      s.driver();
    }
  };
  EXPECT_EQ(after(old_pictures), Role::none);
}

// The keys are held while a bridge is started again.
TEST(Arbiter, APersonWhoDroveBeforeTheConnectionLetsGoFirst) {
  Scene s;
  s.arbiter.connect(0);
  EXPECT_FALSE(s.offer(Role::teleop, 1)) << "no robot";
  s.arbiter.connect(1);
  s.offer(Role::teleop, 1);
  EXPECT_EQ(s.driver(), Role::none);
  s.offer(Role::teleop, 1, false);
  s.offer(Role::teleop, 1);
  EXPECT_EQ(s.driver(), Role::teleop);

  s.arbiter.connect(2);
  Command old = s.command(Role::teleop, 3);
  EXPECT_FALSE(s.arbiter.offer(old, s.cycle)) << "it has not seen this robot";
  const auto now = [&](bool active) {
    Command c = s.command(Role::teleop, 3, active);
    c.epoch = 2;
    return s.arbiter.offer(c, s.cycle);
  };
  now(true);
  EXPECT_EQ(s.driver(), Role::none);
  now(false);
  now(true);
  EXPECT_EQ(s.driver(), Role::teleop);
}

TEST(Arbiter, AnInterruptedPersonHoldsUpNobodyElse) {
  Scene s;
  s.offer(Role::teleop, 1);
  silence(s, 20);
  s.offer(Role::teleop, 1);
  EXPECT_EQ(s.grant().reason,
            "the link to the robot was interrupted while a person drove: let go first, then drive");
  silence(s, 4);
  s.offer(Role::teleop, 2);
  EXPECT_EQ(s.driver(), Role::teleop);
  EXPECT_FALSE(s.offer(Role::teleop, 1)) << "the other one drives";
  s.offer(Role::teleop, 2, false);
  s.offer(Role::teleop, 1);
  EXPECT_EQ(s.driver(), Role::none) << "it was held all the time";
  s.offer(Role::teleop, 1, false);
  s.offer(Role::teleop, 1);
  EXPECT_EQ(s.driver(), Role::teleop);
}

TEST(Arbiter, WhatIsTooOldIsRefused) {
  Scene s;
  Command c = s.command(Role::behaviors, 1);
  c.cycle = s.cycle + 1;
  EXPECT_FALSE(s.arbiter.offer(c, s.cycle)) << "the future";
  const auto oldest = static_cast<std::uint64_t>(s.arbiter.settings().oldest / 0.1 + 0.5);
  c = s.command(Role::behaviors, 1);
  c.cycle = s.cycle - oldest - 1;
  EXPECT_FALSE(s.arbiter.offer(c, s.cycle));
  EXPECT_EQ(s.arbiter.take_refused().back().reason, "answers an old cycle");
  c = s.command(Role::behaviors, 1);
  c.cycle = s.cycle - oldest;
  EXPECT_TRUE(s.arbiter.offer(c, s.cycle));
  EXPECT_EQ(s.driver(), Role::behaviors);
  s.now += 0.1;
  ++s.cycle;
  EXPECT_EQ(s.driver(), Role::none);
}

TEST(Arbiter, AfterAGapNothingFromBeforeDrives) {
  Scene s;
  s.offer(Role::behaviors, 1);
  s.wait(5);
  s.arbiter.forget(s.cycle, s.now + 0.1);
  EXPECT_EQ(s.driver(), Role::none);
  EXPECT_FALSE(s.offer(Role::behaviors, 1)) << "it may have waited in a queue";
  s.now += 0.1;
  EXPECT_FALSE(s.offer(Role::behaviors, 1)) << "it answers a cycle of before";
  ++s.cycle;
  EXPECT_TRUE(s.offer(Role::behaviors, 1));
  EXPECT_EQ(s.driver(), Role::behaviors);
}

TEST(Arbiter, NobodyDrivesARobotThatIsSilent) {
  Scene s;
  s.offer(Role::teleop, 1);
  s.arbiter.forget(s.cycle, 1e300);
  EXPECT_EQ(s.driver(), Role::none);
  Command blind = s.command(Role::teleop, 1);
  blind.epoch = 0;
  blind.cycle = 0;
  EXPECT_FALSE(s.arbiter.offer(blind, s.cycle));
  s.wait(1);
  s.arbiter.forget(s.cycle - 1, s.now);
  EXPECT_TRUE(s.offer(Role::teleop, 1));
  EXPECT_EQ(s.driver(), Role::teleop);
}

TEST(Arbiter, WhoHasNotBeenHeardForLongestIsForgotten) {
  Scene s;
  const Command first = s.command(Role::teleop, 1);
  s.arbiter.offer(first, s.cycle);
  for (int i = 0; i < 2000; ++i) {
    Command other = s.command(Role::behaviors, 2);
    other.writer[1] = static_cast<std::uint8_t>(i % 256);
    other.writer[2] = static_cast<std::uint8_t>(i / 256);
    s.arbiter.offer(other, s.cycle);
    if (i < 1200)
      s.offer(Role::teleop, 1);
  }
  EXPECT_FALSE(s.arbiter.offer(first, s.cycle)) << "an old command again";
}

TEST(Arbiter, RefusalsAreToldOnceAndBounded) {
  Scene s;
  s.offer(Role::direct, 0);
  for (int i = 1; i < 100; ++i) {
    s.offer(Role::direct, i % 50 + 1);
    s.offer(Role::direct, i % 50 + 1);
  }
  EXPECT_EQ(s.arbiter.take_refused().size(), 16U);
  EXPECT_EQ(s.arbiter.take_refused().size(), 0U);
  EXPECT_EQ(s.arbiter.refused_count(), 198U);
}

}  // namespace
}  // namespace saphira::authority

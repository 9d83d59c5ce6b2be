#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::bridge::test {
namespace {

using authority::Role;

template <class What>
std::size_t first(const std::vector<Output>& said) {
  for (std::size_t i = 0; i < said.size(); ++i)
    if (std::holds_alternative<What>(said[i]))
      return i;
  return said.size();
}

/// A speed that the robot does not have.
protocol::Bytes impossible() {
  protocol::InformationPacket packet;
  packet.motors = protocol::Motors::kMoving;
  packet.left_velocity = packet.right_velocity = 30000;
  return protocol::encode(packet);
}

TEST(Session, BeginsWithZeroSetpointsAndADescription) {
  Scene scene;
  scene.connect();
  ASSERT_TRUE(scene.core.in_session());
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_FALSE(scene.was_moved());
  EXPECT_TRUE(scene.noted("connected to robot \"r\" (Pioneer, p3dx), p3dx.p"));
  scene.cycle();
  EXPECT_LT(first<SessionBegan>(scene.said), first<CycleBegan>(scene.said));
  const std::vector<CycleBegan> cycles = scene.all<CycleBegan>();
  ASSERT_EQ(cycles.size(), 1U);
  EXPECT_EQ(cycles[0].stamp, (v1::Stamp{1000, 1}));
}

// Its robot answers after that time [s].
void connect_slowly(Scene& scene, double delay) {
  scene.mute = true;
  scene.around.link_open = true;
  for (const protocol::Bytes& answer : {protocol::encode_sync(0), protocol::encode_sync(1),
                                        protocol::encode_sync2_reply({"r", "Pioneer", "p3dx"})}) {
    scene.pass_slowly(delay);
    scene.say(answer);
    scene.pass(0.01);
  }
}

TEST(Session, AnAnswerToAnEarlierQuestionDoesNotMakeALineFast) {
  for (const int delay : {3, 4, 8}) {  // in cycles
    Scene scene;
    connect_slowly(scene, 0.1 * delay);
    ASSERT_TRUE(scene.core.in_session());
    protocol::ConfigPacket set;
    set.deceleration = 600;
    std::vector<int> answers;  // cycles in which one comes
    bool measured = false;
    for (int i = 0; i < 100; ++i) {
      const auto asked =
          std::count_if(scene.sent.begin(), scene.sent.end(), [](const protocol::Command& command) {
            const auto* const question = std::get_if<protocol::Integer>(&command);
            return question != nullptr && question->number == protocol::Number::kConfigRequest;
          });
      answers.insert(answers.end(), static_cast<std::size_t>(asked), i + delay);
      measured = measured || (i > 10 && asked > 0);
      scene.sent.clear();
      while (!answers.empty() && answers.front() <= i) {
        answers.erase(answers.begin());
        scene.say(protocol::encode(set));
      }
      scene.cycles(1, Role::behaviors, 0.9);
      if (i > 10) {
        EXPECT_NE(scene.condition().reason.find("is slow"), std::string::npos)
            << "cycle " << i << " of a line of " << delay << ": " << scene.condition().reason;
      }
    }
    EXPECT_TRUE(measured) << "it is measured again";
  }
}

TEST(Session, ASlowLineIsToldAndDrivenSlowly) {
  Scene scene;
  connect_slowly(scene, 0.8);
  ASSERT_TRUE(scene.core.in_session());
  EXPECT_TRUE(scene.noted("the line to the robot is slow: an answer takes 0.8 s"));
  scene.forget();
  scene.cycles(12, Role::behaviors, 0.4);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_DEGRADED);
  EXPECT_NE(scene.condition().reason.find("is slow"), std::string::npos);
  const auto fastest = [&] {
    double velocity = 0.0;
    for (const protocol::Command& command : std::exchange(scene.sent, {}))
      if (const auto* const told = std::get_if<protocol::Velocity>(&command))
        velocity = std::max(velocity, told->velocity);
    return velocity;
  };
  EXPECT_TRUE(scene.was_sent(protocol::ConfigRequest{1}));
  const double slow = fastest();
  EXPECT_GT(slow, 0.1);
  EXPECT_LT(slow, 0.22);
  // The machine was busy: the next answer comes at once.
  protocol::ConfigPacket set;
  set.deceleration = 600;
  for (int i = 0; i < 35; ++i) {
    scene.cycles(1, Role::behaviors, 0.4);
    if (scene.was_sent(protocol::ConfigRequest{1}))
      scene.say(protocol::encode(set));
    scene.sent.clear();
  }
  scene.cycles(12, Role::behaviors, 0.4);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_RUNNING) << scene.condition().reason;
  EXPECT_NEAR(fastest(), 0.4, 1e-9);
}

TEST(Session, OnASerialLineZeroSetpointsComeBeforeTheFirstSync) {
  Scene scene;
  scene.around.serial = true;
  scene.mute = true;
  scene.connect();
  ASSERT_GE(scene.sent.size(), 3U);
  EXPECT_EQ(scene.sent[0], protocol::Command(protocol::Velocity{0.0}));
  EXPECT_EQ(scene.sent[1], protocol::Command(protocol::RotationVelocity{0.0}));
}

TEST(Session, EveryOneNeedsANewGrantAndHasANewEpoch) {
  Driven scene;
  const DriveCommand old = scene.wish(Role::behaviors, 0.1);
  const std::uint64_t epoch = scene.core.stamp().epoch;
  scene.core.link_closed("cut", scene.now);
  scene.deliver();
  EXPECT_EQ(scene.core.grant().role, Role::none);
  scene.forget();
  scene.connect();
  EXPECT_GT(scene.core.stamp().epoch, epoch);
  EXPECT_TRUE(scene.was_stopped());
  scene.cycle();
  scene.tell(old);
  EXPECT_FALSE(scene.was_moved()) << "what was meant for the session before";
  scene.cycles(2, Role::behaviors);
  EXPECT_TRUE(scene.was_moved());
  EXPECT_TRUE(scene.noted("goes on in the odom frame of before"));
}

TEST(Session, ALostLinkIsToldWithARobotThatStands) {
  Driven scene;
  scene.core.link_closed("closed by the robot", scene.now);
  scene.deliver();
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_EQ(scene.times_sent(protocol::Close{}), 1);
  EXPECT_TRUE(scene.noted("connection to the robot ended: closed by the robot"));
  const std::vector<GrantDecided> grants = scene.all<GrantDecided>();
  ASSERT_FALSE(grants.empty());
  EXPECT_EQ(grants.back().grant.role, Role::none);
  EXPECT_TRUE(scene.has<CloseLink>());
  EXPECT_FALSE(scene.core.in_session());
}

TEST(Session, TheKeeperIsGivenWhatStopsThisRobot) {
  for (const auto kind : {protocol::Protocol::kPsos, protocol::Protocol::kArcos}) {
    Scene scene;
    scene.robot.protocol = kind;
    scene.connect();
    const std::vector<WatchLink> watched = scene.all<WatchLink>();
    ASSERT_EQ(watched.size(), 1U);
    scene.forget();
    scene.hear(watched[0].stop);
    EXPECT_TRUE(scene.was_stopped());
    EXPECT_EQ(scene.sent.size(), kind == protocol::Protocol::kPsos ? 2U : 3U);
  }
}

TEST(Session, ASilentLinkIsAStop) {
  Driven scene;
  scene.pass_slowly(0.3);
  EXPECT_FALSE(scene.noted("robot link silent"));
  scene.forget();
  scene.pass_slowly(0.3);
  EXPECT_TRUE(scene.noted("robot link silent for 0.5 s: the robot is told to stop"));
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_EQ(scene.core.grant().role, Role::none);
  const DriveCommand waited = scene.wish(Role::teleop, 0.1);
  scene.tell(waited);
  EXPECT_EQ(scene.core.grant().role, Role::none) << "nobody drives what nobody sees";
  scene.forget();
  scene.cycle();
  EXPECT_EQ(scene.core.grant().role, Role::none) << "a new command is needed";
  EXPECT_FALSE(scene.was_moved());
  scene.drive(Role::teleop);
  EXPECT_EQ(scene.core.grant().role, Role::teleop);
}

TEST(Session, ASilentLinkIsGivenUpAfterTwoSeconds) {
  Driven scene;
  scene.pass_slowly(1.85);
  EXPECT_TRUE(scene.core.in_session());
  scene.forget();
  scene.pass_slowly(0.2);
  EXPECT_FALSE(scene.core.in_session());
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_EQ(scene.times_sent(protocol::Close{}), 1);
}

TEST(Session, ASimulatorWhoseTimeStandsKeepsTheSessionAndTheRobotStands) {
  Driven scene;
  const v1::Stamp before = scene.core.stamp();
  for (int i = 0; i < 20; ++i) {
    scene.say(protocol::encode(protocol::SimStatusPacket{}));
    scene.pass_slowly(0.5);
  }
  EXPECT_TRUE(scene.core.in_session());
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_EQ(scene.core.grant().role, Role::none);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_WAITING);
  scene.cycle();
  EXPECT_EQ(scene.core.stamp(), (v1::Stamp{before.epoch, before.cycle + 1}));
  EXPECT_EQ(scene.core.grant().role, Role::none) << "a new command is needed";
}

TEST(Session, WhatCannotBeTrueStopsTheRobotAndKeepsTheSession) {
  Driven scene;
  for (int i = 0; i < 30; ++i) {
    scene.say(impossible());
    scene.pass(0.1);
  }
  EXPECT_TRUE(scene.core.in_session());
  EXPECT_EQ(scene.core.grant().role, Role::none);
  EXPECT_TRUE(scene.noted("no packet for 0.5 s that can be true: the robot is told to stop"));
  EXPECT_EQ(scene.condition().health, v1::SERVICE_WAITING);
  EXPECT_FALSE(scene.has<CycleBegan>());
  scene.cycle();
  ASSERT_TRUE(scene.has<CycleBegan>());
  EXPECT_EQ(scene.all<CycleBegan>()[0].bad_packets, 30U);
}

TEST(Session, AGapOfTheLoopIsAStop) {
  Driven scene;
  const DriveCommand waited = scene.wish(Role::teleop, 0.1);
  scene.pass(0.3);
  EXPECT_TRUE(scene.noted("the bridge stood still for 0.30 s"));
  EXPECT_TRUE(scene.was_stopped());
  scene.tell(waited);
  EXPECT_EQ(scene.core.grant().role, Role::none) << "it waited in some queue";
  scene.cycle();
  scene.drive(Role::teleop);
  EXPECT_EQ(scene.core.grant().role, Role::teleop);
}

TEST(Session, PacketsThatWaitedDuringAGapAreDropped) {
  Driven scene;
  const std::uint64_t cycle = scene.core.stamp().cycle;
  for (int i = 0; i < 600; ++i)
    scene.say(protocol::encode(scene.shown));
  scene.pass(60.0);
  EXPECT_TRUE(scene.core.in_session());
  EXPECT_EQ(scene.core.stamp().cycle, cycle) << "none of a minute's packets is a cycle";
  scene.pass(0.05);
  scene.cycles(3, Role::behaviors);
  EXPECT_EQ(scene.core.stamp().cycle, cycle + 3);
  EXPECT_EQ(scene.core.grant().role, Role::behaviors);
}

TEST(Session, AGapDoesNotEndTheSilenceOfTheLink) {
  Driven scene;
  scene.pass_slowly(0.6);
  scene.pass(0.3);
  scene.pass(0.2);
  DriveCommand without_cycles = scene.wish(Role::teleop, 0.1);
  without_cycles.command.epoch = without_cycles.command.cycle = 0;
  scene.tell(without_cycles);
  EXPECT_EQ(scene.core.grant().role, Role::none);
  EXPECT_FALSE(scene.was_moved());
}

TEST(Session, ShorterPausesOfTheLoopAreNone) {
  Driven scene;
  scene.pass(0.24);
  EXPECT_FALSE(scene.noted("stood still"));
}

TEST(Session, AJumpOfThePositionNeedsANewGrant) {
  Driven scene;
  scene.shown.x = 16000;
  scene.cycle();
  EXPECT_TRUE(scene.noted("the robot's position jumped: a new odom frame begins"));
  EXPECT_EQ(scene.core.grant().role, Role::none);
  EXPECT_TRUE(scene.was_stopped());
  scene.drive(Role::behaviors);
  EXPECT_EQ(scene.core.grant().role, Role::behaviors);
}

TEST(Session, AControllerThatResetsItselfIsConnectedAnew) {
  Driven scene;
  scene.say(protocol::frame(protocol::Bytes{0xFE}));
  scene.pass(0.1);
  EXPECT_TRUE(scene.noted("the robot's controller was reset"));
  EXPECT_FALSE(scene.core.in_session());
}

TEST(Session, ARobotWithoutParametersIsTriedAgainLater) {
  Scene scene;
  scene.has_parameters = false;
  scene.connect();
  EXPECT_FALSE(scene.core.in_session());
  EXPECT_FALSE(scene.core.may_connect(scene.now + 1.8));
  EXPECT_TRUE(scene.core.may_connect(scene.now + 2.0));
  scene.pass_slowly(0.2);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_WAITING);
  EXPECT_EQ(scene.condition().reason, "no parameter file for it");
  scene.pass_slowly(2.0);
  scene.has_parameters = true;
  scene.forget();
  scene.connect();
  EXPECT_TRUE(scene.core.in_session());
  EXPECT_FALSE(scene.noted("no parameter file"));
}

TEST(Session, ASocketWithoutAnAnswerIsConnectedAnewALineIsNot) {
  for (const bool serial : {false, true}) {
    Scene scene;
    scene.mute = true;
    scene.around.serial = serial;
    scene.around.address = "tcp:robot:8101";
    scene.connect();
    scene.pass_slowly(5.2);
    EXPECT_EQ(scene.has<CloseLink>(), !serial);
  }
}

TEST(Session, ARobotOfAnotherBridgeIsNotAsked) {
  Scene scene;
  scene.around.namesake = "process 7";
  scene.connect();
  EXPECT_TRUE(scene.sent.empty());
  EXPECT_EQ(scene.condition().health, v1::SERVICE_WAITING);
  EXPECT_EQ(scene.condition().reason, "another bridge, process 7, has a robot of this name");
  EXPECT_FALSE(scene.has<GrantDecided>()) << "the other bridge says who drives";
  scene.around.namesake.clear();
  scene.connect();
  EXPECT_TRUE(scene.core.in_session());
}

TEST(Session, AnEndInGoodOrderIsNoWarning) {
  Driven scene;
  scene.core.end(scene.now);
  scene.deliver();
  EXPECT_TRUE(scene.was_stopped());
  EXPECT_EQ(scene.times_sent(protocol::Close{}), 1);
  for (const Note& note : scene.all<Note>())
    EXPECT_EQ(note.level, Note::Level::info) << note.text;
}

TEST(Session, ARobotThatBrakesLessIsToldOnce) {
  Driven scene;
  protocol::ConfigPacket set;
  set.deceleration = 300;
  for (int i = 0; i < 2; ++i) {
    scene.say(protocol::encode(set));
    scene.pass(0.05);
  }
  EXPECT_EQ(scene.all<OtherPacket>().size(), 2U);
  const std::vector<Note> notes = scene.all<Note>();
  EXPECT_EQ(std::count_if(notes.begin(), notes.end(),
                          [](const Note& note) {
                            return note.text.find("brakes with 0.30 m/s2") != std::string::npos;
                          }),
            1);
}

/// Drives for the given time with a robot whose packets are all damaged while it moves. Returns the
/// number of starts of motion.
int lurches(Scene& scene, double seconds, bool damages) {
  int begun = 0;
  bool moves = false;
  for (double t = 0.0; t < seconds; t += 0.1) {
    protocol::Bytes packet = protocol::encode(scene.shown);
    if (moves && damages)
      packet[packet.size() - 1] ^= 0x55;
    scene.say(packet);
    scene.pass(0.1);
    scene.drive(Role::behaviors, 0.3);
    for (const protocol::Command& command : scene.sent)
      if (const auto* const velocity = std::get_if<protocol::Velocity>(&command))
        if (std::exchange(moves, velocity->velocity != 0.0) == false && moves)
          ++begun;
    scene.sent.clear();
  }
  return begun;
}

TEST(Session, ARobotThatIsNotHeardWhileItMovesStands) {
  Driven scene;
  EXPECT_LE(lurches(scene, 30.0, true), 5);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_DEGRADED);
  EXPECT_EQ(scene.condition().reason.find("the robot is not heard while it moves (4 times now"), 0U)
      << scene.condition().reason;
  const std::vector<GrantDecided> grants = scene.all<GrantDecided>();
  EXPECT_TRUE(std::any_of(grants.begin(), grants.end(), [](const GrantDecided& decided) {
    return std::any_of(decided.refused.begin(), decided.refused.end(), [](const auto& refused) {
      return refused.reason.find("is not heard while it moves") != std::string::npos;
    });
  })) << "the driver hears why";
  EXPECT_LE(lurches(scene, 300.0, true), 3);
  // The line is repaired: the robot moves by itself, and continues.
  EXPECT_EQ(lurches(scene, 400.0, false), 1);
  EXPECT_EQ(scene.core.grant().role, Role::behaviors);
  EXPECT_EQ(scene.condition().health, v1::SERVICE_RUNNING) << scene.condition().reason;
  // Old events count no more.
  lurches(scene, 0.5, true);
  EXPECT_EQ(lurches(scene, 2.0, false), 1);
  EXPECT_EQ(scene.core.grant().role, Role::behaviors);
}

TEST(Session, ABadLineIsTold) {
  Driven scene;
  const auto one_in = [&](int n) {
    for (int i = 0; i < 60; ++i) {
      if (i % n == 0) {
        protocol::Bytes packet = protocol::encode(scene.shown);
        packet[packet.size() - 1] ^= 0x55;
        scene.say(packet);
        scene.pass(0.01);
      }
      scene.cycle();
      scene.drive(Role::behaviors);
    }
    return scene.condition();
  };
  EXPECT_EQ(one_in(15).health, v1::SERVICE_RUNNING);
  const Condition bad = one_in(7);
  EXPECT_EQ(bad.health, v1::SERVICE_DEGRADED);
  EXPECT_EQ(bad.reason.find("the line to the robot is bad: "), 0U) << bad.reason;
  EXPECT_NE(bad.reason.find(" of its last 50 packets were damaged"), std::string::npos)
      << bad.reason;
  EXPECT_EQ(scene.core.grant().role, Role::behaviors) << "it drives on";
  EXPECT_EQ(one_in(61).health, v1::SERVICE_RUNNING);
}

TEST(Session, UntilARobotSaysHowItBrakesItsParameterFileCounts) {
  const auto told = [](std::uint16_t config) {
    Scene scene;
    scene.robot.deceleration = 0.3;
    scene.robot.stop_deceleration = 0.6;
    scene.connect();
    for (int i = 0; i < 40; ++i) {
      if (config != 0 && i == 1) {
        protocol::ConfigPacket set;
        set.deceleration = config;
        scene.say(protocol::encode(set));
      }
      scene.cycle();
    }
    std::string words;
    for (const Note& note : scene.all<Note>())
      if (note.text.find("brakes with") != std::string::npos ||
          note.text.find("brake with") != std::string::npos)
        words += note.text;
    return words;
  };
  EXPECT_EQ(
      told(0),
      "the robot does not say how it brakes (CONFIG): it is reckoned to brake with 0.30 m/s2, "
      "as its parameter file says, not with 0.60 as asked for");
  EXPECT_EQ(told(600), "");
  EXPECT_EQ(told(400), "the robot brakes with 0.40 m/s2, not with 0.60 as asked for");
}

TEST(Session, HalfAPacketDoesNotHoldBackTheNext) {
  Driven scene;
  scene.say({protocol::kHeader0, protocol::kHeader1, 150});
  scene.say(protocol::encode(scene.shown));
  scene.pass(0.01);
  EXPECT_FALSE(scene.has<CycleBegan>());
  scene.pass(0.06);
  EXPECT_TRUE(scene.has<CycleBegan>());
}

}  // namespace
}  // namespace saphira::bridge::test

// Beside cases.txt: lines that are measured, bodies that are not heard, edges, reports.
#include <gtest/gtest.h>

#include <limits>

#include "saphira/bridge/line.hpp"
#include "scene.hpp"

namespace saphira::bridge::test {
namespace {

using authority::Role;

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
    protocol::ConfigPacket set{.deceleration = 600};
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
        velocity = std::max(velocity, told->value);
    return velocity;
  };
  EXPECT_TRUE(scene.was_sent(protocol::ConfigRequest{1}));
  const double slow = fastest();
  EXPECT_GT(slow, 0.1);
  EXPECT_LT(slow, 0.22);
  // The machine was busy: the next answer comes at once.
  protocol::ConfigPacket set{.deceleration = 600};
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
        if (std::exchange(moves, velocity->value != 0.0) == false && moves)
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

TEST(Drive, TheGuardTakesAnEchoForAnEdgeOfTheDriversMap) {
  // A post that the sonar to the left, half ahead, hears at 0.40 m.
  const auto speed_past_it = [](double error) {
    Driven scene;
    for (int i = 0; i < 9; ++i) {
      scene.shown.sonars = {{1, static_cast<std::uint16_t>(0.40 / scene.robot.range_unit)}};
      scene.cycle();
      const Pose robot = scene.all<CycleBegan>().back().state.pose_in_odom;
      const Vec2 post =
          transform(compose(robot, scene.robot.sonars[1].pose_in_robot), {0.40 + error, 0.0});
      DriveCommand command = scene.wish(Role::behaviors, 0.3);
      command.motion.rotation_velocity = 0.0;
      command.edges = {{post, post}};
      scene.tell(command);
    }
    return scene.all<GrantDecided>().back().guarded.velocity;
  };
  const double at_the_post = speed_past_it(0.0);
  EXPECT_DOUBLE_EQ(speed_past_it(0.1), at_the_post);
  const double strange = speed_past_it(0.3);
  EXPECT_LT(strange, 0.5 * at_the_post);
  EXPECT_GE(speed_past_it(std::numeric_limits<double>::quiet_NaN()), strange)
      << "an edge that is no number counts as none";
}

TEST(Status, ReactionsAreToldOnceASecond) {
  Driven scene;
  for (int i = 0; i < 25; ++i) {
    scene.cycle();
    scene.core.command(scene.wish(Role::behaviors, 0.01 * i), scene.now);
    scene.core.answer(scene.now);
    for (const Output& output : scene.core.take())
      if (std::holds_alternative<Answered>(output))
        scene.core.answered(scene.now + 0.004);
  }
  std::vector<StatusReport::Reaction> told;
  for (const StatusReport& report : scene.all<StatusReport>())
    if (report.reaction)
      told.push_back(*report.reaction);
  ASSERT_GE(told.size(), 2U);
  EXPECT_LE(told.size(), 3U);
  EXPECT_NEAR(told.back().mean, 0.004, 1e-9);
  EXPECT_NEAR(told.back().max, 0.004, 1e-9);
}

TEST(Audit, AProgramSpeaksForItselfUnlessItIsAService) {
  const v1::AuditEntry drove{.act = v1::AUDIT_DROVE, .who = "karen (operator)", .text = ""};
  const v1::AuditEntry wrong{.act = v1::AUDIT_REFUSED, .who = "somebody", .text = "1 wrong key"};
  Reports reports;
  EXPECT_EQ(reports.take(drove, Identity{"flakey", "services"}, 0.0), drove);
  EXPECT_EQ(reports.take(drove, std::nullopt, 0.0), drove) << "an open bus";
  EXPECT_EQ(reports.take(drove, Identity{"planner", "agent"}, 0.0), std::nullopt);
  const auto said = reports.take(wrong, Identity{"flakey", "operator"}, 0.0);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->who, "flakey (operator), somebody");
}

TEST(Audit, NobodyFillsItWithReports) {
  Reports reports;
  const auto taken = [&](const Identity& writer, double now) {
    std::size_t entries = 0;
    for (int i = 0; i < 1000; ++i)
      if (reports.take({.act = v1::AUDIT_REFUSED, .who = std::to_string(i), .text = ""}, writer,
                       now))
        ++entries;
    return entries;
  };
  const Identity liar{"liar", "observer"};
  EXPECT_EQ(taken(liar, 0.0), Reports::kMost + 1) << "and one that says so";
  EXPECT_EQ(taken(liar, 59.0), 0U);
  EXPECT_EQ(taken({"flakey", "operator"}, 59.0), Reports::kMost + 1);
  EXPECT_EQ(taken({"flakey", "services"}, 59.0), 1000U);
  EXPECT_EQ(taken(liar, 60.0), Reports::kMost + 1);
}

TEST(Doubts, AreShownForAWhileAndToldNowAndThen) {
  Doubts doubts;
  EXPECT_EQ(doubts.newest(0.5), "");
  EXPECT_FALSE(doubts.take_words(0.5));
  doubts.add({"sonar number 40", false}, 1.0);
  EXPECT_EQ(doubts.newest(2.9), "sonar number 40");
  EXPECT_EQ(doubts.newest(3.1), "");
  EXPECT_EQ(doubts.take_words(1.0), "sonar number 40");
  doubts.add({"a turn of 183 rad/s", true}, 1.1);
  EXPECT_EQ(doubts.newest(1.1), "a turn of 183 rad/s");
  EXPECT_FALSE(doubts.take_words(1.1)) << "ten a second would be read by nobody";
  EXPECT_EQ(doubts.take_words(11.2), "a turn of 183 rad/s");
  EXPECT_FALSE(doubts.take_words(30.0)) << "nothing new";
  EXPECT_EQ(doubts.count(), 2U);
  doubts.reset();
  EXPECT_EQ(doubts.count(), 0U);
  EXPECT_EQ(doubts.newest(11.2), "");
}

}  // namespace
}  // namespace saphira::bridge::test

// A stop in the core: at once, with the hardest brakes, and answered once the robot stands.
#include <gtest/gtest.h>

#include "scene.hpp"

namespace saphira::bridge::test {
namespace {

using authority::Role;

struct StopScene : Driven {
  explicit StopScene(Role role = Role::direct) : Driven(role) { shows(0.3); }

  /// The robot's packets show this speed [m/s].
  void shows(double velocity) {
    shown.left_velocity = shown.right_velocity = static_cast<std::int16_t>(velocity * 1000.0);
  }
  Answer stop() {
    const auto answer = core.request(
        {.functor = "stop", .arguments = {}, .source = "a person", .asker = 7, .number = ++asked},
        now);
    deliver();
    return answer.value();
  }
  std::vector<Answer> ends() const {
    std::vector<Answer> answers;
    for (const LaterAnswer& later : all<LaterAnswer>())
      answers.push_back(later.answer);
    return answers;
  }
  std::uint64_t asked = 0;
};

TEST(Stop, BrakesAtOnceAndAsHardAsItCan) {
  StopScene scene;
  scene.cycle();
  scene.drive(Role::direct, 0.3);
  scene.forget();
  const Answer answer = scene.stop();
  EXPECT_EQ(answer, (Answer{AnswerCode::underway, "stopped: direct (direct)"}));
  EXPECT_TRUE(scene.was_sent(protocol::EmergencyStop{}));
  ASSERT_TRUE(scene.has<GrantDecided>());
  EXPECT_EQ(scene.all<GrantDecided>().back().grant.stop, (v1::StopId{7, 1}));
  EXPECT_EQ(scene.core.grant().role, Role::none);
}

TEST(Stop, IsDoneOnceTheRobotIsAtRest) {
  StopScene scene;
  scene.stop();
  for (int i = 0; i < 5; ++i)
    scene.cycles(1, Role::direct, 0.3);
  EXPECT_EQ(scene.ends(), std::vector<Answer>{});
  EXPECT_FALSE(scene.was_moved());
  scene.shows(0.0);
  scene.cycle();
  EXPECT_EQ(
      scene.ends(),
      (std::vector<Answer>{{AnswerCode::done, "stopped: direct (direct); the robot is at rest"}}));
  scene.cycles(20, Role::direct, 0.3);
  EXPECT_FALSE(scene.was_moved()) << "its driver has not let go";
}

// The services hear of the stop before its asker goes on.
TEST(Stop, TakesTwoCyclesAtLeast) {
  StopScene scene;
  scene.shows(0.0);
  scene.cycle();
  scene.stop();
  scene.cycle();
  EXPECT_EQ(scene.ends().size(), 0U);
  scene.cycle();
  EXPECT_EQ(scene.ends().size(), 1U);
}

TEST(Stop, FailsWhereTheRobotMovesOn) {
  StopScene scene;
  scene.stop();
  for (int i = 0; i < 60; ++i)
    scene.cycle();
  ASSERT_EQ(scene.ends().size(), 1U);
  EXPECT_EQ(scene.ends()[0].code, AnswerCode::given_up);
}

TEST(Stop, SaysWhereSomebodyElseHasBegunToDrive) {
  StopScene scene;
  scene.stop();
  for (int i = 0; i < 3; ++i) {
    scene.cycle();
    scene.tell(scene.wish(Role::teleop, 0.2, 5));
  }
  ASSERT_EQ(scene.ends().size(), 1U);
  EXPECT_EQ(scene.ends()[0], (Answer{AnswerCode::done,
                                     "stopped: direct (direct); teleop has begun to drive since"}));
}

TEST(Stop, IsLostWithTheLink) {
  StopScene scene;
  scene.stop();
  scene.core.link_closed("cut", scene.now);
  scene.deliver();
  ASSERT_EQ(scene.ends().size(), 1U);
  EXPECT_EQ(scene.ends()[0].code, AnswerCode::lost);
}

TEST(Stop, WithoutARobotIsDoneAtOnceAndHoldsForLater) {
  StopScene scene;
  scene.core.link_closed("cut", scene.now);
  scene.deliver();
  EXPECT_EQ(scene.stop(),
            (Answer{AnswerCode::done, "stopped: direct (direct); no robot is connected"}));
  EXPECT_EQ(scene.core.grant().stop, (v1::StopId{7, 1}));
  scene.connect();
  scene.forget();
  scene.cycles(20, Role::direct, 0.3);
  EXPECT_FALSE(scene.was_moved()) << "it drove before the stop";
}

TEST(Stop, NamesThePersonBehindTheProgram) {
  StopScene scene;
  Request request{
      .functor = "stop", .arguments = {}, .source = "dialogue", .asker = 7, .number = 1};
  request.arguments.push_back({"by", std::string("karen")});
  scene.core.request(request, scene.now);
  EXPECT_EQ(scene.core.grant().stop_source, "karen, through dialogue");
}

// The audit: who drove, stopped, reset and was refused.
struct Audited : StopScene {
  /// Without the drivers that a stronger one keeps from driving.
  std::vector<std::string> acts() {
    std::vector<std::string> found;
    for (const v1::AuditEntry& entry : all<v1::AuditEntry>())
      if (!entry.text.starts_with("to drive"))
        found.push_back(std::to_string(static_cast<int>(entry.act)) + " " + entry.who);
    forget();
    return found;
  }
  static std::string act(v1::AuditAct act, const std::string& who) {
    return std::to_string(static_cast<int>(act)) + " " + who;
  }
};

TEST(Audit, NamesEachDriverOnceAndWhoStops) {
  Audited scene;
  scene.cycles(3, Role::direct, 0.1);
  EXPECT_EQ(scene.acts(), std::vector<std::string>{}) << "it drove before";
  scene.drive(Role::teleop, 0.1);
  scene.cycles(3, Role::teleop, 0.1);
  EXPECT_EQ(scene.acts(), std::vector{Audited::act(v1::AUDIT_DROVE, "teleop")});
  scene.stop();
  EXPECT_EQ(scene.acts(), std::vector{Audited::act(v1::AUDIT_STOPPED, "a person")});
}

TEST(Audit, NamesWhoIsRefusedOnceUnderADriver) {
  Audited scene;
  scene.drive(Role::teleop, 0.1);
  for (int i = 0; i < 5; ++i) {
    scene.tell(scene.wish(Role::direct, 0.1));
    scene.cycles(1, Role::teleop, 0.1);
  }
  const std::vector<v1::AuditEntry> entries = scene.all<v1::AuditEntry>();
  EXPECT_EQ(std::count_if(entries.begin(), entries.end(),
                          [](const v1::AuditEntry& entry) {
                            return entry.act == v1::AUDIT_REFUSED && entry.who == "direct";
                          }),
            1);
}

TEST(Audit, NamesWhoPressesAndResetsTheEmergencyStop) {
  Audited scene;
  scene.estop(true);
  EXPECT_EQ(scene.acts(),
            std::vector{Audited::act(v1::AUDIT_STOPPED, scene.core.latches().estop_source)});
  scene.reset("karen");
  scene.deliver();
  EXPECT_EQ(scene.acts(), std::vector{Audited::act(v1::AUDIT_REFUSED, "karen")})
      << "it is still pressed";
  scene.estop(false);
  scene.reset("karen");
  scene.deliver();
  EXPECT_EQ(scene.acts(), std::vector{Audited::act(v1::AUDIT_RESET, "karen")});
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

}  // namespace
}  // namespace saphira::bridge::test

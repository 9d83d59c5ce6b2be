#include "saphira/behaviors/executive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "pioneer.hpp"

namespace saphira::behaviors {
namespace {

/// Counts the calls.
struct Counts {
  int made = 0;
  int inits = 0;
  int updates = 0;
  double last = 0.0;
};
class Probe : public Behavior {
 public:
  explicit Probe(Counts& counts) : counts_(&counts) { ++counts_->made; }
  void init(const Parameters&, const Context&) override { ++counts_->inits; }
  Evaluation update(const Parameters& parameters, const Context&) override {
    ++counts_->updates;
    counts_->last = parameters.number("value");
    return {{{"go", 1.0, Action::speed, counts_->last}}, {.speed = 1.0}};
  }

 private:
  Counts* counts_;
};

class ExecutiveTest : public ::testing::Test {
 protected:
  ExecutiveTest() : executive_(predefined(), pioneer()) {
    executive_.registry().add(
        {"Probe", "", {number_parameter("value", "m/s", 0.0, 1.0, 0.5)}, [this] {
           return std::make_unique<Probe>(counts_);
         }});
  }
  Output step(std::vector<Intended> behaviors, bool control = true) {
    ++cycle_;
    const Intent intent{cycle_ - 1, control, std::move(behaviors)};
    return executive_.step({cycle_, robot_, {}, &intent});
  }

  Counts counts_;
  Executive executive_;
  RobotNow robot_;
  std::uint64_t cycle_ = 10;
};

TEST_F(ExecutiveTest, MakesWhatIsIntendedAndKeepsIt) {
  step({{"p", "Probe", 0, true, {}}});
  const Output output = step({{"p", "Probe", 0, true, {}}});
  EXPECT_EQ(counts_.made, 1);
  EXPECT_EQ(counts_.inits, 1);
  EXPECT_EQ(counts_.updates, 2);
  EXPECT_TRUE(output.active);
  EXPECT_EQ(output.blend.speed, 0.5);
  EXPECT_EQ(output.speed, 0.4);  // limited to the robot's
}

TEST_F(ExecutiveTest, AnIntendedLimitCapsTheSpeedAndIsNamed) {
  Intent intent{20, true, {{"p", "Probe", 0, true, {}}}, 0.1, "slow zone 7"};
  Output output = executive_.step({21, robot_, {}, &intent});
  EXPECT_EQ(output.speed, 0.1);
  EXPECT_EQ(output.speed_limit, 0.1);
  EXPECT_EQ(output.limit_reason, "slow zone 7");
  intent = {21, true, {{"p", "Probe", 0, true, {number("value", 0.05)}}}, 0.1, "slow zone 7"};
  output = executive_.step({22, robot_, {}, &intent});
  EXPECT_EQ(output.speed, 0.05);
  EXPECT_EQ(output.limit_reason, "") << "it is slower anyway";
  intent = {22, true, {{"p", "Probe", 0, true, {}}}};
  output = executive_.step({23, robot_, {}, &intent});
  EXPECT_EQ(output.speed, 0.4);
  EXPECT_LT(output.speed_limit, 0.0);
}

TEST_F(ExecutiveTest, TakesOverChangedParametersWithoutInit) {
  step({{"p", "Probe", 0, true, {}}});
  step({{"p", "Probe", 3, true, {number("value", 0.25)}}});
  EXPECT_EQ(counts_.inits, 1);
  EXPECT_EQ(counts_.last, 0.25);
}

TEST_F(ExecutiveTest, RemovesWhatIsNotIntended) {
  step({{"p", "Probe", 0, true, {}}});
  const Output output = step({});
  EXPECT_TRUE(output.behaviors.empty());
  EXPECT_FALSE(output.active);
  step({{"p", "Probe", 0, true, {}}});
  EXPECT_EQ(counts_.inits, 2);
}

TEST_F(ExecutiveTest, ContactIsMeantWhereAllMeanIt) {
  const auto bump = [](double contact, const char* name = "bump") {
    return Intended{
        name, "ConstantVelocity", 2, true, {number("speed", 0.2), number("contact", contact)}};
  };
  EXPECT_EQ(step({{"go", "ConstantVelocity", 2, true, {}}}).contact_speed, 0.0);
  EXPECT_EQ(step({bump(0.1)}).contact_speed, 0.1);
  EXPECT_EQ(step({bump(0.1), bump(0.05, "softly")}).contact_speed, 0.05);
  EXPECT_EQ(step({bump(0.1), {"p", "Probe", 2, true, {}}}).contact_speed, 0.0)
      << "the other one does not mean it";
  EXPECT_EQ(step({bump(0.1), {"stop", "Stop", 3, true, {}}}).contact_speed, 0.1)
      << "the other one has no say";
  EXPECT_EQ(step({bump(0.1), {"stop", "Stop", 0, true, {}}}).contact_speed, 0.0);
  EXPECT_FALSE(step({bump(0.5)}).missing.empty()) << "that is no creeping";
}

TEST_F(ExecutiveTest, HeldItTurnsItsSonarsToAndFro) {
  const auto swing = [&] { return step({{"p", "Probe", 0, true, {}}}).heading_in_odom; };
  for (int cycle = 0; cycle < 19; ++cycle)
    EXPECT_EQ(swing(), 0.0);
  for (int cycle = 0; cycle < 20; ++cycle)
    EXPECT_NEAR(swing(), radians(20.0), 1e-9);
  for (int cycle = 0; cycle < 20; ++cycle)
    EXPECT_NEAR(swing(), -radians(20.0), 1e-9);
  for (const double wider : {40.0, -40.0, 60.0, -60.0, 60.0})
    for (int cycle = 0; cycle < 20; ++cycle)
      EXPECT_NEAR(swing(), radians(wider), 1e-9);
  robot_.velocity = 0.1;
  EXPECT_EQ(swing(), 0.0) << "it drives again";
}

TEST_F(ExecutiveTest, AnotherSchemaIsAnotherBehavior) {
  step({{"p", "Probe", 0, true, {}}});
  const Output output = step({{"p", "Stop", 0, true, {}}});
  EXPECT_EQ(output.behaviors.at(0).schema, "Stop");
}

TEST_F(ExecutiveTest, SetOffItStaysAndDoesNotRun) {
  const Output off = step({{"p", "Probe", 0, false, {}}});
  ASSERT_EQ(off.behaviors.size(), 1U);
  EXPECT_FALSE(off.behaviors[0].running);
  EXPECT_EQ(counts_.updates, 0);
  EXPECT_FALSE(off.active);
  EXPECT_TRUE(step({{"p", "Probe", 0, true, {}}}).active);
  EXPECT_EQ(counts_.made, 1);
}

TEST_F(ExecutiveTest, WithoutControlBehaviorsAreStillEvaluated) {
  const Output output = step({{"p", "Probe", 0, true, {}}}, false);
  EXPECT_EQ(counts_.updates, 1);
  EXPECT_TRUE(output.blend.moving);
  EXPECT_FALSE(output.active);
  EXPECT_EQ(output.inactive_reason, "behavior control is off");
}

TEST_F(ExecutiveTest, AnOldIntentDoesNotDrive) {
  const Intent intent{100, true, {{"p", "Probe", 0, true, {}}}};
  EXPECT_TRUE(executive_.step({101, robot_, {}, &intent}).active);
  EXPECT_TRUE(executive_.step({102, robot_, {}, &intent}).active);
  const Output output = executive_.step({103, robot_, {}, &intent});
  EXPECT_FALSE(output.active);
  EXPECT_EQ(output.inactive_reason,
            "no newer intent has come for 2 cycles: intentions, or the network to it, is slow or gone");
  EXPECT_FALSE(executive_.step({104, robot_, {}, nullptr}).active);
}

TEST_F(ExecutiveTest, OneThatCannotBeMadeIsMissing) {
  executive_.registry().add({"Thrower", "", {}, []() -> std::unique_ptr<Behavior> {
                               throw std::runtime_error("no camera");
                             }});
  executive_.registry().add(
      {"Nothing", "", {}, []() -> std::unique_ptr<Behavior> { return nullptr; }});
  const Output output = step(
      {{"a", "Thrower", 0, true, {}}, {"b", "Nothing", 0, true, {}}, {"p", "Probe", 0, true, {}}});
  ASSERT_EQ(output.missing.size(), 2U);
  EXPECT_EQ(output.missing[0].reason, "no camera");
  EXPECT_EQ(output.missing[1].reason, "its schema has made none");
  EXPECT_EQ(output.inactive_reason, "a cannot be made: no camera");
  EXPECT_EQ(counts_.updates, 1);
}

TEST_F(ExecutiveTest, SaysWhatIsWrongAndDoesNotDriveWithoutIt) {
  const Output output = step({{"a", "Fly", 0, true, {}},
                              {"b", "GoToPos", 1, true, {number("speed", 0.2)}},
                              {"c", "GoToPos", 1, true, {number("goal", 0.2)}},
                              {"d", "KeepOff", 1, true, {number("caution", 0.2)}},
                              {"e", "KeepOff", 1, true, {number("sensitivity", 7.0)}},
                              {"f", "Probe", 2, true, {}},
                              {"f", "Stop", 2, true, {}},
                              {"g", "TurnTo", 2, true, {point("goal", {}, Frame::map)}}});
  ASSERT_EQ(output.behaviors.size(), 1U);
  EXPECT_EQ(counts_.updates, 1) << "the others are evaluated";
  EXPECT_FALSE(output.active);
  EXPECT_EQ(output.inactive_reason.find("a cannot be made: unknown schema \"Fly\""), 0U)
      << output.inactive_reason;
  EXPECT_TRUE(step({{"a", "Fly", 0, false, {}}, {"f", "Probe", 2, true, {}}}).active)
      << "what is not to run is not missed";
  for (const char* part :
       {"a: unknown schema \"Fly\"", "b: parameter \"goal\" is missing: expected a point",
        "c: parameter \"goal\": expected a point", "d: unknown parameter \"caution\"",
        "e: parameter \"sensitivity\": expected a number from 0.2 to 2",
        "f: the name is there twice", "g: parameter \"goal\": expected a point in odom"})
    EXPECT_NE(output.trouble.find(part), std::string::npos) << part << "\n" << output.trouble;
}

TEST_F(ExecutiveTest, OrderOfTheSetDoesNotShow) {
  const Output output = step({{"z", "Stop", 1, true, {}},
                              {"b", "Probe", 1, true, {}},
                              {"y", "AvoidCollision", 0, true, {}}});
  ASSERT_EQ(output.behaviors.size(), 3U);
  EXPECT_EQ(output.behaviors[0].name, "y");
  EXPECT_EQ(output.behaviors[1].name, "b");
  EXPECT_EQ(output.behaviors[2].name, "z");
}

TEST_F(ExecutiveTest, NobodyRecommendsASpeedThenItStands) {
  robot_.velocity = 0.3;
  const Output output = step({{"t", "TurnTo", 0, true, {point("goal", {0.0, 5.0, 0.0})}}});
  EXPECT_TRUE(output.active);
  EXPECT_FALSE(output.blend.moving);
  EXPECT_EQ(output.speed, 0.0);
  EXPECT_GT(output.heading_in_odom, 0.0);
}

TEST_F(ExecutiveTest, APointInTheRobotsFrameIsPlacedOnce) {
  robot_.pose_in_odom = {1.0, 0.0, kPi / 2};
  const std::vector<Intended> set{
      {"g", "GoToPos", 0, true, {point("goal", {2.0, 0.0, 0.0}, Frame::robot)}}};
  EXPECT_NEAR(step(set).heading_in_odom, kPi / 2, 1e-9);
  // A point that moved along would still be ahead.
  robot_.pose_in_odom = {2.0, 2.0, kPi / 2};
  EXPECT_EQ(step(set).behaviors[0].blended.evaluation.rules[0].strength, 1.0);
  EXPECT_GT(step(set).blend.turn, 0.3);
}

/// A faulty behavior of a plug-in.
class Faulty : public Behavior {
 public:
  Evaluation update(const Parameters& parameters, const Context&) override {
    if (parameters.number("throws") > 0.5)
      throw std::runtime_error("no idea");
    return {{{"go", 1.0, Action::speed, std::nan("")}, {"turn", INFINITY, Action::turn_left, 0.1}},
            {.turn = 1.0, .speed = 1.0}};
  }
};

TEST_F(ExecutiveTest, ABehaviorThatThrowsOrIsNotANumberDoesNotDriveAndIsTold) {
  executive_.registry().add({"Faulty", "", {number_parameter("throws", "", 0.0, 1.0, 0.0)}, [] {
                               return std::make_unique<Faulty>();
                             }});
  for (const double throws : {0.0, 1.0}) {
    const Output output =
        step({{"f", "Faulty", 0, true, {number("throws", throws)}}, {"p", "Probe", 1, true, {}}});
    EXPECT_EQ(output.trouble,
              throws > 0.0 ? "f: no idea"
                           : "f: rule \"go\" is not a number, rule \"turn\" is not a number");
    EXPECT_EQ(output.behaviors.size(), 2U);
    EXPECT_EQ(counts_.updates, throws > 0.0 ? 2 : 1);
    EXPECT_EQ(output.heading_in_odom, 0.0);
  }
}

// Sonars miss an obstacle that touches the hull between two beams: a stall reveals it.
TEST_F(ExecutiveTest, ItTurnsAwayFromWhatItHasRunInto) {
  const auto drive = [&] {
    return step({{"avoid", "AvoidCollision", 0, true, {}},
                 {"on", "ConstantVelocity", 1, true, {number("speed", 0.2)}}});
  };
  EXPECT_GT(drive().speed, 0.1);
  robot_.left_stalled = true;
  const Output left = drive();
  EXPECT_LT(left.speed, 0.02);
  EXPECT_LT(left.heading_in_odom, 0.0);
  EXPECT_TRUE(std::any_of(executive_.lps().obstacles().begin(), executive_.lps().obstacles().end(),
                          [](const Vec2& at) { return at.y() > 0.1 && at.x() > 0.0; }));
}

TEST_F(ExecutiveTest, ResetBeginsAnew) {
  step({{"p", "Probe", 0, true, {}}});
  executive_.reset();
  step({{"p", "Probe", 0, true, {}}});
  EXPECT_EQ(counts_.inits, 2);
}

TEST_F(ExecutiveTest, EverySchemaRunsOnItsDefaults) {
  for (const std::string& name : executive_.registry().names()) {
    std::vector<Argument> arguments;
    for (const ParameterSpec& spec : executive_.registry().find(name)->parameters)
      if (spec.required)
        arguments.push_back(spec.kind == Kind::point ? point(spec.name, {3.0, 0.0, 0.0})
                                                     : number(spec.name, 300.0));
    const Output output = step({{name, name, 0, true, arguments}});
    EXPECT_EQ(output.trouble, "");
    ASSERT_EQ(output.behaviors.size(), 1U);
    EXPECT_FALSE(output.behaviors[0].blended.evaluation.rules.empty()) << name;
  }
}

}  // namespace
}  // namespace saphira::behaviors

#include "saphira/behaviors/executive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "arguments.hpp"
#include "lines.hpp"
#include "pioneer.hpp"
#include "saphira/base/numbers.hpp"

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

/// The executive, by whose steps a robot is driven.
struct Executed {
  Executed() {
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
  Executive executive_{predefined(), pioneer()};
  RobotNow robot_;
  std::uint64_t cycle_ = 10;
};

/// One case of executive.txt.
class Intentions : public test::LinePlayer, private Executed {
 public:
  Intentions() {
    Registry& schemas = executive_.registry();
    schemas.add({"Faulty", "", {number_parameter("throws", "", 0.0, 1.0, 0.0)}, [] {
                   return std::make_unique<Faulty>();
                 }});
    schemas.add({"Thrower", "", {}, []() -> std::unique_ptr<Behavior> {
                   throw std::runtime_error("no camera");
                 }});
    schemas.add({"Nothing", "", {}, []() -> std::unique_ptr<Behavior> { return nullptr; }});
    events_ = {ON("none", set_.clear()),
               ON("with", intend(in, true)),
               ON("off", intend(in, false)),
               ON("step", now_ = step(set_)),
               ON("step-without-control", now_ = step(set_, false)),
               ON("moves", robot_.velocity = read<double>(in)),
               ON("reset", executive_.reset()),
               ON("inactive", expect_like(now_.inactive_reason, rest(in))),
               ON("trouble", expect_like(now_.trouble, rest(in))),
               ON("missing", expect_like(missing(), rest(in)))};
    facts_ = {IS("made", std::to_string(counts_.made)),
              IS("inits", std::to_string(counts_.inits)),
              IS("updates", std::to_string(counts_.updates)),
              IS("value", decimal(counts_.last, 3)),
              IS("active", yes(now_.active)),
              IS("moving", yes(now_.blend.moving)),
              IS("blend", decimal(now_.blend.speed, 3)),
              IS("speed", decimal(now_.speed, 3)),
              IS("contact", decimal(now_.contact_speed, 3)),
              IS("heading", decimal(degrees(now_.heading_in_odom), 3)),
              IS("behaviors", behaviors())};
  }

 private:
  void intend(std::istringstream& in, bool running) {
    Intended one;
    in >> one.name >> one.schema;
    one.priority = read<int>(in);
    one.running = running;
    one.parameters = test::arguments_of(rest(in), Frame::odom);
    set_.push_back(one);
  }
  std::string missing() const {
    return joined(now_.missing, ", ",
                  [](const Missing& one) { return one.name + ": " + one.reason; });
  }
  std::string behaviors() const {
    return joined(now_.behaviors, ", ", [](const BehaviorState& one) {
      return one.name + " of " + one.schema + (one.running ? "" : " off");
    });
  }

  std::vector<Intended> set_;
  Output now_;
};

TEST(Executive, DoesAsWritten) {
  EXPECT_EQ(test::play<Intentions>("services/behaviors/test/executive.txt"), 14);
}

class ExecutiveTest : public ::testing::Test, protected Executed {};

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

TEST_F(ExecutiveTest, AnOldIntentDoesNotDrive) {
  const Intent intent{100, true, {{"p", "Probe", 0, true, {}}}};
  EXPECT_TRUE(executive_.step({101, robot_, {}, &intent}).active);
  EXPECT_TRUE(executive_.step({102, robot_, {}, &intent}).active);
  const Output output = executive_.step({103, robot_, {}, &intent});
  EXPECT_FALSE(output.active);
  EXPECT_EQ(
      output.inactive_reason,
      "no newer intent has come for 2 cycles: intentions, or the network to it, is slow or gone");
  EXPECT_FALSE(executive_.step({104, robot_, {}, nullptr}).active);
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

#include <gtest/gtest.h>

#include "node_options.hpp"
#include "saphira/runtime/component.hpp"
#include "saphira/runtime/wiring.hpp"

namespace saphira::runtime {
namespace {

/// The inputs that a service saw.
struct Seen {
  int made = 0;
  std::vector<v1::Stamp> steps;
  std::vector<bool> new_robot;
  std::vector<bool> new_frame;
  int between = 0;
  int looks = 0;
  std::string missing;  ///< the result of its gate
};

/// A service that repeats the intent, and asks for a map.
class Repeater final : public Service {
 public:
  Repeater(Ports& ports, Seen& seen)
      : ports_(ports),
        seen_(seen),
        intentions_(ports.cycle(bus::topics::kIntentions)),
        messages_(ports.events(bus::topics::kMessages)),
        behaviors_(ports.each_cycle(bus::topics::kBehaviors)),
        beliefs_(ports.changes(bus::topics::kBeliefs)) {
    ++seen.made;
    ports.gate([&seen](const v1::RobotState&) { return seen.missing; });
  }
  ProcessTable& processes() override { return table_; }
  void step(const Turn& turn) override {
    seen_.steps.push_back(turn.stamp);
    seen_.new_robot.push_back(turn.new_robot);
    seen_.new_frame.push_back(turn.new_frame);
    EXPECT_EQ(turn.description.stamp.epoch, turn.stamp.epoch);
    behaviors_.write({.control = intentions_.value() != nullptr});
    Notes notes;
    for (const auto& message : messages_.take())
      notes.warn(message.data.text);
    ports_.say(notes.lines());
    if (!notes.empty())
      ports_.degrade("somebody spoke");
  }
  void between(double /*silence*/) override { ++seen_.between; }
  void check_files() override { ++seen_.looks; }

 private:
  Ports& ports_;
  Seen& seen_;
  bus::Input<v1::Intentions>& intentions_;
  bus::Reader<v1::Message> messages_;
  Output<v1::BehaviorSet> behaviors_;
  Output<v1::BeliefSet> beliefs_;
  ProcessTable table_;
};

class RuntimeTest : public testing::TestWithParam<bool> {
 protected:
  void state(std::uint64_t odom = 1) {
    if (cycle_ == 0) {
      descriptions_.write({.stamp = {.epoch = epoch_}});
    }
    states_.write({.stamp = {epoch_, ++cycle_}, .odom = odom});
  }
  void intend() { intentions_.write({.stamp = {epoch_, cycle_}}); }

  std::shared_ptr<bus::MemoryBus> memory_ = bus::make_memory_bus();
  bus::Node bridge_{test::memory_options("bridge", GetParam()), memory_};
  bus::Node node_{test::memory_options("repeater", GetParam()), memory_};
  bus::Writer<v1::RobotState> states_{bridge_.writer(bus::topics::kRobotState)};
  bus::Writer<v1::RobotDescription> descriptions_{bridge_.writer(bus::topics::kRobotDescription)};
  bus::Writer<v1::Intentions> intentions_{bridge_.writer(bus::topics::kIntentions)};
  bus::Reader<v1::BehaviorSet> behaviors_{bridge_.reader(bus::topics::kBehaviors)};
  Seen seen_;
  Shell shell_{node_, [this](Ports& ports) { return std::make_unique<Repeater>(ports, seen_); }};
  std::uint64_t epoch_ = 7;
  std::uint64_t cycle_ = 0;
};
INSTANTIATE_TEST_SUITE_P(LiveAndLockstep, RuntimeTest, testing::Bool());

TEST_P(RuntimeTest, StepsWhatIsDueAndNeverWaits) {
  EXPECT_FALSE(shell_.advance());
  state();
  EXPECT_TRUE(shell_.advance());
  EXPECT_FALSE(shell_.advance());
  const auto told = behaviors_.take_newest();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->stamp.epoch, 7U) << "the shell stamps what is written";
  EXPECT_EQ(told->stamp.cycle, 1U);
  EXPECT_FALSE(told->control);
  intend();
  state();
  EXPECT_TRUE(shell_.advance());
  EXPECT_TRUE(behaviors_.take_newest()->control);
}

TEST_P(RuntimeTest, TellsNewRobotsAndNewFrames) {
  const auto step = [&](std::uint64_t odom) {
    state(odom);
    EXPECT_TRUE(shell_.advance());
    intend();
  };
  step(1);
  step(1);
  step(2);
  step(2);
  epoch_ = 8;
  cycle_ = 0;
  step(3);
  EXPECT_EQ(seen_.new_robot, (std::vector<bool>{true, false, false, false, true}));
  EXPECT_EQ(seen_.new_frame, (std::vector<bool>{false, false, true, false, false}));
}

TEST_P(RuntimeTest, AGateHoldsLockstepAlone) {
  seen_.missing = "a letter";
  state();
  EXPECT_EQ(shell_.advance(), !GetParam());
  seen_.missing.clear();
  EXPECT_EQ(shell_.advance(), GetParam());
  EXPECT_EQ(seen_.steps.size(), 1U);
}

TEST_P(RuntimeTest, WaitsWhileAnotherOfItsNameServesAndIsMadeAnewThen) {
  Seen seen;
  std::optional<bus::Node> node(std::in_place, test::memory_options("repeater", GetParam()),
                                memory_);
  std::optional<Shell> other(std::in_place, *node,
                             [&](Ports& ports) { return std::make_unique<Repeater>(ports, seen); });
  state();
  ASSERT_TRUE(other->advance());
  EXPECT_FALSE(shell_.advance());
  shell_.idle();
  EXPECT_EQ(seen_.between, 0);
  EXPECT_EQ(node_.status().state, v1::SERVICE_WAITING);
  other.reset();
  node.reset();
  EXPECT_FALSE(shell_.advance());
  EXPECT_EQ(seen_.made, 1);
  const bool knows_the_state = shell_.advance();  // in lockstep it is kept
  EXPECT_EQ(seen_.made, 2);
  state();
  EXPECT_TRUE(knows_the_state || shell_.advance());
  EXPECT_EQ(seen_.steps.size(), 1U);
}

TEST_P(RuntimeTest, SaysThatItIsDegradedForOneStep) {
  bus::Writer<v1::Message> messages{bridge_.writer(bus::topics::kMessages)};
  state();
  shell_.advance();
  intend();
  messages.write({});
  state();
  ASSERT_TRUE(shell_.advance());
  EXPECT_EQ(node_.status().state, v1::SERVICE_DEGRADED);
  EXPECT_EQ(node_.status().reason, "somebody spoke");
  intend();
  state();
  ASSERT_TRUE(shell_.advance());
  EXPECT_EQ(node_.status().state, v1::SERVICE_RUNNING);
}

TEST_P(RuntimeTest, LooksAtFilesBehindTheSteps) {
  for (int i = 0; i < 200; ++i) {
    state();
    ASSERT_TRUE(shell_.advance());
    intend();
  }
  EXPECT_EQ(seen_.looks, GetParam() ? 2 : 20);
}

TEST_P(RuntimeTest, KnowsItsPorts) {
  const std::vector<Port> ports{
      {"robot/state", Port::Use::kState},    {"robot/description", Port::Use::kState},
      {"intentions", Port::Use::kCycle},     {"messages", Port::Use::kEvents},
      {"behaviors/state", Port::Use::kEach}, {"beliefs", Port::Use::kChanges}};
  EXPECT_EQ(shell_.ports().table(), ports);
  const Component component{"repeater", "repeats", {}, [this](Ports& made) {
                              return std::make_unique<Repeater>(made, seen_);
                            }};
  EXPECT_EQ(ports_of(component), ports);
}

const std::vector<Unit> kUnits{
    {"bridge", "drives", {{"robot/state", Port::Use::kEach}, {"drive", Port::Use::kEvents}}},
    {"behaviors", "thinks", {{"robot/state", Port::Use::kState}, {"drive", Port::Use::kEach}}}};

TEST(Wiring, HasALineForEachTopic) {
  const std::vector<Line> lines = lines_of(kUnits);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].topic, "robot/state");
  ASSERT_EQ(lines[0].writers.size(), 1U);
  EXPECT_EQ(lines[0].writers[0].unit, 0U);
  ASSERT_EQ(lines[0].readers.size(), 1U);
  EXPECT_EQ(lines[0].readers[0].unit, 1U);
}

TEST(Wiring, IsATableAndADrawing) {
  EXPECT_EQ(wiring_table(kUnits),
            "| topic | written by | read by |\n|---|---|---|\n"
            "| robot/state | bridge (each cycle) | behaviors (cycle N) |\n"
            "| drive | behaviors (each cycle) | bridge (every sample) |\n");
  EXPECT_EQ(wiring_text(kUnits),
            "robot/state  bridge (each cycle) -> behaviors (cycle N)\n"
            "drive        behaviors (each cycle) -> bridge (every sample)\n");
  const std::string drawing = wiring_drawing(kUnits);
  for (const char* part : {"<svg ", ">bridge<", ">behaviors<", ">robot/state<", "</svg>"})
    EXPECT_NE(drawing.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace saphira::runtime

#include "saphira/bus/cycle.hpp"

#include <poll.h>

#include <set>
#include <thread>

#include "harness.hpp"

namespace saphira::bus::test {
namespace {

// A bridge and an intentions service that are written by hand, and a service that steps.
class Cycles : public OnEachBus {
 protected:
  void start(bool lockstep) {
    bridge_ = node("bridge", "", lockstep);
    other_ = node("intentions", "", lockstep);
    service_ = node("service", "", lockstep);
    cycle_ = std::make_unique<Cycle>(*service_);
    input_ = &cycle_->input(topics::kIntentions);
    description_.emplace(bridge_->writer(topics::kRobotDescription));
    robot_.emplace(bridge_->writer(topics::kRobotState));
    intentions_.emplace(other_->writer(topics::kIntentions));
    ASSERT_TRUE(eventually(*bridge_, [&] { return robot_->matched() == 1; }));
    ASSERT_TRUE(eventually(*other_, [&] { return intentions_->matched() == 1; }));
    ASSERT_TRUE(eventually(*service_, [&] { return cycle_->connected(); }));
  }

  // The next step, or nothing when there is none for so long.
  std::optional<Step> next(milliseconds patience) { return next(*cycle_, patience); }
  static std::optional<Step> next(Cycle& cycle, milliseconds patience) {
    Stop stop;
    Stop over;
    std::thread guard([&] {
      pollfd fd{over.fd(), POLLIN, 0};
      if (poll(&fd, 1, static_cast<int>(patience.count())) == 0)
        stop.request();
    });
    auto result = cycle.next(stop);
    over.request();
    guard.join();
    return result;
  }
  std::uint64_t step() {
    const auto result = next(milliseconds(10000));
    if (!result)
      return 0;
    cycle_->done();
    return result->robot.stamp.cycle;
  }
  std::uint64_t step(std::uint64_t epoch, std::uint64_t number) {
    send(epoch, number);
    return step();
  }
  /// On DDS there is none for so long; samples of the memory transport arrive at once.
  bool no_step() {
    const bool came = GetParam() == "dds" && next(milliseconds(200));
    return !came && !cycle_->poll();
  }

  // Live samples are read one by one: they are not kept for a reader that is behind.
  void send(std::uint64_t epoch, std::uint64_t number) {
    if (described_.insert(epoch).second)
      description_->write(description(epoch));
    robot_->write(robot_state(epoch, number));
  }
  void send_intentions(std::uint64_t epoch, std::uint64_t number) {
    intentions_->write(intentions(epoch, number));
    // Two topics have no order between them; here the input is to be there first.
    service_->wait(milliseconds(GetParam() == "dds" ? 50 : 0));
  }

  std::unique_ptr<Node> bridge_;
  std::unique_ptr<Node> other_;
  std::unique_ptr<Node> service_;
  std::unique_ptr<Cycle> cycle_;
  Input<v1::Intentions>* input_ = nullptr;
  std::set<std::uint64_t> described_;
  std::optional<Writer<v1::RobotDescription>> description_;
  std::optional<Writer<v1::RobotState>> robot_;
  std::optional<Writer<v1::Intentions>> intentions_;
};
INSTANTIATE_TEST_SUITE_P(Over, Cycles, testing::Values("memory", "dds"),
                         [](const auto& bus) { return bus.param; });

TEST_P(Cycles, LiveStepsOnEachStateWithTheInputOfTheCycleBefore) {
  start(false);
  send(1, 1);
  const auto first = next(milliseconds(10000));
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->new_epoch);
  EXPECT_EQ(input_->value(), nullptr);
  EXPECT_EQ(cycle_->stamp().epoch, 1U);
  EXPECT_EQ(cycle_->stamp().cycle, 1U);
  cycle_->done();
  send_intentions(1, 1);
  send(1, 2);
  const auto second = next(milliseconds(10000));
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->new_epoch);
  EXPECT_FALSE(second->stale);
  ASSERT_NE(input_->value(), nullptr);
  EXPECT_EQ(input_->value()->stamp.cycle, 1U);
  cycle_->done();
  EXPECT_EQ(service_->status().steps, 2U);
  EXPECT_EQ(service_->status().late_cycles, 0U);
  EXPECT_EQ(service_->status().state, v1::SERVICE_RUNNING);
  EXPECT_TRUE(no_step());
}

TEST_P(Cycles, LiveGoesOnWithAnOldInputAndSaysSo) {
  start(false);
  EXPECT_EQ(step(1, 1), 1U);
  send_intentions(1, 1);
  for (std::uint64_t number = 2; number <= 4; ++number) {
    send(1, number);
    const auto result = next(milliseconds(10000));
    ASSERT_TRUE(result);
    EXPECT_EQ(result->stale, number > 2);
    ASSERT_NE(input_->value(), nullptr);
    EXPECT_EQ(input_->value()->stamp.cycle, 1U);
    cycle_->done();
  }
  EXPECT_EQ(service_->status().late_cycles, 2U);
  EXPECT_EQ(service_->status().state, v1::SERVICE_DEGRADED);
  EXPECT_NE(service_->status().reason.find("intentions"), std::string::npos);
}

TEST_P(Cycles, LiveNeverReadsTheCycleThatIsBeingComputed) {
  start(false);
  EXPECT_EQ(step(1, 1), 1U);
  send_intentions(1, 1);
  send_intentions(1, 2);
  send(1, 2);
  ASSERT_EQ(step(), 2U);
  ASSERT_NE(input_->value(), nullptr);
  EXPECT_EQ(input_->value()->stamp.cycle, 1U);
}

TEST_P(Cycles, LiveSkipsToTheNewestAndCounts) {
  start(false);
  EXPECT_EQ(step(1, 1), 1U);
  for (std::uint64_t number = 2; number <= 6; ++number)
    send(1, number);
  std::uint64_t number = 1;
  while (number < 6) {  // over DDS some of them may come one by one
    const std::uint64_t stepped = step();
    ASSERT_GT(stepped, number);
    number = stepped;
  }
  const std::uint64_t steps = service_->status().steps;
  EXPECT_GE(service_->status().late_cycles, 6U - steps);
  if (GetParam() == "memory") {
    EXPECT_EQ(steps, 2U);
    EXPECT_EQ(service_->status().late_cycles, 4U + 1U);  // four skipped, one on stale input
  }
}

TEST_P(Cycles, SamplesOfAnEpochThatWasLeftAreRefused) {
  start(false);
  EXPECT_EQ(step(1, 1), 1U);
  send(2, 1);
  const auto fresh = next(milliseconds(10000));
  ASSERT_TRUE(fresh);
  EXPECT_TRUE(fresh->new_epoch);
  EXPECT_EQ(cycle_->stamp().epoch, 2U);
  cycle_->done();
  EXPECT_EQ(service_->status().refused_samples, 0U);
  send(1, 2);
  send_intentions(1, 1);
  EXPECT_TRUE(no_step());
  EXPECT_EQ(service_->status().refused_samples, 2U);
  send(2, 2);
  ASSERT_EQ(step(), 2U);
  EXPECT_EQ(input_->value(), nullptr);
  EXPECT_EQ(service_->status().state, v1::SERVICE_DEGRADED);
}

TEST_P(Cycles, SecondBridgeIsRefusedAndNamedUntilTheFirstIsGone) {
  start(false);
  EXPECT_EQ(step(1, 1), 1U);
  auto second = node("second-bridge");
  auto describes = second->writer(topics::kRobotDescription);
  auto writer = second->writer(topics::kRobotState);
  ASSERT_TRUE(
      eventually(*second, [&] { return writer.matched() == 1 && describes.matched() > 0; }));
  describes.write(description(2));
  // The reader may know of the writer later than the writer of the reader.
  ASSERT_TRUE(eventually(*service_, [&] {
    writer.write(robot_state(2, 50));
    next(milliseconds(1));
    return service_->status().refused_samples > 0;
  }));
  EXPECT_EQ(step(1, 2), 2U);
  EXPECT_EQ(service_->status().state, v1::SERVICE_DEGRADED);
  EXPECT_NE(service_->status().reason.find("second-bridge"), std::string::npos)
      << service_->status().reason;
  robot_.reset();
  description_.reset();
  bridge_.reset();
  ASSERT_TRUE(eventually(*second, [&] {
    writer.write(robot_state(2, 51));
    return next(milliseconds(1)).has_value();
  }));
  EXPECT_EQ(cycle_->stamp().epoch, 2U);
}

TEST_P(Cycles, OfTwoServicesOfOneNameOneWaitsUntilTheOtherIsGone) {
  start(false);
  auto second = node("service");
  auto other = std::make_unique<Cycle>(*second);
  other->input(topics::kIntentions);
  std::uint64_t number = 0;
  const auto steps = [&](Cycle& cycle) {
    const bool step = next(cycle, milliseconds(5)).has_value();
    if (step)
      cycle.done();
    return step;
  };
  const auto waits = [](Node& node) {
    return node.status().reason.starts_with("another service, process ");
  };
  ASSERT_TRUE(eventually(*bridge_, [&] {
    send(1, ++number);
    steps(*cycle_);
    steps(*other);
    return waits(*service_) || waits(*second);
  }));
  // Which of the two depends on their instances.
  if (waits(*service_)) {
    std::swap(service_, second);
    std::swap(cycle_, other);
  }
  EXPECT_EQ(second->status().state, v1::SERVICE_WAITING);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(eventually(*bridge_, [&] {
      send(1, ++number);
      return steps(*cycle_);
    }));
    EXPECT_FALSE(steps(*other));
  }
  EXPECT_FALSE(other->superseded());
  cycle_.reset();
  service_.reset();
  EXPECT_TRUE(eventually(*bridge_, [&] {
    send(1, ++number);
    EXPECT_FALSE(steps(*other)) << "its state is older than that of the one that is gone";
    return other->superseded();
  }));
  other.reset();
  other = std::make_unique<Cycle>(*second);
  EXPECT_TRUE(eventually(*bridge_, [&] {
    send(1, ++number);
    return steps(*other);
  }));
}

TEST_P(Cycles, OneWrongNumberOfTheBridgeDoesNotMakeItDeaf) {
  start(false);
  EXPECT_EQ(step(1, 1), 1U);
  EXPECT_EQ(step(1, 1000000), 1000000U);
  send(1, 2);
  send(1, 3);
  EXPECT_TRUE(no_step());
  EXPECT_EQ(step(1, 4), 4U);
  EXPECT_EQ(step(1, 5), 5U);
}

TEST_P(Cycles, StateWithoutEpochIsRefused) {
  start(false);
  send(0, 0);
  EXPECT_TRUE(no_step());
  EXPECT_EQ(service_->status().refused_samples, 1U);
}

TEST_P(Cycles, LockstepWaitsForItsInput) {
  start(true);
  EXPECT_EQ(step(1, 1), 1U);
  send(1, 2);
  EXPECT_TRUE(no_step());
  intentions_->write(intentions(1, 1));
  const auto second = next(milliseconds(10000));
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->stale);
  ASSERT_NE(input_->value(), nullptr);
  EXPECT_EQ(input_->value()->stamp.cycle, 1U);
}

TEST_P(Cycles, LockstepStepsEveryStateInOrder) {
  start(true);
  for (std::uint64_t number = 1; number <= 6; ++number) {
    send(1, number);
    send_intentions(1, number);
  }
  for (std::uint64_t number = 1; number <= 6; ++number) {
    ASSERT_EQ(step(), number);
    if (number > 1) {
      ASSERT_NE(input_->value(), nullptr);
      EXPECT_EQ(input_->value()->stamp.cycle, number - 1);
    }
  }
  EXPECT_TRUE(no_step());
  EXPECT_EQ(service_->status().late_cycles, 0U);
}

TEST_P(Cycles, LockstepKeepsTheInputsOfAnEpochThatIsNotKnownYet) {
  start(true);
  EXPECT_EQ(step(1, 1), 1U);
  send_intentions(2, 1);  // the other service was faster
  EXPECT_TRUE(no_step());
  send(2, 1);
  ASSERT_EQ(step(), 1U);
  send(2, 2);
  ASSERT_EQ(step(), 2U);
  ASSERT_NE(input_->value(), nullptr);
  EXPECT_EQ(input_->value()->stamp.epoch, 2U);
}

TEST_P(Cycles, LockstepSaysWhatItWaitsFor) {
  start(true);
  EXPECT_EQ(step(1, 1), 1U);
  send(1, 2);
  EXPECT_FALSE(next(milliseconds(2500)).has_value());
  EXPECT_EQ(service_->status().state, v1::SERVICE_WAITING);
  EXPECT_EQ(service_->status().reason, "waits for intentions of cycle 1");
  intentions_.reset();
  EXPECT_FALSE(next(milliseconds(2500)).has_value());
  EXPECT_EQ(service_->status().reason, "waits for intentions of cycle 1: nobody writes it");
}

TEST_P(Cycles, LockstepServiceThatComesLateGivesTheOthersWhatTheyWaitFor) {
  start(true);
  cycle_.reset();
  // The bridge is at 20, intentions has answered 19 and waits for this service's 19.
  for (std::uint64_t number = 1; number <= 20; ++number)
    send(1, number);
  for (std::uint64_t number = 1; number <= 19; ++number)
    intentions_->write(intentions(1, number));
  cycle_ = std::make_unique<Cycle>(*service_);
  input_ = &cycle_->input(topics::kIntentions);
  std::uint64_t number = step();
  EXPECT_GE(number, 13U);
  EXPECT_LE(number, 19U);
  while (number < 20) {
    ASSERT_NE(input_->value(), nullptr);
    EXPECT_EQ(input_->value()->stamp.cycle, number - 1);
    ASSERT_EQ(step(), number + 1);
    ++number;
  }
}

TEST_P(Cycles, LockstepBeginsWithoutAnInputThatNobodyHas) {
  start(true);
  for (std::uint64_t number = 1; number <= 20; ++number)
    send(1, number);
  const auto result = next(milliseconds(10000));
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->stale);
  EXPECT_GE(result->robot.stamp.cycle, 13U);
  EXPECT_EQ(input_->value(), nullptr);
}

TEST_P(Cycles, QuietBridgeIsSaid) {
  start(false);
  EXPECT_EQ(step(1, 1), 1U);
  robot_.reset();
  EXPECT_FALSE(next(milliseconds(1200)).has_value());
  EXPECT_EQ(service_->status().state, v1::SERVICE_WAITING);
  EXPECT_EQ(service_->status().reason, "waits for robot/state of cycle 2: nobody writes it");
}

}  // namespace
}  // namespace saphira::bus::test

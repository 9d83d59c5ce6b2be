// Random streams of commands, with any mix of ages, epochs, numbers, writers and gaps: nobody
// drives the robot without a live grant. The definition of "live" is written here a second time,
// from the whole history and without state, so that the two can disagree.
#include <gtest/gtest.h>

#include "saphira/authority/arbiter.hpp"
#include "saphira/base/random.hpp"

namespace saphira::authority {
namespace {

struct Heard {
  Command command;
  bool accepted;
};

class Stream : public ::testing::TestWithParam<int> {};

TEST_P(Stream, NeverDrivesWithoutALiveGrant) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  const Settings settings;
  Arbiter arbiter(settings);
  std::vector<Heard> history;
  double now = 0.0;
  std::uint64_t cycle = 0;
  std::uint64_t epoch = 0;
  double not_before = -1.0;  // of the newest connection or gap
  bool estopped = false;
  bool handed_over = true;  // to autonomy: no person has driven since, and there was no reset
  int driven = 0;
  for (int step = 0; step < 12000; ++step) {
    const double what = random.uniform();
    if (what < 0.01) {
      epoch = random.chance(0.2) ? 0 : epoch + 1;
      cycle = 0;
      arbiter.connect(epoch);
      not_before = now;
      history.clear();
    } else if (what < 0.02) {
      now += random.uniform(0.25, 3.0);
      cycle += random.next() % 20;
      arbiter.forget(cycle, now + 0.1);
      history.clear();
      not_before = now + 0.1;
    } else if (what < 0.06) {
      const bool was = estopped;
      if (arbiter.reset("reset", now).empty()) {
        ASSERT_TRUE(was) << step;
        estopped = false;
        // Behaviors that were known to be at rest may begin again.
        const Command* newest = nullptr;
        bool direct = false;
        for (const Heard& heard : history) {
          if (heard.accepted && heard.command.role == Role::behaviors)
            newest = &heard.command;
          if (heard.accepted && heard.command.role == Role::direct)
            direct = heard.command.active;
        }
        if (direct || newest == nullptr || newest->active ||
            now - newest->received > settings.lease + 1e-9)
          handed_over = false;
      }
    } else if (what < 0.4) {
      now += random.uniform(0.0, 0.1);
      cycle += random.next() % 2;
    } else {
      Command c;
      c.role = kRoles[random.next() % 4];
      // Emergency stops and teleoperators are rarer, or no other role would ever drive.
      if (c.role != Role::direct && c.role != Role::behaviors &&
          random.chance(c.role == Role::estop ? 0.99 : 0.9))
        c.role = Role::behaviors;
      c.writer[0] = static_cast<std::uint8_t>(random.next() % 3);
      c.source = std::to_string(c.writer[0]);
      c.number = random.chance(0.9) ? static_cast<std::uint64_t>(step) : random.next() % 4000;
      c.active = random.chance(0.8);
      c.epoch = random.chance(0.9) ? epoch : random.next() % 4;
      c.cycle = random.chance(0.1) ? 0 : cycle - std::min<std::uint64_t>(cycle, random.next() % 6);
      c.hand_back = c.role == Role::teleop && !c.active && random.chance(0.5);
      c.received = now;
      const bool accepted = arbiter.offer(c, cycle);
      history.push_back({c, accepted});
      estopped = estopped || (c.role == Role::estop && c.active);
      handed_over = handed_over || c.hand_back;
    }

    const Grant grant = arbiter.decide(now, cycle);
    ASSERT_EQ(grant.estopped, estopped) << step;
    ASSERT_EQ(grant.role == Role::estop, estopped) << step;
    const auto live = [&](const Command& c) {
      return c.active && now - c.received <= settings.lease + 1e-9;
    };
    if (grant.role == Role::none || grant.role == Role::estop)
      continue;
    ++driven;
    // The driver's newest command is accepted, active, young and fresh.
    const Command* newest = nullptr;
    for (const Heard& heard : history) {
      if (heard.accepted && heard.command.role == grant.role &&
          heard.command.writer == grant.writer)
        newest = &heard.command;
    }
    ASSERT_NE(newest, nullptr) << step;
    ASSERT_TRUE(live(*newest)) << step;
    ASSERT_NEAR(grant.command_age,
                newest->cycle == 0 ? now - newest->received
                                   : 0.1 * static_cast<double>(cycle - newest->cycle),
                1e-9);
    ASSERT_NE(epoch, 0U);
    ASSERT_TRUE(newest->epoch == epoch || (newest->epoch == 0 && newest->cycle == 0)) << step;
    ASSERT_GE(newest->received, not_before) << step;
    if (newest->cycle != 0) {
      ASSERT_LE(0.1 * static_cast<double>(cycle - newest->cycle), settings.oldest + 1e-9) << step;
    }
    if (grant.role == Role::teleop)
      handed_over = false;
    else
      ASSERT_TRUE(handed_over) << "autonomy drives after a person at step " << step;
  }
  EXPECT_GT(driven, 100) << "the streams never let anybody drive: the property was not tried";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Stream, ::testing::Range(0, 50));

}  // namespace
}  // namespace saphira::authority

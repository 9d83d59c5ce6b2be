// Two processes: the samples of one when it dies, stops, and comes back.
#include "process.hpp"

#include <algorithm>
#include <csignal>

#include "harness.hpp"
#include "only.hpp"
#include "saphira/bus/introspect.hpp"

namespace saphira::bus::test {
namespace {

using Clock = std::chrono::steady_clock;

class Processes : public testing::Test {
 protected:
  saphira::test::Process peer(const std::string& role, std::vector<std::string> more = {}) {
    std::vector<std::string> argv{"saphira-bus-peer", "--robot", robot_, "--role", role};
    argv.insert(argv.end(), more.begin(), more.end());
    return {argv,
            folder_.path("peer" + std::to_string(++started_)),
            {{"SAPHIRA_DOMAIN", saphira::test::domain()}, {"SAPHIRA_PROFILE", "host"}}};
  }
  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  /// How many of the endpoints that are there belong to that process.
  std::size_t endpoints_of(pid_t pid) {
    const auto all = Census(*node_).endpoints();
    return static_cast<std::size_t>(std::count_if(
        all.begin(), all.end(),
        [&](const EndpointEntry& entry) { return entry.pid == static_cast<std::uint32_t>(pid); }));
  }

  const std::string robot_ = robot("p");
  const std::unique_ptr<Node> node_ = std::make_unique<Node>(node_options("test", robot_));
  saphira::test::TempDir folder_;
  int started_ = 0;
};

TEST_F(Processes, AnyOrderOfStart) {
  auto writer = peer("writer");
  auto early = node_->reader(topics::kGoals);
  EXPECT_EQ(take_at_least(*node_, early, 1).size(), 1U);
  auto reader = peer("reader");
  EXPECT_EQ(reader.wait(), 0) << reader.output();
  writer.signal(SIGTERM);
  EXPECT_EQ(writer.wait(), 0) << writer.output();
}

TEST_F(Processes, WriterThatIsKilledIsLostWithinASecond) {
  auto goals = node_->reader(topics::kGoals);
  auto writer = peer("writer");
  const auto got = saphira::test::only(take_at_least(*node_, goals, 1));
  writer.signal(SIGKILL);
  const auto killed = Clock::now();
  std::vector<WriterId> lost;
  EXPECT_TRUE(eventually(*node_, [&] { return !(lost = goals.take_lost()).empty(); }));
  EXPECT_EQ(lost, std::vector<WriterId>{got.info.writer});
  EXPECT_LT(seconds_since(killed), 10.0);  // far from the lease of discovery, on a busy machine
  EXPECT_EQ(goals.matched(), 0U);
  // The goal was not withdrawn: its reader decides about it.
  EXPECT_TRUE(goals.take().empty());
}

TEST_F(Processes, NobodyWaitsForAReaderThatWasKilled) {
  auto goals = node_->writer(topics::kGoals);
  auto states = node_->reader(topics::kRobotState);
  auto living = peer("reader", {"--count", "1000000", "--seconds", "100"});
  auto killed = peer("reader", {"--count", "1000000", "--seconds", "100"});
  ASSERT_TRUE(eventually(*node_, [&] { return goals.matched() == 2; }));
  killed.signal(SIGKILL);
  EXPECT_TRUE(eventually(*node_, [&] { return goals.matched() == 1; }));
  EXPECT_GT(endpoints_of(living.pid()), 0U);
  EXPECT_EQ(endpoints_of(killed.pid()), 0U);
  goals.write(goal(5));
  const auto began = Clock::now();
  EXPECT_TRUE(goals.wait_acknowledged(30000));
  EXPECT_LT(seconds_since(began), 20.0);
}

TEST_F(Processes, WriterThatNappedIsThereAgainWithoutAnotherMatch) {
  auto goals = node_->reader(topics::kGoals);
  auto states = node_->reader(topics::kRobotState);
  auto writer = peer("writer");
  ASSERT_EQ(take_at_least(*node_, goals, 1).size(), 1U);
  const auto before = take_at_least(*node_, states, 1);
  writer.signal(SIGSTOP);
  std::vector<WriterId> lost;
  ASSERT_TRUE(eventually(*node_, [&] { return !(lost = goals.take_lost()).empty(); }));
  EXPECT_TRUE(goals.take().empty());
  EXPECT_EQ(goals.matched(), 0U);
  states.take();
  writer.signal(SIGCONT);
  const auto after = take_at_least(*node_, states, 1);
  EXPECT_EQ(after.at(0).info.writer, before.at(0).info.writer);
  EXPECT_TRUE(eventually(*node_, [&] { return goals.matched() == 1; }));
  EXPECT_TRUE(goals.take_lost().empty());
  const auto again =
      saphira::test::only(take_at_least(*node_, goals, 1));  // it declares its goal once more
  EXPECT_EQ(again.info.writer, lost.at(0));
}

TEST_F(Processes, NodeThatBeginsAnewTellsItsStateAgainAndNoWishes) {
  Node sleeper(node_options("sleeper", robot_));
  auto tiles = sleeper.writer(topics::kGrid);
  auto wishes = sleeper.writer(topics::kGoals);
  auto log = node_->reader(topics::kMessages);
  auto said = sleeper.writer(topics::kMessages);
  auto read_tiles = node_->reader(topics::kGrid);
  auto read_wishes = node_->reader(topics::kGoals);
  v1::GridTile tile;
  for (int i = 0; i < 3; ++i) {
    tile.column = i;
    tiles.write(tile);
  }
  tiles.dispose(tile);
  wishes.write(goal(1));
  said.write(v1::Message());
  const auto first = take_at_least(*node_, read_wishes, 1);
  take_at_least(*node_, log, 1);
  ASSERT_TRUE(eventually(*node_, [&] { return read_tiles.matched() == 1; }));
  std::size_t before = 0;
  ASSERT_TRUE(eventually(*node_, [&] { return (before += read_tiles.take().size()) >= 2; }));

  internal::transport_of(sleeper).renew();
  EXPECT_EQ(take_at_least(*node_, read_tiles, 2).size(), 2U);
  std::vector<WriterId> lost;
  EXPECT_TRUE(eventually(*node_, [&] { return !(lost = read_wishes.take_lost()).empty(); }));
  EXPECT_EQ(lost, std::vector<WriterId>{first.at(0).info.writer});
  // Its new samples are heard, and no earlier wish or message comes again.
  ASSERT_TRUE(eventually(*node_, [&] { return read_wishes.matched() == 1 && log.matched() == 1; }));
  wishes.write(goal(2));
  said.write(v1::Message());
  const auto next = saphira::test::only(take_at_least(*node_, read_wishes, 1));
  EXPECT_EQ(next.data.id.number, 2U);
  EXPECT_EQ(take_at_least(*node_, log, 1).size(), 1U);
}

TEST_F(Processes, NodeThatBeginsAnewHearsNothingTwiceAndMissesNothing) {
  Node sleeper(node_options("sleeper", robot_));
  auto said = node_->writer(topics::kMessages);
  auto wishes = node_->writer(topics::kGoals);
  auto hears = sleeper.reader(topics::kMessages);
  auto reads = sleeper.reader(topics::kGoals);
  auto writer = peer("writer");
  v1::Message message{.text = "one"};
  said.write(message);
  wishes.write(goal(5));
  EXPECT_EQ(take_at_least(sleeper, hears, 1).size(), 1U);
  EXPECT_EQ(take_at_least(sleeper, reads, 2).size(), 2U);

  writer.signal(SIGKILL);  // a death during the sleep
  writer.wait();
  internal::transport_of(sleeper).renew();
  message.text = "two";
  said.write(message);
  wishes.write(goal(6));
  const auto heard = saphira::test::only(take_at_least(sleeper, hears, 1));
  EXPECT_EQ(heard.data.text, "two");
  const auto read = saphira::test::only(take_at_least(sleeper, reads, 1));
  EXPECT_EQ(read.data.id.number, 6U);
  EXPECT_TRUE(eventually(sleeper, [&] { return reads.take_lost().size() == 1; }));
  EXPECT_TRUE(reads.take().empty());
}

}  // namespace
}  // namespace saphira::bus::test

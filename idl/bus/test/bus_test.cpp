#include <poll.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "harness.hpp"
#include "only.hpp"
#include "saphira/bus/held.hpp"
#include "saphira/bus/introspect.hpp"
#include "trouble.hpp"

namespace saphira::bus::test {
namespace {

class Bus : public OnEachBus {};
INSTANTIATE_TEST_SUITE_P(Over, Bus, testing::Values("memory", "dds"),
                         [](const auto& bus) { return bus.param; });

TEST_P(Bus, WhatIsWrittenIsRead) {
  auto [a, b, writer, reader] = pair(topics::kRobotState);
  ASSERT_TRUE(eventually(*a, [&] { return writer.matched() == 1; }));
  ASSERT_TRUE(eventually(*b, [&] { return reader.matched() == 1; }));
  auto state = robot_state(3, 4);
  state.pose_in_odom.x = 1.25;
  state.sonars.resize(2);
  state.sonars[1].range = 0.5F;
  state.battery = 12.5;
  ASSERT_TRUE(writer.write(state));
  const auto sample = saphira::test::only(take_at_least(*b, reader, 1));
  EXPECT_TRUE(sample.data == state);
  EXPECT_FALSE(sample.info.disposed);
  EXPECT_NE(sample.info.writer, WriterId{});
}

TEST_P(Bus, NewestOfWhatHasCome) {
  auto a = node("a", "", true);
  auto b = node("b", "", true);
  auto writer = a->writer(topics::kRobotState);
  for (std::uint64_t cycle = 1; cycle <= 5; ++cycle)
    writer.write(robot_state(1, cycle));
  auto reader = b->reader(topics::kRobotState);
  std::uint64_t newest = 0;
  EXPECT_TRUE(eventually(*b, [&] {
    if (const auto state = reader.take_newest())
      newest = state->stamp.cycle;
    return newest == 5;
  }));
  EXPECT_FALSE(reader.take_newest().has_value());
}

TEST_P(Bus, LateReaderOfLatchedTopicGetsTheNewestOfEachKey) {
  auto a = node("a");
  auto writer = a->writer(topics::kGoals);
  writer.write(goal(1, "old"));
  writer.write(goal(2, "old"));
  writer.write(goal(1, "new"));
  writer.write(goal(2, "new"));
  auto b = node("b");
  auto reader = b->reader(topics::kGoals);
  const auto samples = take_at_least(*b, reader, 2);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].data.functor, "new");
  EXPECT_EQ(samples[1].data.functor, "new");
  EXPECT_NE(samples[0].data.id.number, samples[1].data.id.number);
}

// As the map that registration had in a cycle.
TEST_P(Bus, InLockstepAReaderOfALatchedTopicGetsWhatCameInBetween) {
  const auto tool = node("tool", robot("l"), true);
  auto reader = tool->reader(topics::kMap);
  const auto service = node("service", robot("l"), true);
  auto writer = service->writer(topics::kMap);
  // Both sides: a reader that knows its writer later than the writer knows it gets the newest only.
  ASSERT_TRUE(eventually(*service, [&] { return writer.matched() == 1; }));
  ASSERT_TRUE(eventually(*tool, [&] { return reader.matched() == 1; }));
  std::vector<std::uint64_t> revisions;
  for (const std::uint64_t revision : {1U, 2U, 3U}) {
    ASSERT_TRUE(writer.write({.revision = revision}));
  }
  EXPECT_TRUE(eventually(*tool, [&] {
    for (const auto& sample : reader.take())
      revisions.push_back(sample.data.revision);
    return !revisions.empty() && revisions.back() == 3;
  }));
  EXPECT_EQ(revisions, (std::vector<std::uint64_t>{1, 2, 3}));
}

TEST_P(Bus, ManyKeys) {
  auto [a, b, writer, reader] = pair(topics::kGoals);
  for (std::uint64_t number = 1; number <= 200; ++number)
    ASSERT_TRUE(writer.write(goal(number)));
  EXPECT_EQ(take_at_least(*b, reader, 200).size(), 200U);
}

TEST_P(Bus, DisposeTellsWhatWasWithdrawn) {
  auto [a, b, writer, reader] = pair(topics::kGoals);
  writer.write(goal(1, "one"));
  writer.write(goal(2, "two"));
  take_at_least(*b, reader, 2);
  ASSERT_TRUE(writer.dispose(goal(1)));
  const auto gone = saphira::test::only(take_at_least(*b, reader, 1));
  EXPECT_TRUE(gone.info.disposed);
  EXPECT_EQ(gone.data.functor, "one");
  // It may be asked for again.
  writer.write(goal(1, "again"));
  const auto again = take_at_least(*b, reader, 1);
  EXPECT_FALSE(again[0].info.disposed);
  EXPECT_EQ(again[0].data.functor, "again");
}

TEST_P(Bus, AnotherWriterWithdrawsWhatAnEndedOneHasWritten) {
  auto a = node("a");
  auto b = node("b");
  auto reader = b->reader(topics::kGoals);
  {
    auto writer = a->writer(topics::kGoals);
    writer.write(goal(1, "one"));
    take_at_least(*b, reader, 1);
  }
  ASSERT_TRUE(eventually(*b, [&] { return reader.matched() == 0; }));
  auto c = node("c");
  auto another = c->writer(topics::kGoals);
  ASSERT_TRUE(eventually(*c, [&] { return another.matched() == 1; }));
  ASSERT_TRUE(another.dispose(goal(1)));
  const auto gone = saphira::test::only(take_at_least(*b, reader, 1));
  EXPECT_TRUE(gone.info.disposed);
  EXPECT_EQ(gone.data.functor, "one");
}

TEST_P(Bus, LateReaderDoesNotSeeWhatWasWithdrawn) {
  auto a = node("a");
  auto writer = a->writer(topics::kGoals);
  writer.write(goal(1));
  writer.dispose(goal(1));
  writer.write(goal(2));
  auto b = node("b");
  auto reader = b->reader(topics::kGoals);
  const auto sample = saphira::test::only(take_at_least(*b, reader, 1));
  EXPECT_EQ(sample.data.id.number, 2U);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Of this process [MB].
double resident() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0;
  double pages = 0.0;
  file >> total >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

TEST_P(Bus, WhatWasWithdrawnCostsNoMemory) {
  auto [a, b, writer, reader] = pair(topics::kGoals);
  const auto ask_and_withdraw = [&](std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t number = from; number < to; ++number) {
      ASSERT_TRUE(writer.write(goal(number)));
      ASSERT_TRUE(writer.dispose(goal(number)));
      if (number % 100 == 0)
        reader.take();
    }
    ASSERT_TRUE(writer.wait_acknowledged(10000));
    reader.take();
  };
  ASSERT_TRUE(eventually(*a, [&] { return writer.matched() == 1; }));
  ask_and_withdraw(0, 1000);
  const double before = resident();
  ask_and_withdraw(1000, 9000);
  EXPECT_LT(resident() - before, 3.0) << "[MB] of 8000 goals";
}
#endif

TEST_P(Bus, WriterThatEndsIsLostByItsName) {
  auto a = node("a");
  auto b = node("b");
  auto reader = b->reader(topics::kGoals);
  auto staying = b->writer(topics::kGoals);
  WriterId id;
  {
    auto writer = a->writer(topics::kGoals);
    writer.write(goal(1));
    const auto sample = saphira::test::only(take_at_least(*b, reader, 1));
    id = sample.info.writer;
    EXPECT_TRUE(reader.take_lost().empty());
  }
  std::vector<WriterId> lost;
  EXPECT_TRUE(eventually(*b, [&] { return !(lost = reader.take_lost()).empty(); }));
  EXPECT_EQ(lost, std::vector<WriterId>{id});
  EXPECT_TRUE(eventually(*b, [&] { return reader.matched() == 1; }));
}

TEST(MemoryBus, AHeldValueIsThatOfALivingWriter) {
  const auto bus = make_memory_bus();
  Node reads(node_options("reads", "one"), bus);
  Held<v1::FloorMap> held(reads.reader(topics::kMap));
  const auto revisions = [&] {
    std::vector<std::uint64_t> all;
    for (const v1::FloorMap& map : held.take())
      all.push_back(map.revision);
    return all;
  };
  using Revisions = std::vector<std::uint64_t>;
  const auto map = [](std::uint64_t revision) {
    v1::FloorMap made;
    made.revision = revision;
    return made;
  };
  std::optional<Node> first(std::in_place, node_options("registration", "one"), bus);
  auto writer = std::make_unique<Writer<v1::FloorMap>>(first->writer(topics::kMap));
  writer->write(map(7));
  writer->write(map(8));
  EXPECT_EQ(revisions(), (Revisions{7, 8}));
  {
    Node second(node_options("registration", "one"), bus);
    auto other = second.writer(topics::kMap);
    other.write(map(1));
    EXPECT_EQ(revisions(), Revisions{1});
  }
  EXPECT_EQ(revisions(), Revisions{8}) << "the second one has left";
  writer.reset();
  first.reset();
  EXPECT_EQ(revisions(), Revisions{}) << "it stays over a restart";
  Node again(node_options("registration", "one"), bus);
  auto restarted = std::make_unique<Writer<v1::FloorMap>>(again.writer(topics::kMap));
  restarted->write(map(9));
  EXPECT_EQ(revisions(), Revisions{9});
  restarted.reset();
  EXPECT_EQ(revisions(), Revisions{}) << "a value of one that had ended does not return";
}

TEST(MemoryBus, AProgramThatIsSilentForAWhileIsLostAndReturns) {
  const auto bus = make_memory_bus();
  Node a(node_options("a", "one"), bus);
  Node b(node_options("b", "one"), bus);
  auto reader = b.reader(topics::kGoals);
  auto writer = a.writer(topics::kGoals);
  writer.write(goal(1));
  const auto sample = saphira::test::only(reader.take());
  const std::vector<WriterId> id{sample.info.writer};
  set_silent(*bus, "a", true);
  EXPECT_EQ(reader.matched(), 0U);
  EXPECT_EQ(reader.take_lost(), id);
  EXPECT_TRUE(reader.take().empty());
  set_silent(*bus, "a", false);
  EXPECT_EQ(reader.matched(), 1U);
  EXPECT_TRUE(reader.take_lost().empty());
  const auto again = saphira::test::only(reader.take());  // it declares its goal once more
  EXPECT_EQ(again.data, sample.data);
  EXPECT_EQ(again.info.writer, id[0]);
  EXPECT_TRUE(reader.take().empty());
  // A loss that nobody has noticed is none.
  set_silent(*bus, "a", true);
  set_silent(*bus, "a", false);
  EXPECT_TRUE(reader.take_lost().empty());
  EXPECT_TRUE(reader.take().empty());
  // Lost once more, and ended then: that is one loss.
  set_silent(*bus, "a", true);
  { const auto ended = std::move(writer); }
  EXPECT_EQ(reader.take_lost(), id);
  EXPECT_TRUE(reader.take().empty());
}

TEST_P(Bus, RobotsDoNotHearEachOtherAndAFleetToolHearsAll) {
  const std::string one = robot("one");
  const std::string two = robot("two");
  auto a = node("a", one);
  auto b = node("b", two);
  auto fleet = node("fleet", robot("*"));  // "*" alone would meet tests that run beside this one
  auto writer_a = a->writer(topics::kGoals);
  auto writer_b = b->writer(topics::kGoals);
  auto reader_b = b->reader(topics::kGoals);
  auto reader_fleet = fleet->reader(topics::kGoals);
  const std::uint64_t mark = a->instance();
  auto goal_a = goal(1);
  goal_a.id.writer = mark;
  auto goal_b = goal(2);
  goal_b.id.writer = mark;
  writer_a.write(goal_a);
  writer_b.write(goal_b);
  std::vector<std::uint64_t> heard;
  EXPECT_TRUE(eventually(*fleet, [&] {
    for (const auto& sample : reader_fleet.take())
      if (sample.data.id.writer == mark)
        heard.push_back(sample.data.id.number);
    return heard.size() >= 2;
  }));
  std::sort(heard.begin(), heard.end());
  EXPECT_EQ(heard, (std::vector<std::uint64_t>{1, 2}));
  const auto at_b = saphira::test::only(take_at_least(*b, reader_b, 1));
  EXPECT_EQ(at_b.data.id.number, 2U);
  EXPECT_EQ(reader_b.matched(), 1U);
}

TEST_P(Bus, CommandsAreNotForLateReaders) {
  auto a = node("a");
  auto writer = a->writer<v1::Request>(topics::kTimer);
  v1::Request command{.number = 1};
  writer.write(command);
  auto b = node("b");
  auto reader = b->reader<v1::Request>(topics::kTimer);
  ASSERT_TRUE(eventually(*a, [&] { return writer.matched() == 1; }));
  ASSERT_TRUE(eventually(*b, [&] { return reader.matched() == 1; }));
  command.number = 2;
  writer.write(command);
  const auto sample = saphira::test::only(take_at_least(*b, reader, 1));
  EXPECT_EQ(sample.data.number, 2U);
}

TEST_P(Bus, IncompatibleQosIsReportedOnBothSides) {
  auto a = node("weak");
  auto b = node("strong");
  auto writer = Writer<v1::Goal>(internal::transport_of(*a).make_writer(
      topics::kGoals.name, internal::Policies{}, type_of<v1::Goal>()));
  auto reader = b->reader(topics::kGoals);
  EXPECT_TRUE(eventually(*a, [&] { return a->health().incompatible == 1; }));
  EXPECT_TRUE(eventually(*b, [&] { return b->health().incompatible == 1; }));
  EXPECT_EQ(writer.matched(), 0U);
  const std::string text_a = a->health().incompatible_text;
  const std::string text_b = b->health().incompatible_text;
  EXPECT_NE(text_a.find("goals"), std::string::npos) << text_a;
  EXPECT_NE(text_a.find("the reader of strong"), std::string::npos) << text_a;
  EXPECT_NE(text_b.find("the writer of weak"), std::string::npos) << text_b;
  EXPECT_NE(text_b.find("reliability: offered best effort, requested reliable"), std::string::npos)
      << text_b;
  b->publish_status();
  EXPECT_EQ(b->status().incompatible, 1U);
}

TEST(Mismatch, NamesTheProgramAndTheRemedyAndIsNoneBetweenTwoRobots) {
  EndpointEntry stops;
  stops.topic = "drive/estop";
  stops.type = "saphira::v1::MotorCommand";
  stops.writer = true;
  stops.robot = "one";
  stops.durability = "volatile";
  stops.ownership = "shared";
  stops.liveliness = "automatic";
  EndpointEntry bridge = stops;
  bridge.writer = false;
  EXPECT_EQ(internal::mismatch_text(stops, bridge, "bridge"), std::nullopt);
  bridge.reliable = true;
  EXPECT_EQ(internal::mismatch_text(stops, bridge, "bridge at karen"),
            "topic drive/estop: the reader of bridge at karen does not match, reliability: offered "
            "best effort, requested reliable; run both programs with --lockstep, or neither");
  EXPECT_EQ(internal::mismatch_text(bridge, stops, "panel"),
            "topic drive/estop: the writer of panel does not match, reliability: offered best "
            "effort, requested reliable; run both programs with --lockstep, or neither");
  EXPECT_EQ(internal::mismatch_text(stops, stops, "panel"), std::nullopt);
  bridge.robot = "two";
  EXPECT_EQ(internal::mismatch_text(stops, bridge, "bridge"), "");
}

TEST_P(Bus, OtherTypeOnATopicOfOursIsReported) {
  auto a = node("odd");
  auto b = node("b");
  auto reader = b->reader(topics::kRobotState);
  auto writer = Writer<v1::Goal>(internal::transport_of(*a).make_writer(
      topics::kRobotState.name, internal::policies(Qos::cyclic, false), type_of<v1::Goal>()));
  EXPECT_TRUE(eventually(*b, [&] { return b->health().incompatible == 1; }));
  const std::string text = b->health().incompatible_text;
  EXPECT_NE(text.find("odd"), std::string::npos) << text;
  EXPECT_NE(text.find("saphira::v1::Goal"), std::string::npos) << text;
  EXPECT_NE(text.find("saphira::v1::RobotState"), std::string::npos) << text;
  EXPECT_EQ(reader.matched(), 0U);
}

TEST_P(Bus, StatusComesAtOnceAndIsWithdrawnAtTheEnd) {
  auto b = node("b");
  auto reader = b->reader(topics::kStatus);
  auto a = node("a");
  EXPECT_TRUE(a->publish_status());
  EXPECT_FALSE(a->publish_status());
  a->status().state = v1::SERVICE_RUNNING;
  EXPECT_TRUE(a->publish_status());
  bool running = false;
  EXPECT_TRUE(eventually(*b, [&] {
    for (const auto& sample : reader.take())
      running |= sample.data.name == "a" && sample.data.state == v1::SERVICE_RUNNING &&
                 sample.data.rss_mb > 1.0 && sample.data.instance == a->instance();
    return running;
  }));
  a.reset();
  bool gone = false;
  EXPECT_TRUE(eventually(*b, [&] {
    for (const auto& sample : reader.take())
      gone |= sample.data.name == "a" && sample.info.disposed;
    return gone;
  }));
}

TEST_P(Bus, LogIsReadByWhoComesLater) {
  auto a = node("a");
  a->warn("odd things");
  auto b = node("b");
  auto reader = b->reader(topics::kLog);
  const auto samples = take_at_least(*b, reader, 1);
  EXPECT_EQ(samples[0].data.text, "odd things");
  EXPECT_EQ(samples[0].data.level, v1::LOG_WARNING);
  EXPECT_EQ(samples[0].data.name, "a");
}

TEST_P(Bus, StopEndsAWait) {
  auto a = node("a");
  Stop stop;
  stop.request();
  a->clear_wake();
  EXPECT_TRUE(a->wait(milliseconds(10000), &stop));
  EXPECT_TRUE(stop.requested());
}

TEST_P(Bus, EchoSpeaksJson) {
  auto a = node("a");
  auto writer = a->writer(topics::kGoalStatus);
  v1::GoalStatus status{.id = {18446744073709551615ULL, 2},
                        .state = v1::GOAL_FAILED,
                        .code = v1::CODE_BLOCKED,
                        .reason = "a \"wall\"\n",
                        .progress = 0.1,
                        .elapsed = std::numeric_limits<double>::quiet_NaN()};
  writer.write(status);
  auto b = node("b");
  Echo echo(*b, "goals/status");
  std::vector<std::string> lines;
  ASSERT_TRUE(eventually(*b, [&] { return !(lines = echo.take_json()).empty(); }));
  EXPECT_EQ(
      lines[0],
      R"({"id":{"writer":18446744073709551615,"number":2},"stamp":{"epoch":0,"cycle":0},)"
      R"("requester":"","functor":"","state":"GOAL_FAILED","code":"CODE_BLOCKED",)"
      R"("reason":"a \"wall\"\u000a","step":"","progress":0.1,"level":0,"trend":"TREND_STEADY",)"
      R"("elapsed":null,"note":"","waits_for":{"writer":0,"number":0}})");
  writer.dispose(status);
  ASSERT_TRUE(eventually(*b, [&] { return !(lines = echo.take_json()).empty(); }));
  EXPECT_EQ(lines[0].substr(0, 25), R"({"_disposed":true,"id":{")");
}

// Another program may write any bytes; JSON is UTF-8.
TEST_P(Bus, EchoSpeaksJsonOfAnyText) {
  auto a = node("a");
  auto writer = a->writer(topics::kGoalStatus);
  v1::GoalStatus status{.reason =
                            "K\xFC"
                            "che, K\u00fcche, \U0001f600 \xE2\x82"};
  writer.write(status);
  auto b = node("b");
  Echo echo(*b, "goals/status");
  std::vector<std::string> lines;
  ASSERT_TRUE(eventually(*b, [&] { return !(lines = echo.take_json()).empty(); }));
  EXPECT_NE(lines[0].find("\"reason\":\"K\uFFFDche, K\u00fcche, \U0001f600 \uFFFD\uFFFD\""),
            std::string::npos)
      << lines[0];
}

TEST_P(Bus, EchoNamesTheTopicsThatThereAre) {
  auto a = node("a");
  EXPECT_TRUE(saphira::test::has(
      saphira::test::trouble_of<std::runtime_error>([&] { const Echo echo(*a, "robot/stat"); }),
      "robot/state"));
  // Every topic can be read.
  for (const auto& topic : known_topics())
    EXPECT_TRUE(Echo(*a, topic.name).take_json().empty());
}

TEST_P(Bus, CensusTellsWhoIsThereAndWhoDoesNotMatch) {
  const std::string here = robot("census");
  auto a = node("weak", here);
  auto b = node("strong", here);
  auto c = node("census", here);
  const Census census(*c);
  auto writer = Writer<v1::Goal>(internal::transport_of(*a).make_writer(
      topics::kGoals.name, internal::Policies{}, type_of<v1::Goal>()));
  auto reader = b->reader(topics::kGoals);
  std::vector<Mismatch> mismatches;
  ASSERT_TRUE(eventually(*c, [&] { return !(mismatches = census.mismatches()).empty(); }));
  EXPECT_EQ(mismatches[0].writer.program, "weak");
  EXPECT_EQ(mismatches[0].reader.program, "strong");
  EXPECT_EQ(mismatches[0].why, "reliability: offered best effort, requested reliable");
  EXPECT_EQ(mismatches[0].reader.durability, "transient_local");
  EXPECT_EQ(mismatches[0].reader.host, internal::host_name());
  EXPECT_EQ(mismatches[0].reader.pid, static_cast<std::uint32_t>(getpid()));
  EXPECT_EQ(mismatches[0].reader.robot, here);
  for (const auto& endpoint : census.endpoints())
    EXPECT_NE(endpoint.program, "census");
  b.reset();
}

TEST(Wake, ManySignalsAreOneWakeUntilCleared) {
  internal::Wake wake;
  const auto readable = [&] {
    pollfd fd{wake.fd(), POLLIN, 0};
    return poll(&fd, 1, 0) == 1;
  };
  EXPECT_FALSE(readable());
  wake.signal();
  wake.signal();
  wake.signal();
  EXPECT_TRUE(readable());
  wake.clear();
  EXPECT_FALSE(readable());
  wake.clear();
  wake.signal();
  EXPECT_TRUE(readable());
}

TEST(Partitions, MeetByWildcard) {
  EXPECT_TRUE(internal::partitions_meet("a", "a"));
  EXPECT_TRUE(internal::partitions_meet("*", "a"));
  EXPECT_TRUE(internal::partitions_meet("fleet-3", "fleet-*"));
  EXPECT_TRUE(internal::partitions_meet("x,a", "a"));
  EXPECT_FALSE(internal::partitions_meet("a", "b"));
  EXPECT_FALSE(internal::partitions_meet("", "b"));
}

TEST(Dds, WrongSettingsAreNamed) {
  NodeOptions options;
  options.domain = 400;
  EXPECT_THROW(Node{options}, std::runtime_error);
}

// An address or a name may come later: until then the programs of this machine reach each other.
TEST(Dds, WithoutItsAddressItWorksOnThisMachine) {
  NodeOptions options = node_options("here", robot("no address"));
  options.profile = Profile::wan;
  options.interface = "203.0.113.7";
  options.peers = {"robot.invalid"};
  const Node node(options);
  const std::vector<std::string> waits = node.network_waits();
  ASSERT_EQ(waits.size(), 2U);
  EXPECT_NE(waits[0].find("interface 203.0.113.7 is no address of this machine"),
            std::string::npos);
  EXPECT_NE(waits[1].find("the address of peer robot.invalid is not known"), std::string::npos);

  NodeOptions other_options = options;
  other_options.profile = Profile::host;
  other_options.peers.clear();
  Node here(options);
  Node other(other_options);
  auto writer = here.writer(topics::kGoals);
  auto reader = other.reader(topics::kGoals);
  ASSERT_TRUE(writer.write(goal(1)));
  EXPECT_TRUE(eventually(other, [&] { return !reader.take().empty(); }));
}

TEST(Dds, NodesAreFreedInAnyOrder) {
  auto node = std::make_unique<Node>(node_options("here", robot("order")));
  auto writer = node->writer(topics::kGoals);
  auto reader = node->reader(topics::kGoals);
  node.reset();
  EXPECT_TRUE(writer.write(goal(1)));
  EXPECT_EQ(reader.take().size(), 1U);
}

}  // namespace
}  // namespace saphira::bus::test

#include "saphira/runtime/processes.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"

namespace saphira::runtime {
namespace {

/// A service and somebody who looks at it and asks, on a bus in memory.
class ProcessesOnBusTest : public ::testing::Test {
 protected:
  std::optional<v1::ProcessAnswer> ask(const std::string& whom, const std::string& process,
                                       v1::ProcessAction action, std::uint32_t cycles = 0) {
    v1::ProcessRequest request;
    request.source("a person");
    request.request(++number);
    request.service(whom);
    request.process(process);
    request.action(action);
    request.cycles(cycles);
    requests.write(request);
    on_bus.idle();
    return answers.take_newest();
  }
  void cycle() {
    stamp.cycle(stamp.cycle() + 1);
    on_bus.step(stamp);
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node service{test::memory_options("eyes"), memory};
  bus::Node person{test::memory_options("person"), memory};
  bus::Writer<v1::ProcessRequest> requests = person.writer(bus::topics::kProcessRequest);
  bus::Reader<v1::ProcessAnswer> answers = person.reader(bus::topics::kProcessAnswer);
  bus::Reader<v1::Processes> states = person.reader(bus::topics::kProcesses);
  ProcessTable table;
  Process& doors = table.add("doors", "finds doors");
  ProcessesOnBus on_bus{service, table,
                        [](const std::string& name, ProcessAction,
                           std::uint32_t cycles) -> std::optional<std::string> {
                          if (name == "follow-it")
                            return cycles == 0 ? "" : "not for so long";
                          return std::nullopt;
                        }};
  v1::Stamp stamp;
  std::uint64_t number = 0;
};

TEST_F(ProcessesOnBusTest, TellsTheStatesWhenTheyChange) {
  auto newest = states.take_newest();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->service(), "eyes");
  EXPECT_EQ(newest->instance(), service.instance());
  ASSERT_EQ(newest->processes().size(), 1U);
  EXPECT_EQ(newest->processes()[0].state(), v1::PROCESS_INIT);
  EXPECT_EQ(newest->processes()[0].effect(), "finds doors");
  cycle();
  newest = states.take_newest();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->processes()[0].state(), v1::PROCESS_RUNNING);
  EXPECT_EQ(newest->processes()[0].number(), 10);
  cycle();
  EXPECT_FALSE(states.take_newest());
}

TEST_F(ProcessesOnBusTest, ObeysAndAnswers) {
  cycle();
  auto answer = ask("eyes", "doors", v1::PROCESS_INTERRUPT);
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->done());
  EXPECT_EQ(answer->request(), number);
  // Told at once, also while the cycles stand still.
  EXPECT_EQ(states.take_newest().value().processes()[0].state(), v1::PROCESS_INTERRUPTED);
  cycle();
  EXPECT_TRUE(doors.interrupted());
  EXPECT_EQ(states.take_newest().value().processes()[0].state(), v1::PROCESS_SUSPENDED);
  EXPECT_TRUE(ask("eyes", "doors", v1::PROCESS_RESUME).value().done());
  cycle();
  EXPECT_TRUE(doors.works());
  EXPECT_TRUE(ask("eyes", "doors", v1::PROCESS_SUSPEND, 2).value().done());
  EXPECT_EQ(states.take_newest().value().processes()[0].state(), v1::PROCESS_SLEEPING);
}

TEST_F(ProcessesOnBusTest, SaysWhyNot) {
  auto answer = ask("eyes", "windows", v1::PROCESS_SUSPEND);
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->done());
  EXPECT_EQ(answer->reason(), "no process \"windows\"; there are doors");
  EXPECT_FALSE(ask("ears", "doors", v1::PROCESS_SUSPEND));
  EXPECT_FALSE(ask("eyes", "doors", static_cast<v1::ProcessAction>(77)).value().done());
}

TEST_F(ProcessesOnBusTest, LetsTheServiceAnswerForWhatIsNotInTheTable) {
  EXPECT_TRUE(ask("eyes", "follow-it", v1::PROCESS_INTERRUPT).value().done());
  EXPECT_EQ(ask("eyes", "follow-it", v1::PROCESS_SUSPEND, 3).value().reason(), "not for so long");
}

}  // namespace
}  // namespace saphira::runtime

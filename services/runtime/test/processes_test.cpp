#include "saphira/runtime/processes.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"
#include "saphira/bus/request_client.hpp"

namespace saphira::runtime {
namespace {

/// A service and a client of its processes, on a bus in memory.
class ProcessesOnBusTest : public ::testing::Test {
 protected:
  std::optional<v1::Answer> ask(const std::string& whom, const std::string& process,
                                const char* functor, std::optional<double> cycles = {}) {
    v1::Request request{.source = "a person"};
    request.number = ++number;
    request.service = whom;
    request.functor = functor;
    request.arguments = {bus::text("process", process)};
    if (cycles)
      request.arguments.push_back(bus::number("cycles", *cycles));
    requests.write(request);
    on_bus.idle();
    return answers.take_newest();
  }
  void cycle() {
    ++stamp.cycle;
    on_bus.step(stamp);
  }

  std::shared_ptr<bus::MemoryBus> memory = bus::make_memory_bus();
  bus::Node service{test::memory_options("eyes"), memory};
  bus::Node person{test::memory_options("person"), memory};
  bus::Writer<v1::Request> requests = person.writer<v1::Request>(bus::topics::kProcessRequest);
  bus::Reader<v1::Answer> answers = person.reader(bus::topics::kProcessAnswers);
  bus::Reader<v1::ProcessSet> states = person.reader(bus::topics::kProcesses);
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
  EXPECT_EQ(newest->service, "eyes");
  EXPECT_EQ(newest->instance, service.instance());
  ASSERT_EQ(newest->processes.size(), 1U);
  EXPECT_EQ(newest->processes[0].state, v1::PROCESS_INIT);
  EXPECT_EQ(newest->processes[0].effect, "finds doors");
  cycle();
  newest = states.take_newest();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->processes[0].state, v1::PROCESS_RUNNING);
  EXPECT_EQ(newest->processes[0].number, 10);
  cycle();
  EXPECT_FALSE(states.take_newest());
}

TEST_F(ProcessesOnBusTest, ObeysAndAnswers) {
  cycle();
  auto answer = ask("eyes", "doors", "interrupt");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->code, v1::ANSWER_DONE);
  EXPECT_EQ(answer->number, number);
  // Published at once, also while the cycles stand still.
  EXPECT_EQ(states.take_newest().value().processes[0].state, v1::PROCESS_INTERRUPTED);
  cycle();
  EXPECT_TRUE(doors.interrupted());
  EXPECT_EQ(states.take_newest().value().processes[0].state, v1::PROCESS_SUSPENDED);
  EXPECT_EQ(ask("eyes", "doors", "resume").value().code, v1::ANSWER_DONE);
  cycle();
  EXPECT_TRUE(doors.works());
  EXPECT_EQ(ask("eyes", "doors", "suspend", 2).value().code, v1::ANSWER_DONE);
  EXPECT_EQ(states.take_newest().value().processes[0].state, v1::PROCESS_SLEEPING);
}

TEST_F(ProcessesOnBusTest, SaysWhyNot) {
  auto answer = ask("eyes", "windows", "suspend");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->code, v1::ANSWER_REFUSED);
  EXPECT_EQ(answer->text, "no process \"windows\"; there are doors");
  EXPECT_FALSE(ask("ears", "doors", "suspend"));
  EXPECT_EQ(ask("eyes", "doors", "end").value().code, v1::ANSWER_UNKNOWN_FUNCTOR);
  EXPECT_EQ(ask("eyes", "doors", "suspend", -1.0).value().code, v1::ANSWER_BAD_ARGUMENT);
}

TEST_F(ProcessesOnBusTest, LetsTheServiceAnswerForWhatIsNotInTheTable) {
  EXPECT_EQ(ask("eyes", "follow-it", "interrupt").value().code, v1::ANSWER_DONE);
  EXPECT_EQ(ask("eyes", "follow-it", "suspend", 3).value().text, "not for so long");
}

}  // namespace
}  // namespace saphira::runtime

#include "saphira/base/process.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace saphira {
namespace {

/// The example of manual 6.5.1: finds doors, and shows the result about every second.
class FindDoors {
 public:
  enum State { kFind = 20, kDisplay = 21 };

  void operator()(Process& self) {
    switch (self.state()) {
      case kInit:
        seen += "I";
        self.set_state(kFind);
        break;
      case kResume:
        seen += "R";
        self.set_state(kFind);
        break;
      case kInterrupt:
        seen += "X";
        self.suspend();
        break;
      case kFind:
        seen += "F";
        self.set_state(kDisplay);
        break;
      case kDisplay:
        seen += "D";
        self.suspend(8);
        break;
    }
  }
  std::string seen;
};

TEST(ProcessTable, RunsTheManualsExample) {
  ProcessTable table;
  FindDoors doors;
  Process& process = table.add("find_doors", "", [&](Process& self) { doors(self); });
  std::uint64_t cycle = 0;
  const auto run = [&](int cycles) {
    doors.seen.clear();
    for (int i = 0; i < cycles; ++i) {
      const std::size_t before = doors.seen.size();
      table.step(++cycle);
      if (doors.seen.size() == before)
        doors.seen += ".";
    }
    return doors.seen;
  };
  EXPECT_EQ(run(14), "IFD........RFD");
  EXPECT_EQ(process.since(), 14U);
  EXPECT_EQ(run(3), "...");
  process.interrupt();
  EXPECT_EQ(run(4), "X...");
  EXPECT_EQ(process.state(), kSuspend);
  EXPECT_EQ(process.since(), cycle - 3);
  process.resume();
  EXPECT_EQ(run(4), "RFD.");
}

TEST(ProcessTable, GivesEachItsTurnInOrder) {
  ProcessTable table;
  std::string order;
  for (const char* name : {"b", "a", "c"})
    table.add(name, "", [&order, name](Process&) { order += name; });
  table.step(1);
  table.find("a")->suspend();
  table.step(2);
  EXPECT_EQ(order, "bacbc");
  EXPECT_TRUE(table.find("a")->suspended());
  EXPECT_FALSE(table.find("b")->suspended());
  EXPECT_EQ(table.find("d"), nullptr);
  EXPECT_THROW(table.add("a", ""), std::invalid_argument);
}

TEST(ProcessTable, OneDoneByItsOwnerIsToldWhenToWork) {
  ProcessTable table;
  Process& process = table.add("grid", "puts readings into the grid");
  table.step(1);
  EXPECT_TRUE(process.works());
  EXPECT_FALSE(process.resumed());
  EXPECT_EQ(process.state(), kFirstOwnState);
  process.interrupt();
  table.step(2);
  EXPECT_FALSE(process.works());
  EXPECT_TRUE(process.interrupted());
  table.step(3);
  EXPECT_FALSE(process.works());
  EXPECT_FALSE(process.interrupted());
  EXPECT_TRUE(process.suspended());
  process.resume();
  table.step(4);
  EXPECT_TRUE(process.works());
  EXPECT_TRUE(process.resumed());
  table.step(5);
  EXPECT_TRUE(process.works());
  EXPECT_FALSE(process.resumed());
  process.suspend(2);
  table.step(6);
  EXPECT_FALSE(process.works());
  table.step(7);
  EXPECT_FALSE(process.works());
  table.step(8);
  EXPECT_TRUE(process.works());
}

TEST(ProcessTable, OneThatIgnoresAnInterruptIsSuspendedAllTheSame) {
  ProcessTable table;
  int calls = 0;
  Process& process = table.add("deaf", "", [&](Process&) { ++calls; });
  table.step(1);
  process.interrupt();
  table.step(2);
  table.step(3);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(process.state(), kSuspend);
}

TEST(ProcessTable, KeepsItsOwnStatesApartFromTheReservedOnes) {
  ProcessTable table;
  Process& process = table.add("one", "");
  EXPECT_THROW(process.set_state(4), std::invalid_argument);
  EXPECT_THROW(process.set_state(9), std::invalid_argument);
  process.set_state(10);
  EXPECT_EQ(process.state(), 10);
}

TEST(ProcessTable, SaysWhyARequestCannotBeDone) {
  ProcessTable table;
  EXPECT_EQ(table.request("grid", ProcessAction::suspend), "no process \"grid\"; there are none");
  table.add("grid", "");
  table.add("doors", "");
  table.step(1);
  EXPECT_EQ(table.request("walls", ProcessAction::suspend),
            "no process \"walls\"; there are grid, doors");
  EXPECT_EQ(table.request("grid", ProcessAction::resume), "it is not suspended");
  EXPECT_EQ(table.request("grid", ProcessAction::suspend, 3), "");
  EXPECT_EQ(table.find("grid")->state(), -3);
  EXPECT_EQ(table.request("grid", ProcessAction::resume), "");
  EXPECT_EQ(table.request("doors", ProcessAction::interrupt), "");
  table.step(2);
  EXPECT_EQ(table.request("doors", ProcessAction::interrupt), "it is suspended already");
}

TEST(ProcessTable, TellsOfChangesButNotOfNaps) {
  ProcessTable table;
  FindDoors doors;
  Process& grid = table.add("grid", "");
  EXPECT_TRUE(table.take_changed());
  table.step(1);
  EXPECT_TRUE(table.take_changed());  // it has begun
  table.step(2);
  EXPECT_FALSE(table.take_changed());
  grid.suspend(1);  // by itself
  for (std::uint64_t cycle = 3; cycle < 7; ++cycle) {
    table.step(cycle);
    EXPECT_FALSE(table.take_changed());
  }
  // A request is shown: the sleep, and its end.
  EXPECT_EQ(table.request("grid", ProcessAction::suspend, 2), "");
  EXPECT_TRUE(table.take_changed());
  table.step(7);
  table.step(8);
  EXPECT_FALSE(table.take_changed());
  table.step(9);
  EXPECT_TRUE(table.take_changed());
}

}  // namespace
}  // namespace saphira

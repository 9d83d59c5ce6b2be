#include "saphira/behaviors/folder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "process.hpp"
#include "saphira/behaviors/executive.hpp"
#include "saphira/behaviors/language.hpp"

namespace saphira::behaviors {
namespace {

namespace fs = std::filesystem;

/// A behavior that counts its cycles, and puts out the count as its speed in mm/s.
std::string counter(const std::string& speed, const std::string& more = "") {
  return "BeginBehavior Counter\nParams\n  sfFLOAT p = 1 from 0 to 9\n" + more +
         "Rules\n  If 1.0 Then Speed v\nInit\n  float n = 0;\nUpdate\n  n += 1;\n  float v = " +
         speed + ";\nActivity\n  Speed 1.0\nEndBehavior\n";
}

class FolderTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(path_ / name) << text;
    // Files that are written within a tick of the clock have the same time.
    fs::last_write_time(path_ / name, fs::file_time_type(std::chrono::seconds(++time_)));
  }
  double step(std::string* trouble = nullptr) {
    ++cycle_;
    const Intent intent{cycle_, true, {{"c", "Counter", 0, true, {}}}};
    Inputs inputs;
    inputs.cycle = cycle_;
    inputs.intent = &intent;
    const Output output = executive_.step(inputs);
    if (trouble != nullptr)
      *trouble = output.trouble;
    else
      EXPECT_EQ(output.trouble, "");
    return output.blend.speed * 1000.0;
  }

  const test::TempDir temporary_;
  const fs::path path_ = temporary_.path();
  Executive executive_{{}, {}};
  std::uint64_t cycle_ = 0;
  int time_ = 1'000'000;
};

TEST_F(FolderTest, ARunningBehaviorTakesTheNewCodeAndKeepsItsVariables) {
  write("c.beh", counter("n"));
  Folder folder(path_.string());
  EXPECT_TRUE(folder.reload(executive_.registry()).changed);
  EXPECT_FALSE(folder.reload(executive_.registry()).changed);
  EXPECT_DOUBLE_EQ(step(), 1);
  EXPECT_DOUBLE_EQ(step(), 2);
  write("c.beh", counter("100 + n"));
  const Folder::Reload reload = folder.reload(executive_.registry());
  EXPECT_TRUE(reload.changed);
  EXPECT_EQ(reload.taken.size(), 1U);
  EXPECT_DOUBLE_EQ(step(), 103);
}

TEST_F(FolderTest, ABrokenFileLeavesWhatRunsUntouchedAndIsTold) {
  write("c.beh", counter("n"));
  Folder folder(path_.string());
  folder.reload(executive_.registry());
  step();
  write("c.beh", counter("n +"));
  const Folder::Reload reload = folder.reload(executive_.registry());
  EXPECT_TRUE(reload.changed);
  ASSERT_EQ(reload.faults.size(), 1U);
  EXPECT_NE(reload.faults[0].find("c.beh:10:16: expected a number, a variable"), std::string::npos)
      << reload.faults[0];
  EXPECT_EQ(folder.trouble() + "\nWhat this file gave before stays in use.", reload.faults[0]);
  EXPECT_DOUBLE_EQ(step(), 2);
  write("c.beh", counter("n"));
  EXPECT_TRUE(folder.reload(executive_.registry()).changed);
  EXPECT_EQ(folder.trouble(), "");
  EXPECT_DOUBLE_EQ(step(), 3);
}

TEST_F(FolderTest, AVersionThatWantsOtherParametersWaitsUntilItGetsThem) {
  write("c.beh", counter("n"));
  Folder folder(path_.string());
  folder.reload(executive_.registry());
  step();
  write("c.beh", counter("500", "  sfPTR goal\n"));
  folder.reload(executive_.registry());
  std::string trouble;
  EXPECT_DOUBLE_EQ(step(&trouble), 2);
  EXPECT_NE(trouble.find("the old version runs on: parameter \"goal\" is missing"),
            std::string::npos)
      << trouble;
}

TEST_F(FolderTest, WhatIsGoneCannotBeIntendedAnewButRunsOn) {
  write("c.beh", counter("n"));
  Folder folder(path_.string());
  folder.reload(executive_.registry());
  step();
  fs::remove(path_ / "c.beh");
  const Folder::Reload reload = folder.reload(executive_.registry());
  EXPECT_TRUE(reload.changed);
  EXPECT_EQ(reload.gone, std::vector<std::string>{(path_ / "c.beh").string()});
  EXPECT_TRUE(folder.reload(executive_.registry()).gone.empty());
  EXPECT_DOUBLE_EQ(step(), 2);
  executive_.reset();
  std::string trouble;
  step(&trouble);
  EXPECT_NE(trouble.find("unknown schema \"Counter\""), std::string::npos);
}

TEST_F(FolderTest, OneNameInTwoFilesIsAFault) {
  write("a.beh", counter("1"));
  write("b.beh", counter("2"));
  Folder folder(path_.string());
  Registry registry;
  const Folder::Reload reload = folder.reload(registry);
  ASSERT_EQ(reload.faults.size(), 1U);
  EXPECT_NE(reload.faults[0].find("b.beh: the behavior \"Counter\" is in a.beh already"),
            std::string::npos);
}

TEST_F(FolderTest, ABehaviorMayMoveFromOneFileToAnother) {
  const auto another = [](std::string text) {
    return text.replace(text.find("Counter"), 7, "Another");
  };
  write("z.beh", counter("n"));
  Folder folder(path_.string());
  Registry registry;
  folder.reload(registry);
  write("a.beh", counter("2 * n"));
  write("z.beh", another(counter("n")));
  Folder::Reload reload = folder.reload(registry);
  EXPECT_TRUE(reload.faults.empty()) << reload.faults.front();
  EXPECT_EQ(reload.taken.size(), 2U);
  ASSERT_NE(registry.find("Counter"), nullptr);
  ASSERT_NE(registry.find("Another"), nullptr);
  // Also in two looks.
  write("b.beh", another(counter("3 * n")));
  EXPECT_EQ(folder.reload(registry).faults.size(), 1U);
  write("c.beh", another(counter("4 * n")));
  reload = folder.reload(registry);
  ASSERT_EQ(reload.faults.size(), 1U) << "what was told of b.beh is not told again";
  EXPECT_NE(reload.faults[0].find("c.beh"), std::string::npos);
  fs::remove(path_ / "c.beh");
  fs::remove(path_ / "z.beh");
  reload = folder.reload(registry);
  EXPECT_TRUE(reload.faults.empty());
  EXPECT_EQ(folder.trouble(), "");
  EXPECT_NE(registry.find("Another"), nullptr);
}

TEST_F(FolderTest, ALaterSourceCoversAnEarlierOneUntilItIsGone) {
  const auto version = [](const std::string& speed) {
    return std::move(compile(counter(speed), "fixed").schemas.front());
  };
  Registry fixed;
  fixed.add(version("10 + n"));
  Sources sources;
  sources.add(std::move(fixed));
  sources.add(Folder(path_.string()));
  EXPECT_TRUE(sources.reload(executive_.registry()).changed);
  EXPECT_DOUBLE_EQ(step(), 11);
  write("mine.beh", counter("20 + n"));
  EXPECT_TRUE(sources.reload(executive_.registry()).changed);
  EXPECT_DOUBLE_EQ(step(), 22);
  EXPECT_FALSE(sources.reload(executive_.registry()).changed);
  fs::remove(path_ / "mine.beh");
  EXPECT_TRUE(sources.reload(executive_.registry()).changed);
  EXPECT_DOUBLE_EQ(step(), 13);
  EXPECT_EQ(sources.trouble(), "");
}

TEST_F(FolderTest, AFolderThatIsNotThereIsAFaultAndTakesNothingAway) {
  write("a.beh", counter("1"));
  Folder folder(path_.string());
  Registry registry;
  folder.reload(registry);
  fs::remove_all(path_);
  EXPECT_EQ(folder.reload(registry).faults.size(), 1U);
  EXPECT_NE(registry.find("Counter"), nullptr);
  EXPECT_NE(folder.trouble().find("expected a folder"), std::string::npos);
  EXPECT_THROW(load_behaviors(path_.string()), std::runtime_error);
}

}  // namespace
}  // namespace saphira::behaviors

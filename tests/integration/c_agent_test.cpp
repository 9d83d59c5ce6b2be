// An agent in C on another vendor's DDS, from the installed contract alone, with the demo's robot.

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>

#include "installed.hpp"

namespace saphira {
namespace {

namespace fs = std::filesystem;

bool there_is(const std::string& command) {
  const test::TempDir folder;
  test::Process which({"/bin/sh", "-c", command}, folder.path("which"));
  return which.wait() == 0;
}

std::uintmax_t megabytes(const std::string& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    bytes += entry.is_regular_file() ? entry.file_size() : 0;
  return bytes >> 20U;
}

TEST(Installed, HoldsWhatPeopleNeedAndNoDebugInformation) {
  const test::Installed installed;
  for (const char* file :
       {"share/doc/saphira/README.md", "share/doc/saphira/docs/situations.md",
        "share/saphira/deployments/robot.yaml", "lib/systemd/system/saphira@.service",
        "share/saphira/examples/agents/go_there/go_there.cpp",
        "share/saphira/examples/agents/c_agent/c_agent.c", "share/saphira/idl/motion.idl",
        "share/saphira/idl/README.md", "share/saphira/idl/topics.def",
        "share/bash-completion/completions/saphira"})
    EXPECT_TRUE(fs::exists(installed.prefix() + "/" + file)) << file;
  EXPECT_LT(megabytes(installed.prefix()), 200U);
}

TEST(CAgent, OfAnotherVendorLooksSendsTakesBackDrivesAnswersAndAsks) {
  if (!there_is("command -v idlc") || !there_is("ls /usr/lib/*/cmake/CycloneDDS"))
    GTEST_SKIP() << "no Cyclone DDS: apt-get install cyclonedds-dev cyclonedds-tools";
  const test::Installed installed;
  const std::string build = installed.build("agents/examples/c_agent");
  if (HasFatalFailure())
    return;
  const std::map<std::string, std::string> environment = {{"SAPHIRA_ROBOT", test::unique_robot()},
                                                          {"SAPHIRA_DOMAIN", test::domain()}};
  test::Process up({installed.program("saphira"), "up", "demo"}, installed.path("up.log"),
                   environment);
  const auto run = [&](const std::vector<std::string>& words, const std::string& said,
                       int code = 0) {
    std::vector<std::string> command{build + "/c_agent"};
    command.insert(command.end(), words.begin(), words.end());
    test::Process agent(command, installed.path(words[0] + ".log"), environment);
    EXPECT_EQ(agent.wait(std::chrono::minutes(2)), std::optional<int>(code))
        << words[0] << ": " << agent.output() << up.output();
    EXPECT_NE(agent.output().find(said), std::string::npos) << agent.output();
  };
  // The programs of the robot may not be there yet.
  EXPECT_TRUE(test::wait_until([&] {
    test::Process agent({build + "/c_agent", "state"}, installed.path("state.log"), environment);
    return agent.wait() == 0 && agent.output().find("m/s") != std::string::npos;
  })) << up.output();
  run({"go", "0.6", "0"}, "succeeded");
  run({"cancel", "8", "0", "3"}, "canceled");
  run({"drive", "0.1", "0.3", "2"}, "c_agent drives");
  const auto estop = [&](const std::vector<std::string>& words) {
    std::vector<std::string> command{installed.program("saphira"), "estop"};
    command.insert(command.end(), words.begin(), words.end());
    test::Process stop(command, installed.path("estop.log"), environment);
    EXPECT_EQ(stop.wait(), std::optional<int>(0)) << stop.output();
  };
  estop({});
  run({"drive", "0", "0.3", "3"}, "it may not drive: an emergency stop is latched, pressed by", 1);
  estop({"reset"});
  run({"go", "0.6", "0"}, "succeeded");
  {
    const test::Process facilitator({installed.program("saphira-facilitator")},
                                    installed.path("facilitator.log"), environment);
    test::Process knows({build + "/c_agent", "know", "karen", "library"},
                        installed.path("know.log"), environment);
    const auto asked = [&](const std::vector<std::string>& command) {
      test::Process asks(command, installed.path("asked.log"), environment);
      return asks.wait() == 0 ? asks.output() : std::string();
    };
    const auto is_known = [&] {
      return asked({installed.program("saphira"), "ask", "place_of", "person=karen", "place=?"})
                 .find("library") != std::string::npos;
    };
    EXPECT_TRUE(test::wait_until(is_known)) << knows.output();
    // It stands still for a while: it is not asked then, and is asked again afterwards.
    knows.signal(SIGSTOP);
    EXPECT_TRUE(test::wait_until([&] { return !is_known(); }));
    knows.signal(SIGCONT);
    EXPECT_TRUE(test::wait_until(is_known)) << knows.output();
    EXPECT_NE(asked({build + "/c_agent", "ask", "karen"}).find("karen is in library"),
              std::string::npos)
        << knows.output();
    EXPECT_EQ(asked({build + "/c_agent", "ask", "nobody"}), "");
  }
  // A wrong word gives the exit code of a usage error.
  test::Process wrong({build + "/c_agent", "fly"}, installed.path("wrong.log"), environment);
  EXPECT_EQ(wrong.wait(), std::optional<int>(2));
  EXPECT_NE(wrong.output().find("expected state"), std::string::npos);
}

}  // namespace
}  // namespace saphira

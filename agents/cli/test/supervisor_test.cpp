#include "saphira/cli/supervisor.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "process.hpp"

namespace saphira::cli {
namespace {

using std::chrono::milliseconds;
using Clock = Supervisor::Clock;

ChildSpec shell(const std::string& name, const std::string& script) {
  return {name, {"/bin/sh", "-c", script}, {}, true};
}

/// A supervisor with stored output.
class SupervisorTest : public testing::Test {
 protected:
  Supervisor::Print keep() {
    return [this](std::string_view from, std::string_view line) {
      lines_.push_back(std::string(from) + "|" + std::string(line));
    };
  }

  Supervisor& start(std::vector<ChildSpec> children) {
    supervisor_.emplace(std::move(children), keep());
    supervisor_->start();
    return *supervisor_;
  }

  static bool run_until(Supervisor& supervisor, const std::function<bool()>& condition) {
    const auto end = Clock::now() + std::chrono::seconds(30);
    while (!condition() && Clock::now() < end)
      supervisor.step(milliseconds(20));
    return condition();
  }

  bool said(const std::string& line) const {
    return std::ranges::find(lines_, line) != lines_.end();
  }
  std::string all() const {
    std::string text;
    for (const std::string& line : lines_)
      text += line + "\n";
    return text;
  }

  std::vector<std::string> lines_;
  std::optional<Supervisor> supervisor_;
};

TEST_F(SupervisorTest, PrintsEachLineWithItsName) {
  Supervisor& supervisor = start(
      {shell("a", "echo one; echo two >&2; exec sleep 60"), shell("b", "printf 'without an end'")});
  EXPECT_TRUE(run_until(supervisor, [&] {
    return said("a|one") && said("a|two") && said("b|without an end");
  })) << all();
}

TEST_F(SupervisorTest, GivesTheEnvironment) {
  ChildSpec child = shell("a", "echo \"$SAPHIRA_TEST_WORD\"; exec sleep 60");
  child.environment["SAPHIRA_TEST_WORD"] = "hello";
  Supervisor& supervisor = start({child});
  EXPECT_TRUE(run_until(supervisor, [&] { return said("a|hello"); })) << all();
}

TEST_F(SupervisorTest, KillsWhatHangsAndStartsItAgainWithTheReason) {
  // A node's heartbeats, and then none.
  Supervisor& supervisor =
      start({shell("a",
                   "echo \"again: $SAPHIRA_STARTED_AGAIN\"\n"
                   "fd=${SAPHIRA_HEARTBEAT%%:*}\n"
                   "for i in 1 2 3 4 5 6; do head -c 32 /dev/zero >/dev/fd/$fd; done\n"
                   "exec sleep 1000"),
             shell("b", "exec sleep 1000")});
  const pid_t other = supervisor.children()[1].pid;
  EXPECT_TRUE(run_until(supervisor, [&] {
    return said("a|again: it hung: no sign of life for 10 s");
  })) << all();
  EXPECT_TRUE(said("|a: it hung: no sign of life for 10 s; killed")) << all();
  EXPECT_TRUE(said("a|again: ")) << all();
  EXPECT_EQ(supervisor.children()[1].pid, other) << "it says nothing, and is not judged";
}

TEST_F(SupervisorTest, StartsAgainWhatIsKilledAndBacksOff) {
  Supervisor& supervisor = start({shell("a", "exec sleep 60")});
  const auto starts = [&] { return supervisor.children().at(0).starts; };
  for (int round = 1; round <= 3; ++round) {
    const pid_t pid = supervisor.children().at(0).pid;
    ASSERT_GT(pid, 0);
    const auto killed = Clock::now();
    kill(pid, SIGKILL);
    ASSERT_TRUE(run_until(supervisor, [&] { return starts() == round + 1; })) << all();
    EXPECT_GE(Clock::now() - killed, milliseconds(100) * (1 << (round - 1)));
  }
  EXPECT_TRUE(said("|a ended: killed by SIGKILL; started again in 100 ms")) << all();
  EXPECT_TRUE(said("|a ended: killed by SIGKILL; started again in 400 ms")) << all();
}

TEST_F(SupervisorTest, TakesInNewVersionsOneAfterTheOther) {
  const test::TempDir folder;
  const auto write = [&](const std::string& name, const std::string& version) {
    const std::string path = folder.path(name);
    std::filesystem::remove(path);
    std::ofstream(path) << "#!/bin/sh\necho \"" << version << "\"\nexec sleep 1000\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return path;
  };
  std::vector<ChildSpec> children;
  for (const char* name : {"a", "b", "odd", "same"}) {
    children.push_back({name, {write(name, "old")}, {}, true});
    children.back().robot = "pioneer";
  }
  children.push_back({"sim", {write("sim", "old")}, {}, true});
  Supervisor& supervisor = start(children);
  const auto pid = [&](std::size_t i) { return supervisor.children()[i].pid; };
  // All children, since a shell reads its script only after its start.
  EXPECT_TRUE(run_until(supervisor, [&] {
    return said("a|old") && said("b|old") && said("odd|old") && said("same|old") && said("sim|old");
  })) << all();
  const pid_t same = pid(3);
  const pid_t sim = pid(4);
  for (const char* name : {"a", "b", "odd", "sim"})
    write(name, "new");
  supervisor.renew([&](const ChildSpec& child) {
    return child.name == "odd" || child.robot.empty() ? std::string("it speaks otherwise")
                                                      : std::string();
  });
  EXPECT_TRUE(supervisor.renews());
  EXPECT_TRUE(said("|odd stays as it is: it speaks otherwise")) << all();
  EXPECT_TRUE(said("|sim stays as it is: it speaks otherwise")) << all();
  const pid_t b = pid(1);
  EXPECT_TRUE(run_until(supervisor, [&] { return said("a|new"); })) << all();
  EXPECT_EQ(pid(1), b) << "one after the other";
  EXPECT_TRUE(run_until(supervisor, [&] { return said("|all new versions are taken in"); }))
      << all();
  EXPECT_TRUE(said("b|new"));
  EXPECT_FALSE(said("odd|new"));
  EXPECT_EQ(pid(3), same);
  EXPECT_EQ(pid(4), sim);
  EXPECT_FALSE(supervisor.renews());
  supervisor.renew([](const ChildSpec&) { return std::string("no"); });
  EXPECT_EQ(supervisor.children()[0].starts, 2);
}

TEST_F(SupervisorTest, HandsItsChildrenOver) {
  const test::TempDir folder;
  const std::string go_on = folder.path("go-on");
  const std::string waits =
      "echo one; while [ ! -e " + go_on + " ]; do sleep 0.02; done; echo two; exec sleep 1000";
  // Never destroyed, as its process would have got another program.
  auto* const before =
      new Supervisor({shell("a", waits), shell("gone", "exec sleep 1000")}, keep());
  before->start();
  ASSERT_TRUE(run_until(*before, [&] { return said("a|one"); })) << all();
  const pid_t a = before->children()[0].pid;
  const pid_t gone = before->children()[1].pid;
  const std::string children = before->hand_over();
  lines_.clear();
  {
    Supervisor after({shell("new", "echo new; exec sleep 1000"), shell("a", waits)}, keep());
    after.take_over(children);
    EXPECT_EQ(after.children()[1].pid, a);
    EXPECT_EQ(after.children()[1].starts, 1);
    std::ofstream(go_on).close();
    EXPECT_TRUE(run_until(after, [&] { return said("a|two") && said("new|new"); })) << all();
    EXPECT_FALSE(said("a|one"));
    EXPECT_TRUE(said("|gone is no more part of it"));
    EXPECT_EQ(waitpid(gone, nullptr, 0), gone);
    kill(a, SIGKILL);
    EXPECT_TRUE(run_until(after, [&] { return after.children()[1].starts == 2; })) << all();
  }
  EXPECT_NE(kill(a, 0), 0);
  Supervisor odd({shell("a", "exec sleep 1000")}, keep());
  EXPECT_THROW(odd.take_over("children 2\n"), std::invalid_argument);
  for (const char* child :
       {"my agent 1 1 -1 -1 file", "a", "a 1 1 -1", "a 1 1 -1 -1 file more", ""})
    EXPECT_THROW(odd.take_over(std::string("children 1\n") + child + "\n"), std::invalid_argument)
        << child;
  EXPECT_EQ(odd.children().at(0).pid, 0) << "none is taken, and none is started";
}

TEST_F(SupervisorTest, DoesNotStartAgainWhatIsMisused) {
  Supervisor& supervisor = start({shell("a", "echo bad option; exit 2")});
  EXPECT_TRUE(run_until(supervisor, [&] { return supervisor.misused().has_value(); }));
  EXPECT_EQ(supervisor.misused(), "a");
  EXPECT_TRUE(supervisor.finished());
  EXPECT_EQ(supervisor.children().at(0).starts, 1);
  EXPECT_EQ(lines_, (std::vector<std::string>{"a|bad option", "|a ended: exit code 2"}));
}

TEST_F(SupervisorTest, StartsAgainWhatEndsLateAsIfMisused) {
  // It ran, so its input is right.
  Supervisor supervisor({shell("a", "sleep 0.1; exit 2")}, keep(), milliseconds(50));
  supervisor.start();
  EXPECT_TRUE(run_until(supervisor, [&] { return supervisor.children().at(0).starts == 2; }));
  EXPECT_FALSE(supervisor.misused().has_value());
  EXPECT_TRUE(said("|a ended: exit code 2; started again in 100 ms")) << all();
}

/// Allows no further descriptor, as long as it lives.
class NoMoreFiles {
 public:
  NoMoreFiles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    rlimit few = before_;
    few.rlim_cur = 3;
    setrlimit(RLIMIT_NOFILE, &few);
  }
  ~NoMoreFiles() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoMoreFiles& operator=(NoMoreFiles&&) = delete;

 private:
  rlimit before_{};
};

TEST_F(SupervisorTest, TriesAgainWhatCannotBeStartedNow) {
  Supervisor& supervisor = start({shell("a", "exec sleep 60"), shell("b", "exec sleep 60")});
  const pid_t other = supervisor.children().at(1).pid;
  const std::string words = "|a cannot be started, no pipe: Too many open files; tried again in ";
  {
    const NoMoreFiles now;
    kill(supervisor.children().at(0).pid, SIGKILL);
    EXPECT_TRUE(run_until(supervisor, [&] { return said(words + "400 ms"); })) << all();
  }
  EXPECT_TRUE(said(words + "200 ms")) << all();
  EXPECT_EQ(supervisor.children().at(0).pid, 0);
  EXPECT_FALSE(supervisor.finished());
  EXPECT_TRUE(run_until(supervisor, [&] { return supervisor.children().at(0).starts == 2; }));
  EXPECT_EQ(supervisor.children().at(1).pid, other);
}

TEST_F(SupervisorTest, DoesNotStartAgainWhatMayEnd) {
  ChildSpec once = shell("a", "exit 0");
  once.restart = false;
  Supervisor& supervisor = start({once});
  EXPECT_TRUE(run_until(supervisor, [&] { return supervisor.finished(); }));
  EXPECT_FALSE(supervisor.misused().has_value());
}

TEST_F(SupervisorTest, SaysWhatCannotRun) {
  Supervisor& supervisor = start({{"a", {"/no/such/program"}, {}, false}});
  EXPECT_TRUE(run_until(supervisor, [&] { return supervisor.finished(); }));
  EXPECT_TRUE(said("a|cannot run /no/such/program: No such file or directory")) << all();
}

TEST_F(SupervisorTest, TellsACrashFromBeingKilled) {
  Supervisor& supervisor =
      start({shell("killed", "kill -TERM $$"), shell("crashed",
                                                     "trap 'kill -ABRT $$' TERM; echo up; "
                                                     "while :; do sleep 0.01; done")});
  EXPECT_TRUE(run_until(supervisor, [&] { return said("crashed|up"); })) << all();
  supervisor.stop();
  EXPECT_FALSE(supervisor.children()[0].crashed);
  EXPECT_TRUE(supervisor.children()[1].crashed);
}

TEST_F(SupervisorTest, StopsInReverseOrder) {
  const std::string script = "trap 'echo bye; exit 0' TERM; echo up; while :; do sleep 0.01; done";
  Supervisor& supervisor = start({shell("a", script), shell("b", script), shell("c", script)});
  ASSERT_TRUE(run_until(supervisor, [&] { return said("a|up") && said("b|up") && said("c|up"); }));
  lines_.clear();
  supervisor.stop(std::chrono::seconds(20));
  EXPECT_EQ(lines_, (std::vector<std::string>{"c|bye", "b|bye", "a|bye"}));
  EXPECT_TRUE(supervisor.finished());
}

TEST_F(SupervisorTest, KillsWhatDoesNotEnd) {
  Supervisor& supervisor = start({shell("a", "trap '' TERM; echo up; while :; do sleep 1; done")});
  ASSERT_TRUE(run_until(supervisor, [&] { return said("a|up"); }));
  const auto begin = Clock::now();
  supervisor.stop(milliseconds(300));
  EXPECT_GE(Clock::now() - begin, milliseconds(300));
  EXPECT_TRUE(said("|a did not end in time: killed")) << all();
  EXPECT_EQ(supervisor.children().at(0).ended, "killed by SIGKILL");
}

TEST_F(SupervisorTest, EndsAlsoWhatWasStopped) {
  Supervisor& supervisor = start({shell("a", "exec sleep 60")});
  kill(supervisor.children().at(0).pid, SIGSTOP);
  supervisor.stop(std::chrono::seconds(20));
  EXPECT_EQ(supervisor.children().at(0).ended, "killed by SIGTERM");
}

TEST_F(SupervisorTest, TheChildrenEndWithTheirSupervisor) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t middle = fork();
  if (middle == 0) {
    Supervisor supervisor({shell("a", "exec sleep 60")}, [](auto, auto) {});
    supervisor.start();
    const pid_t child = supervisor.children().at(0).pid;
    if (write(ends[1], &child, sizeof child) != sizeof child)
      _exit(1);
    raise(SIGKILL);
  }
  pid_t child = 0;
  ASSERT_EQ(read(ends[0], &child, sizeof child), static_cast<ssize_t>(sizeof child));
  waitpid(middle, nullptr, 0);
  // Re-parented: another process reaps it, so a zombie counts as ended.
  const auto gone = [child] {
    std::ifstream stat("/proc/" + std::to_string(child) + "/stat");
    std::string word;
    stat >> word >> word >> word;
    return !stat || word == "Z";
  };
  const auto limit = Clock::now() + std::chrono::seconds(30);
  while (!gone() && Clock::now() < limit)
    usleep(2000);
  EXPECT_TRUE(gone());
  close(ends[0]);
  close(ends[1]);
}

}  // namespace
}  // namespace saphira::cli

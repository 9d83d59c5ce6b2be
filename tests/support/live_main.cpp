// The main of tests on a bus of their own. It reserves a DDS domain that no other test of this
// machine uses, including leftovers of a killed test, and reports after a failure the time for
// which the machine itself stood still. 77: all tests were skipped.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Above, the ports of a domain overlap the kernel's ephemeral ports; lower domains are for people.
constexpr int kFirstDomain = 20;
constexpr int kDomains = 80;

/// Reserves a domain by the lock of a file. Children inherit the lock, so that the domain of a
/// process that outlives its test is not used again. False: all are taken, or the folder cannot be
/// written.
bool reserve_domain() {
  constexpr char kFolder[] = "/tmp/saphira-test-domains";
  mkdir(kFolder, 0777);
  chmod(kFolder, 0777);  // for any umask: tests of another user use it too
  for (int i = 0; i < kDomains; ++i) {
    const std::string domain = std::to_string(kFirstDomain + (getpid() + i) % kDomains);
    const int file = open((std::string(kFolder) + "/" + domain).c_str(), O_RDWR | O_CREAT, 0666);
    if (file < 0)
      continue;
    if (flock(file, LOCK_EX | LOCK_NB) == 0)
      return setenv("SAPHIRA_DOMAIN", domain.c_str(), 1) == 0;
    close(file);
  }
  return false;
}

/// Processor time that the host of this virtual machine has taken away so far, over all processors.
Seconds stolen() {
  std::ifstream in("/proc/stat");
  std::string cpu;
  double user = 0, nice = 0, system = 0, idle = 0, iowait = 0, irq = 0, softirq = 0, steal = 0;
  in >> cpu >> user >> nice >> system >> idle >> iowait >> irq >> softirq >> steal;
  return Seconds(steal / static_cast<double>(sysconf(_SC_CLK_TCK)));
}

/// Measures the time for which this process was ready but did not run.
class StallWatch {
 public:
  StallWatch() : thread_([this] { watch(); }) {}
  ~StallWatch() {
    ended_ = true;
    thread_.join();
  }

  Seconds longest() const { return Seconds(longest_.load()); }
  double stolen_share() const {
    return (stolen() - stolen_) / (Clock::now() - began_) / static_cast<double>(cores_);
  }

 private:
  void watch() {
    while (!ended_) {
      const auto before = Clock::now();
      poll(nullptr, 0, 5);
      longest_ = std::max(longest_.load(), Seconds(Clock::now() - before).count());
    }
  }

  const Clock::time_point began_ = Clock::now();
  const Seconds stolen_ = stolen();
  const unsigned cores_ = std::max(1U, std::thread::hardware_concurrency());
  std::atomic<bool> ended_ = false;
  std::atomic<double> longest_ = 0.0;
  std::thread thread_;
};

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!testing::GTEST_FLAG(list_tests) && !reserve_domain()) {
    std::printf("no DDS domain is free: see who uses /tmp/saphira-test-domains\n");
    return 1;
  }
  const StallWatch watch;
  const int result = RUN_ALL_TESTS();
  if (result != 0)
    std::printf("longest stall of the machine %.3f s, %.1f %% of its time taken by its host\n",
                watch.longest().count(), 100.0 * watch.stolen_share());
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  return result == 0 && all.successful_test_count() == 0 && all.skipped_test_count() > 0 ? 77
                                                                                         : result;
}

#include "saphira/cli/service_manager.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>

#include "process.hpp"

namespace saphira::cli {
namespace {

/// The receiver of the notifications, in place of a service manager.
class Manager {
 public:
  explicit Manager(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  ~Manager() { close(fd_); }
  std::string heard() const {
    std::array<char, 256> text{};
    const ssize_t size = recv(fd_, text.data(), text.size(), MSG_DONTWAIT);
    return {text.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }

 private:
  int fd_ = socket(AF_UNIX, SOCK_DGRAM, 0);
};

TEST(ServiceManager, IsToldOfTheStartTheEndAndLife) {
  const test::TempDir folder;
  const Manager manager(folder.path("notify"));
  setenv("WATCHDOG_USEC", "30000000", 1);
  setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  const ServiceManager us;
  EXPECT_EQ(std::getenv("NOTIFY_SOCKET"), nullptr) << "children are not to use it";
  EXPECT_EQ(us.period(), std::chrono::seconds(15));
  us.ready("8 programs of demo");
  EXPECT_EQ(manager.heard(), "READY=1\nSTATUS=8 programs of demo\n");
  us.alive();
  EXPECT_EQ(manager.heard(), "WATCHDOG=1\n");
  us.stopping();
  EXPECT_EQ(manager.heard(), "STOPPING=1\n");
}

TEST(ServiceManager, WithoutAWatchdogLifeIsNotTold) {
  const test::TempDir folder;
  const Manager manager(folder.path("notify"));
  const ServiceManager us;
  EXPECT_FALSE(us.period());
  us.alive();
  EXPECT_EQ(manager.heard(), "");
}

TEST(ServiceManager, WithoutAManagerNothingHappens) {
  unsetenv("NOTIFY_SOCKET");
  setenv("WATCHDOG_USEC", "30000000", 1);
  const ServiceManager us;
  EXPECT_FALSE(us.period());
  us.ready("");
  us.stopping();
}

}  // namespace
}  // namespace saphira::cli

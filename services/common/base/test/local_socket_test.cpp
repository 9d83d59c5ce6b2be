#include "saphira/base/local_socket.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "process.hpp"

namespace saphira {
namespace {

constexpr uid_t kOther = 65534;

/// A socket on which a user listens; the kernel tells its client whose it is.
Descriptor listener(const std::string& path, uid_t user) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.data(), path.size());
  Descriptor fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  EXPECT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::seteuid(user), 0);
  EXPECT_EQ(::listen(fd, 4), 0);
  EXPECT_EQ(::seteuid(::getuid()), 0);
  return fd;
}

TEST(LocalSocket, OfAnotherUserIsRefusedWhereAllMayWrite) {
  if (::getuid() != 0)
    GTEST_SKIP() << "only root can listen as another user";
  const test::TempDir folder;
  const std::string own = folder.path("own");
  const std::string others = folder.path("others");
  const Descriptor mine = listener(own, 0);
  const Descriptor theirs = listener(others, kOther);
  ASSERT_EQ(::chmod(folder.path().c_str(), 01777), 0);
  EXPECT_TRUE(bool(connect_local(own)));
  EXPECT_FALSE(bool(connect_local(others)));
  EXPECT_EQ(errno, EPERM);
  ASSERT_EQ(::chmod(folder.path().c_str(), 0755), 0);
  EXPECT_TRUE(bool(connect_local(others)));
}

TEST(LocalSocket, NobodyListensThere) {
  const test::TempDir folder;
  EXPECT_FALSE(bool(connect_local(folder.path("none"))));
  EXPECT_EQ(errno, ENOENT);
}

}  // namespace
}  // namespace saphira

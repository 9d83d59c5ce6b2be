#include "log.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>

namespace saphira::bus::test {
namespace {

// A terminal that was stopped, a pager: the bridge has a robot to hold.
TEST(Log, DoesNotWaitForWhoDoesNotRead) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const int flags = ::fcntl(ends[1], F_GETFL);
  ::fcntl(ends[1], F_SETFL, flags | O_NONBLOCK);
  const std::array<char, 4096> page{};
  while (::write(ends[1], page.data(), page.size()) > 0) {
  }
  ::fcntl(ends[1], F_SETFL, flags);
  const int kept = ::dup(STDERR_FILENO);
  ::dup2(ends[1], STDERR_FILENO);
  internal::write_log(v1::LOG_WARNING, "bridge", "lost");  // would wait for ever
  std::array<char, 1 << 17> all{};
  EXPECT_GT(::read(ends[0], all.data(), all.size()), 0);
  internal::write_log(v1::LOG_WARNING, "bridge", "read again");
  ::dup2(kept, STDERR_FILENO);
  const ssize_t n = ::read(ends[0], all.data(), all.size());
  const std::string text(all.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  EXPECT_NE(text.find(" warning bridge: 1 lines are missing here"), std::string::npos) << text;
  EXPECT_NE(text.find(" warning bridge: read again\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("lost"), std::string::npos) << text;
  for (const int fd : {ends[0], ends[1], kept})
    ::close(fd);
}

}  // namespace
}  // namespace saphira::bus::test

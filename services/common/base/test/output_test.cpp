#include "saphira/base/output.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <string>

namespace saphira {
namespace {

/// The answer where standard output goes to `fd`.
std::string answer_of(int fd, std::size_t size = 10, bool flushed_before = false) {
  std::fflush(stdout);
  const int before = ::dup(STDOUT_FILENO);
  EXPECT_GE(::dup2(fd, STDOUT_FILENO), 0);
  std::fputs(std::string(size, 'x').c_str(), stdout);
  if (flushed_before)
    std::fflush(stdout);
  std::string answer = flush_standard_output();
  EXPECT_GE(::dup2(before, STDOUT_FILENO), 0);
  ::close(before);
  std::fflush(stdout);
  std::clearerr(stdout);
  return answer;
}

TEST(Output, TheReasonIsNamedWhereItCannotBeWritten) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  // Text of the buffer, and more than fits there.
  for (const std::size_t size : {10U, 100000U})
    for (const bool before : {false, true})
      EXPECT_EQ(answer_of(full, size, before),
                "could not write the output: No space left on device");
  ::close(full);
}

TEST(Output, AReaderThatHasLeftIsNoFailure) {
  std::signal(SIGPIPE, SIG_IGN);
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  EXPECT_EQ(answer_of(ends[1]), "") << "a reader is there";
  ::close(ends[0]);
  EXPECT_EQ(answer_of(ends[1]), "");
  EXPECT_EQ(answer_of(ends[1], 10, true), "");
  EXPECT_EQ(answer_of(ends[1], 100000), "");
  ::close(ends[1]);
}

}  // namespace
}  // namespace saphira

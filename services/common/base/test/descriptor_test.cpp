#include "saphira/base/descriptor.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <optional>

namespace saphira {
namespace {

bool is_open(int fd) {
  return ::fcntl(fd, F_GETFD) >= 0;
}

TEST(Descriptor, IsClosedByItsLastOwner) {
  std::optional<Descriptor> first(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const int fd = *first;
  Descriptor second = std::move(*first);
  EXPECT_FALSE(*first);
  first.reset();
  EXPECT_TRUE(second && is_open(fd));
  errno = ENOENT;
  second.reset();
  EXPECT_EQ(errno, ENOENT);
  EXPECT_FALSE(is_open(fd));
}

}  // namespace
}  // namespace saphira

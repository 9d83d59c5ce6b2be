#include "saphira/base/fnv1a.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

std::uint64_t of(std::string_view text) {
  Fnv1a hash;
  hash.add(text);
  return hash.value();
}

// The test vectors of its authors (draft-eastlake-fnv, FNV-1a, 64 bits).
TEST(Fnv1a, IsWhatIsPublished) {
  EXPECT_EQ(of(""), 0xcbf29ce484222325U);
  EXPECT_EQ(of("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(of("foobar"), 0x85944171f73967e8U);
}

TEST(Fnv1a, BytesAfterEachOtherAreTheText) {
  Fnv1a hash;
  hash.add("foo");
  for (const std::uint8_t byte : {'b', 'a', 'r'})
    hash.add(byte);
  EXPECT_EQ(hash.value(), of("foobar"));
}

}  // namespace
}  // namespace saphira

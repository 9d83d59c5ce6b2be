#include "saphira/base/format.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace saphira {
namespace {

TEST(Format, IsOfAnyLength) {
  EXPECT_EQ(format("%.1f s of %d", 2.25, 7), "2.2 s of 7");
  const std::string word(255, 'x');
  EXPECT_EQ(format("%s", word.c_str()), word);
  EXPECT_EQ(format("%sy%s", word.c_str(), word.c_str()), word + "y" + word);
}

TEST(Format, BytesAreTwoDigitsEach) {
  EXPECT_EQ(hex_text({}), "");
  EXPECT_EQ(hex_text(std::array<std::uint8_t, 3>{0x00, 0x5A, 0xFF}), "005aff");
  EXPECT_EQ(random_hex(16).size(), 32U);
  EXPECT_NE(random_hex(16), random_hex(16));
}

TEST(Format, ATimeIsInUtcOrLocal) {
  EXPECT_EQ(utc_text(86400, "%Y-%m-%d %H:%M UTC"), "1970-01-02 00:00 UTC");
  ::setenv("TZ", "UTC-2", 1);
  ::tzset();
  EXPECT_EQ(local_text(86400, "%H:%M"), "02:00");
  ::unsetenv("TZ");
  ::tzset();
}

}  // namespace
}  // namespace saphira

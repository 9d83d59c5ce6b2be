#include "saphira/base/log_line.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace saphira {
namespace {

TEST(LogLine, HasTimeLevelProgramAndText) {
  ::setenv("TZ", "UTC0", 1);
  ::tzset();
  EXPECT_EQ(log_line(36123.456789, "info", "sim", "listening on /tmp/robot"),
            "10:02:03.456 info sim: listening on /tmp/robot");
  EXPECT_EQ(log_line(0.0, "warning", "bridge", ""), "00:00:00.000 warning bridge: ");
  EXPECT_EQ(log_line(86399.9999, "error", "a", "two\nlines"), "23:59:59.999 error a: two\nlines");
  EXPECT_EQ(log_line(0.0, "info", "a\nb", "\x1b[2J"), "00:00:00.000 info a?b: ?[2J");
}

}  // namespace
}  // namespace saphira

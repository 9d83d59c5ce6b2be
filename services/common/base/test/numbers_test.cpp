#include "saphira/base/numbers.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace saphira {
namespace {

TEST(Numbers, ArePlainForPeople) {
  EXPECT_EQ(plain(0.3), "0.3");
  EXPECT_EQ(plain(2.0), "2");
  EXPECT_EQ(plain(-1e6), "-1e+06");
  EXPECT_EQ(plain(1.0 / 3.0), "0.333333");
}

TEST(Numbers, ComeBackExactly) {
  for (const double value : {0.1, 1.0 / 3.0, -1e-300, std::numeric_limits<double>::max(), 0.0})
    EXPECT_EQ(std::stod(exact(value)), value);
  EXPECT_EQ(exact(0.1), "0.1");
}

TEST(Numbers, AsDecimalsHaveNoExponentAndNoZerosAtTheEnd) {
  EXPECT_EQ(decimal(1.5, 3), "1.5");
  EXPECT_EQ(decimal(100.0, 3), "100");
  EXPECT_EQ(decimal(100.0, 0), "100");
  EXPECT_EQ(decimal(-0.0001, 3), "0");
  EXPECT_EQ(decimal(1e9, 3), "1000000000");
  EXPECT_EQ(decimal(std::numeric_limits<double>::max(), 3).size(), 309U);
}

TEST(Numbers, AreReadOfAWholeTextOnly) {
  EXPECT_EQ(number_in<int>("-12"), -12);
  EXPECT_EQ(number_in<std::uint8_t>("ff", 16), 255);
  EXPECT_EQ(number_in<double>("1.5e3"), 1500.0);
  EXPECT_TRUE(number_in<double>("nan"));
  for (const char* wrong : {"", "+1", " 1", "1 ", "1x", "x"}) {
    EXPECT_FALSE(number_in<int>(wrong)) << wrong;
    EXPECT_FALSE(number_in<double>(wrong)) << wrong;
  }
  EXPECT_FALSE(number_in<int>("1.5"));
  EXPECT_FALSE(number_in<std::uint8_t>("256"));
  EXPECT_FALSE(number_in<std::uint32_t>("-1"));
  EXPECT_FALSE(number_in<double>("1e999"));
}

}  // namespace
}  // namespace saphira

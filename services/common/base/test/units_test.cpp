#include "saphira/base/units.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace saphira {
namespace {

TEST(Units, ANumberMayHaveItsUnit) {
  EXPECT_EQ(measured("0.3", "m/s"), 0.3);
  EXPECT_EQ(measured("0.3m/s", "m/s"), 0.3);
  EXPECT_EQ(measured("30 cm/s", "m/s"), 0.3);
  EXPECT_EQ(measured("+1.5m", "m"), 1.5);
  EXPECT_EQ(measured("-30cm", "m"), -0.3);
  EXPECT_EQ(measured("250mm", "m"), 0.25);
  EXPECT_EQ(measured("500ms", "s"), 0.5);
  EXPECT_EQ(measured("2min", "s"), 120.0);
  EXPECT_EQ(measured("90deg", "rad"), std::numbers::pi / 2.0);
  EXPECT_EQ(measured("90deg", "deg"), 90.0);
  EXPECT_DOUBLE_EQ(measured("1.5rad", "deg").value_or(0.0), 270.0 / std::numbers::pi);
  EXPECT_DOUBLE_EQ(measured("45deg/s", "rad/s").value_or(0.0), std::numbers::pi / 4.0);
}

TEST(Units, AnotherUnitIsNone) {
  for (const char* const text : {"1m", "1deg", "1s", "1kg", "1m/", "1 ", "1  m/s", "m/s", "",
                                 "fast", "nan", "inf", "+-1", "1e999", "1%", "0.3 m/s "})
    EXPECT_EQ(measured(text, "m/s"), std::nullopt) << text;
  EXPECT_EQ(measured("50%", ""), std::nullopt);
  EXPECT_EQ(measured("3parsec", "parsec"), 3.0);  // a unit that an activity declares
}

TEST(Units, AreNamed) {
  EXPECT_EQ(unit_names(), "m mm cm km s ms min h deg rad m/s mm/s cm/s deg/s rad/s %");
  EXPECT_EQ(find_unit("furlong"), nullptr);
  ASSERT_NE(find_unit("%"), nullptr);
  EXPECT_EQ(find_unit("%")->factor, 1e-2);
}

}  // namespace
}  // namespace saphira

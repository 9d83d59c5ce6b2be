// Numbers, bytes, units and lines of the log, as text and back.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "saphira/base/base64.hpp"
#include "saphira/base/fnv1a.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/log_line.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/printable.hpp"
#include "saphira/base/units.hpp"

namespace saphira {
namespace {

TEST(Base64, IsThatOfTheStandardBothWays) {
  // RFC 4648, 10.
  for (const auto& [bytes, text] : {std::pair{"", ""},
                                    {"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"fooba", "Zm9vYmE="},
                                    {"foobar", "Zm9vYmFy"}}) {
    EXPECT_EQ(base64(std::string_view(bytes)), text);
    EXPECT_EQ(from_base64(text), bytes);
  }
  std::string all;
  for (int byte = 0; byte < 256; ++byte)
    all += static_cast<char>(byte);
  EXPECT_EQ(from_base64(base64(all)), all);
}

TEST(Base64, AnythingElseIsRefused) {
  for (const char* text : {"Z", "Zg=", "Zg==Zg==", "Zm9v\n", "Zm-v", "===="})
    EXPECT_EQ(from_base64(text), std::nullopt) << text;
}

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

const std::vector<std::string> kCommands{"demo", "goal", "estop", "status", "behaviors"};

TEST(Guess, FindsWhatWasMeant) {
  EXPECT_EQ(guess("gaol", kCommands), "goal") << "two letters swapped";
  EXPECT_EQ(guess("dmo", kCommands), "demo") << "one left out";
  EXPECT_EQ(guess("estopp", kCommands), "estop") << "one too many";
  EXPECT_EQ(guess("behaviours", kCommands), "behaviors");
  EXPECT_EQ(guess("stat", kCommands), "status") << "the beginning";
  EXPECT_EQ(guess("radiusrobt", {"RadiusRobot"}), "RadiusRobot") << "whatever the case";
  EXPECT_EQ(did_you_mean("gaol", kCommands, "; help lists them"), ": did you mean goal?");
}

TEST(Guess, MarksAreLeftOut) {
  EXPECT_EQ(guess("jose", {"karen", "jos\u00e9"}), "jos\u00e9");
  EXPECT_EQ(guess("buro sud", {"B\u00fcro S\u00fcd"}), "B\u00fcro S\u00fcd");
  EXPECT_EQ(guess("BU\u0308RO SUD", {"B\u00fcro S\u00fcd"}), "B\u00fcro S\u00fcd");
  EXPECT_EQ(guess("\xFFgoal", kCommands), "goal") << "not UTF-8";
}

TEST(Guess, IsSilentWhereNothingIsNear) {
  EXPECT_EQ(guess("fly", kCommands), "");
  EXPECT_EQ(guess("", kCommands), "");
  EXPECT_EQ(guess("x", kCommands), "");
  EXPECT_EQ(guess(std::string(100'000, 'g'), kCommands), "");
  EXPECT_EQ(guess("goal", {}), "");
  EXPECT_EQ(did_you_mean("fly", kCommands), "");
  EXPECT_EQ(did_you_mean("halt", {"goal", "estop"}), ": did you mean estop?");
  EXPECT_EQ(did_you_mean("hand-back", {"drive"}), ": did you mean drive hand-back?");
  EXPECT_EQ(did_you_mean("off", {"reset"}), ": did you mean reset?");
  EXPECT_EQ(did_you_mean("off", {"goal"}), "");
  EXPECT_EQ(did_you_mean("fly", kCommands, "; help lists them"), "; help lists them");
}

TEST(Guess, TheLongestKnownBeginningOfALongerName) {
  const std::vector<std::string> robots{"p3dx", "p3dx-sh", "p3at"};
  EXPECT_EQ(guess("p3dx-sh-lms1xx", robots), "p3dx-sh");
  EXPECT_EQ(guess("P3AT_laser_and_gripper", robots), "p3at");
  EXPECT_EQ(guess("p3atlaserandgripper", robots), "");
}

TEST(LogLine, HasTimeLevelProgramAndText) {
  ::setenv("TZ", "UTC0", 1);
  ::tzset();
  EXPECT_EQ(log_line(36123.456789, "info", "sim", "listening on /tmp/robot"),
            "10:02:03.456 info sim: listening on /tmp/robot");
  EXPECT_EQ(log_line(0.0, "warning", "bridge", ""), "00:00:00.000 warning bridge: ");
  EXPECT_EQ(log_line(86399.9999, "error", "a", "two\nlines"), "23:59:59.999 error a: two\nlines");
  EXPECT_EQ(log_line(0.0, "info", "a\nb", "\x1b[2J"), "00:00:00.000 info a?b: ?[2J");
}

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

TEST(Printable, NothingDrivesTheTerminal) {
  EXPECT_EQ(printable("hello"), "hello");
  EXPECT_EQ(printable("\x1b[2J\x1b]0;title\x07"), "?[2J?]0;title?");
  EXPECT_EQ(printable(std::string_view("a\0b\x7f", 4)), "a?b?");
  EXPECT_EQ(printable("a\nb\tc\rd"), "a?b?c?d");
  EXPECT_EQ(printable("a\nb\tc\rd", "\n\t"), "a\nb\tc?d");
}

TEST(Printable, LettersStay) {
  EXPECT_EQ(printable("Grüße, 世界"), "Grüße, 世界");
  EXPECT_EQ(printable("\xc2\xa0\xc2\x9b"
                      "2J"),
            "\xc2\xa0??2J");
}

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
  EXPECT_EQ(unit_names(), "m mm cm km s ms min h deg rad m/s mm/s cm/s km/h deg/s rad/s %");
  EXPECT_EQ(find_unit("furlong"), nullptr);
  ASSERT_NE(find_unit("%"), nullptr);
  EXPECT_EQ(find_unit("%")->factor, 1e-2);
}

}  // namespace
}  // namespace saphira

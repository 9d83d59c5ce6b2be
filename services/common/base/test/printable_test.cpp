#include "saphira/base/printable.hpp"

#include <gtest/gtest.h>

namespace saphira {
namespace {

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

}  // namespace
}  // namespace saphira

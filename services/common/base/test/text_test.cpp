#include "saphira/base/text.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>

#include "process.hpp"

namespace saphira {
namespace {

/// The message of its FileError.
template <class F>
std::string trouble(F&& f) {
  return test::trouble_of<FileError>(std::forward<F>(f));
}

TEST(Text, NamesAreComparedAsPeopleReadThem) {
  EXPECT_EQ(lowered("EJ-231 [@Z`{"), "ej-231 [@z`{");
  const std::string jose = "jos\u00e9";
  for (const char* const said : {"Jos\u00e9", "Jose\u0301", "JOS\u00c9", "JOSE\u0301"})
    EXPECT_EQ(lowered(said), jose) << said;
  EXPECT_NE(lowered("Jose"), jose);
  EXPECT_EQ(lowered("Bu\u0308ro S\u00dcD"), "b\u00fcro s\u00fcd");
  EXPECT_EQ(lowered("Wei\u00df"), lowered("WEISS"));
  // The dot of this capital is a mark of its own behind the small letter, with any locale.
  EXPECT_EQ(lowered("\u0130stanbul"), "i\u0307stanbul");
  EXPECT_EQ(lowered(lowered("\u0130stanbul")), lowered("\u0130stanbul"));
}

TEST(Text, WhatIsNotUtf8StaysAsItIs) {
  EXPECT_EQ(lowered("EJ-231 \xC4"), "ej-231 \xC4");
  EXPECT_EQ(lowered("\xC3"), "\xC3");
  EXPECT_EQ(lowered("\xED\xA0\x80\xFF"), "\xED\xA0\x80\xFF");
  EXPECT_EQ(lowered(""), "");
  const std::string zero("\0\u00c9", 3);
  EXPECT_EQ(lowered(zero), std::string("\0\u00e9", 3));
}

TEST(Text, SplitsWordsAndDropsComments) {
  const auto lines = split_lines("; head\n\n  width 38000 ; mm\r\n\tpop\n");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].number, 3);
  ASSERT_EQ(lines[0].words.size(), 2U);
  EXPECT_EQ(lines[0].words[1].text, "38000");
  EXPECT_EQ(lines[0].words[1].column, 9);
  EXPECT_EQ(lines[1].words[0].column, 2);
}

TEST(Text, ErrorNamesThePlaceAndWhatWasExpected) {
  const auto lines = split_lines("0 0 abc 3");
  LineReader reader("a.wld", lines[0]);
  reader.number("x");
  reader.number("y");
  EXPECT_EQ(trouble([&] { reader.number("x of the end point"); }),
            "a.wld:1:5: expected a number (x of the end point), found \"abc\"\n"
            "    0 0 abc 3\n"
            "        ^");
}

TEST(Text, OfALongLineThePartAroundThePlaceIsShown) {
  const std::string many(1000, 'a');
  const std::string part(49, 'a');
  EXPECT_EQ(
      FileError("a.p", 1, 1001, "bad", many + "b" + many).what(),
      "a.p:1:1001: bad\n    ..." + part + "b" + part + "a...\n    " + std::string(52, ' ') + "^");
  EXPECT_EQ(FileError("a.p", 1, 1, "bad", many).what(),
            "a.p:1:1: bad\n    " + many.substr(0, 100) + "...\n    ^");
  const std::string line = "n " + many;
  const auto words = split_lines(line);
  LineReader reader("a.p", words[0]);
  reader.word("a name");
  EXPECT_TRUE(test::has(trouble([&] { reader.number("x"); }),
                        "found \"" + many.substr(0, 100) + "...\"\n"));
}

TEST(Text, ControlCharactersDoNotEndAMessage) {
  EXPECT_STREQ(
      FileError("a.p", 1, 2, std::string("bad \0", 5) + "x", std::string_view("\0\t\x1B[1m", 6))
          .what(),
      "a.p:1:2: bad ?x\n    ?\t?[1m\n     ^");
}

TEST(Text, ATextThatEndsWithinALineWasCutOff) {
  for (const char* whole : {"", "; comment", "a 1\n", "a 1\r", "a 1 \n", "a 1; comment", "a 1\n\n"})
    EXPECT_NO_THROW(expect_last_line_break(whole, "a.p")) << whole;
  for (const char* cut : {"a 100\n\nb 20", "a 100\n\nb 20 ", "a 100\n\nb 20\t"})
    EXPECT_TRUE(trouble([&] { expect_last_line_break(cut, "a.p"); }).starts_with("a.p:3:5: "));
}

TEST(Text, MissingAndSurplusWordsAreErrors) {
  const auto lines = split_lines("push 1 2\npop 3\nn 2.5\nn 1e999\nn nan\nn 7");
  LineReader push("f", lines[0]);
  push.word("a directive");
  push.number("x");
  push.number("y");
  EXPECT_THROW(push.number("theta"), FileError);
  LineReader pop("f", lines[1]);
  pop.word("a directive");
  EXPECT_THROW(pop.expect_end(), FileError);
  for (const std::size_t i : {2U, 3U, 4U, 5U}) {
    LineReader reader("f", lines[i]);
    reader.word("a name");
    EXPECT_THROW(reader.integer("count", 0, 5), FileError) << i;
  }
}

TEST(Text, AByteOrderMarkIsNoPartOfTheText) {
  const test::TempDir folder;
  const std::string path = folder.path("marked.map");
  std::ofstream(path) << "\xEF\xBB\xBFWALL\n";
  EXPECT_EQ(read_file(path), "WALL\n");
}

TEST(Text, ALetterHasItsBytes) {
  EXPECT_EQ(first_letters("a\u00fcb", 4), "a\u00fcb");
  EXPECT_EQ(first_letters("a\u00fcb", 3), "a\u00fc");
  EXPECT_EQ(first_letters("a\u00fcb", 2), "a");
  EXPECT_EQ(first_letters("", 2), "");
  EXPECT_EQ(letter_size(""), 0U);
  EXPECT_EQ(letter_size("ab"), 1U);
  EXPECT_EQ(letter_size(std::string_view("\0", 1)), 1U);
  EXPECT_EQ(letter_size("\u00fcb"), 2U);
  EXPECT_EQ(letter_size("\u20ac"), 3U);
  EXPECT_EQ(letter_size("\U0010ffff"), 4U);
  for (const char* const none :
       {"\xFCr", "\x80", "\xC3", "\xC3(", "\xE2\x82", "\xE2(\xAC", "\xC0\xAF", "\xC1\x81",
        "\xE0\x80\x80", "\xED\xA0\x80", "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80",
        "\xFF"})
    EXPECT_EQ(letter_size(none), 0U) << none;
}

TEST(Text, AFileInLatin1IsRefusedAtItsPlace) {
  const test::TempDir folder;
  const std::string path = folder.path("office.map");
  std::ofstream(path) << "; caf\u00e9\nPOS (1) 0, 0, 0 \"K\xFC"
                      << "che\"\n";
  EXPECT_EQ(trouble([&] { read_file(path); }),
            path +
                ":2:19: expected a text in UTF-8, found the byte 0xFC (Latin-1?): save it as "
                "UTF-8\n    POS (1) 0, 0, 0 \"K?che\"\n                      ^");
  EXPECT_NE(read_bytes(path).find('\xFC'), std::string::npos);
  const std::string good = "\u00fc \u20ac \U0001f600\n";
  std::ofstream(path) << good;
  EXPECT_EQ(read_file(path), good);
  // The reader of a map names a picture.
  std::ofstream(path) << "\x89PNG" << '\0';
  EXPECT_EQ(other_format(read_file(path)), "a picture (PNG)");
  std::ofstream(path) << "\xFF\xFE"
                         "DOOR";
  EXPECT_EQ(other_format(read_file(path)), "a text in UTF-16 (save it as UTF-8)");
}

TEST(Text, FilesOfOtherProgramsAreKnown) {
  EXPECT_NE(other_format("2D-Map\nLineMinPos: 0 0\n").find("ARIA"), std::string_view::npos);
  EXPECT_NE(other_format("P5\n10 10\n255\n").find("PGM"), std::string_view::npos);
  EXPECT_EQ(other_format("POS (1) 0, 0, 0\n"), "");
  EXPECT_EQ(other_format("P50 0 0\n"), "");
  EXPECT_EQ(other_format(""), "");
  EXPECT_EQ(other_format("#ROSBAG V2.0\n"), "a recording of ROS (rosbag)");
  EXPECT_EQ(other_format("\x1f\x8b\x08"), "a packed file (gzip)");
  EXPECT_EQ(other_format("define floorplan model\n"), "a world of Stage");
  EXPECT_NO_THROW(expect_own_format("width 1000\n", "a.wld", "a world"));
  EXPECT_EQ(trouble([] { expect_own_format("\xFF\xFEw", "a.wld", "a world"); }),
            "a.wld:1:1: this is a text in UTF-16 (save it as UTF-8), and not a world");
}

TEST(Text, TheReasonStandsBehindTheFile) {
  errno = ENOSPC;
  EXPECT_EQ(cannot_be("/run/lock", "written"),
            "/run/lock: cannot be written: No space left on device");
}

TEST(Text, OneThingIsNoPlural) {
  EXPECT_EQ(counted(0, "program"), "0 programs");
  EXPECT_EQ(counted(1, "program"), "1 program");
  EXPECT_EQ(counted(2, "program"), "2 programs");
}

TEST(Text, EveryItemOfAListIsSeparated) {
  EXPECT_EQ(joined(std::vector<std::string>{}), "");
  EXPECT_EQ(joined(std::vector<std::string>{"", "b", ""}, "/"), "/b/");
  EXPECT_EQ(joined(std::vector<int>{1, 2}, " and ", [](int n) { return std::to_string(n); }),
            "1 and 2");
}

TEST(Text, UnusableFileIsNamed) {
  EXPECT_TRUE(
      test::has(test::trouble_of<std::runtime_error>([] { read_file("/nonexistent/file.wld"); }),
                "/nonexistent/file.wld"));
  EXPECT_THROW(read_file("/"), std::runtime_error);
  EXPECT_EQ(read_file("/dev/null"), "");
}

}  // namespace
}  // namespace saphira

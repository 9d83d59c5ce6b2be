#include "saphira/security/audit_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::security {
namespace {

class AuditFileTest : public testing::Test {
 protected:
  AuditFileTest() { begin(); }
  void begin(std::size_t most = AuditFile::kMost) { audit.emplace(path, most); }
  /// Entries of different texts.
  void write(int count) {
    for (int i = 0; i < count; ++i)
      EXPECT_EQ(audit->write({.act = v1::AUDIT_ASKED,
                              .who = "karen (operator), saphira goal",
                              .text = std::to_string(++number)},
                             1'800'000'000.0),
                "");
  }
  void change(const std::string& file, const std::function<std::string(std::string)>& how) const {
    const std::string text = how(read_bytes(file));
    std::ofstream(file) << text;
  }
  std::string trouble(const std::string& known = {}) const {
    return read_audit(path, known).trouble;
  }

  std::uint64_t first_number() const { return std::stoull(read_audit(path).lines.front()); }

  saphira::test::TempDir folder;
  std::string path = folder.path("audit");
  std::optional<AuditFile> audit;
  int number = 0;
};

TEST_F(AuditFileTest, SaysWhoDidWhatAndWhen) {
  EXPECT_THROW(read_audit(path), UnusableFile);
  audit->write(
      {.act = v1::AUDIT_STOPPED, .who = "john (observer), the console", .text = "nobody drove"},
      1'800'000'000.0);
  const AuditRecord record = read_audit(path);
  EXPECT_EQ(record.lines, std::vector<std::string>{
                              "1\t2027-01-15T08:00:00Z\tstopped\tjohn (observer), the console\t"
                              "nobody drove"});
  EXPECT_EQ(record.number, 1U);
  EXPECT_EQ(record.hash.size(), 64U);
  EXPECT_EQ(record.trouble, "");
}

TEST_F(AuditFileTest, GoesOnAfterARestart) {
  write(2);
  begin();
  write(2);
  EXPECT_EQ(read_audit(path).number, 4U);
  EXPECT_EQ(trouble(), "");
}

TEST_F(AuditFileTest, EachChangeShows) {
  write(4);
  const std::string whole = read_bytes(path);
  const auto lines = [&](std::size_t from, std::size_t count) {
    std::size_t begin = 0;
    while (from-- > 0)
      begin = whole.find('\n', begin) + 1;
    std::size_t end = begin;
    while (count-- > 0)
      end = whole.find('\n', end) + 1;
    return whole.substr(begin, end - begin);
  };
  std::string changed = whole;
  changed[whole.find("karen")] = 'K';
  std::string other_hash = whole;
  other_hash.replace(whole.size() - 3, 2, "zz");
  for (const std::string& text :
       {changed, other_hash, lines(1, 3), lines(0, 3), lines(0, 1) + lines(2, 2),
        lines(1, 1) + lines(0, 1) + lines(2, 2), whole + lines(3, 1), whole + "5\tx\n",
        whole.substr(0, whole.size() - 1), std::string()}) {
    change(path, [&](const std::string&) { return text; });
    EXPECT_NE(trouble(), "") << text;
  }
  change(path, [&](const std::string&) { return whole; });
  EXPECT_EQ(trouble(), "");
  std::filesystem::remove(path + ".head");
  EXPECT_NE(trouble(), "");
}

TEST_F(AuditFileTest, AnAuditThatWasWrittenAnewHasNotTheNotedHash) {
  write(3);
  const std::string noted = read_audit(path).hash;
  write(1);
  EXPECT_EQ(trouble(noted), "");
  std::filesystem::remove(path);
  std::filesystem::remove(path + ".head");
  begin();
  write(4);
  EXPECT_EQ(trouble(), "");
  EXPECT_NE(trouble(noted), "");
}

TEST_F(AuditFileTest, ItsPartsAreOneChainAndBounded) {
  begin(1000);  // some entries a part
  write(30);
  ASSERT_TRUE(std::filesystem::exists(path + ".1"));
  EXPECT_FALSE(std::filesystem::exists(path + ".8"));
  EXPECT_EQ(read_audit(path).lines.size(), 30U);
  EXPECT_EQ(trouble(), "");
  std::filesystem::remove(path + ".2");
  EXPECT_NE(trouble(), "") << "a part in the middle";
  write(300);
  EXPECT_TRUE(std::filesystem::exists(path + ".8"));
  EXPECT_FALSE(std::filesystem::exists(path + ".9"));
  EXPECT_EQ(trouble(), "") << "the oldest entries have ended with their parts";
  begin(1000);
  write(20);
  EXPECT_EQ(trouble(), "");
  EXPECT_EQ(read_audit(path).vouched_from, first_number());
  const std::string oldest = read_bytes(path + ".8");
  change(path + ".8", [](const std::string& text) { return text.substr(text.find('\n') + 1); });
  EXPECT_NE(trouble(), "") << "the first entry";
  change(path + ".8", [&](const std::string&) {
    std::string changed = oldest;
    changed[changed.find("karen")] = 'K';
    return changed;
  });
  EXPECT_NE(trouble(), "") << "its text";
  change(path + ".8", [&](const std::string&) { return oldest; });
  EXPECT_EQ(trouble(), "");
  std::filesystem::remove(path + ".8");
  EXPECT_NE(trouble(), "") << "the oldest part";
}

TEST_F(AuditFileTest, APartThatIsAboutToEndIsVouchedForAsBefore) {
  begin(1000);
  write(200);
  // A crash between the entry about the oldest part and its end: that part is still there.
  std::vector<std::string> parts;
  std::string newest;
  std::string head;
  const auto ends = [&] { return newest.find("\tended\t") != std::string::npos; };
  do {
    parts.clear();
    head = read_bytes(path + ".head");
    for (int part = 1; part <= 8; ++part)
      parts.push_back(read_bytes(path + "." + std::to_string(part)));
    write(1);
    newest = read_bytes(path + ".1");
  } while (newest == parts[0]);
  ASSERT_TRUE(ends());
  for (int part = 1; part <= 8; ++part)
    change(path + "." + std::to_string(part), [&](const std::string&) { return parts[part - 1]; });
  change(path, [&](const std::string&) { return newest; });
  change(path + ".head", [&](const std::string&) { return head; });
  begin(1000);
  write(1);
  EXPECT_EQ(trouble(), "");
  EXPECT_EQ(read_audit(path).vouched_from, first_number());
}

TEST_F(AuditFileTest, AnAuditThatAnEarlierVersionCutIsVouchedForFromItsSecondEntryOn) {
  write(3);
  const std::string whole = read_bytes(path);
  std::ofstream(path + ".8") << whole.substr(whole.find('\n') + 1);
  std::filesystem::remove(path);
  for (int part = 1; part < 8; ++part)
    std::ofstream(path + "." + std::to_string(part)).close();
  EXPECT_EQ(trouble(), "");
  EXPECT_EQ(read_audit(path).vouched_from, 3U);
}

TEST_F(AuditFileTest, WhatAFullDiskDoesNotTakeWaitsAndIsCounted) {
  EXPECT_EQ(audit->tend(0.0), "");
  EXPECT_EQ(read_audit(path).lines.size(), 0U);
  EXPECT_EQ(trouble(), "");
  const std::string kept = path + ".kept";
  std::filesystem::rename(path, kept);
  std::filesystem::create_symlink("/dev/full", path);
  for (std::size_t i = 0; i < AuditFile::kMostWaiting + 2; ++i)
    EXPECT_NE(
        audit->write({.act = v1::AUDIT_ASKED, .who = "karen (operator)", .text = std::to_string(i)},
                     100.0),
        "");
  EXPECT_NE(audit->tend(100.0), "");
  std::filesystem::rename(kept, path);
  EXPECT_EQ(audit->tend(200.0), "");
  const AuditRecord record = read_audit(path);
  EXPECT_EQ(record.trouble, "");
  ASSERT_EQ(record.lines.size(), AuditFile::kMostWaiting + 1);
  EXPECT_NE(record.lines.front().find("1970-01-01T00:01:40Z"), std::string::npos)
      << "the time of the act";
  EXPECT_NE(record.lines.back().find("2 later entries"), std::string::npos);
}

TEST_F(AuditFileTest, LinesWithoutTheirHeadAreGoneOnFrom) {
  write(1);
  const std::string head = read_bytes(path + ".head");
  write(3);
  change(path + ".head", [&](const std::string&) { return head; });
  begin();
  write(1);
  EXPECT_EQ(read_audit(path).number, 5U);
  EXPECT_EQ(trouble(), "");
}

TEST_F(AuditFileTest, APowerCutLeavesAWholeChain) {
  write(2);
  change(path, [](const std::string& text) { return text + "3\t2027-01"; });
  begin();
  write(1);
  EXPECT_EQ(read_audit(path).number, 3U);
  EXPECT_EQ(trouble(), "");
  // The line came, and its head did not.
  const std::string head = read_bytes(path + ".head");
  write(1);
  change(path + ".head", [&](const std::string&) { return head; });
  EXPECT_EQ(trouble(), "");
  begin();
  write(1);
  EXPECT_EQ(read_audit(path).number, 5U);
  EXPECT_EQ(trouble(), "");
}

TEST_F(AuditFileTest, ARepetitionWithinTenSecondsIsLeftOut) {
  const v1::AuditEntry entry{
      .act = v1::AUDIT_DROVE, .who = "karen (operator), saphira drive", .text = ""};
  for (const double time : {100.0, 101.0, 109.9, 110.0})
    audit->write(entry, time);
  EXPECT_EQ(read_audit(path).lines.size(), 2U);
}

TEST_F(AuditFileTest, ATextOfSomebodyElseIsNoSecondEntry) {
  audit->write(
      {.act = v1::AUDIT_ASKED, .who = "a\tb\n2\t", .text = "\x1b[2J" + std::string(2000, 'x')},
      1'800'000'000.0);
  const AuditRecord record = read_audit(path);
  ASSERT_EQ(record.lines.size(), 1U);
  EXPECT_EQ(record.lines[0].find('\x1b'), std::string::npos);
  EXPECT_LT(record.lines[0].size(), 600U);
  EXPECT_EQ(record.trouble, "");
}

}  // namespace
}  // namespace saphira::security

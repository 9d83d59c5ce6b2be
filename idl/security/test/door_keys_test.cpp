#include "saphira/security/door_keys.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/digest.hpp"

namespace saphira::security {
namespace {

constexpr std::int64_t kNow = 1'800'000'000;  // 2027-01-15
constexpr std::int64_t kDay = 86400;

TEST(Digest, IsTheOneOfTheStandard) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(DoorKeys, AKeyIsFoundUntilItsLastDayIsOver) {
  DoorKeys keys;
  const std::string anna = keys.add("anna", DoorRight::operate, 1, kNow);
  const std::string bob = keys.add("bob", DoorRight::watch, 30, kNow);
  ASSERT_NE(keys.find(anna, kNow), nullptr);
  EXPECT_EQ(keys.find(anna, kNow)->name, "anna");
  EXPECT_EQ(keys.find(bob, kNow)->right, DoorRight::watch);
  EXPECT_NE(keys.find(anna, kNow + kDay), nullptr);
  EXPECT_EQ(keys.find(anna, kNow + 2 * kDay), nullptr);
  EXPECT_EQ(keys.ended(anna, kNow + 2 * kDay), "anna");
  EXPECT_EQ(keys.ended(anna, kNow), "");
  EXPECT_EQ(keys.ended("nobody's", kNow + 2 * kDay), "");
  for (const std::string& wrong : {std::string(), anna.substr(1), anna + "0", std::string(32, 'f')})
    EXPECT_EQ(keys.find(wrong, kNow), nullptr) << wrong;
  EXPECT_EQ(keys.find(keys.all()[0].hash, kNow), nullptr) << "the file gives nobody a key";
}

TEST(DoorKeys, TheFileHoldsNoKeyAndReadsTheSame) {
  DoorKeys keys;
  const std::string anna = keys.add("anna", DoorRight::drive, 30, kNow);
  const std::string text = keys.text();
  EXPECT_EQ(text.find(anna), std::string::npos);
  const DoorKeys again(text, "keys");
  EXPECT_EQ(again.text(), text);
  ASSERT_NE(again.find(anna, kNow), nullptr);
  EXPECT_TRUE(again.holds(keys.all()[0], kNow));
}

TEST(DoorKeys, ARevokedOrChangedKeyDoesNotHold) {
  DoorKeys keys;
  keys.add("anna", DoorRight::drive, 30, kNow);
  const DoorKey before = keys.all()[0];
  EXPECT_FALSE(keys.holds(before, before.until));
  keys.revoke("anna");
  EXPECT_FALSE(keys.holds(before, kNow));
  keys.add("anna", DoorRight::drive, 30, kNow);
  EXPECT_FALSE(keys.holds(before, kNow)) << "a new key of that name";
  EXPECT_THROW(keys.revoke("bob"), std::invalid_argument);
}

TEST(DoorKeys, BadNamesAndTermsAreRefused) {
  DoorKeys keys;
  keys.add("anna", DoorRight::drive, 30, kNow);
  for (const char* const name : {"", "anna", "a b", "a\nb", "anna at flakey", "\x1b[2J", "Anna",
                                 "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"})
    EXPECT_THROW(keys.add(name, DoorRight::drive, 30, kNow), std::invalid_argument) << name;
  EXPECT_THROW(keys.add("bob", DoorRight::drive, 0, kNow), std::invalid_argument);
  EXPECT_THROW(keys.add("bob", DoorRight::drive, 3651, kNow), std::invalid_argument);
}

TEST(DoorKeys, AnErrorNamesItsLineAndColumn) {
  const std::string hash = std::string(64, 'a');
  const auto place = [](const std::string& text) {
    try {
      DoorKeys(text, "keys");
    } catch (const FileError& error) {
      return std::pair(error.line(), error.column());
    }
    return std::pair(0, 0);
  };
  EXPECT_EQ(place("; nothing\nanna drive 2027-05-31 " + hash + "\n"), std::pair(0, 0));
  EXPECT_EQ(place("\nanna fly 2027-05-31 " + hash + "\n"), std::pair(2, 6));
  EXPECT_EQ(place("anna drive tomorrow " + hash + "\n"), std::pair(1, 12));
  EXPECT_EQ(place("anna drive 2027-05-31 abc\n"), std::pair(1, 23));
  EXPECT_EQ(place("anna drive 2027-05-31 " + hash + "\nanna drive 2027-05-31 " + hash + "\n"),
            std::pair(2, 1));
  EXPECT_EQ(place("anna drive 2027-05-31 " + hash), std::pair(1, 87)) << "half a line";
}

TEST(DoorKeysFile, AChangedFileCountsAndABadOneDoesNot) {
  saphira::test::TempDir folder;
  const std::string path = folder.path("door-keys");
  DoorKeysFile file({folder.path("none"), path});
  EXPECT_EQ(file.reload(1), "");
  DoorKeys keys;
  const std::string anna = keys.add("anna", DoorRight::drive, 30, kNow);
  const auto write = [&](const std::string& text) {
    std::ofstream(path) << text;
    chmod(path.c_str(), 0644);
  };
  write(keys.text());
  EXPECT_EQ(file.reload(1), "") << "once in a second";
  EXPECT_EQ(file.keys().find(anna, kNow), nullptr);
  EXPECT_EQ(file.reload(2), "");
  EXPECT_NE(file.keys().find(anna, kNow), nullptr);
  write("anna\n");
  EXPECT_NE(file.reload(3), "");
  EXPECT_EQ(file.reload(4), "") << "said once";
  EXPECT_NE(file.keys().find(anna, kNow), nullptr);
  write(DoorKeys().text());
  EXPECT_EQ(file.reload(5), "");
  EXPECT_EQ(file.keys().find(anna, kNow), nullptr);
  write(keys.text());
  chmod(path.c_str(), 0666);
  EXPECT_NE(file.reload(6), "") << "anybody may have written it";
  EXPECT_EQ(file.keys().find(anna, kNow), nullptr);
}

}  // namespace
}  // namespace saphira::security

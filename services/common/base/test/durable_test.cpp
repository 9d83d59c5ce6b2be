#include "saphira/base/durable.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "trouble.hpp"

namespace saphira {
namespace {

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

TEST(Durable, ASealedTextIsWhatItWas) {
  const std::string text = "one\ntwo\n";
  const std::string whole = sealed(text);
  EXPECT_EQ(unsealed(whole, "file"), text);
  EXPECT_EQ(unsealed(sealed(""), "file"), "");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      EXPECT_THROW(unsealed(damaged, "file"), FileError) << i << " " << bit;
    }
    EXPECT_THROW(unsealed(whole.substr(0, i), "file"), FileError);
  }
  EXPECT_THROW(unsealed(whole + "more\n", "file"), FileError);
}

TEST(Durable, WhatWasSealedIsKnownByItsBeginning) {
  const std::string whole = sealed("one\ntwo\n");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_TRUE(was_sealed(whole.substr(0, i))) << i;
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      EXPECT_TRUE(was_sealed(damaged)) << i << " " << bit << " " << damaged;
    }
  }
  EXPECT_TRUE(was_sealed(std::string(256, '\0'))) << "after a power cut";
  EXPECT_TRUE(was_sealed("; memory of saphira\nodom 1\n")) << "of an earlier version";
  for (const char* const other :
       {"my notes\n", "POS (1) 0, 0, 0\n", "; a map\n", "12345678\n", "\n", "{\"a\": 1}",
        "2024-01-01 cleaned it\n", "; memory of mine\n",
        "\x7f"
        "ELF"})
    EXPECT_FALSE(was_sealed(other)) << other;
}

TEST(Durable, AnotherFileStaysAsItIs) {
  const test::TempDir folder;
  const std::string path = folder.path("notes.txt");
  write(path, "mine\n");
  const auto read = [](const std::string&) { throw std::runtime_error("it has no sum"); };
  for (const Files files : {Files::kChange, Files::kStay}) {
    EXPECT_EQ(
        test::trouble_of<std::invalid_argument>([&] { read_or_set_aside(path, read, files); }),
        path +
            ": expected a file that this program has written, or a new name; found another "
            "file, which stays as it is: it has no sum");
    EXPECT_EQ(read_file(path), "mine\n");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  }
}

TEST(Durable, WhatCannotBeUnderstoodIsSetAside) {
  const test::TempDir folder;
  const std::string path = folder.path("state");
  const std::string good = sealed("good\n");
  const std::string bad = sealed("bad\n");
  const std::string worse = sealed("worse\n");
  const auto understand = [&](const std::string& text) {
    if (text != good)
      throw std::runtime_error("it is bad");
  };
  EXPECT_EQ(read_or_set_aside(path, understand), "") << "there is none";
  write(path, good);
  EXPECT_EQ(read_or_set_aside(path, understand), "");
  EXPECT_TRUE(std::filesystem::exists(path));
  write(path, bad);
  const std::string said = read_or_set_aside(path, understand);
  EXPECT_NE(said.find(path + ".damaged"), std::string::npos) << said;
  EXPECT_NE(said.find("it is bad"), std::string::npos) << said;
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(read_file(path + ".damaged"), bad);
  // The next damaged file replaces it.
  write(path, worse);
  EXPECT_NE(read_or_set_aside(path, understand), "");
  EXPECT_EQ(read_file(path + ".damaged"), worse);
}

TEST(Durable, ADryRunChangesNoFile) {
  const test::TempDir folder;
  const std::string path = folder.path("state");
  const std::string old = sealed("old\n");
  write(path, old);
  EXPECT_EQ(
      read_or_set_aside(
          path, [](const std::string&) { throw std::runtime_error("it is old"); }, Files::kStay),
      path + " cannot be used; a start would set it aside as " + path +
          ".damaged, and begin it anew: it is old");
  EXPECT_TRUE(can_replace_file(path, Files::kStay));
  EXPECT_FALSE(can_replace_file(folder.path("nowhere/state"), Files::kStay));
  EXPECT_EQ(errno, ENOENT);
  EXPECT_EQ(read_file(path), old);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Durable, AFileIsReplacedWhole) {
  const test::TempDir folder;
  const std::string path = folder.path("state");
  EXPECT_TRUE(replace_file(path, "one"));
  EXPECT_EQ(read_file(path), "one");
  EXPECT_TRUE(replace_file(path, "two", true));
  EXPECT_EQ(read_file(path), "two");
  EXPECT_FALSE(std::filesystem::exists(path + ".new"));
  EXPECT_FALSE(replace_file(folder.path("nowhere/state"), "three"));
  EXPECT_EQ(errno, ENOENT);
  // A file that cannot be replaced leaves nothing beside it.
  std::filesystem::create_directories(folder.path("full/of"));
  EXPECT_FALSE(replace_file(folder.path("full"), "four"));
  EXPECT_EQ(errno, EISDIR);
  EXPECT_FALSE(std::filesystem::exists(folder.path("full.new")));
}

TEST(Durable, OnlyAFileIsReplaced) {
  const test::TempDir folder;
  const std::string pipe = folder.path("pipe");
  const std::string link = folder.path("link");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/null", link);
  for (const std::string& path : {pipe, link, std::string("/dev/null")}) {
    EXPECT_FALSE(replace_file(path, "text"));
    EXPECT_EQ(errno, ENOTSUP);
    EXPECT_EQ(cannot_be(path, "written"),
              path +
                  ": cannot be written: expected a file or a new name, found a device, a pipe "
                  "or a socket");
    EXPECT_FALSE(can_replace_file(path));
    EXPECT_EQ(errno, ENOTSUP);
    EXPECT_FALSE(std::filesystem::is_regular_file(path));
    EXPECT_FALSE(std::filesystem::exists(path + ".new"));
  }
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  // A link to a file, and one to nothing.
  write(folder.path("old"), "old");
  std::filesystem::create_symlink(folder.path("old"), folder.path("to-old"));
  std::filesystem::create_symlink(folder.path("nothing"), folder.path("to-nothing"));
  EXPECT_TRUE(replace_file(folder.path("to-old"), "new"));
  EXPECT_TRUE(replace_file(folder.path("to-nothing"), "new"));
}

TEST(Durable, AFileIsTriedAndStaysAsItIs) {
  const test::TempDir folder;
  const std::string path = folder.path("state");
  EXPECT_TRUE(can_replace_file(path));
  EXPECT_FALSE(std::filesystem::exists(path) || std::filesystem::exists(path + ".new"));
  write(path, "one");
  EXPECT_TRUE(can_replace_file(path));
  EXPECT_EQ(read_file(path), "one");
  EXPECT_FALSE(can_replace_file(folder.path("nowhere/state")));
  EXPECT_EQ(errno, ENOENT);
  EXPECT_FALSE(can_replace_file(folder.path(".")));
  EXPECT_EQ(errno, EISDIR);
}

}  // namespace
}  // namespace saphira

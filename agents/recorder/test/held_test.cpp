// A recording under a name at which another one may be.
#include "held.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "process.hpp"
#include "saphira/base/text.hpp"
#include "saphira/recorder/recording.hpp"

namespace saphira::recorder {
namespace {

namespace fs = std::filesystem;

class HeldRecording : public testing::Test {
 protected:
  /// The error of a recorder that begins; empty: it may.
  std::string trouble(bool overwrite = false) const {
    return test::trouble_of<std::invalid_argument>([&] { Held held(file_, overwrite); });
  }
  void record(const std::string& file) const {
    std::ofstream out(file, std::ios::binary);
    Writer writer(out);
    EXPECT_TRUE(writer.close());
  }
  /// The files that are there.
  std::string all() const {
    std::string names;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      names += entry.path().filename().string() + " ";
    return names;
  }

  const test::TempDir folder_;
  const std::string file_ = folder_.path("a.mcap");
};

TEST_F(HeldRecording, StaysUntilSomethingIsRecorded) {
  record(file_);
  const std::string before = read_bytes(file_);
  {
    Held held(file_, true);
    held.out() << "new";
    held.out().flush();
    EXPECT_EQ(read_bytes(file_), before);
  }
  EXPECT_EQ(read_bytes(file_), before);
  EXPECT_EQ(all(), "a.mcap ");
  {
    Held held(file_, true);
    held.out() << "new";
    held.keep();
    held.out() << " and more";
    held.keep();
  }
  EXPECT_EQ(read_bytes(file_), "new and more");
  EXPECT_EQ(all(), "a.mcap ");
}

TEST_F(HeldRecording, ANameWithoutARecordingIsFreeAgain) {
  { const Held held(file_, false); }
  EXPECT_EQ(all(), "");
  std::ofstream(file_ + ".new") << "of a recorder that was killed";
  {
    Held held(file_, false);
    held.out() << "new";
    held.keep();
  }
  EXPECT_EQ(read_bytes(file_), "new");
}

TEST_F(HeldRecording, HasOneRecorder) {
  const std::string other = file_ + ": another recorder writes it; give a new name";
  Held held(file_, false);
  EXPECT_EQ(trouble(), other);
  EXPECT_EQ(trouble(true), other);
  held.keep();
  EXPECT_EQ(trouble(true), other) << "in its place";
  EXPECT_EQ(all(), "a.mcap ");
}

TEST_F(HeldRecording, IsReplacedOnRequestAloneAndNothingElseIs) {
  record(file_);
  EXPECT_EQ(trouble(), file_ + ": a recording is there; give a new name, or --overwrite");
  EXPECT_EQ(trouble(true), "");
  std::ofstream(file_) << "notes";
  EXPECT_TRUE(test::has(trouble(true), "a file with other content is there"));
  EXPECT_EQ(read_bytes(file_), "notes");
  EXPECT_EQ(all(), "a.mcap ");
  std::ofstream(file_).close();
  EXPECT_EQ(trouble(), "") << "an empty file";
  fs::remove(file_);
  fs::create_directory(file_);
  EXPECT_TRUE(test::has(trouble(true), "cannot be written"));
  EXPECT_TRUE(test::has(test::trouble_of<std::invalid_argument>(
                            [&] { Held held(folder_.path("nowhere/a.mcap"), false); }),
                        "cannot be written"));
}

}  // namespace
}  // namespace saphira::recorder

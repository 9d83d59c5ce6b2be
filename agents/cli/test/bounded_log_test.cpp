#include "saphira/cli/bounded_log.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "process.hpp"

namespace saphira::cli {
namespace {

namespace fs = std::filesystem;

class BoundedLogTest : public testing::Test {
 protected:
  static int opened(const std::string& path) {
    return open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  }
  void write_line(std::size_t size) {
    const std::string line(size, 'x');
    ASSERT_EQ(write(first_, line.data(), line.size()), static_cast<ssize_t>(size));
    ASSERT_EQ(write(second_, "!", 1), 1);
    log_.keep_bounded();
  }
  void TearDown() override {
    close(first_);
    close(second_);
  }

  test::TempDir folder_;
  const std::string path_ = folder_.path("log");
  int first_ = opened(path_);
  int second_ = opened(path_);
  const BoundedLog log_{path_, {first_, second_}, 1000};
};

TEST_F(BoundedLogTest, KeepsTheNewestAndOneOlderPart) {
  for (int i = 0; i < 100; ++i)
    write_line(99);
  EXPECT_EQ(fs::file_size(path_), 0U) << "a new part";
  EXPECT_EQ(fs::file_size(path_ + ".old"), 1000U) << "of both descriptors";
  write_line(99);
  EXPECT_EQ(fs::file_size(path_), 100U);
}

TEST_F(BoundedLogTest, IsBoundedWithoutItsFolderToo) {
  fs::remove_all(folder_.path());
  for (int i = 0; i < 100; ++i)
    write_line(99);
  EXPECT_LT(lseek(first_, 0, SEEK_END), 1000);
}

}  // namespace
}  // namespace saphira::cli

// Each shipped world, cut off at each of its bytes. The mistakes within a line:
// sim/test/world_test.cpp and services/common/maps/test/map_test.cpp.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "floor_plan.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"

namespace saphira {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> found;
  for (const Line& line : split_lines(text))
    for (const Word& word : line.words)
      found.push_back(std::to_string(line.number) + " " + std::string(word.text));
  return found;
}

// A world file that is cut off between two lines may still be valid, without the rest. But no line
// is read in part.
TEST(BrokenFiles, EachWorldThatIsCutOffWithinALineIsRefused) {
  const std::string path = ::testing::TempDir() + "cut-off-" + std::to_string(getpid()) + ".wld";
  for (const std::string& stem : names_in(test::source("config/worlds"), ".wld")) {
    const std::string text = read_file(test::source("config/worlds/" + stem + ".wld"));
    ASSERT_TRUE(text.ends_with('\n')) << stem;
    const std::vector<std::string> whole = words_of(text);
    std::ofstream(path, std::ios::binary) << text;
    int refused = 0;
    for (std::size_t size = text.size(); size-- > 0;) {
      std::filesystem::resize_file(path, size);
      SCOPED_TRACE(stem + " cut to " + std::to_string(size) + " bytes");
      try {
        sim::load_world(path);
        const auto left = words_of(text.substr(0, size));
        ASSERT_LE(left.size(), whole.size());
        ASSERT_TRUE(std::equal(left.begin(), left.end(), whole.begin()));
        // The first missing word begins a line.
        EXPECT_TRUE(left.empty() || left.size() == whole.size() ||
                    std::atoi(left.back().c_str()) < std::atoi(whole[left.size()].c_str()));
      } catch (const FileError& error) {
        ++refused;
        EXPECT_EQ(error.file(), path);
        EXPECT_GE(error.line(), 1);
        EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos) << error.what();
      }
    }
    EXPECT_GT(refused, 0);
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace saphira

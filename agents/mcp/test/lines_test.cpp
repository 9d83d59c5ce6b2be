#include "saphira/mcp/lines.hpp"

#include <gtest/gtest.h>

namespace saphira::mcp {
namespace {

using All = std::vector<std::string>;

TEST(McpLines, ALineMayComeInPiecesAndSeveralAtOnce) {
  Lines lines;
  EXPECT_EQ(lines.take("one"), All{});
  EXPECT_EQ(lines.take(" more\ntwo\n\nthr"), (All{"one more", "two"}));
  EXPECT_EQ(lines.take("ee\n"), All{"three"});
}

TEST(McpLines, OfALineThatIsTooLongOneComesAndTheNextIsWhole) {
  Lines lines;
  std::vector<std::string> all;
  for (std::size_t size = 0; size <= Session::kLongestLine; size += 4096)
    for (std::string& line : lines.take(std::string(4096, 'x')))
      all.push_back(std::move(line));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_GT(all[0].size(), Session::kLongestLine);
  EXPECT_EQ(lines.take("x\nnext\n"), All{"next"});
  EXPECT_EQ(lines.take(std::string(Session::kLongestLine, 'x') + "\n"),
            All{std::string(Session::kLongestLine, 'x')})
      << "the longest";
  EXPECT_EQ(lines.take(std::string(Session::kLongestLine + 1, 'x') + "\nnext\n").size(), 2U);
}

}  // namespace
}  // namespace saphira::mcp

#include "saphira/cli/picture.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

/// The lines without colors.
std::vector<std::string> plain(const std::vector<std::string>& lines) {
  std::vector<std::string> all;
  for (const std::string& line : lines) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\x1b')
        i = line.find('m', i);
      else
        text += line[i];
    }
    all.push_back(text);
  }
  return all;
}

/// Column and row of the first `letter`, or (-1, -1).
std::pair<int, int> find(const std::vector<std::string>& lines, char letter) {
  for (std::size_t row = 0; row < lines.size(); ++row)
    if (const auto column = lines[row].find(letter); column != std::string::npos)
      return {static_cast<int>(column), static_cast<int>(row)};
  return {-1, -1};
}

TEST(Picture, HasTheSizeThatWasAskedFor) {
  const auto lines = plain(Picture().draw(40, 12, false));
  ASSERT_EQ(lines.size(), 12U);
  for (const std::string& line : lines)
    EXPECT_EQ(line.size(), 40U);
  EXPECT_EQ(Picture().draw(0, 0, true).size(), 1U);
}

TEST(Picture, ShowsTheWallsOfTheMapWithinWhatElseIsShown) {
  Picture picture;
  picture.move_robot({});
  picture.set_goal({4.0, 0.0});
  EXPECT_EQ(find(plain(picture.draw(60, 20, false)), ':').first, -1);
  picture.set_walls({{{-10.0, 1.0}, {10.0, 1.0}}, {{50.0, 0.0}, {50.0, 9.0}}});
  const auto lines = plain(picture.draw(60, 20, false));
  const auto [column, row] = find(lines, ':');
  EXPECT_EQ(column, 0) << "from one side to the other";
  EXPECT_EQ(lines[static_cast<std::size_t>(row)], std::string(60, ':'));
  EXPECT_LT(row, find(lines, 'O').second) << "above the robot";
  EXPECT_NE(Picture::legend(false).find("map"), std::string::npos);
}

TEST(Picture, XIsToTheRightAndYIsUp) {
  Picture picture;
  picture.move_robot({0, 0, 0});
  picture.set_goal({8.0, 4.0});
  const auto lines = plain(picture.draw(60, 20, false));
  const auto robot = find(lines, 'O');
  const auto goal = find(lines, 'X');
  ASSERT_GE(robot.first, 0);
  ASSERT_GE(goal.first, 0);
  EXPECT_GT(goal.first, robot.first);
  EXPECT_LT(goal.second, robot.second);
}

TEST(Picture, ShowsEchoesAndTheWakeAndForgetsThem) {
  Picture picture;
  for (int i = 0; i <= 40; ++i)
    picture.move_robot({i * 0.1, 0, 0});
  picture.add_echo({2.0, 3.0});
  const auto lines = plain(picture.draw(60, 20, false));
  EXPECT_GE(find(lines, '.').first, 0);
  EXPECT_GE(find(lines, '-').first, 0);
  EXPECT_LT(find(lines, '.').second, find(lines, '-').second);
}

TEST(Picture, BrailleIsThreeBytesADot) {
  Picture picture;
  bool seen = false;
  for (const std::string& line : plain(picture.draw(20, 8, true))) {
    std::size_t columns = 0;
    for (std::size_t i = 0; i < line.size(); ++columns) {
      const bool braille = line[i] == '\xe2';
      seen = seen || braille;
      i += braille ? 3 : 1;
    }
    EXPECT_EQ(columns, 20U);
  }
  EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace saphira::cli

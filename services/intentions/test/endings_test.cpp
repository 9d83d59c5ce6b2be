#include "saphira/intentions/endings.hpp"

#include <gtest/gtest.h>

namespace saphira::intentions {
namespace {

Ending ending(std::uint64_t number) {
  return {{1, number}, v1::GOAL_SUCCEEDED, v1::CODE_NONE, "done"};
}

TEST(Endings, TheNewestAreRemembered) {
  Endings endings(2);
  for (const std::uint64_t number : {1U, 2U, 3U})
    endings.recall(ending(number));
  EXPECT_EQ(endings.find({1, 1}), nullptr);
  EXPECT_EQ(*endings.find({1, 2}), ending(2));
  EXPECT_EQ(endings.newest(), (GoalId{1, 3}));
  EXPECT_FALSE(endings.due(0)) << "they are saved";
}

TEST(Endings, AreSavedOnce) {
  Endings endings;
  endings.add(ending(1));
  EXPECT_TRUE(endings.due(0));
  EXPECT_EQ(endings.take(), std::vector{ending(1)});
  EXPECT_FALSE(endings.due(1000));
  endings.change_work();
  EXPECT_TRUE(endings.due(1000));
  EXPECT_TRUE(endings.take().empty());
}

TEST(Endings, AFullDiskIsTriedAgainAfterASecondAndWithTheNextChange) {
  Endings endings(2);
  endings.not_saved({ending(1), ending(2)}, 100);
  EXPECT_FALSE(endings.due(109));
  EXPECT_TRUE(endings.due(110));
  endings.add(ending(3));
  EXPECT_TRUE(endings.due(101));
  EXPECT_EQ(endings.take(), (std::vector{ending(1), ending(2), ending(3)}));
  EXPECT_FALSE(endings.due(1000));
  endings.add(ending(4));
  endings.not_saved({ending(1), ending(2), ending(3)}, 200);
  EXPECT_EQ(endings.take(), (std::vector{ending(3), ending(4)})) << "the newest stay";
}

}  // namespace
}  // namespace saphira::intentions

#include "saphira/cli/gathering.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

TEST(Gathering, EndsWhenNoReaderHasComeForAWhile) {
  Gathering readers;
  EXPECT_FALSE(readers.complete(0, 0.0));
  EXPECT_FALSE(readers.complete(0, 2.0)) << "nobody reads";
  EXPECT_FALSE(readers.complete(1, 2.1)) << "the first one is not all of them";
  EXPECT_FALSE(readers.complete(1, 2.3));
  EXPECT_FALSE(readers.complete(2, 2.35)) << "a second one, so a third one may come";
  EXPECT_FALSE(readers.complete(2, 2.6));
  EXPECT_TRUE(readers.complete(2, 2.7));
}

TEST(Gathering, IsWaitedForOnce) {
  Gathering readers;
  readers.complete(1, 0.0);
  ASSERT_TRUE(readers.complete(1, 0.5));
  EXPECT_TRUE(readers.complete(2, 0.6)) << "the next lines of the input go at once";
  EXPECT_FALSE(readers.complete(0, 0.7)) << "nobody would hear it";
  EXPECT_TRUE(readers.complete(1, 0.8));
}

}  // namespace
}  // namespace saphira::cli

#include "saphira/cli/second_deployment.hpp"

#include <gtest/gtest.h>

namespace saphira::cli {
namespace {

SeenProcess process(const std::string& name, std::uint32_t pid, bool namesake) {
  SeenProcess seen;
  seen.status.name = name;
  seen.status.pid = pid;
  seen.status.host = "attic";
  seen.namesake = namesake;
  return seen;
}

const std::vector<SeenProcess> kOne{process("bridge", 1, false), process("intentions", 2, false)};
const std::vector<SeenProcess> kTwo{process("bridge", 1, false), process("bridge", 8, true),
                                    process("intentions", 2, false),
                                    process("intentions", 9, true)};

TEST(SecondDeployment, IsToldOnceWhenItIsCertain) {
  SecondDeployment second;
  EXPECT_FALSE(second.news(kOne, 0.0));
  EXPECT_FALSE(second.doubtful());
  EXPECT_FALSE(second.news(kTwo, 1.0));
  EXPECT_TRUE(second.doubtful());
  EXPECT_FALSE(second.news(kTwo, 2.9));
  EXPECT_EQ(second.news(kTwo, 3.0), second_deployment(kTwo));
  EXPECT_FALSE(second.news(kTwo, 9.0));
  EXPECT_FALSE(second.doubtful());
  EXPECT_FALSE(second.news(kOne, 10.0));
  ASSERT_TRUE(second.news(kOne, 12.0));
  EXPECT_FALSE(second.news(kOne, 20.0));
}

TEST(SecondDeployment, AProgramThatIsStartedAgainIsNone) {
  SecondDeployment second;
  EXPECT_FALSE(second.news(kTwo, 1.0));
  EXPECT_FALSE(second.news(kOne, 2.0));
  EXPECT_FALSE(second.doubtful());
  EXPECT_FALSE(second.news(kTwo, 10.0));
  EXPECT_FALSE(second.news(kOne, 11.9));
  EXPECT_FALSE(second.news(kOne, 99.0));
}

}  // namespace
}  // namespace saphira::cli

#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "node_options.hpp"
#include "process.hpp"

namespace saphira::test {

/// `saphira` on the bus of this test.
class CliFixture : public testing::Test {
 protected:
  std::vector<std::string> command(const std::vector<std::string>& words) const {
    std::vector<std::string> argv{"saphira", "--robot", robot_, "--domain", domain()};
    argv.insert(argv.end(), words.begin(), words.end());
    return argv;
  }
  Outcome run(const std::vector<std::string>& words) const { return test::run(command(words)); }
  /// Runs it; expects that exit code, and these parts in what it prints.
  void expect(const std::vector<std::string>& words, int code,
              const std::vector<std::string>& parts = {}) const {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, code) << outcome.text;
    for (const std::string& part : parts)
      EXPECT_TRUE(has(outcome.text, part)) << part << " is not in " << outcome.text;
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path(name)) << text;
    return folder_.path(name);
  }

  const std::string robot_ = unique_robot();
  const TempDir folder_;
};

}  // namespace saphira::test

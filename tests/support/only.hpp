#pragma once

#include <gtest/gtest.h>

#include <vector>

namespace saphira::test {

/// The only one of them; the test fails where there are none or more.
template <class T>
T only(const std::vector<T>& all) {
  EXPECT_EQ(all.size(), 1U);
  return all.empty() ? T() : all.front();
}

}  // namespace saphira::test

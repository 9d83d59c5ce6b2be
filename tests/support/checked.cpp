// Linked into every test: what a simulator's checker finds is a failure of the test.
#include <gtest/gtest.h>

#include "process.hpp"

namespace saphira::test {
namespace {

[[maybe_unused]] const bool kChecked = [] {
  Process::complain = [](const std::string& violations) {
    ADD_FAILURE() << "against the robots' protocol:\n" << violations;
  };
  return true;
}();

}  // namespace
}  // namespace saphira::test

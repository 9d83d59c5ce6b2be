// Linked into every test: findings of a simulator's checker or a sanitizer in a program fail the
// test.
#include <gtest/gtest.h>

#include "process.hpp"

namespace saphira::test {
namespace {

[[maybe_unused]] const bool kChecked = [] {
  Process::complain = [](const std::string& found) { ADD_FAILURE() << found; };
  return true;
}();

}  // namespace
}  // namespace saphira::test

// Linked into every test: what a simulator's checker or a sanitizer finds in a program is a failure
// of the test.
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

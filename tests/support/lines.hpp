#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "process.hpp"
#include "saphira/base/text.hpp"

namespace saphira::test {

/// Gives each line of a file of the source tree to `use`, without empty lines and comments. A
/// failure in it tells file and line.
template <class Use>
void each_line(const std::string& file, char comment, const Use& use) {
  std::istringstream lines(read_file(source(file)));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    SCOPED_TRACE(file + ":" + std::to_string(++number));
    if (!line.empty() && line[0] != comment)
      use(line);
  }
}

}  // namespace saphira::test

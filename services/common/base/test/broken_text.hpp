#pragma once

#include <gtest/gtest.h>

#include <string>

#include "saphira/base/text.hpp"

namespace saphira::test {

/// A faulty file text: the place, and the expected word.
struct Broken {
  const char* text;
  int line;
  int column;
  const char* expected;
};

/// parse(text) has to throw the FileError.
template <class Parse>
void expect_mistake(const Broken& broken, Parse&& parse) {
  try {
    parse(broken.text);
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_EQ(error.line(), broken.line) << error.what();
    EXPECT_EQ(error.column(), broken.column) << error.what();
    EXPECT_NE(std::string(error.what()).find(broken.expected), std::string::npos) << error.what();
  }
}

}  // namespace saphira::test

#pragma once

#include <exception>
#include <string>

namespace saphira::test {

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The message of the exception that f() throws; empty where it throws none.
template <class F>
std::string trouble(F&& f) {
  try {
    f();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

/// The same where it is an Error; another one passes.
template <class Error, class F>
std::string trouble_of(F&& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace saphira::test

#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/value.hpp"

/// What intentions keep over a restart of the service is a value of the language: lists within
/// lists.
namespace saphira::intentions {

inline Value count(std::size_t number) {
  return Value(static_cast<double>(number));
}

/// The elements of a list that was saved, one after the other.
class Saved {
 public:
  explicit Saved(const Value& list) : list_(list.list()) {}
  const Value& any() {
    if (next_ >= list_.size())
      throw ActivityError("what was remembered ends too early");
    return list_[next_++];
  }
  double number() {
    const double* const number = any().number();
    if (number == nullptr)
      throw ActivityError("what was remembered has no number where there should be one");
    return *number;
  }
  template <class T>
  T whole() {
    const double value = number();
    if (!(std::abs(value) < 9e15))
      throw ActivityError("what was remembered has a number that is too large");
    return static_cast<T>(static_cast<std::int64_t>(value));
  }
  std::string text() {
    const std::string* const text = any().text();
    return text == nullptr ? std::string() : *text;
  }
  bool yes() { return any().truthy(); }

 private:
  const Value::List& list_;
  std::size_t next_ = 0;
};

}  // namespace saphira::intentions

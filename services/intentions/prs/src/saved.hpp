#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/value.hpp"

/// Saves records as values of the language, over a restart of the service: nested lists.
namespace saphira::intentions {

/// Writes the fields of a record one after the other, as a list. Reading takes the same calls, so
/// that a record lists its fields once: see Loading.
class Saving {
 public:
  template <class... T>
  void operator()(const T&... fields) {
    (list_.push_back(value_of(fields)), ...);
  }
  Value value() { return Value(std::move(list_)); }

 private:
  static Value value_of(const Value& value) { return value; }
  static Value value_of(const std::string& text) { return Value(text); }
  static Value value_of(const Bindings& bindings) {
    Value::List list;
    for (const auto& [name, value] : bindings)
      list.emplace_back(Value::List{Value(name), value});
    return Value(std::move(list));
  }
  static Value value_of(const Value::List& list) { return Value(list); }
  template <class T>
  static Value value_of(const std::optional<T>& field) {
    return field ? value_of(*field) : Value();
  }
  static Value value_of(bool yes) { return Value::truth(yes); }
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  static Value value_of(T number) { return Value(static_cast<double>(number)); }

  Value::List list_;
};

/// Reads the fields that Saving has written. ActivityError where they are missing. The list has to
/// outlive this object.
class Loading {
 public:
  explicit Loading(const Value& list) : list_(list.list()) {}
  template <class... T>
  void operator()(T&... fields) {
    (read(next(), fields), ...);
  }

 private:
  const Value& next() {
    if (next_ >= list_.size())
      throw ActivityError("what was remembered ends too early");
    return list_[next_++];
  }
  static void read(const Value& value, Value& field) { field = value; }
  static void read(const Value& value, Value::List& field) { field = value.list(); }
  static void read(const Value& value, std::string& field) {
    const std::string* const text = value.text();
    field = text == nullptr ? std::string() : *text;
  }
  static void read(const Value& value, Bindings& field) {
    for (const Value& one : value.list()) {
      auto& [name, given] = field.emplace_back();
      Loading in(one);
      in(name, given);
    }
  }
  static void read(const Value& value, bool& field) { field = value.truthy(); }
  static void read(const Value& value, double& field) {
    const double* const number = value.number();
    if (number == nullptr)
      throw ActivityError("what was remembered has no number where there should be one");
    field = *number;
  }
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  static void read(const Value& value, T& field) {
    double number = 0.0;
    read(value, number);
    if (!(std::abs(number) < 9e15))
      throw ActivityError("what was remembered has a number that is too large");
    field = static_cast<T>(static_cast<std::int64_t>(number));
  }
  template <class T>
  static void read(const Value& value, std::optional<T>& field) {
    if (!value.nil())
      read(value, field.emplace());
  }

  const Value::List& list_;
  std::size_t next_ = 0;
};

}  // namespace saphira::intentions

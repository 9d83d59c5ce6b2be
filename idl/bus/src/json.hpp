#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "saphira/base/base64.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/idl/members.hpp"

namespace saphira::bus::internal {

/// Writes a sample of a generated type as JSON. Numbers read back to the same value; NaN and
/// infinities are null.
class JsonWriter {
 public:
  template <class T>
  void value([[maybe_unused]] const Member& member, const T& item) {
    if constexpr (std::is_same_v<T, bool>)
      text_ += item ? "true" : "false";
    else if constexpr (std::is_same_v<T, std::string>)
      quote(item);
    else if constexpr (std::is_floating_point_v<T>)
      number(item, std::isfinite(item));
    else if constexpr (std::is_same_v<T, std::uint8_t>)
      number(static_cast<unsigned>(item), true);
    else if constexpr (std::is_same_v<T, std::int32_t>)
      named(member.name_of == nullptr ? nullptr : member.name_of(item), item);
    else if constexpr (std::is_integral_v<T>)
      number(item, true);
    else if constexpr (std::is_enum_v<T>)
      named(name_of(item), static_cast<std::uint32_t>(item));
    else
      structure(item, "");
  }
  template <class T>
  void value(const Member& member, const std::vector<T>& items) {
    if constexpr (std::is_same_v<T, std::uint8_t>)
      if (member.bound > kMostNumbers)
        return quote(base64(items));
    text_ += '[';
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (i > 0)
        text_ += ',';
      value(member, items[i]);
    }
    text_ += ']';
  }
  template <class T>
  void structure(const T& item, std::string_view prefix) {
    text_ += '{';
    text_ += prefix;
    bool first = true;
    visit_members(item, [&](const Member& member, const auto& part) {
      text_ += first ? "\"" : ",\"";
      first = false;
      text_ += member.name;
      text_ += "\":";
      value(member, part);
    });
    text_ += '}';
  }
  std::string&& take() { return std::move(text_); }

 private:
  template <class T>
  void number(T item, bool finite) {
    std::array<char, 40> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), item).ptr;
    text_ += finite ? std::string_view(buffer.data(), end) : std::string_view("null");
  }
  template <class T>
  void named(const char* name, T item) {
    if (name != nullptr)
      quote(name);
    else
      number(item, true);
  }
  void quote(std::string_view item) {
    text_ += '"';
    while (!item.empty()) {
      const char c = item.front();
      const std::size_t size = letter_size(item);
      if (size != 1) {
        // Another program may write any bytes.
        text_ += size == 0 ? std::string_view("\uFFFD") : item.substr(0, size);
      } else if (c == '"' || c == '\\') {
        text_ += '\\';
        text_ += c;
      } else if (static_cast<unsigned char>(c) < 0x20) {
        text_ += format("\\u%04x", static_cast<unsigned>(c));
      } else {
        text_ += c;
      }
      item.remove_prefix(std::max<std::size_t>(1, size));
    }
    text_ += '"';
  }

  std::string text_;
};

template <class T>
std::string to_json(const T& sample, std::string_view prefix) {
  JsonWriter writer;
  writer.structure(sample, prefix);
  return writer.take();
}

}  // namespace saphira::bus::internal

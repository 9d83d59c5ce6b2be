#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "saphira/base/base64.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"
#include "saphira/idl/members.hpp"

namespace saphira::bus::internal {

/// Sets a sample of a generated type from JSON: members that are not named stay as they are.
/// std::invalid_argument that names the place and the expected text.
class JsonReader {
 public:
  template <class T>
  void read([[maybe_unused]] const Member& member, const nlohmann::json& json, T& item,
            const std::string& place) {
    if constexpr (std::is_same_v<T, bool>) {
      expect(json.is_boolean(), json, place, "true or false");
      item = json.get<bool>();
    } else if constexpr (std::is_same_v<T, std::string>) {
      expect(json.is_string(), json, place, "a text");
      item = json.get<std::string>();
    } else if constexpr (std::is_enum_v<T>) {
      item = enumerator<T>(json, place);
    } else if constexpr (std::is_floating_point_v<T>) {
      // Null is what stands for NaN in a sample's JSON.
      expect(json.is_number() || json.is_null(), json, place, "a number");
      expect(json.is_null() || std::isfinite(json.get<T>()), json, place,
             "a number from -3.4e38 to 3.4e38");
      item = json.is_null() ? std::numeric_limits<T>::quiet_NaN() : json.get<T>();
    } else if constexpr (std::is_integral_v<T>) {
      if (member.name_of != nullptr && json.is_string())
        item = static_cast<T>(named(member, json, place));
      else
        integer(json, item, place);
    } else {
      structure(json, item, place);
    }
  }
  template <class T>
  void read(const Member& member, const nlohmann::json& json, std::vector<T>& items,
            const std::string& place) {
    if constexpr (std::is_same_v<T, std::uint8_t>)
      if (member.bound > kMostNumbers) {
        const auto bytes = json.is_string() ? from_base64(json.get<std::string>()) : std::nullopt;
        expect(bytes.has_value(), json, place, "a text in base64");
        return items.assign(bytes->begin(), bytes->end());
      }
    expect(json.is_array(), json, place, "a list [...]");
    items.clear();
    for (std::size_t i = 0; i < json.size(); ++i)
      read(member, json[i], items.emplace_back(), place + "[" + std::to_string(i) + "]");
  }
  template <class T>
  void structure(const nlohmann::json& json, T& item, const std::string& place) {
    expect(json.is_object(), json, place, "an object {...}");
    std::vector<std::string> names;
    std::size_t known = 0;
    visit_members(item, [&](const Member& member, auto& part) {
      names.emplace_back(member.name);
      const auto found = json.find(member.name);
      if (found == json.end())
        return;
      ++known;
      read(member, *found, part, place.empty() ? member.name : place + "." + member.name);
    });
    if (known < json.size())
      unknown(json, names, place);
  }

 private:
  static constexpr int kMostNamed = 10000;  // numbers with names are below

  [[noreturn]] static void fail(const std::string& place, const std::string& what) {
    throw std::invalid_argument((place.empty() ? "" : place + ": ") + what);
  }
  static void expect(bool good, const nlohmann::json& json, const std::string& place,
                     const std::string& what) {
    if (!good)
      fail(place, "expected " + what + ", found " + json.dump().substr(0, 60));
  }
  static void unknown(const nlohmann::json& json, const std::vector<std::string>& names,
                      const std::string& place) {
    const std::string all = joined(names);
    for (const auto& [key, value] : json.items())
      if (std::find(names.begin(), names.end(), key) == names.end())
        fail(place, "no member \"" + key.substr(0, 60) + '"' + did_you_mean(key, names, ";") +
                        " there are " + all);
  }
  template <class T>
  static void integer(const nlohmann::json& json, T& item, const std::string& place) {
    using Limits = std::numeric_limits<T>;
    const std::string range = "a whole number from " + std::to_string(Limits::min()) + " to " +
                              std::to_string(Limits::max());
    expect(json.is_number_integer(), json, place, range);
    if (json.is_number_unsigned()) {
      const auto value = json.get<std::uint64_t>();
      expect(value <= static_cast<std::uint64_t>(Limits::max()), json, place, range);
      item = static_cast<T>(value);
    } else {
      const auto value = json.get<std::int64_t>();
      expect(std::is_signed_v<T> && value >= static_cast<std::int64_t>(Limits::min()), json, place,
             range);
      item = static_cast<T>(value);
    }
  }
  static std::int32_t named(const Member& member, const nlohmann::json& json,
                            const std::string& place) {
    for (std::int32_t value = 0; value < kMostNamed; ++value)
      if (const char* const name = member.name_of(value); name != nullptr && json == name)
        return value;
    fail(place, "expected a number or one of its names, found " + json.dump().substr(0, 60));
  }
  template <class T>
  static T enumerator(const nlohmann::json& json, const std::string& place) {
    std::string all;
    for (std::uint32_t i = 0; name_of(static_cast<T>(i)) != nullptr; ++i) {
      if (json.is_string() && json.get<std::string>() == name_of(static_cast<T>(i)))
        return static_cast<T>(i);
      all += (i == 0 ? "" : ", ") + std::string(name_of(static_cast<T>(i)));
    }
    fail(place, "expected one of " + all + ", found " + json.dump().substr(0, 60));
  }
};

template <class T>
void from_json(const std::string& text, T& sample) {
  nlohmann::json json;
  try {
    json = nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw std::invalid_argument("this is not JSON, at character " + std::to_string(error.byte) +
                                ": " + text.substr(0, 60));
  } catch (const nlohmann::json::out_of_range& error) {
    // Its message has the number in quotation marks.
    const std::string said = error.what();
    const std::size_t begin = std::min(said.find('\''), said.size() - 1) + 1;
    throw std::invalid_argument("expected a finite number, found " +
                                said.substr(begin, said.find('\'', begin) - begin).substr(0, 60));
  }
  JsonReader().structure(json, sample, "");
}

}  // namespace saphira::bus::internal

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "saphira/base/enumerators.hpp"

namespace saphira {

/// Pairs of two enumerations with the same meaning, such as a library's and the bus's: one table
/// for both directions. Where several of one side are the same to the other, the first pair counts.
/// A table that lacks an enumerator of either side does not compile, unless it lists that as left
/// out.
template <class Ours, class Theirs, std::size_t size>
class EnumPairs {
 public:
  consteval EnumPairs(const std::array<std::pair<Ours, Theirs>, size>& pairs,
                      std::initializer_list<Ours> ours_left_out = {},
                      std::initializer_list<Theirs> theirs_left_out = {})
      : pairs_(pairs) {
    for (const Ours value : kEnumerators<Ours>)
      if (!contains(ours_left_out, value) &&
          std::none_of(pairs.begin(), pairs.end(),
                       [&](const auto& pair) { return pair.first == value; }))
        throw "an enumerator of ours has no pair";
    for (const Theirs value : kEnumerators<Theirs>)
      if (!contains(theirs_left_out, value) &&
          std::none_of(pairs.begin(), pairs.end(),
                       [&](const auto& pair) { return pair.second == value; }))
        throw "an enumerator of theirs has no pair";
  }

  /// A value that is left out gets the first pair's.
  constexpr Theirs theirs(Ours value) const {
    for (const auto& [ours, theirs] : pairs_)
      if (ours == value)
        return theirs;
    return pairs_.front().second;
  }

  /// Others may send an unknown enumerator.
  constexpr Ours ours(Theirs value, Ours otherwise) const {
    for (const auto& [ours, theirs] : pairs_)
      if (theirs == value)
        return ours;
    return otherwise;
  }

 private:
  template <class Value>
  static consteval bool contains(std::initializer_list<Value> values, Value value) {
    return std::find(values.begin(), values.end(), value) != values.end();
  }

  std::array<std::pair<Ours, Theirs>, size> pairs_;
};

/// The table of two enumerations with the same names: `keep_out` is their ZONE_KEEP_OUT.
template <class Ours, class Theirs>
consteval auto pairs_by_name() {
  constexpr auto& names = kEnumeratorNames<Theirs>;
  constexpr std::size_t size = kEnumerators<Ours>.size();
  std::array<std::pair<Ours, Theirs>, size> pairs{};
  for (std::size_t i = 0; i < size; ++i) {
    const std::string_view ours = kEnumeratorNames<Ours>[i];
    const auto same = [&](std::string_view theirs) {
      theirs.remove_prefix(theirs.find('_') + 1);
      return std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end(),
                        [](char a, char b) { return a == b || a - 'a' == b - 'A'; });
    };
    const auto found = std::find_if(names.begin(), names.end(), same);
    if (found == names.end())
      throw "an enumerator of ours has no namesake";
    pairs[i] = {kEnumerators<Ours>[i],
                kEnumerators<Theirs>[static_cast<std::size_t>(found - names.begin())]};
  }
  return EnumPairs<Ours, Theirs, size>(pairs);
}

}  // namespace saphira

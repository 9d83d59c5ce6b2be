#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace saphira {

/// Two enumerations that say the same, such as a library's and the bus's, in pairs: both ways are
/// one table. Where several of one side are the same to the other, the first pair counts.
template <class Ours, class Theirs, std::size_t size>
struct EnumPairs {
  std::array<std::pair<Ours, Theirs>, size> pairs;

  /// The first pair's for a value that has no pair.
  constexpr Theirs theirs(Ours value) const {
    for (const auto& [ours, theirs] : pairs)
      if (ours == value)
        return theirs;
    return pairs.front().second;
  }

  /// Others may send what is none of the enumerators.
  constexpr Ours ours(Theirs value, Ours otherwise) const {
    for (const auto& [ours, theirs] : pairs)
      if (theirs == value)
        return ours;
    return otherwise;
  }
};

}  // namespace saphira

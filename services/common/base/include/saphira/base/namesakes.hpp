#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "saphira/base/enum_pairs.hpp"
#include "saphira/base/members.hpp"

namespace saphira {

/// The table of two enumerations with the same meaning: by their names, or a table of its own.
template <class Ours, class Theirs>
inline constexpr auto kPairs = pairs_by_name<Ours, Theirs>();

template <class To, class From>
void take(To& to, const From& from);

namespace detail {

/// The names of an enumeration of the bus are in capitals.
template <class E>
inline constexpr bool kIsTheirs = kEnumeratorNames<E>[0][0] <= 'Z';

template <class To, class From, std::size_t to, std::size_t from, class A, class B>
void take_namesake(A& all, const B& given) {
  if constexpr (kMemberName<To, to> == kMemberName<From, from>)
    take(std::get<to>(all), std::get<from>(given));
}

template <class To, class From, std::size_t to, std::size_t... from, class A, class B>
void take_member(A& all, const B& given, std::index_sequence<from...> /*all*/) {
  (take_namesake<To, From, to, from>(all, given), ...);
}

}  // namespace detail

/// Takes a value of the same meaning: numbers and texts as they are, enumerators and the members of
/// plain structs by their names, sequences item by item. These stay as they are: an enumerator that
/// is unknown, and members of `to` for which `from` has no member of that name and kind.
template <class To, class From>
void take(To& to, const From& from) {
  if constexpr (std::is_convertible_v<From, To>) {
    to = static_cast<To>(from);
  } else if constexpr (std::is_enum_v<To> && std::is_enum_v<From>) {
    if constexpr (detail::kIsTheirs<To>)
      to = kPairs<From, To>.theirs(from);
    else
      to = kPairs<To, From>.ours(from, to);
  } else if constexpr (requires { to.emplace_back(), from.begin(); }) {
    if constexpr (std::is_aggregate_v<typename To::value_type>) {
      to.clear();
      for (const auto& each : from)
        take(to.emplace_back(), each);
    }
  } else if constexpr (std::is_aggregate_v<To> && std::is_aggregate_v<From>) {
    auto all = members_of(to);
    const auto given = members_of(from);
    constexpr std::make_index_sequence<std::tuple_size_v<decltype(given)>> each;
    [&]<std::size_t... i>(std::index_sequence<i...> /*all*/) {
      (detail::take_member<To, From, i>(all, given, each), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(all)>>());
  }
}

template <class To, class From>
To translated(const From& from) {
  To to{};
  take(to, from);
  return to;
}

}  // namespace saphira

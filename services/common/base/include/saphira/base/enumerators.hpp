#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace saphira {
namespace detail {

/// True where the value has a name: the compiler writes others as a number.
template <class E, E value>
consteval bool is_enumerator() {
  const std::string_view text = __PRETTY_FUNCTION__;
  const std::size_t at = text.rfind("value = ") + 8;
  return text[at] != '(' && text[at] != '-' && (text[at] < '0' || text[at] > '9');
}

template <class E, std::size_t... i>
consteval auto enumerators(std::index_sequence<i...> /*all*/) {
  constexpr std::size_t count =
      (static_cast<std::size_t>(is_enumerator<E, static_cast<E>(i)>()) + ...);
  std::array<E, count> result{};
  std::size_t next = 0;
  ((is_enumerator<E, static_cast<E>(i)>() ? void(result[next++] = static_cast<E>(i)) : void()),
   ...);
  return result;
}

template <auto value>
consteval auto enumerator_name() {
  std::string_view text = __PRETTY_FUNCTION__;
  text.remove_prefix(text.rfind("value = ") + 8);
  text = text.substr(0, text.find_first_of(";]"));
  return text.substr(text.rfind(':') + 1);
}

}  // namespace detail

/// All enumerators of an enumeration with a fixed underlying type (as every enum class has) whose
/// values are from 0 to 63, in the order of their values.
template <class E>
inline constexpr auto kEnumerators = detail::enumerators<E>(std::make_index_sequence<64>());

/// Their names in the code, in the same order.
template <class E>
inline constexpr auto kEnumeratorNames = []<std::size_t... i>(std::index_sequence<i...>) {
  return std::array{detail::enumerator_name<kEnumerators<E>[i]>()...};
}
(std::make_index_sequence<kEnumerators<E>.size()>());

/// The word of a value, of one for each enumerator from 0 on; "?" where others send another value.
template <class E, std::size_t count>
constexpr const char* word_of(E value, const char* const (&words)[count]) {
  static_assert(kEnumerators<E>.size() == count, "a word for each enumerator");
  static_assert(static_cast<std::size_t>(kEnumerators<E>.back()) == count - 1);
  const auto at = static_cast<std::size_t>(value);
  return at < count ? words[at] : "?";
}

}  // namespace saphira

#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "saphira/base/enumerators.hpp"
#include "saphira/base/members.hpp"
#include "saphira/base/text.hpp"

namespace saphira {

/// Saves a state as a line of JSON, and restores it to the last bit: numbers, texts, enumerations,
/// optional and shared values, variants, containers, matrices, and plain structs of them. A
/// class with private state lists its members once, for both directions:
///
///     SAPHIRA_ARCHIVE(estopped_, wait_)
///
/// Saving changes no state. A text that does not fit exactly (of another version) gives a
/// std::runtime_error that names the place and the expected value.
class Archive {
 public:
  /// Saves.
  Archive();
  /// Restores.
  explicit Archive(std::string_view text);
  ~Archive();

  bool restores() const { return restores_; }
  /// The saved state.
  std::string text() const;

  /// A member of an object.
  template <class T>
  Archive& operator()(std::string_view name, T& value) {
    enter(name);
    item(value);
    leave();
    return *this;
  }
  /// Members of a class under their names, such as "estopped_, wait_".
  template <class... T>
  void listed(std::string_view names, T&... values) {
    const auto next = [&names] {
      const std::string_view name = names.substr(0, names.find(','));
      names.remove_prefix(std::min(name.size() + 2, names.size()));
      return name.substr(0, name.find_last_not_of('_') + 1);
    };
    ((*this)(next(), values), ...);
  }
  /// Those of a plain struct.
  template <class T>
  void members(T& value);
  /// The state as a whole, once.
  template <class T>
  void whole(T& state) {
    item(state);
    check_all_read();
  }
  /// The value alone.
  template <class T>
  void item(T& value);
  /// Any JSON.
  void json(std::string& text);
  /// A large array of whole numbers as a member: its bytes, in base64.
  template <class T, std::size_t count>
  Archive& bytes(std::string_view name, std::array<T, count>& value) {
    enter(name);
    bytes(std::as_writable_bytes(std::span(value)));
    leave();
    return *this;
  }

  /// "pose[1]: expected a number, found "abc"" at the present place.
  [[noreturn]] void fail(const std::string& expected) const;
  /// A restored value that is not as it must be is an error.
  void expect(bool good, const std::string& expected) const {
    if (restores_ && !good)
      fail(expected);
  }

 private:
  struct Places;

  void enter(std::string_view name);
  void enter_element();
  void leave();
  void check_all_read() const;
  /// Begins a list of that size, or returns the size of the saved one.
  std::size_t size(std::size_t count, bool exactly);
  bool present(bool value);
  void truth(bool& value);
  void number(double& value);
  void text(std::string& value);
  void bytes(std::span<std::byte> bytes);
  void integer(std::int64_t& value, std::int64_t least, std::int64_t most);
  void integer(std::uint64_t& value, std::uint64_t least, std::uint64_t most);

  template <class T>
  void element(T& value) {
    enter_element();
    item(value);
    leave();
  }
  template <class T>
  void container(T& value);
  /// A set or map, as a list of its entries.
  template <class Entry, class T>
  void copy(T& value) {
    std::vector<Entry> entries(value.begin(), value.end());
    item(entries);
    if (restores_)
      value = T(entries.begin(), entries.end());
  }
  template <class Wide, class T>
  void take(Wide wide, T& value) const {
    if (restores_)
      value = static_cast<T>(wide);
  }

  template <class... Kinds>
  void kinds(std::variant<Kinds...>& value) {
    size(2, true);
    std::size_t kind = value.index();
    element(kind);
    expect(kind < sizeof...(Kinds), "a kind below " + std::to_string(sizeof...(Kinds)));
    std::size_t i = 0;
    if (restores_)
      ((i++ == kind ? static_cast<void>(value.template emplace<Kinds>()) : void()), ...);
    std::visit([&](auto& of_kind) { element(of_kind); }, value);
  }

  bool restores_;
  std::unique_ptr<Places> places_;
};

/// A state that was saved earlier, and is restored later.
struct Saved {
  std::string text = "null";

  bool operator==(const Saved&) const = default;
  void archive(Archive& a) { a.json(text); }
};

template <class T>
std::string saved(const T& state) {
  Archive a;
  a.whole(const_cast<T&>(state));  // which reads it
  return a.text();
}

template <class T>
void restore(std::string_view text, T& state) {
  Archive(text).whole(state);
}

template <class T>
T restored(std::string_view text) {
  T state{};
  restore(text, state);
  return state;
}

template <class T>
void Archive::item(T& value) {
  if constexpr (requires { value.archive(*this); }) {
    value.archive(*this);
  } else if constexpr (std::same_as<T, bool>) {
    truth(value);
  } else if constexpr (std::same_as<T, std::string>) {
    text(value);
  } else if constexpr (std::floating_point<T>) {
    double wide = value;
    number(wide);
    take(wide, value);
  } else if constexpr (std::integral<T>) {
    std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t> wide = value;
    integer(wide, std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
    take(wide, value);
  } else if constexpr (std::is_enum_v<T> && sizeof(T) == 1) {  // of a protocol, not all named
    auto number = static_cast<std::uint8_t>(value);
    item(number);
    take(number, value);
  } else if constexpr (std::is_enum_v<T>) {
    constexpr auto& all = kEnumerators<T>;
    constexpr auto& names = kEnumeratorNames<T>;
    const auto at = [&](auto found, auto& list) {
      return static_cast<std::size_t>(found - list.begin());
    };
    std::size_t i = at(std::find(all.begin(), all.end(), value), all);
    std::string name(i < all.size() ? names[i] : "?");
    text(name);
    i = at(std::find(names.begin(), names.end(), name), names);
    expect(i < all.size(), "one of " + joined(names));
    if (restores_)
      value = all[i];
  } else if constexpr (requires { value.valueless_by_exception(); }) {
    kinds(value);
  } else if constexpr (requires { value.first, value.second; }) {
    size(2, true);
    element(value.first);
    element(value.second);
  } else if constexpr (
      requires { std::get<0>(value); } && !requires { value.data(); }) {
    size(std::tuple_size_v<T>, true);
    std::apply([&](auto&... each) { (element(each), ...); }, value);
  } else if constexpr (requires { value.use_count(); }) {
    using Element = std::remove_const_t<typename T::element_type>;
    auto shared = std::const_pointer_cast<Element>(value);
    if (!present(shared != nullptr))
      shared.reset();
    else
      item(restores_ ? *(shared = std::make_shared<Element>()) : *shared);
    value = std::move(shared);
  } else if constexpr (requires { value.has_value(); }) {
    if (!present(value.has_value())) {
      value.reset();
    } else {
      // To clang, a nested struct with default values has no default constructor here.
      if constexpr (requires { value.emplace(); }) {
        if (!value)
          value.emplace();
      } else if (!value) {
        value = typename T::value_type{};
      }
      item(*value);
    }
  } else if constexpr (std::is_aggregate_v<T> && !requires { value.data(); }) {
    members(value);
  } else {
    container(value);
  }
}

template <class T>
void Archive::members(T& value) {
  const auto all = members_of(value);
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((*this)(kMemberName<T, i>, std::get<i>(all)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(all)>>());
}

template <class T>
void Archive::container(T& value) {
  if constexpr (std::same_as<T, std::vector<bool>>) {
    std::string bits;
    for (const bool each : value)
      bits += each ? '1' : '0';
    text(bits);
    expect(bits.find_first_not_of("01") == std::string::npos, "zeros and ones");
    value.resize(bits.size());
    for (std::size_t i = 0; i < bits.size(); ++i)
      value[i] = bits[i] == '1';
  } else if constexpr (requires { typename T::mapped_type; }) {
    copy<std::pair<typename T::key_type, typename T::mapped_type>>(value);
  } else if constexpr (requires { typename T::key_type; }) {
    copy<typename T::key_type>(value);
  } else if constexpr (requires { value.pop_back(); }) {
    value.resize(size(value.size(), false));
    for (auto& each : value)
      element(each);
  } else {  // of a fixed size: std::array, a matrix
    size(static_cast<std::size_t>(value.size()), true);
    for (auto* each = value.data(); each != value.data() + value.size(); ++each)
      element(*each);
  }
}

}  // namespace saphira

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <string>
#include <type_traits>

#include "cdr.hpp"
#include "json.hpp"
#include "json_reader.hpp"
#include "saphira/base/printable.hpp"
#include "saphira/bus/endpoint.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus {
namespace {

using internal::to_json;

// The bytes of the key as two numbers.
template <class T>
InstanceKey key_of(const T& sample) {
  const internal::CdrKey key(sample);
  InstanceKey words{};
  for (std::size_t i = 0; i < key.bytes.size(); ++i)
    words[i / 8] = words[i / 8] << 8 | static_cast<std::uint8_t>(key.bytes[i]);
  return words;
}

template <class T>
bool is_keyed() {
  bool keyed = false;
  const T sample;
  visit_members(sample, [&](const Member& member, const auto&) { keyed |= member.key; });
  return keyed;
}

template <class T>
void make_printable(T& item) {
  if constexpr (std::is_same_v<T, std::string>)
    item = printable(item, "\n\t");
  else if constexpr (std::ranges::range<T>)
    std::for_each(item.begin(), item.end(), [](auto&& part) { make_printable(part); });
  else if constexpr (std::is_class_v<T>)
    visit_members(item, [](const Member&, auto& part) { make_printable(part); });
}

template <class T>
TypeInfo make_type(const char* name) {
  return {
      .name = name,
      .keyed = is_keyed<T>(),
      .key = [](const void* sample) { return key_of(*static_cast<const T*>(sample)); },
      .create = []() -> void* { return new T; },
      .copy = [](const void* from,
                 void* to) { *static_cast<T*>(to) = *static_cast<const T*>(from); },
      .destroy = [](void* sample) { delete static_cast<T*>(sample); },
      .json = [](const void* sample,
                 const char* prefix) { return to_json(*static_cast<const T*>(sample), prefix); },
      .parse = [](const std::string& json,
                  void* sample) { internal::from_json(json, *static_cast<T*>(sample)); },
      .make_printable = [](void* sample) { make_printable(*static_cast<T*>(sample)); }};
}

}  // namespace

#define SAPHIRA_TYPE(T)                                                \
  template <>                                                          \
  const TypeInfo& type_of<v1::T>() {                                   \
    static const TypeInfo type = make_type<v1::T>("saphira::v1::" #T); \
    return type;                                                       \
  }
#include "saphira/idl/topic_types.def"

}  // namespace saphira::bus

#include <type_traits>

#include "json.hpp"
#include "json_reader.hpp"
#include "saphira/bus/endpoint.hpp"
#include "saphira/bus/topics.hpp"
#include "saphira_visit.hpp"

namespace saphira::bus {
namespace {

using internal::to_json;

// Integers, in their order; a struct within the key counts whole, as fastddsgen has it.
struct KeyWords {
  template <class T>
  void operator()(const char* /*name*/, const T& value) {
    if constexpr (std::is_integral_v<T>)
      words.at(count++) = static_cast<std::uint64_t>(value);
    else
      visit_members(value, *this);
  }
  InstanceKey words{};
  std::size_t count = 0;
};

template <class T>
InstanceKey key_of(const T& sample) {
  KeyWords words;
  visit_keys(sample, words);
  return words.words;
}

template <class T>
TypeInfo make_type(const char* name) {
  return {
      .name = name,
      .keyed = T::isKeyDefined(),
      .key = [](const void* sample) { return key_of(*static_cast<const T*>(sample)); },
      .create = []() -> void* { return new T; },
      .copy = [](const void* from,
                 void* to) { *static_cast<T*>(to) = *static_cast<const T*>(from); },
      .destroy = [](void* sample) { delete static_cast<T*>(sample); },
      .json = [](const void* sample,
                 const char* prefix) { return to_json(*static_cast<const T*>(sample), prefix); },
      .parse = [](const std::string& json,
                  void* sample) { internal::from_json(json, *static_cast<T*>(sample)); }};
}

}  // namespace

#define SAPHIRA_TYPE(T)                                                \
  template <>                                                          \
  const TypeInfo& type_of<v1::T>() {                                   \
    static const TypeInfo type = make_type<v1::T>("saphira::v1::" #T); \
    return type;                                                       \
  }
#include "saphira/bus/topics.def"

}  // namespace saphira::bus

#pragma once

#include <string>

#include "../../idl/bus/src/json.hpp"
#include "../../idl/bus/src/json_reader.hpp"

namespace saphira::test {

/// A sample of the contract from its JSON, as `saphira echo` prints it: members that are not named
/// are 0, false or empty. std::invalid_argument for another text.
template <class T>
T sample(const nlohmann::json& json) {
  T made{};
  bus::internal::JsonReader().structure(json, made, "");
  return made;
}
template <class T>
std::vector<T> samples(const nlohmann::json& json) {
  std::vector<T> all;
  for (const nlohmann::json& each : json)
    all.push_back(sample<T>(each));
  return all;
}
template <class T>
std::string json_of(const T& made) {
  return bus::internal::to_json(made, "");
}

}  // namespace saphira::test

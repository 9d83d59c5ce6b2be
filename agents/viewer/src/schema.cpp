#include "saphira/viewer/schema.hpp"

#include <nlohmann/json.hpp>

namespace saphira::viewer {

namespace {

using nlohmann::json;

/// Without references, alternatives and lists of types.
json in_one_piece(const json& place, const json& types) {
  if (const auto reference = place.find("$ref"); reference != place.end()) {
    const std::string name = reference->get<std::string>();
    json found = in_one_piece(types.at(name.substr(name.rfind('/') + 1)), types);
    if (place.contains("description"))
      found["description"] = place["description"];
    return found;
  }
  json made = place;
  made.erase("additionalProperties");
  made.erase("maxItems");
  if (place.contains("anyOf"))  // a number whose values have names
    made.erase("anyOf");
  if (!place.contains("type"))
    made["type"] = "string";
  else if (place["type"].is_array())
    made["type"] = place["type"].front();
  if (place.contains("items"))
    made["items"] = in_one_piece(place["items"], types);
  if (place.contains("properties"))
    for (auto& [name, member] : made["properties"].items())
      member = in_one_piece(member, types);
  return made;
}

}  // namespace

std::string schema_of(const std::string& type) {
  static const json types = json::parse(contract())["$defs"];
  const auto found = types.find(type.substr(type.rfind(':') + 1));
  json schema = found == types.end() ? json{{"type", "object"}} : in_one_piece(*found, types);
  schema["title"] = type;
  return schema.dump();
}

}  // namespace saphira::viewer

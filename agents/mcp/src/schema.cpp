// The part of JSON Schema that tools use.
#include <algorithm>

#include "protocol.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/base/text.hpp"

namespace saphira::mcp {

namespace {

bool has_type(const Json& value, const Json& type) {
  if (type.is_array())
    return std::ranges::any_of(type, [&](const Json& each) { return has_type(value, each); });
  if (type == "number")
    return value.is_number();
  if (type == "integer")
    return value.is_number_integer();
  if (type == "string")
    return value.is_string();
  if (type == "boolean")
    return value.is_boolean();
  if (type == "object")
    return value.is_object();
  if (type == "array")
    return value.is_array();
  return type != "null" || value.is_null();
}

/// The known arguments, for one that is not.
std::string others_than(const std::string& name, const Json& properties) {
  std::vector<std::string> names;
  for (const auto& [known, schema] : properties.items())
    names.push_back(known);
  return (names.empty() ? " (the tool takes none)" : " (known: " + joined(names) + ")") +
         did_you_mean(name, names);
}

std::string misfit_at(const std::string& where, const Json& value, const Json& schema) {
  const std::string who = where.empty() ? "the arguments" : "\"" + where + "\"";
  if (const Json type = member(schema, "type"); !type.is_null() && !has_type(value, type))
    return who + ": expected " + (type.is_string() ? type.get<std::string>() : type.dump()) +
           ", found " + value.dump().substr(0, 60);
  if (const Json forms = member(schema, "anyOf"); !forms.is_null()) {
    std::string why;
    for (const Json& form : forms)
      if (why = misfit_at(where, value, form); why.empty())
        break;
    if (!why.empty())
      return why;
  }
  if (const Json choices = member(schema, "enum");
      choices.is_array() && std::ranges::find(choices, value) == choices.end())
    return who + ": expected one of " + choices.dump() + ", found " + value.dump().substr(0, 60);
  if (value.is_number()) {
    const double number = value.get<double>();
    const Json low = member(schema, "minimum");
    const Json high = member(schema, "maximum");
    if ((low.is_number() && !(number >= low.get<double>())) ||
        (high.is_number() && !(number <= high.get<double>())))
      return who + ": expected a number" + (low.is_number() ? " from " + low.dump() : "") +
             (high.is_number() ? " up to " + high.dump() : "") + ", found " + value.dump();
  }
  if (value.is_array() && schema.contains("items"))
    for (const Json& each : value)
      if (std::string why = misfit_at(where, each, schema["items"]); !why.empty())
        return why;
  if (!value.is_object())
    return {};
  const Json properties = member(schema, "properties");
  for (const Json& name : member(schema, "required"))
    if (!value.contains(name.get<std::string>()))
      return (where.empty() ? "" : who + ": ") + name.dump() + " is missing";
  for (const auto& [name, inner] : value.items()) {
    const Json of = properties.is_object() ? member(properties, name.c_str()) : Json();
    if (of.is_null()) {
      if (member(schema, "additionalProperties") == false)
        return (where.empty() ? "" : who + ": ") + "there is no argument \"" + name.substr(0, 60) +
               '"' + others_than(name, properties);
      continue;
    }
    if (std::string why = misfit_at(where.empty() ? name : where + "." + name, inner, of);
        !why.empty())
      return why;
  }
  return {};
}

}  // namespace

void drop_nulls(Json& arguments, const Json& schema) {
  const Json properties = member(schema, "properties");
  const Json required = member(schema, "required");
  if (!arguments.is_object() || !properties.is_object())
    return;
  for (auto each = arguments.begin(); each != arguments.end();) {
    const Json form = member(properties, each.key());
    const bool needed = std::find(required.begin(), required.end(), each.key()) != required.end();
    if (each->is_null() && !needed && !form.is_null() && !misfit(nullptr, form).empty()) {
      each = arguments.erase(each);
      continue;
    }
    drop_nulls(*each, form);
    ++each;
  }
}

std::string misfit(const Json& arguments, const Json& schema) {
  return misfit_at({}, arguments, schema);
}

}  // namespace saphira::mcp

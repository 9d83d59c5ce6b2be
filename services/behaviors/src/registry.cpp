#include "saphira/behaviors/behavior.hpp"

namespace saphira::behaviors {

void Behavior::init(const Parameters& /*parameters*/, const Context& /*context*/) {}

void Registry::add(Schema schema) {
  schemas_[schema.name] = std::move(schema);
}

const Schema* Registry::find(const std::string& name) const {
  const auto found = schemas_.find(name);
  return found == schemas_.end() ? nullptr : &found->second;
}

std::vector<std::string> Registry::names() const {
  std::vector<std::string> names;
  for (const auto& [name, schema] : schemas_)
    names.push_back(name);
  return names;
}

}  // namespace saphira::behaviors

#include <cctype>

#include "saphira/behaviors/behavior.hpp"

namespace saphira::behaviors {
namespace {

std::string plain(const std::string& name) {
  std::string out;
  const bool sf = name.size() > 2 && name.starts_with("sf") &&
                  std::isupper(static_cast<unsigned char>(name[2])) != 0;
  for (const char c : sf ? name.substr(2) : name)
    if (c != '-' && c != '_')
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace

void Behavior::init(const Parameters& /*parameters*/, const Context& /*context*/) {}

void Behavior::take_over(const Behavior& /*old*/) {}

void Registry::add(Schema schema) {
  schema.revision = ++revision_;
  plain_names_[plain(schema.name)] = schema.name;
  schemas_[schema.name] = std::move(schema);
}

bool Registry::remove(const std::string& name) {
  if (schemas_.erase(name) == 0)
    return false;
  ++revision_;
  if (const auto found = plain_names_.find(plain(name));
      found != plain_names_.end() && found->second == name)
    plain_names_.erase(found);
  return true;
}

const Schema* Registry::find(const std::string& name) const {
  auto found = schemas_.find(name);
  if (found == schemas_.end()) {
    const auto same = plain_names_.find(plain(name));
    if (same != plain_names_.end())
      found = schemas_.find(same->second);
  }
  return found == schemas_.end() ? nullptr : &found->second;
}

std::vector<std::string> Registry::names() const {
  std::vector<std::string> names;
  for (const auto& [name, schema] : schemas_)
    names.push_back(name);
  return names;
}

}  // namespace saphira::behaviors

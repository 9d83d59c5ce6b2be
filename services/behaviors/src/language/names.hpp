#pragma once

#include <map>
#include <string>
#include <string_view>

#include "assembler.hpp"

// The meanings of the names in a behavior.
namespace saphira::behaviors::language {

struct Variable {
  Value value;
  Place place;
  bool parameter = false;
  bool kept = false;     ///< of Init
  bool cleared = false;  ///< to be 0 at the beginning of each update
  bool used = false;
  const ParameterSpec* spec = nullptr;
};
using Variables = std::map<std::string, Variable>;

/// A function that is a single instruction.
struct Quick {
  const char* name;
  int arguments;
  Op op;
};
/// Null where there is none of that name.
const Quick* find_quick(std::string_view name);
const Function* find_function(std::string_view name);

/// True for a name with a fixed meaning, which no behavior can define.
bool reserved(std::string_view name);
bool is_function(std::string_view name);

/// ": did you mean ...?" where a similar name exists.
std::string meant_variable(const std::string& name, const Variables& variables);
std::string meant_function(const std::string& name);

}  // namespace saphira::behaviors::language

#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// An IDL file as it is written.
namespace idl {

struct Type {
  std::string name;   // in IDL, or of a definition; of a sequence: of its elements
  std::string bound;  // of a sequence [empty: it is none]
  std::string array;  // how many it has [empty: it is none]
};

struct Member {
  Type type;
  std::string name;
  std::string comment;
  bool key = false;
};

enum class Kind { open, close, enumeration, structure, alias, constant };

struct Definition {
  Kind kind;
  std::string name;  // close: none
  std::string comment;
  std::vector<Member> members;  // enumeration: names alone
  std::string of;               // alias, constant: the type
  std::string value;            // constant
};

struct File {
  std::string stem;
  std::vector<std::string> includes;
  std::vector<Definition> definitions;
};

/// The accepted IDL is the contract's: modules, enums, structs with @key, typedefs of a base type
/// with their constants, bounded sequences, strings; of foreign files also sequences without a
/// bound, arrays and qualified names of types. Throws std::runtime_error that names the place of
/// anything else.
File parse(const std::filesystem::path& path, bool foreign);

}  // namespace idl

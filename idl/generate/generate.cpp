// Generates the contract's C++ from its IDL files.
//
//   saphira-idl-generate FOLDER FILE.idl... [topics.def]
//   saphira-idl-generate FOLDER --foreign NAME FILE.idl...
//
// FOLDER/saphira/idl/ gets a header with plain structs and enums for each file; types.hpp, which
// includes them all; members.hpp, which visits the members of each struct with their names, keys
// and bounds and names the enumerators (CDR, JSON and keys are made with it); and schema.json, the
// JSON Schema of each type; v1.py, a Python dataclass or enum for each, and topics.py, the topics
// with their types; topic_types.def, a macro's line for each of these types; contract.md, a page
// about all of them. Comments go with what they are about.
//
// --foreign: messages of another system, such as ROS 2. The headers go to FOLDER/saphira/NAME/, and
// there is neither JSON nor Python.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "parser.hpp"

namespace {

using namespace idl;

constexpr std::size_t kVaries = 1000000;      // more than any key may have
constexpr unsigned long kMostNumbers = 4096;  // a longer sequence of octets is base64 in JSON

struct Base {
  const char* cpp;
  std::size_t size;  // in CDR
  const char* json;
  const char* python;
};

const std::map<std::string, Base> bases{
    {"boolean", {"bool", 1, R"("type": "boolean")", "bool"}},
    {"int8", {"std::int8_t", 1, R"("type": "integer", "minimum": -128, "maximum": 127)", "int"}},
    {"octet", {"std::uint8_t", 1, R"("type": "integer", "minimum": 0, "maximum": 255)", "int"}},
    {"short",
     {"std::int16_t", 2, R"("type": "integer", "minimum": -32768, "maximum": 32767)", "int"}},
    {"unsigned short",
     {"std::uint16_t", 2, R"("type": "integer", "minimum": 0, "maximum": 65535)", "int"}},
    {"long", {"std::int32_t", 4, R"("type": "integer")", "int"}},
    {"unsigned long", {"std::uint32_t", 4, R"("type": "integer", "minimum": 0)", "int"}},
    {"long long", {"std::int64_t", 8, R"("type": "integer")", "int"}},
    {"unsigned long long", {"std::uint64_t", 8, R"("type": "integer", "minimum": 0)", "int"}},
    {"float", {"float", 4, R"("type": ["number", "null"])", "float"}},
    {"double", {"double", 8, R"("type": ["number", "null"])", "float"}},
    {"string", {"std::string", kVaries, R"("type": "string")", "str"}}};

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += '\\';
    result += c;
  }
  return result + '"';
}

std::string trimmed(const std::string& text) {
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

/// The texts that are made of the files.
class Generator {
 public:
  /// Headers are in saphira/`place`; `foreign`: see above.
  Generator(std::string place, bool foreign) : place_(std::move(place)), foreign_(foreign) {}

  void add(const File& file) {
    stem_ = file.stem;
    std::ostringstream out;
    out << top << (foreign_ ? "#include <array>\n" : "")
        << "#include <cstdint>\n#include <string>\n#include <vector>\n\n";
    for (const std::string& include : file.includes)
      out << "#include \"saphira/" << place_ << "/" << include << ".hpp\"\n";
    for (const Definition& item : file.definitions)
      write(item, out);
    headers_[file.stem + ".hpp"] = out.str();
  }

  /// The list of the topics, a macro's line each; and of their types: topic_types.def.
  void add_topics(const std::filesystem::path& path) {
    std::ifstream in(path);
    if (!in)
      throw std::runtime_error(path.string() + ": cannot be read");
    const std::regex topic(
        R"re(SAPHIRA_(TOPIC|REQUESTS)\(k(\w+), ("[^"]+"), (\w+)(?:, (\w+))?\).*)re");
    std::smatch found;
    for (std::string line; std::getline(in, line);)
      if (std::regex_match(line, found, topic)) {
        const std::string type = found[1] == "TOPIC" ? found[4].str() : "Request";
        std::string name;
        for (const char c : found[2].str()) {
          const auto letter = static_cast<unsigned char>(c);
          name += name.empty() || std::isupper(letter) == 0 ? "" : "_";
          name += static_cast<char>(std::toupper(letter));
        }
        topic_types_.insert(type);
        topics_ << name << " = Topic(" << found[3] << ", v1." << type << ")\n";
        const std::string text = found[3].str();
        page_topics_ << "| `" << text.substr(1, text.size() - 2) << "` | " << linked(type) << " | "
                     << (found[1] == "TOPIC" ? found[5].str() : "command") << " |\n";
      }
  }

  /// By file name.
  std::map<std::string, std::string> texts() const {
    std::map<std::string, std::string> all = headers_;
    std::string includes;
    for (const auto& [name, text] : headers_)
      includes += "#include \"saphira/" + place_ + "/" + name + "\"\n";
    all["types.hpp"] = top + includes;
    all["members.hpp"] = top + std::string("#include <type_traits>\n\n") +
                         (foreign_ ? "#include \"saphira/idl/members.hpp\"\n" : "") +
                         "#include \"saphira/" + place_ + "/types.hpp\"\n" +
                         (foreign_ ? "\n" : visitor()) + members_.str();
    if (foreign_)
      return all;
    all["schema.json"] =
        "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"$defs\": {" +
        schemas_.str() + "\n  }\n}\n";
    all["v1.py"] = python_top + python_.str();
    std::string& topic_types = all["topic_types.def"];
    for (const std::string& type : topic_types_)
      topic_types += "SAPHIRA_TYPE(" + type + ")\n";
    topic_types += "#undef SAPHIRA_TYPE\n";
    all["topics.py"] = topics_top + topics_.str();
    all["contract.md"] = page_top + page_topics_.str() + page_.str();
    return all;
  }

 private:
  static constexpr const char* top = "// Generated from idl/; changes are lost.\n#pragma once\n\n";
  static std::string visitor() {
    return R"(
namespace saphira {

/// A member of a struct of the contract.
struct Member {
  const char* name;
  bool key;
  std::uint32_t bound;                  ///< of a sequence [0: it is none]
  const char* (*name_of)(std::int32_t);  ///< of a number whose values have names [nullptr: it is none]
};

/// A sequence of octets with a higher bound is base64 in JSON.
constexpr std::uint32_t kMostNumbers = )" +
           std::to_string(kMostNumbers) + R"(;

/// Calls visit(member, value) for each member of a sample of the contract, in their order.
template <class T, class Visit>
constexpr void visit_members(T& sample, Visit&& visit) {
  visit_members(std::type_identity<std::remove_const_t<T>>{}, sample, visit);
}

}  // namespace saphira

)";
  }

  static constexpr const char* python_top = R"(# Generated from idl/; changes are lost.
"""The types of the contract. Lengths are in m, angles in rad, times in s."""

import enum
from dataclasses import dataclass, field


class Enumeration(enum.IntEnum):
    """Names for numbers. A number without a name, from a newer program, stays as it is."""

    @classmethod
    def _missing_(cls, value: object) -> "Enumeration | None":
        if not isinstance(value, int):
            return None
        item = int.__new__(cls, value)
        item._name_ = str(value)
        item._value_ = value
        return item
)";
  static constexpr const char* topics_top = R"(# Generated from idl/; changes are lost.
"""The topics of the bus."""

from dataclasses import dataclass
from typing import Generic, TypeVar

from . import v1

T = TypeVar("T")


@dataclass(frozen=True)
class Topic(Generic[T]):
    name: str
    type: type[T]


)";

  static constexpr const char* page_top = R"(<!-- Generated from idl/; changes are lost. -->
# The contract

Each topic with its type and its QoS, then each type. Lengths are in m, angles in rad, times in s where a member says no other unit; a frame is part of a
member's name.

| topic | type | QoS |
|---|---|---|
)";

  void write(const Definition& item, std::ostream& out) {
    if (!foreign_) {
      python(item);
      page(item);
    }
    const std::string comment = item.comment.empty() ? "" : "///" + item.comment + "\n";
    switch (item.kind) {
      case Kind::open:
        out << "\nnamespace " << item.name << " {\n";
        scope_.push_back(item.name);
        members_ << "namespace " << item.name << " {\n";
        break;
      case Kind::close:
        out << "\n}\n";
        scope_.pop_back();
        members_ << "}\n";
        break;
      case Kind::alias:
        out << "\n" << comment << "using " << item.name << " = " << cpp(item.of) << ";\n";
        aliases_[item.name] = item.of;
        break;
      case Kind::constant:
        out << "inline constexpr " << item.of << " " << item.name << " = " << item.value << ";"
            << behind(item.comment);
        constants_[item.of].push_back(item.name);
        break;
      case Kind::enumeration:
        out << "\n" << comment;
        enumeration(item, out);
        break;
      case Kind::structure:
        out << "\n" << comment;
        structure(item, out);
        break;
    }
  }

  void python(const Definition& item) {
    if (item.kind == Kind::constant)
      python_ << "    " << item.name << " = " << item.value << python_behind(item.comment);
    if (item.kind != Kind::enumeration && item.kind != Kind::structure && item.kind != Kind::alias)
      return;
    const bool is_struct = item.kind == Kind::structure;
    python_ << "\n\n"
            << (is_struct ? "@dataclass(slots=True)\n" : "") << "class " << item.name
            << (is_struct ? "" : "(Enumeration)") << ":\n";
    if (!item.comment.empty())
      python_ << "    r\"\"\"" << trimmed(item.comment) << "\"\"\"\n\n";
    std::size_t number = 0;
    for (const Member& member : item.members) {
      python_ << "    " << member.name;
      if (is_struct)
        python_ << ": " << python_member(member.type);
      else
        python_ << " = " << number++;
      python_ << python_behind(member.comment);
    }
    if (!is_struct)
      numbers_.insert(item.name);
  }

  void page(const Definition& item) {
    if (item.kind == Kind::constant)
      page_ << "| `" << item.name << "` | " << item.value << " |" << item.comment << " |\n";
    if (item.kind != Kind::enumeration && item.kind != Kind::structure && item.kind != Kind::alias)
      return;
    const bool is_struct = item.kind == Kind::structure;
    page_ << "\n## " << item.name << "\n\n"
          << (item.comment.empty() ? "" : trimmed(item.comment) + "\n\n")
          << (is_struct ? "| member | type | |\n" : "| name | value | |\n") << "|---|---|---|\n";
    std::size_t number = 0;
    for (const Member& member : item.members)
      page_ << "| `" << member.name << "` | "
            << (is_struct ? page_type(member) : std::to_string(number++)) << " |" << member.comment
            << " |\n";
  }

  static std::string page_type(const Member& member) {
    const std::string& name = member.type.name;
    return (bases.contains(name) ? name : linked(name)) +
           (member.type.bound.empty() ? "" : ", at most " + member.type.bound) +
           (member.key ? ", key" : "");
  }

  /// A link to the heading of a type on the page.
  static std::string linked(const std::string& type) {
    std::string anchor = type;
    std::ranges::transform(anchor, anchor.begin(), [](unsigned char c) { return std::tolower(c); });
    return "[" + type + "](#" + anchor + ")";
  }

  static std::string python_behind(const std::string& comment) {
    return (comment.empty() ? "" : "  #:" + comment) + "\n";
  }

  /// The type of a member, and its value where none is given.
  std::string python_member(const Type& type) const {
    static const std::map<std::string, std::string> zeros{
        {"bool", "False"}, {"int", "0"}, {"float", "0.0"}, {"str", "\"\""}};
    const auto base = bases.find(type.name);
    const std::string name = base == bases.end() ? type.name : base->second.python;
    if (type.name == "octet" && !type.bound.empty())
      return "bytes = b\"\"";
    if (!type.bound.empty())
      return "list[" + name + "] = field(default_factory=list)";
    if (base == bases.end() && !numbers_.contains(name))
      return name + " = field(default_factory=" + name + ")";
    return name + " = " + (base == bases.end() ? name + "(0)" : zeros.at(name));
  }

  static std::string behind(const std::string& comment) {
    return (comment.empty() ? "" : "  ///<" + comment) + "\n";
  }

  std::string cpp(const std::string& type) const {
    const auto base = bases.find(type);
    return base == bases.end() ? type : base->second.cpp;
  }

  void name_of(const std::string& function, const std::string& type,
               const std::vector<std::string>& names) {
    members_ << "constexpr const char* " << function << "(" << type << " value) {\n"
             << "  switch (value) {\n";
    for (const std::string& name : names)
      members_ << "    case " << name << ":\n      return \"" << name << "\";\n";
    members_ << "  }\n  return nullptr;\n}\n";
  }

  void enumeration(const Definition& item, std::ostream& out) {
    out << "enum " << item.name << " : std::uint32_t {\n";
    std::vector<std::string> names;
    for (const Member& member : item.members) {
      out << "  " << member.name << "," << behind(member.comment);
      names.push_back(member.name);
    }
    out << "};\n";
    name_of("name_of", item.name, names);
    sizes_[qualified(item.name)] = 4;
    schema(item, "\"enum\": [" + listed(names) + "]");
  }

  void structure(const Definition& item, std::ostream& out) {
    out << "struct " << item.name << " {\n";
    std::ostringstream visits;
    std::string properties;
    std::size_t whole = 0;
    std::size_t keys = 0;
    for (const Member& member : item.members) {
      const bool is_sequence = !member.type.bound.empty();
      const std::string type = cpp(member.type.name);
      const bool is_array = !member.type.array.empty();
      out << "  "
          << (is_sequence ? "std::vector<" + type + ">"
              : is_array  ? "std::array<" + type + ", " + member.type.array + ">"
                          : type)
          << " " << member.name << "{};" << behind(member.comment);
      std::string names = "nullptr";
      if (const auto found = constants_.find(member.type.name); found != constants_.end()) {
        if (named_.insert(found->first).second)
          name_of("name_of_" + found->first, found->first, found->second);
        names = "name_of_" + found->first;
      }
      visits << "  visit(saphira::Member{\"" << member.name << "\", "
             << (member.key ? "true" : "false") << ", " << (is_sequence ? member.type.bound : "0")
             << ", " << names << "}, sample." << member.name << ");\n";
      const std::size_t size = is_sequence ? kVaries : size_of(member.type.name);
      whole = end(whole, size);
      if (member.key)
        keys = end(keys, size);
      if (!foreign_)
        properties += std::string(properties.empty() ? "" : ",") + "\n        " +
                      quoted(member.name) + ": {" + property(member) + "}";
    }
    // Other vendors do not hear the withdrawal of a longer one.
    if (keys > 16)
      throw std::runtime_error(stem_ + ".idl: the key of " + item.name + " has more than 16 bytes");
    sizes_[qualified(item.name)] = whole;
    out << "  bool operator==(const " << item.name << "&) const = default;\n};\n";
    members_
        << "template <class Sample, class Visit>\nconstexpr void visit_members(std::type_identity<"
        << item.name << ">, Sample& sample, Visit& visit) {\n"
        << visits.str() << "}\n";
    schema(item, "\"type\": \"object\",\n      \"properties\": {" + properties +
                     "\n      },\n      \"additionalProperties\": false");
  }

  // Where a member ends in CDR that begins at `begin` or later.
  static std::size_t end(std::size_t begin, std::size_t size) {
    const std::size_t align = size >= 8 ? 8 : size >= 4 ? 4 : size >= 2 ? 2 : 1;
    return (begin + align - 1) / align * align + size;
  }

  // In bytes of CDR.
  std::size_t size_of(const std::string& type) const {
    if (const auto base = bases.find(type); base != bases.end())
      return base->second.size;
    if (const auto alias = aliases_.find(type); alias != aliases_.end())
      return size_of(alias->second);
    auto found = sizes_.find(qualified(type));
    if (found == sizes_.end())
      found = sizes_.find(type);
    if (found == sizes_.end())
      throw std::runtime_error(stem_ + ".idl: no type " + type);
    return found->second;
  }

  std::string qualified(const std::string& type) const {
    std::string all;
    for (const std::string& name : scope_)
      all += name + "::";
    return all + type;
  }

  static std::string listed(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names)
      all += (all.empty() ? "" : ", ") + quoted(name);
    return all;
  }

  std::string property(const Member& member) const {
    std::string type = "\"$ref\": " + quoted("#/$defs/" + member.type.name);
    if (const auto base = bases.find(member.type.name); base != bases.end())
      type = base->second.json;
    else if (const auto found = constants_.find(member.type.name); found != constants_.end())
      type = "\"anyOf\": [{\"enum\": [" + listed(found->second) + "]}, {" +
             bases.at(aliases_.at(found->first)).json + "}]";
    if (member.type.name == "octet" && !member.type.bound.empty() &&
        std::stoul(member.type.bound) > kMostNumbers)
      type = R"("type": "string", "contentEncoding": "base64")";
    else if (!member.type.bound.empty())
      type =
          "\"type\": \"array\", \"maxItems\": " + member.type.bound + ", \"items\": {" + type + "}";
    if (!member.comment.empty())
      type += ", \"description\": " + quoted(trimmed(member.comment));
    return type;
  }

  void schema(const Definition& item, const std::string& text) {
    schemas_ << (schemas_.tellp() == 0 ? "" : ",") << "\n    " << quoted(item.name) << ": {\n";
    if (!item.comment.empty())
      schemas_ << "      \"description\": " << quoted(trimmed(item.comment)) << ",\n";
    schemas_ << "      " << text << "\n    }";
  }

  std::string place_;
  bool foreign_;
  std::vector<std::string> scope_;  // the modules of the present definition
  std::string stem_;                // of the present file
  std::map<std::string, std::string> headers_;
  std::ostringstream members_;
  std::ostringstream schemas_;
  std::ostringstream python_;
  std::ostringstream topics_;
  std::set<std::string> topic_types_;
  std::ostringstream page_topics_;
  std::ostringstream page_;
  std::set<std::string> numbers_;  // Python's enums
  std::map<std::string, std::string> aliases_;
  std::map<std::string, std::vector<std::string>> constants_;  // by their type
  std::map<std::string, std::size_t> sizes_;
  std::set<std::string> named_;  // types of constants with a function for their names
};

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 3)
      throw std::runtime_error("usage: saphira-idl-generate FOLDER FILE.idl... [topics.def]");
    const bool foreign = std::string(argv[2]) == "--foreign" && argc > 4;
    const std::string place = foreign ? argv[3] : "idl";
    std::map<std::string, File> files;
    Generator generator(place, foreign);
    for (int i = foreign ? 4 : 2; i < argc; ++i) {
      if (std::filesystem::path(argv[i]).extension() == ".def") {
        generator.add_topics(argv[i]);
        continue;
      }
      File file = parse(argv[i], foreign);
      files[file.stem] = std::move(file);
    }
    std::set<std::string> added;
    const std::function<void(const std::string&)> add = [&](const std::string& stem) {
      if (!added.insert(stem).second)
        return;
      const auto found = files.find(stem);
      if (found == files.end())
        throw std::runtime_error(stem + ".idl is included and was not given");
      for (const std::string& include : found->second.includes)
        add(include);
      generator.add(found->second);
    };
    for (const auto& [stem, file] : files)
      add(stem);
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / "saphira" / place;
    std::filesystem::create_directories(folder);
    for (const auto& [name, text] : generator.texts()) {
      // A header that stays the same is left as it is, so its users are not compiled again.
      std::stringstream before;
      before << std::ifstream(folder / name).rdbuf();
      if (before.str() == text)
        continue;
      std::ofstream out(folder / name);
      out << text;
      out.close();
      if (!out)
        throw std::runtime_error((folder / name).string() + ": cannot be written");
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}

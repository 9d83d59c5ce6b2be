// Writes a C++ header that visits the members of every struct of the given IDL files by name, and
// names their enumerators. JSON and keys are made with this header, without types at run time.
//
//   saphira-idl-visit OUTPUT.hpp FILE.idl...
//
// The accepted IDL is the contract's: modules, enums, structs with @key, typedefs of a base type
// with their constants, sequences, strings. Anything else is an error that names the place.

#include <cctype>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Token {
  std::string text;
  int line;
};

class Parser {
 public:
  Parser(std::string file, std::ostream& out) : file_(std::move(file)), out_(out) { split(); }

  void parse() {
    while (next_ < tokens_.size())
      definition();
  }

  // Of all files so far: typedefs with their constants.
  static std::map<std::string, std::vector<std::string>> constants;

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    const int line = next_ < tokens_.size() ? tokens_[next_].line : last_line_;
    const std::string found = next_ < tokens_.size() ? tokens_[next_].text : "the end of the file";
    throw std::runtime_error(file_ + ":" + std::to_string(line) + ": expected " + expected +
                             ", found " + found);
  }

  void split() {
    std::ifstream in(file_);
    if (!in)
      throw std::runtime_error(file_ + ": cannot be read");
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (line.starts_with("#"))
        continue;
      line = line.substr(0, line.find("//"));
      for (std::size_t i = 0; i < line.size();) {
        const auto is_word = [](char c) {
          return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '@';
        };
        std::size_t end = i + 1;
        if (is_word(line[i])) {
          while (end < line.size() && is_word(line[end]))
            ++end;
        }
        if (std::isspace(static_cast<unsigned char>(line[i])) == 0)
          tokens_.push_back({line.substr(i, end - i), number});
        i = end;
      }
    }
    last_line_ = number;
  }

  bool at(const std::string& text) const {
    return next_ < tokens_.size() && tokens_[next_].text == text;
  }
  bool take(const std::string& text) {
    const bool found = at(text);
    next_ += found ? 1 : 0;
    return found;
  }
  void expect(const std::string& text) {
    if (!take(text))
      fail("\"" + text + "\"");
  }
  std::string word() {
    if (next_ >= tokens_.size() ||
        (std::isalnum(static_cast<unsigned char>(tokens_[next_].text[0])) == 0 &&
         tokens_[next_].text[0] != '_'))
      fail("a name");
    return tokens_[next_++].text;
  }

  // True where it was @key.
  bool annotation() {
    const std::string name = tokens_[next_++].text;
    if (take("("))
      while (!take(")"))
        word();
    return name == "@key";
  }

  void definition() {
    while (next_ < tokens_.size() && tokens_[next_].text[0] == '@')
      annotation();
    if (take("module")) {
      out_ << "namespace " << word() << " {\n";
      expect("{");
      while (!take("}"))
        definition();
      out_ << "}\n";
    } else if (take("enum")) {
      enumeration();
    } else if (take("struct")) {
      structure();
    } else if (take("typedef")) {
      type();
      constants[word()];
    } else if (take("const")) {
      const std::string of = word();
      if (!constants.contains(of))
        fail("a type that was defined");
      constants[of].push_back(word());
      expect("=");
      word();
    } else {
      fail("module, enum, struct, typedef or const");
    }
    expect(";");
  }

  void enumeration() {
    const std::string name = word();
    out_ << "inline const char* name_of(" << name << " value) {\n  switch (value) {\n";
    expect("{");
    do {
      const std::string item = word();
      out_ << "    case " << item << ":\n      return \"" << item << "\";\n";
    } while (take(","));
    expect("}");
    out_ << "  }\n  return nullptr;\n}\n";
  }

  // The name of the type where it is a single word.
  std::string type() {
    if (take("sequence")) {
      expect("<");
      type();
      if (take(","))
        word();
      expect(">");
      return {};
    }
    std::string name = word();
    if (name == "unsigned" || name == "long")
      while (at("long") || at("short"))
        name += " " + word();
    if (name == "string" && take("<")) {
      word();
      expect(">");
    }
    while (take(":")) {
      expect(":");
      name += "::" + word();
    }
    return name;
  }

  void structure() {
    const std::string name = word();
    expect("{");
    std::ostringstream members;
    std::ostringstream settable;
    std::ostringstream keys;
    std::set<std::string> named;
    while (!take("}")) {
      bool key = false;
      while (next_ < tokens_.size() && tokens_[next_].text[0] == '@')
        key |= annotation();
      const std::string of = type();
      const std::string member = word();
      const std::string value = "sample." + member + "()";
      members << "  visit(\"" << member << "\", ";
      if (constants.contains(of)) {
        members << "Named<" << of << ">{" << value << ", name_of_" << of << "(" << value << ")}";
        named.insert(of);
      } else {
        members << value;
      }
      members << ");\n";
      settable << "  visit(\"" << member << "\", ";
      if (constants.contains(of))
        settable << "Nameable<" << of << ">{" << value << ", name_of_" << of << "}";
      else
        settable << value;
      settable << ");\n";
      if (key)
        keys << "  visit(\"" << member << "\", " << value << ");\n";
      expect(";");
    }
    for (const auto& [of, values] : constants) {
      if (!named.contains(of) || !written_.insert(of).second)
        continue;
      out_ << "inline const char* name_of_" << of << "(" << of << " value) {\n";
      for (const auto& item : values)
        out_ << "  if (value == " << item << ")\n    return \"" << item << "\";\n";
      out_ << "  return nullptr;\n}\n";
    }
    out_ << "template <class Visit>\nvoid visit_members(const " << name
         << "& sample, Visit&& visit) {\n"
         << members.str() << "}\n";
    out_ << "template <class Visit>\nvoid visit_members(" << name << "& sample, Visit&& visit) {\n"
         << settable.str() << "}\n";
    out_ << "template <class Visit>\nvoid visit_keys([[maybe_unused]] const " << name
         << "& sample, [[maybe_unused]] Visit&& visit) {\n"
         << keys.str() << "}\n";
  }

  std::string file_;
  std::ostream& out_;
  std::vector<Token> tokens_;
  std::size_t next_ = 0;
  int last_line_ = 0;
  std::set<std::string> written_;
};

std::map<std::string, std::vector<std::string>> Parser::constants;

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 3)
      throw std::runtime_error("usage: saphira-idl-visit OUTPUT.hpp FILE.idl...");
    std::ostringstream out;
    out << "// Generated from the IDL files; changes are lost.\n#pragma once\n\n";
    for (int i = 2; i < argc; ++i) {
      const std::string path = argv[i];
      const auto slash = path.rfind('/') + 1;
      out << "#include \"" << path.substr(slash, path.rfind('.') - slash) << ".h\"\n";
    }
    out << "\nnamespace saphira {\n"
           "/// A number whose values have names; nullptr for one that has none.\n"
           "template <class T>\nstruct Named {\n  T value;\n  const char* name;\n};\n"
           "/// The same, to be set.\n"
           "template <class T>\nstruct Nameable {\n  T& value;\n  const char* (*name)(T);\n};\n"
           "}\n\n";
    for (int i = 2; i < argc; ++i)
      Parser(argv[i], out).parse();
    std::ofstream file(argv[1]);
    file << out.str();
    file.close();
    if (!file)
      throw std::runtime_error(std::string(argv[1]) + ": cannot be written");
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}

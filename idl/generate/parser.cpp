#include "parser.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <stdexcept>
#include <utility>

namespace idl {
namespace {

struct Token {
  std::string text;
  int line;
};

class Parser {
 public:
  Parser(const std::filesystem::path& path, bool foreign)
      : path_(path.string()), foreign_(foreign) {
    file_.stem = path.stem().string();
    split();
  }
  File parse() {
    while (next_ < tokens_.size())
      definition();
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    const int line = next_ < tokens_.size() ? tokens_[next_].line : last_line_;
    const std::string found = next_ < tokens_.size() ? tokens_[next_].text : "the end of the file";
    throw std::runtime_error(path_ + ":" + std::to_string(line) + ": expected " + expected +
                             ", found " + found);
  }

  static bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '@';
  }
  void split() {
    std::ifstream in(path_);
    if (!in)
      throw std::runtime_error(path_ + ": cannot be read");
    for (std::string line; std::getline(in, line);) {
      ++last_line_;
      if (line.starts_with("#include \"")) {
        file_.includes.push_back(line.substr(10, line.find(".idl") - 10));
        continue;
      }
      const std::size_t comment = std::min(line.find("//"), line.size());
      const std::size_t before = tokens_.size();
      for (std::size_t i = 0; i < comment;) {
        std::size_t end = i + 1;
        while (is_word(line[i]) && end < comment && is_word(line[end]))
          ++end;
        if (std::isspace(static_cast<unsigned char>(line[i])) == 0)
          tokens_.push_back({line.substr(i, end - i), last_line_});
        i = end;
      }
      if (comment < line.size())
        comments_[last_line_] = {line.substr(comment + 2), comment, tokens_.size() == before};
    }
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
    if (next_ >= tokens_.size() || !is_word(tokens_[next_].text[0]) ||
        tokens_[next_].text[0] == '@')
      fail("a name");
    return tokens_[next_++].text;
  }
  // The lines of comment alone that end before this line.
  std::string comment_above(int line) const {
    std::string text;
    for (auto found = comments_.find(--line); found != comments_.end() && found->second.alone;
         found = comments_.find(--line))
      text = found->second.text + text;
    return text;
  }
  // The comment behind the token that was taken last, with its further lines below.
  std::string comment_behind() const {
    int line = tokens_[next_ - 1].line;
    if (next_ < tokens_.size() && tokens_[next_].line == line && !at("}"))
      return {};
    std::string text;
    auto found = comments_.find(line);
    if (found == comments_.end() || found->second.alone)
      return {};
    const std::size_t column = found->second.column;
    do
      text += found->second.text;
    while ((found = comments_.find(++line)) != comments_.end() && found->second.alone &&
           found->second.column == column);
    return text;
  }
  int line() const { return next_ < tokens_.size() ? tokens_[next_].line : last_line_; }

  void definition() {
    const std::string comment = comment_above(line());
    auto& made = file_.definitions;
    if (take("module")) {
      made.push_back({Kind::open, word(), {}, {}, {}, {}});
      expect("{");
      while (!take("}"))
        definition();
      made.push_back({Kind::close, {}, {}, {}, {}, {}});
    } else if (take("enum")) {
      Definition item{Kind::enumeration, word(), comment, {}, {}, {}};
      expect("{");
      bool more = true;
      while (more) {
        item.members.push_back({{}, word(), {}});
        more = take(",");
        item.members.back().comment = comment_behind();
      }
      expect("}");
      made.push_back(item);
    } else if (at("@extensibility")) {
      // Other kinds of structs have other bytes for some vendors.
      for (const char* const part : {"@extensibility", "(", "FINAL", ")", "struct"})
        expect(part);
      Definition item{Kind::structure, word(), comment, {}, {}, {}};
      expect("{");
      while (!take("}")) {
        const bool key = take("@key");
        Type of = type();
        const std::string name = word();
        if (foreign_ && take("[")) {
          of.array = word();
          expect("]");
        }
        expect(";");
        item.members.push_back({of, name, comment_behind(), key});
      }
      made.push_back(item);
    } else if (take("typedef")) {
      const std::string of = type().name;
      made.push_back({Kind::alias, word(), comment, {}, of, {}});
    } else if (take("const")) {
      const std::string of = word();
      const std::string name = word();
      expect("=");
      made.push_back({Kind::constant, name, {}, {}, of, word()});
      expect(";");
      made.back().comment = comment_behind();
      return;
    } else {
      fail("module, enum, @extensibility(FINAL) struct, typedef or const");
    }
    expect(";");
  }

  Type type() {
    Type result;
    if (take("sequence")) {
      expect("<");
      result = type();
      if (!result.bound.empty())
        fail("no sequence in a sequence");
      if (foreign_ && take(">")) {
        result.bound = "0xFFFFFFFF";
        return result;
      }
      expect(",");
      result.bound = word();
      expect(">");
      return result;
    }
    result.name = word();
    if (result.name == "unsigned" || result.name == "long")
      while (at("long") || at("short"))
        result.name += " " + word();
    while (foreign_ && take(":")) {
      expect(":");
      result.name += "::" + word();
    }
    return result;
  }

  std::string path_;
  bool foreign_;
  File file_;
  std::vector<Token> tokens_;
  std::size_t next_ = 0;
  int last_line_ = 0;
  struct Comment {
    std::string text;
    std::size_t column;
    bool alone;  // no code on its line
  };
  std::map<int, Comment> comments_;  // by line
};

}  // namespace

File parse(const std::filesystem::path& path, bool foreign) {
  return Parser(path, foreign).parse();
}

}  // namespace idl

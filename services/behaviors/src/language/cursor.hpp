#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "lexer.hpp"

namespace saphira::behaviors::language {

/// Thrown at an unreadable sentence; caught at the beginning of the next one.
struct SyntaxError {
  Place place;
  std::string message;
};

/// Words that end a section of the language, at any place.
bool ends_section(const Token& token);
/// SyntaxError where the nesting is too deep for a person's text.
void limit_depth(int depth, const Place& place);

/// The parser's place in a text.
class Cursor {
 public:
  explicit Cursor(const std::vector<Token>& tokens) : tokens_(tokens) {}

  const Token& now() const { return tokens_[at_]; }
  const Token& ahead(std::size_t n) const { return tokens_[std::min(at_ + n, tokens_.size() - 1)]; }
  bool at_end() const { return now().kind == TokenKind::end; }
  std::size_t place() const { return at_; }
  /// The tokens between two places as text.
  std::string words(std::size_t begin, std::size_t end) const;

  void skip(std::size_t n = 1) { at_ += n; }
  const Token& take();
  bool accept(std::string_view what);
  // These throw a SyntaxError for any other token.
  void expect(std::string_view what);
  const Token& expect_symbol(const std::string& what);
  double expect_number(const std::string& what);
  [[noreturn]] void expected(const std::string& what) const;

 private:
  const std::vector<Token>& tokens_;
  std::size_t at_ = 0;
};

}  // namespace saphira::behaviors::language

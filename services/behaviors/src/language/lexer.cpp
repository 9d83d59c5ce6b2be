#include "lexer.hpp"

#include <charconv>
#include <cmath>

namespace saphira::behaviors::language {
namespace {

bool letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool digit(char c) {
  return c >= '0' && c <= '9';
}

class Lexer {
 public:
  Lexer(std::string_view text, Messages& messages) : text_(text), messages_(messages) {}

  std::vector<Token> all() {
    std::vector<Token> tokens;
    while (!messages_.full()) {
      skip_blanks();
      Token token = next();
      const bool end = token.kind == TokenKind::end;
      // A word missing at the end is reported after the last one.
      if (end && !tokens.empty()) {
        const Token& last = tokens.back();
        const bool text = last.kind == TokenKind::text;
        token.place = {last.place.line,
                       last.place.column + static_cast<int>(last.text.size()) + (text ? 2 : 0)};
      }
      tokens.push_back(token);
      if (end)
        return tokens;
    }
    tokens.push_back({TokenKind::end, {}, 0.0, false, place()});
    return tokens;
  }

 private:
  Place place() const { return {line_, static_cast<int>(at_ - line_start_) + 1}; }
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  void advance() {
    if (text_[at_++] == '\n') {
      ++line_;
      line_start_ = at_;
    }
  }

  void skip_blanks() {
    while (at_ < text_.size()) {
      const char c = peek();
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v') {
        advance();
      } else if (c == '/' && peek(1) == '/') {
        while (at_ < text_.size() && peek() != '\n')
          advance();
      } else if (c == '/' && peek(1) == '*') {
        const Place begin = place();
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos)
          messages_.error(begin, "expected \"*/\" at the end of this comment");
        const std::size_t to = end == std::string_view::npos ? text_.size() : end + 2;
        while (at_ < to)
          advance();
      } else {
        return;
      }
    }
  }

  Token next() {
    Token token;
    token.place = place();
    const std::size_t begin = at_;
    const char c = peek();
    if (at_ >= text_.size())
      return token;
    if (letter(c)) {
      while (letter(peek()) || digit(peek()))
        ++at_;
      token.kind = TokenKind::symbol;
      token.text = text_.substr(begin, at_ - begin);
      return token;
    }
    if (digit(c) || (c == '.' && digit(peek(1))))
      return number(token);
    if (c == '"')
      return quoted(token);
    token.kind = TokenKind::mark;
    constexpr std::string_view pairs[] = {
        "&&", "||", "==", "!=", "<=", ">=", "->", "+=", "-=", "*=", "/="};
    for (const std::string_view pair : pairs)
      if (text_.substr(at_, 2) == pair) {
        at_ += 2;
        token.text = pair;
        return token;
      }
    if (std::string_view("+-*/%<>=!?:;,.(){}|").find(c) == std::string_view::npos) {
      // The rest may be no text of this language at all.
      messages_.error(token.place, "expected a name, a number or a sign of the language");
      at_ = text_.size();
      token.kind = TokenKind::end;
      return token;
    }
    ++at_;
    token.text = text_.substr(begin, 1);
    return token;
  }

  Token number(Token token) {
    const char* const begin = text_.data() + at_;
    const char* const end = text_.data() + text_.size();
    const auto [rest, error] = std::from_chars(begin, end, token.value);
    token.text = text_.substr(at_, static_cast<std::size_t>(rest - begin));
    at_ += token.text.size();
    token.kind = TokenKind::number;
    token.whole = token.text.find_first_of(".eE") == std::string_view::npos;
    // C's suffix of a float.
    if ((peek() == 'f' || peek() == 'F') && !letter(peek(1)) && !digit(peek(1)))
      ++at_;
    if (error != std::errc() || !std::isfinite(token.value) || std::abs(token.value) > 1e12) {
      messages_.error(token.place, "expected a number of at most 1e12, found " + found(token));
      token.value = 0.0;
    } else if (letter(peek())) {
      messages_.error(place(), "expected a blank or a sign after the number");
      while (letter(peek()) || digit(peek()))
        ++at_;
    }
    return token;
  }

  Token quoted(Token token) {
    ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && peek() != '"' && peek() != '\n')
      ++at_;
    token.kind = TokenKind::text;
    token.text = text_.substr(begin, at_ - begin);
    if (peek() == '"')
      ++at_;
    else
      messages_.error(token.place, "expected '\"' at the end of this text");
    return token;
  }

  std::string_view text_;
  Messages& messages_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  int line_ = 1;
};

}  // namespace

FileError Messages::made(const Place& place, const std::string& message) const {
  std::string_view rest = text_;
  for (int line = 1; line < place.line; ++line) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) {
      rest = {};
      break;
    }
    rest.remove_prefix(end + 1);
  }
  std::string_view line = rest.substr(0, rest.find('\n'));
  if (!line.empty() && line.back() == '\r')
    line.remove_suffix(1);
  return FileError(file_, place.line, place.column, message, line);
}

void Messages::error(const Place& place, const std::string& message) {
  // Only the first error at one place is useful to people.
  for (const FileError& other : errors)
    if (other.line() == place.line && other.column() == place.column)
      return;
  if (!full())
    errors.push_back(made(place, message));
}

void Messages::warn(const Place& place, const std::string& message) {
  if (warnings.size() < kMost)
    warnings.push_back(made(place, message));
}

std::vector<Token> tokenize(std::string_view text, Messages& messages) {
  return Lexer(text, messages).all();
}

std::string found(const Token& token) {
  if (token.kind == TokenKind::end)
    return "the end of the file";
  return "\"" + std::string(token.text.substr(0, 40)) + "\"";
}

}  // namespace saphira::behaviors::language

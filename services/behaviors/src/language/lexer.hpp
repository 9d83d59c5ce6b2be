#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/text.hpp"

namespace saphira::behaviors::language {

/// A place in the text, from 1.
struct Place {
  int line = 1;
  int column = 1;
};

enum class TokenKind { symbol, number, text, mark, end };

struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;  ///< of a text: without its quotes
  double value = 0.0;     ///< of a number
  bool whole = false;     ///< of a number: written without point and exponent
  Place place;

  bool is(std::string_view what) const {
    return (kind == TokenKind::symbol || kind == TokenKind::mark) && text == what;
  }
};

/// Collects the errors of a text.
class Messages {
 public:
  Messages(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {}

  void error(const Place& place, const std::string& message);
  void warn(const Place& place, const std::string& message);
  bool full() const { return errors.size() >= kMost; }

  std::vector<FileError> errors;
  std::vector<FileError> warnings;

 private:
  static constexpr std::size_t kMost = 20;
  FileError made(const Place& place, const std::string& message) const;

  std::string file_;
  std::string_view text_;
};

/// The tokens of a text, without comments; the last one is an end. Views into the text.
std::vector<Token> tokenize(std::string_view text, Messages& messages);

/// Its name in "found ...".
std::string found(const Token& token);

}  // namespace saphira::behaviors::language

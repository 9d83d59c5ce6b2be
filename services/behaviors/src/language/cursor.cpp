#include "cursor.hpp"

#include <array>

namespace saphira::behaviors::language {
namespace {

constexpr int kDeepest = 100;

}  // namespace

bool ends_section(const Token& token) {
  constexpr std::array keywords{"BeginBehavior", "Params",   "Rules",      "Init",
                                "Update",        "Activity", "EndBehavior"};
  return token.kind == TokenKind::symbol &&
         std::find(keywords.begin(), keywords.end(), token.text) != keywords.end();
}

void limit_depth(int depth, const Place& place) {
  if (depth > kDeepest)
    throw SyntaxError{place, "expected something simpler: this is more than " +
                                 std::to_string(kDeepest) + " levels deep"};
}

std::string Cursor::words(std::size_t begin, std::size_t end) const {
  std::string out;
  for (std::size_t i = begin; i < end && out.size() < 200; ++i) {
    const Token& token = tokens_[i];
    const bool tight =
        out.empty() || token.is(")") || tokens_[i - 1].is("(") || tokens_[i - 1].is("-");
    out += (tight ? "" : " ") + std::string(token.text);
  }
  return out;
}

const Token& Cursor::take() {
  const Token& token = now();
  if (!at_end())
    ++at_;
  return token;
}

bool Cursor::accept(std::string_view what) {
  if (!now().is(what))
    return false;
  ++at_;
  return true;
}

void Cursor::expected(const std::string& what) const {
  throw SyntaxError{now().place, "expected " + what + ", found " + found(now())};
}

void Cursor::expect(std::string_view what) {
  if (!accept(what))
    expected("\"" + std::string(what) + "\"");
}

const Token& Cursor::expect_symbol(const std::string& what) {
  if (now().kind != TokenKind::symbol || ends_section(now()))
    expected(what);
  return take();
}

double Cursor::expect_number(const std::string& what) {
  const bool negative = accept("-");
  if (now().kind != TokenKind::number)
    expected(what);
  const double value = take().value;
  return negative ? -value : value;
}

}  // namespace saphira::behaviors::language

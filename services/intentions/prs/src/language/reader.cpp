#include "language/reader.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "saphira/base/units.hpp"

namespace saphira::intentions {
namespace {

constexpr int kDeepest = 100;  ///< nested parentheses
/// A file with more errors is no file of activities.
constexpr std::size_t kMostTroubles = 100;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}
bool ends_atom(char c) {
  return is_blank(c) || c == '(' || c == ')' || c == '\'' || c == '"' || c == ';';
}

}  // namespace

std::string normal(std::string_view name) {
  std::string result(name);
  for (char& c : result) {
    if (c == '_')
      c = '-';
    else if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

bool Form::is(std::string_view name) const {
  return (kind == Kind::kName || kind == Kind::kKeyword) && normal(text) == name;
}

Reader::Reader(std::string file, std::string_view content, std::vector<Diagnostic>& troubles)
    : file_(std::move(file)), content_(content), troubles_(troubles) {
  for (std::size_t begin = 0; begin <= content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    std::string_view line = content.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r')
      line.remove_suffix(1);
    lines_.push_back(line);
    begin = end + 1;
  }
}

Diagnostic Reader::trouble(int line, int column, bool error, std::string message) const {
  const auto index = static_cast<std::size_t>(line - 1);
  std::string text(index < lines_.size() ? lines_[index] : std::string_view());
  return {error, file_, line, column, std::move(message), std::move(text)};
}

std::vector<Form> Reader::read() {
  std::vector<Form> forms;
  for (;;) {
    skip_blank();
    if (!more() || troubles_.size() >= kMostTroubles)
      return forms;
    try {
      forms.push_back(read_form(0));
    } catch (const Stop&) {
      recover();
    }
  }
}

void Reader::advance() {
  if (content_[at_] == '\n') {
    ++line_;
    column_ = 1;
  } else {
    ++column_;
  }
  ++at_;
}

bool Reader::at_definition() const {
  return column_ == 1 && content_.substr(at_).starts_with("(def");
}

void Reader::skip_blank() {
  while (more()) {
    if (peek() == ';') {
      while (more() && peek() != '\n')
        advance();
    } else if (is_blank(peek())) {
      advance();
    } else {
      return;
    }
  }
}

void Reader::fail(int line, int column, std::string message) {
  troubles_.push_back(trouble(line, column, true, std::move(message)));
  throw Stop();
}

void Reader::recover() {
  // read_list stops before a definition in the first column; skips anything else.
  while (more() && !at_definition())
    advance();
}

Form Reader::read_form(int depth) {
  if (depth > kDeepest)
    fail(line_, column_,
         "expected no more than " + std::to_string(kDeepest) + " parentheses within another");
  const int line = line_;
  const int column = column_;
  switch (peek()) {
    case '(':
      return read_list(depth);
    case ')':
      advance();
      fail(line, column, "a ) too many: expected (defintention ...)");
    case '\'': {
      advance();
      skip_blank();
      if (!more())
        fail(line, column, "expected something after the '");
      Form form = read_form(depth + 1);
      form.quoted = true;
      return form;
    }
    case '"':
      return read_text();
    default:
      return read_atom();
  }
}

Form Reader::read_list(int depth) {
  Form form;
  form.line = line_;
  form.column = column_;
  advance();
  bool dot = false;
  for (;;) {
    skip_blank();
    // A definition begins in the first column: the enclosing form lacks a parenthesis.
    if (!more() || at_definition())
      fail(form.line, form.column, "expected a ) for this (");
    if (peek() == ')') {
      advance();
      if (dot)
        fail(form.line, form.column, "expected one thing after the dot");
      return form;
    }
    const int line = line_;
    const int column = column_;
    if (form.dotted)
      fail(line, column, "expected a ) after what follows the dot");
    Form item = read_form(depth + 1);
    if (item.kind == Form::Kind::kName && item.text == "." && !item.quoted) {
      if (form.items.empty() || dot)
        fail(line, column, "expected something before the dot");
      dot = true;
      continue;
    }
    form.items.push_back(std::move(item));
    form.dotted = std::exchange(dot, false);
  }
}

Form Reader::read_text() {
  Form form;
  form.kind = Form::Kind::kText;
  form.line = line_;
  form.column = column_;
  advance();
  while (more() && peek() != '"') {
    if (peek() == '\n')
      fail(form.line, form.column, "expected a \" for this one on the same line");
    if (peek() == '\\' && at_ + 1 < content_.size()) {
      advance();
      if (peek() == '\n')
        fail(form.line, form.column, "expected a \" for this one on the same line");
    }
    // A text is printed on one line, in plain letters.
    const auto byte = static_cast<unsigned char>(peek());
    if (byte != '\t' && (byte < 0x20 || byte == 0x7f))
      fail(line_, column_, "expected no control character");
    form.text += byte == '\t' ? ' ' : peek();
    advance();
  }
  if (!more())
    fail(form.line, form.column, "expected a \" for this one");
  advance();
  return form;
}

Form Reader::read_atom() {
  Form form;
  form.line = line_;
  form.column = column_;
  while (more() && !ends_atom(peek())) {
    const auto byte = static_cast<unsigned char>(peek());
    if (byte < 0x20 || byte == 0x7f)
      fail(line_, column_, "expected no control character");
    form.text += peek();
    advance();
  }
  if (form.text.front() == ':') {
    form.kind = Form::Kind::kKeyword;
    form.text.erase(0, 1);
    if (form.text.empty())
      fail(form.line, form.column, "expected a name after the :");
    return form;
  }
  const char* first = form.text.data();
  const char* const last = first + form.text.size();
  if (*first == '+' && form.text.size() > 1 && form.text[1] != '-')
    ++first;
  // "inf" and "nan" are names here.
  const char* const digit = *first == '-' ? first + 1 : first;
  const bool numeric = digit != last && (std::isdigit(static_cast<unsigned char>(*digit)) != 0 ||
                                         (*digit == '.' && digit + 1 != last &&
                                          std::isdigit(static_cast<unsigned char>(digit[1])) != 0));
  if (!numeric) {
    form.kind = Form::Kind::kName;
    return form;
  }
  form.kind = Form::Kind::kNumber;
  const auto parsed = std::from_chars(first, last, form.number);
  if (parsed.ec != std::errc() || !std::isfinite(form.number))
    fail(form.line, form.column, "expected a number, found " + quoted(form.text));
  form.unit.assign(parsed.ptr, last);
  if (form.unit.empty())
    return form;
  if (const Unit* const unit = find_unit(form.unit)) {
    form.number *= unit->factor;
    return form;
  }
  fail(form.line, form.column + static_cast<int>(parsed.ptr - form.text.data()),
       "expected a unit (" + unit_names() + ") or none, found " + quoted(form.unit));
}

namespace {

void print(const Form& form, std::string& out, std::size_t longest) {
  if (out.size() > longest)
    return;
  if (form.quoted)
    out += '\'';
  switch (form.kind) {
    case Form::Kind::kKeyword:
      out += ':' + form.text;
      break;
    case Form::Kind::kText:
      out += '"' + form.text + '"';
      break;
    case Form::Kind::kName:
    case Form::Kind::kNumber:
      out += form.text;
      break;
    case Form::Kind::kList:
      out += '(';
      for (std::size_t i = 0; i < form.items.size(); ++i) {
        if (i > 0)
          out += form.dotted && i + 1 == form.items.size() ? " . " : " ";
        print(form.items[i], out, longest);
      }
      out += ')';
      break;
  }
}

}  // namespace

std::string to_text(const Form& form, std::size_t longest) {
  std::string out;
  print(form, out, longest);
  if (out.size() > longest) {
    out.resize(longest);
    // Not within a character.
    while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0x80) != 0)
      out.pop_back();
    out += "...";
  }
  return out;
}

Value literal(const Form& form) {
  switch (form.kind) {
    case Form::Kind::kNumber:
      return Value(form.number);
    case Form::Kind::kText:
    case Form::Kind::kKeyword:
      return Value(form.text);
    case Form::Kind::kName:
      if (form.is("nil"))
        return {};
      if (form.is("t"))
        return Value::truth(true);
      return Value(form.text);
    case Form::Kind::kList: {
      Value::List list;
      for (const Form& item : form.items)
        list.push_back(literal(item));
      return Value(std::move(list));
    }
  }
  return {};
}

}  // namespace saphira::intentions

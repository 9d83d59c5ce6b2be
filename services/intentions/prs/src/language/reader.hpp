#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "saphira/intentions/language.hpp"

namespace saphira::intentions {

/// An expression in a file of activities: a list or an atom, with its place.
struct Form {
  enum class Kind { kList, kNumber, kText, kName, kKeyword };
  Kind kind = Kind::kList;
  std::string text;     ///< of all but lists, as written; a keyword without its colon
  double number = 0.0;  ///< SI
  std::string unit;     ///< of a number, as written
  bool quoted = false;  ///< a ' before it
  bool dotted = false;  ///< of a list: (a . b), whose b is the last item
  std::vector<Form> items;
  int line = 1;
  int column = 1;

  bool is_list() const { return kind == Kind::kList; }
  /// True for a name or keyword of that normal form.
  bool is(std::string_view name) const;
};

/// Reads s-expressions. Errors go to `troubles`; the result has the readable forms.
class Reader {
 public:
  Reader(std::string file, std::string_view content, std::vector<Diagnostic>& troubles);
  std::vector<Form> read();

  /// An error at a place of the file.
  Diagnostic trouble(int line, int column, bool error, std::string message) const;

 private:
  struct Stop {};  ///< thrown to the top-level form after an error
  bool more() const { return at_ < content_.size(); }
  char peek() const { return content_[at_]; }
  /// True at a "(def" in the first column, where only a definition may begin.
  bool at_definition() const;
  void advance();
  void skip_blank();
  Form read_form(int depth);
  Form read_list(int depth);
  Form read_text();
  Form read_atom();
  [[noreturn]] void fail(int line, int column, std::string message);
  /// After an error: skips to the next definition.
  void recover();

  std::string file_;
  std::string_view content_;
  std::vector<Diagnostic>& troubles_;
  std::vector<std::string_view> lines_;
  std::size_t at_ = 0;
  int line_ = 1;
  int column_ = 1;
};

/// The form as one line, cut to `longest` characters.
std::string to_text(const Form& form, std::size_t longest = 60);
/// A quoted form as a value: lists, names, numbers.
Value literal(const Form& form);

}  // namespace saphira::intentions

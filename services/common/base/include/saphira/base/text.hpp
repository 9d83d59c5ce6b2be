#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace saphira {

/// A mistake in a file that a person wrote. what() has the form of compiler messages, with the line
/// and a caret under the place:
///
///     office.wld:12:7: expected a number (x of the end point), found "abc"
///         0 0 abc 30000
///             ^
class FileError : public std::runtime_error {
 public:
  /// line and column count from 1; line_text is the offending line, without its line break.
  FileError(std::string file, int line, int column, const std::string& message,
            std::string_view line_text = {});

  const std::string& file() const { return file_; }
  int line() const { return line_; }
  int column() const { return column_; }

 private:
  std::string file_;
  int line_;
  int column_;
};

/// A file that a person named cannot be used: it cannot be read or written, or is of another kind.
/// what() names it and the reason. A mistake of use, as FileError and std::invalid_argument.
class UnusableFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// For comparing names: without case and composed (NFC), by Unicode, in every locale the same.
std::string lowered(std::string_view text);

/// True for a separator of words within a line.
bool blank(char c);

/// A word of a line, with its column.
struct Word {
  std::string_view text;
  int column = 1;  ///< from 1
};

/// One line of a file of words (the Saphira parameter, world and map files): words are separated by
/// blanks, a semicolon starts a comment. Views into the text that was split.
struct Line {
  std::string_view text;
  int number = 1;  ///< from 1
  std::vector<Word> words;
};

/// The lines of a text that have words on them; empty lines and comments are left out.
std::vector<Line> split_lines(std::string_view text);

/// Reads the words of one line in order, and reports the expected word at an error.
class LineReader {
 public:
  LineReader(std::string file, const Line& line) : file_(std::move(file)), line_(&line) {}

  int line() const { return line_->number; }
  bool at_end() const { return next_ >= line_->words.size(); }
  /// The next word, or FileError "expected <what>".
  std::string_view word(std::string_view what);
  /// The next word as a finite number within [low, high], or FileError.
  double number(std::string_view what, double low = -1e12, double high = 1e12);
  /// The next word as a whole number within [low, high], or FileError.
  long integer(std::string_view what, long low, long high);
  /// FileError unless every word has been read.
  void expect_end() const;
  /// A FileError at the word read last (or at the end of the line where there is none).
  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void fail_at(int column, const std::string& message) const;

  std::string file_;
  const Line* line_;
  std::size_t next_ = 0;
};

/// FileError where the text ends within the words of a line. Half a number would read as a whole
/// one, half a line as all of it; so the last line of a file that must be whole has a line break.
void expect_last_line_break(std::string_view text, const std::string& file);

/// The number of bytes of the letter (UTF-8) at the beginning of the text; 0: it begins with none.
std::size_t letter_size(std::string_view text);

/// The letters at the beginning of the text that take at most that many bytes.
std::string_view first_letters(std::string_view text, std::size_t most);

/// The whole content of a file, whatever it is. UnusableFile where it cannot be read.
std::string read_bytes(const std::string& path);

/// The text in a file, without a byte order mark. FileError where it is not UTF-8, as the bus and
/// JSON need it. A file with zero bytes, or of another program, is no text: its reader names its
/// kind.
std::string read_file(const std::string& path);

/// "PATH: cannot be written: No space left on device": the reason is that of errno.
std::string cannot_be(const std::string& path, std::string_view done);

/// "1 program", "2 programs".
std::string counted(std::size_t count, const std::string& thing);

/// A list in words: each item by `words`, with `between` before all but the first.
template <class Items, class Words = std::identity>
std::string joined(const Items& items, std::string_view between = ", ", Words words = {}) {
  std::string text;
  std::string_view before;
  for (const auto& item : items) {
    text.append(before).append(std::invoke(words, item));
    before = between;
  }
  return text;
}

/// The kind of file, in words, of a text that begins as a file of another program; empty for any
/// other text.
std::string_view other_format(std::string_view text);

/// FileError "this is a picture (PNG), and not EXPECTED" where the text is of such a kind.
void expect_own_format(std::string_view text, const std::string& file, std::string_view expected);

}  // namespace saphira

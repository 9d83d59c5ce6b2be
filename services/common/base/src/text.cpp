#include "saphira/base/text.hpp"

#include <utf8proc.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "folding.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/printable.hpp"

namespace saphira {

namespace {

constexpr std::size_t kExcerpt = 100;  // letters of a quotation

/// FileError at the first byte that begins no letter of UTF-8.
void expect_utf8(std::string_view text, const std::string& file) {
  int line = 1;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = letter_size(text.substr(i));
    if (size == 0) {
      std::string shown(text.substr(begin, text.find('\n', i) - begin));
      for (char& c : shown)
        if (static_cast<unsigned char>(c) >= 0x80)
          c = '?';  // one for each byte, so that the caret stands under the place
      char byte[8];
      std::snprintf(byte, sizeof byte, "0x%02X", static_cast<unsigned char>(text[i]));
      throw FileError(file, line, static_cast<int>(i - begin) + 1,
                      std::string("expected a text in UTF-8, found the byte ") + byte +
                          " (Latin-1?): save it as UTF-8",
                      shown);
    }
    if (text[i] == '\n') {
      ++line;
      begin = i + 1;
    }
    i += size;
  }
}

/// The start of a word.
std::string quoted(std::string_view word) {
  return '"' + std::string(word.substr(0, kExcerpt)) + (word.size() > kExcerpt ? "...\"" : "\"");
}

std::string describe(const std::string& file, int line, int column, const std::string& message,
                     std::string_view line_text) {
  std::string out = file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " +
                    printable(message, "\n\t");
  if (!line_text.empty()) {
    // Of a long line the part around the place, of whole UTF-8 letters.
    const auto within = [&](std::size_t i) {
      return i < line_text.size() && (static_cast<unsigned char>(line_text[i]) & 0xC0U) == 0x80U;
    };
    std::string shown(line_text);
    if (line_text.size() > kExcerpt) {
      const auto place = std::min(static_cast<std::size_t>(column), line_text.size());
      std::size_t begin = place > kExcerpt / 2 ? place - kExcerpt / 2 : 0;
      for (int i = 0; i < 3 && within(begin); ++i)
        ++begin;
      std::size_t end = std::min(begin + kExcerpt, line_text.size());
      for (int i = 0; i < 3 && within(end); ++i)
        --end;
      const std::string before = begin > 0 ? "..." : "";
      shown = before + std::string(line_text.substr(begin, end - begin)) +
              (end < line_text.size() ? "..." : "");
      column += static_cast<int>(before.size()) - static_cast<int>(begin);
    }
    out += "\n    " + printable(shown, "\n\t") + "\n    ";
    // Tabs are kept so that the caret stands under the place whatever their width.
    for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(column); ++i)
      out += i < shown.size() && shown[i] == '\t' ? '\t' : ' ';
    out += '^';
  }
  return out;
}

}  // namespace

std::string lowered(std::string_view text) {
  return internal::without_case(text, UTF8PROC_COMPOSE);
}

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

FileError::FileError(std::string file, int line, int column, const std::string& message,
                     std::string_view line_text)
    : std::runtime_error(describe(file, line, column, message, line_text)),
      file_(std::move(file)),
      line_(line),
      column_(column) {}

std::vector<Line> split_lines(std::string_view text) {
  std::vector<Line> lines;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    Line line{text.substr(0, end), ++number, {}};
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (!line.text.empty() && line.text.back() == '\r')
      line.text.remove_suffix(1);
    const std::string_view code = line.text.substr(0, line.text.find(';'));
    std::size_t at = 0;
    while (true) {
      while (at < code.size() && blank(code[at]))
        ++at;
      if (at == code.size())
        break;
      const std::size_t begin = at;
      while (at < code.size() && !blank(code[at]))
        ++at;
      line.words.push_back({code.substr(begin, at - begin), static_cast<int>(begin) + 1});
    }
    if (!line.words.empty())
      lines.push_back(std::move(line));
  }
  return lines;
}

std::string_view LineReader::word(std::string_view what) {
  if (at_end()) {
    const Word& last = line_->words.back();
    fail_at(last.column + static_cast<int>(last.text.size()),
            "expected " + std::string(what) + ", found the end of the line");
  }
  return line_->words[next_++].text;
}

double LineReader::number(std::string_view what, double low, double high) {
  const std::string_view text = word(what);
  const auto value = number_in<double>(text.substr(text.starts_with('+') ? 1 : 0));
  if (!value || !std::isfinite(*value))
    fail("expected a number (" + std::string(what) + "), found " + quoted(text));
  if (*value < low || *value > high) {
    std::ostringstream range;
    range << "expected " << what << " between " << low << " and " << high << ", found " << text;
    fail(range.str());
  }
  return *value;
}

long LineReader::integer(std::string_view what, long low, long high) {
  const double value = number(what, static_cast<double>(low), static_cast<double>(high));
  if (value != std::floor(value))
    fail("expected a whole number (" + std::string(what) + ")");
  return static_cast<long>(value);
}

void LineReader::expect_end() const {
  if (!at_end()) {
    const Word& extra = line_->words[next_];
    fail_at(extra.column, "expected the end of the line, found " + quoted(extra.text));
  }
}

void LineReader::fail(const std::string& message) const {
  const std::size_t at = next_ == 0 ? 0 : next_ - 1;
  fail_at(line_->words[at].column, message);
}

void LineReader::fail_at(int column, const std::string& message) const {
  throw FileError(file_, line_->number, column, message, line_->text);
}

void expect_last_line_break(std::string_view text, const std::string& file) {
  const std::vector<Line> lines = split_lines(text);
  if (lines.empty() || !other_format(text).empty())  // the reader names the other format
    return;
  const Word& last = lines.back().words.back();
  const char* const end = last.text.data() + last.text.size();
  const std::string_view rest = text.substr(static_cast<std::size_t>(end - text.data()));
  if (rest.find_first_not_of(" \t") != std::string_view::npos)
    return;
  throw FileError(file, lines.back().number, last.column + static_cast<int>(last.text.size()),
                  "expected a line break behind the last line (has the file been cut off?)",
                  lines.back().text);
}

std::size_t letter_size(std::string_view text) {
  if (text.empty())
    return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80)
    return 1;
  const std::size_t size = first < 0xC2   ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  if (size == 0 || text.size() < size)
    return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xC0U) != 0x80U)
      return 0;
  // Not in more bytes than it needs, no half of a UTF-16 letter, none beyond U+10FFFF.
  const unsigned char second = byte(1);
  const bool letter = (first != 0xE0 || second >= 0xA0) && (first != 0xED || second < 0xA0) &&
                      (first != 0xF0 || second >= 0x90) && (first != 0xF4 || second < 0x90);
  return letter ? size : 0;
}

std::string_view first_letters(std::string_view text, std::size_t most) {
  std::size_t size = 0;
  for (std::size_t letter = letter_size(text); letter > 0 && size + letter <= most;
       letter = letter_size(text.substr(size)))
    size += letter;
  return text.substr(0, size);
}

std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw UnusableFile(cannot_be(path, "read"));
  in.peek();
  if (in.bad())
    throw UnusableFile(path + ": cannot be read (is it a file?)");
  std::string bytes;
  std::array<char, 65536> part{};
  while (in.read(part.data(), part.size()), in.gcount() > 0)
    bytes.append(part.data(), static_cast<std::size_t>(in.gcount()));
  return bytes;
}

std::string read_file(const std::string& path) {
  std::string text = read_bytes(path);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // as some editors write it
  if (text.starts_with(kByteOrderMark))
    text.erase(0, kByteOrderMark.size());
  const bool of_another_program = letter_size(text) == 0 && !other_format(text).empty();
  if (!of_another_program && text.find('\0') == std::string::npos)
    expect_utf8(text, path);
  return text;
}

std::string cannot_be(const std::string& path, std::string_view done) {
  const int why = errno;
  std::error_code none;
  const bool refused =  // by replace_file
      why == ENOTSUP && std::filesystem::is_other(path, none);
  return path + ": cannot be " + std::string(done) + ": " +
         (refused ? "expected a file or a new name, found a device, a pipe or a socket"
                  : std::generic_category().message(why));
}

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string_view other_format(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> kBeginnings[] = {
      {"2D-Map", "a map of ARIA and MobileSim (2D-Map)"},
      {"P2", "a picture (PGM), such as occupancy grids are kept in"},
      {"P5", "a picture (PGM), such as occupancy grids are kept in"},
      {"\x89PNG", "a picture (PNG)"},
      {"image:", "the description of an occupancy grid (ROS)"},
      {"<?xml", "an XML file"},
      {"<sdf", "a world of Gazebo"},
      {"#VRML", "a world of Webots"},
      {"\xFF\xFE", "a text in UTF-16 (save it as UTF-8)"},
      {"\xFE\xFF", "a text in UTF-16 (save it as UTF-8)"},
      {"#ROSBAG", "a recording of ROS (rosbag)"},
      {"SQLite format 3", "a database (SQLite), such as recordings of ROS 2 (.db3)"},
      {"\x89MCAP", "a recording (MCAP)"},
      {"## Player", "a log of Player"},
      {"VERTEX_SE2", "a graph of poses (g2o)"},
      {"BZh", "a packed file (bzip2)"},
      {"PK\x03\x04", "a packed file (zip)"},
      {"\x1f\x8b", "a packed file (gzip)"},
      {"define ", "a world of Stage"},
      {"include ", "a world of Stage"},
      {"driver", "a configuration of Player"},
      {"{", "a JSON file"},
  };
  for (const auto& [beginning, name] : kBeginnings)
    if (text.starts_with(beginning) && (beginning.size() > 2 || text.size() == 2 ||
                                        beginning[0] != 'P' || blank(text[2]) || text[2] == '\n'))
      return name;
  return {};
}

void expect_own_format(std::string_view text, const std::string& file, std::string_view expected) {
  if (const std::string_view other = other_format(text); !other.empty())
    throw FileError(file, 1, 1,
                    "this is " + std::string(other) + ", and not " + std::string(expected));
}

}  // namespace saphira

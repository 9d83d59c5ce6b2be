#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "process.hpp"
#include "saphira/base/text.hpp"

/// An entry of LinePlayer's events: its statements, with what follows the word in `in`.
#define ON(word, ...)                                        \
  {                                                          \
    word, [this]([[maybe_unused]] auto& in) { __VA_ARGS__; } \
  }
/// An entry of its facts or values.
#define IS(name, ...)                    \
  {                                      \
    name, [this] { return __VA_ARGS__; } \
  }

namespace saphira::test {

/// Gives each line of a file of the source tree to `use`, without empty lines and comments. A
/// failure in it tells file and line. Returns how many lines there are.
template <class Use>
int each_line(const std::string& file, char comment, const Use& use) {
  std::istringstream lines(read_file(source(file)));
  int number = 0;
  int used = 0;
  for (std::string line; std::getline(lines, line);) {
    SCOPED_TRACE(file + ":" + std::to_string(++number));
    if (!line.empty() && line[0] != comment) {
      ++used;
      use(line);
    }
  }
  return used;
}

/// Plays a file of mistakes, one a line: "TEXT => LINE:COLUMN EXPECTED", with "\n" for a line break
/// within TEXT. parse(TEXT) has to throw a FileError with these parts. Returns the number of lines.
template <class Parse>
int each_mistake(const std::string& file, const Parse& parse) {
  return each_line(file, '#', [&](const std::string& line) {
    const std::size_t arrow = line.rfind("=> ");
    std::string text = line.substr(0, arrow - (arrow > 0 ? 1 : 0));
    for (std::size_t at = 0; (at = text.find('\\', at)) != std::string::npos; ++at)
      text.replace(at, 2, text.substr(at, 2) == "\\r" ? "\r" : "\n");
    const std::string wanted = line.substr(arrow + 3);
    const std::size_t space = wanted.find(' ');
    try {
      parse(text);
      ADD_FAILURE() << "no error: " << line;
    } catch (const FileError& error) {
      EXPECT_EQ(std::to_string(error.line()) + ":" + std::to_string(error.column()),
                wanted.substr(0, space))
          << error.what();
      EXPECT_NE(std::string(error.what()).find(wanted.substr(space + 1)), std::string::npos)
          << error.what();
    }
  });
}

/// Plays a file of cases, each with a player of its own: "== its name" begins one, and " ; " parts
/// lines that are written as one. `wanted`, of a case's number and name: of cases that take long,
/// those of one test. Returns how many cases there are.
template <class Player>
int play(const std::string& file, char comment = '#',
         const std::function<bool(int, const std::string&)>& wanted = {}) {
  std::unique_ptr<Player> player;
  int cases = 0;
  const auto finish = [&] {
    if constexpr (requires { player->finish(); })
      if (player)
        player->finish();
  };
  each_line(file, comment, [&](const std::string& line) {
    if (line.starts_with("== ")) {
      finish();
      const bool plays = !wanted || wanted(cases, line.substr(3));
      player = plays ? std::make_unique<Player>() : nullptr;
      ++cases;
      return;
    }
    ASSERT_GT(cases, 0);
    if (!player)
      return;
    for (std::size_t at = 0, end = 0; at < line.size(); at = end + 3) {
      end = std::min(line.find(" ; ", at), line.size());
      const std::string part = line.substr(at, end - at);
      try {
        player->take(part);
      } catch (const std::exception& trouble) {
        ADD_FAILURE() << part << ": " << trouble.what();
      }
    }
  });
  SCOPED_TRACE("the end of " + file);
  finish();
  return cases;
}

/// True for the sign of a comparison.
inline bool is_sign(const std::string& word) {
  return word == "==" || word == "~" || word == "<" || word == ">" || word == "<=" || word == ">=";
}

/// Checks a value against its line: "NAME == NUMBER", likewise <, >, <= and >=, or "NAME ~
/// NUMBER +- TOLERANCE".
inline void expect_compared(const std::string& line, double is) {
  std::istringstream in(line);
  std::string name;
  std::string sign;
  std::string more;
  double wanted = 0.0;
  double tolerance = 0.0;
  in >> name >> sign >> wanted >> more >> tolerance;
  EXPECT_TRUE(sign == "~"    ? std::abs(is - wanted) <= tolerance
              : sign == "==" ? is == wanted
              : sign == "<"  ? is < wanted
              : sign == ">"  ? is > wanted
              : sign == "<=" ? is <= wanted
                             : is >= wanted)
      << line << ", and it is " << is;
}

/// A player of three kinds of lines: an event, "verb rest"; a fact, "name: value", whose present
/// value must be equal to the written one; and a comparison of a value (expect_compared). "3 times:
/// a & b" repeats its parts, up to the first failure.
class LinePlayer {
 public:
  void take(const std::string& line) {
    const std::size_t times = line.find(" times: ");
    if (times != std::string::npos && std::isdigit(static_cast<unsigned char>(line[0])) != 0) {
      const bool failed = testing::Test::HasFailure();
      for (int left = std::stoi(line); left > 0 && testing::Test::HasFailure() == failed; --left)
        for (std::size_t at = times + 8, end = 0; at < line.size(); at = end + 3) {
          end = std::min(line.find(" & ", at), line.size());
          take_one(line.substr(at, end - at));
        }
      return;
    }
    take_one(line);
  }

 protected:
  using Events = std::map<std::string, std::function<void(std::istringstream&)>>;
  using Facts = std::map<std::string, std::function<std::string()>>;
  using Values = std::map<std::string, std::function<double()>>;

  template <class T>
  static T read(std::istringstream& in) {
    T value{};
    EXPECT_TRUE(in >> value);
    return value;
  }
  static std::string rest(std::istringstream& in) {
    std::string text;
    std::getline(in >> std::ws, text);
    return text;
  }

  /// "..." in a pattern stands for any text.
  static bool is_like(const std::string& text, const std::string& pattern) {
    std::size_t at = 0;
    for (std::size_t from = 0; from <= pattern.size();) {
      const std::size_t dots = std::min(pattern.find("...", from), pattern.size());
      const std::string part = pattern.substr(from, dots - from);
      const std::size_t found = dots == pattern.size() && from > 0 && !part.empty()
                                    ? text.rfind(part)
                                    : text.find(part, at);
      if (found == std::string::npos || found < at || (from == 0 && found != 0))
        return false;
      at = found + part.size();
      from = dots + 3;
    }
    return pattern.ends_with("...") || at == text.size();
  }
  static void expect_like(const std::string& text, const std::string& pattern) {
    EXPECT_TRUE(is_like(text, pattern)) << text << "\nis not like\n" << pattern;
  }

  static std::string yes(bool is) { return is ? "yes" : "no"; }

  Events events_;
  Facts facts_;
  Values values_;

 private:
  void take_one(const std::string& line) {
    const std::size_t colon = std::min(line.find(": "), line.size());
    if (const auto fact = facts_.find(line.substr(0, colon));
        fact != facts_.end() && colon < line.size()) {
      EXPECT_EQ(fact->second(), line.substr(colon + 2)) << line;
      return;
    }
    std::istringstream in(line);
    const auto name = read<std::string>(in);
    std::string sign;
    if (const auto value = values_.find(name);
        value != values_.end() && std::istringstream(line.substr(name.size())) >> sign &&
        is_sign(sign))
      return expect_compared(line, value->second());
    const auto event = events_.find(name);
    if (event == events_.end())
      throw std::invalid_argument("not understood");
    event->second(in);
  }
};

}  // namespace saphira::test

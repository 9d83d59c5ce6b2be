#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "saphira/base/numbers.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace saphira {

/// Exit codes of every program.
enum Exit : int {
  kExitOk = 0,
  kExitFailed = 1,  ///< ran, and the outcome is a failure (goal not reached)
  kExitUsage = 2,   ///< an option or a file that a person wrote is wrong; stderr says where. Of a
                    ///< service: before its first cycle
  kExitBroken = 3,  ///< could not run: no bus, no memory, our own bug
};

/// The error of a whole number outside of T's range, which the parser may let wrap around. Another
/// text has no error here: the parser reports it.
template <class T>
std::string trouble_of_limits(const std::string& text) {
  const std::string digits = text.substr(text.starts_with('-') ? 1 : 0);
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos ||
      number_in<T>(text))
    return {};
  return "expected a whole number between " + std::to_string(std::numeric_limits<T>::min()) +
         " and " + std::to_string(std::numeric_limits<T>::max()) + ", found " + text;
}

/// The variable that an option writes. Its own value is the default, which the help shows unless it
/// is an empty text, an empty list or none.
using OptionValue =
    std::variant<std::string*, std::vector<std::string>*, int*, unsigned*, std::uint16_t*, long*,
                 unsigned long*, double*, std::vector<double>*, std::optional<std::string>*,
                 std::optional<bool>*, std::optional<int>*, std::optional<std::uint16_t>*,
                 std::optional<double>*, std::function<void(const std::string&)>>;

/// One option of a command line. A handle: copies mean the same option.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  const Option& required() const;
  const Option& in_range(int low, int high) const;        ///< a whole number, both ends included
  const Option& in_range(double low, double high) const;  ///< a number, both ends included
  const Option& positive() const;                         ///< a number above 0
  const Option& one_of(const std::vector<std::string>& words) const;
  const Option& existing_file() const;
  const Option& ipv4() const;
  /// `complaint` returns the error of a value in words; empty: none.
  const Option& check(const std::function<std::string(const std::string&)>& complaint) const;
  const Option& environment(const std::string& name) const;  ///< the value if the option is absent
  const Option& separated_by(char separator) const;          ///< many values in one word
  const Option& values(int count) const;
  const Option& values(int least, int most) const;
  const Option& one_value_each() const;  ///< a list: the option is repeated for each value
  const Option& last_wins() const;       ///< a second value replaces the first
  const Option& needs(const Option& other) const;
  const Option& excludes(const Option& other) const;
  const Option& shows(const std::string& default_text) const;  ///< as default, in the help
  const Option& describe(const std::string& help) const;
  const Option& placeholder(const std::string& type) const;  ///< such as FILE.svg, in the help
  const Option& hidden() const;                              ///< not in the help

  bool given() const;
  std::string text() const;  ///< the given text; empty: absent

 private:
  friend class CommandLine;
  CLI::Option* option_;
};

/// The options of a program. A thin layer over CLI11, whose headers stay out of the programs.
class CommandLine {
 public:
  explicit CommandLine(const std::string& description, const std::string& program = "");
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// `names`: "--long,-s", or "word" for a value by its place.
  template <class T>
  Option add_option(const std::string& names, T& value, const std::string& help) {
    return add(names, OptionValue(&value), help);
  }
  Option add_action(const std::string& names, std::function<void(const std::string&)> action,
                    const std::string& help) {
    return add(names, OptionValue(std::move(action)), help);
  }
  /// "--name" sets `value`, "!--name" clears it.
  Option add_flag(const std::string& names, bool& value, const std::string& help);
  void add_version(const std::string& text);
  /// An added option. std::out_of_range: unknown name.
  Option option(const std::string& name) const;

  /// Parses the words. Returns the exit code where the program has to end at once: 0 after --help
  /// and --version (3 where they could not be written), 2 after an error, which is on stderr then.
  std::optional<int> parse(int argc, const char* const* argv);

  /// Its name in messages.
  std::string program() const;

  /// The parser itself, for a program with subcommands.
  CLI::App& parser() { return *app_; }

 private:
  Option add(const std::string& names, const OptionValue& value, const std::string& help);

  std::unique_ptr<CLI::App> app_;
};

/// The exit code of `body`, for a program without a bus. An exception becomes a message of that
/// program, and kExitUsage where it is a FileError, UnusableFile or std::invalid_argument, else
/// kExitBroken.
int exit_code_of(const std::string& program, const std::function<int()>& body);

}  // namespace saphira

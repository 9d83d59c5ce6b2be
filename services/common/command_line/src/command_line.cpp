#include "saphira/command_line/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "saphira/base/guess.hpp"
#include "saphira/base/output.hpp"
#include "saphira/base/text.hpp"

namespace saphira {

namespace {

/// The command that was chosen, and the ones that it belongs to, from the program on.
std::vector<const CLI::App*> chosen(const CLI::App& app) {
  std::vector<const CLI::App*> commands{&app};
  while (!commands.back()->get_subcommands().empty())
    commands.push_back(commands.back()->get_subcommands().front());
  return commands;
}

/// nullptr: there is no such option.
const CLI::Option* option_of(const CLI::App& app, const std::string& name) {
  for (const CLI::App* const command : chosen(app))
    for (const CLI::Option* const option : command->get_options())
      if (option->get_name() == name)
        return option;
  return nullptr;
}

/// The kind of value that the option of that name takes.
std::string kind_of(const CLI::App& app, const std::string& name) {
  const CLI::Option* const option = option_of(app, name);
  if (option == nullptr)
    return "another value";
  if (option->get_expected_max() == 0)  // a flag
    return "true, false or no value";
  const std::string type = option->get_type_name();
  return type.starts_with("UINT")  ? "a whole number of 0 or more"
         : type.starts_with("INT") ? "a whole number"
                                   : "a number";
}

/// " (which host to use)", from the help of that option.
std::string help_of(const CLI::App& app, const std::string& name) {
  const CLI::Option* const option = option_of(app, name);
  return option == nullptr || option->get_description().empty()
             ? std::string()
             : " (" + option->get_description() + ")";
}

/// "laser, sonar or bumper"
std::string one_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

/// The nearest name in the folder of a file that does not exist.
std::string nearest_file(const std::string& file) {
  const std::filesystem::path path(file);
  const std::filesystem::path folder = path.parent_path();
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder.empty() ? "." : folder, error), end;
       !error && it != end; it.increment(error))
    names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::string meant = guess(path.filename().string(), names);
  return meant.empty() ? std::string() : ": did you mean " + (folder / meant).string() + "?";
}

/// The part of a text between two others; empty: it has not both.
std::string between(const std::string& text, const std::string& before, const std::string& behind) {
  const std::size_t begin = text.find(before);
  const std::size_t end = begin == std::string::npos ? begin : text.find(behind, begin);
  return end == std::string::npos ? std::string()
                                  : text.substr(begin + before.size(), end - begin - before.size());
}
/// That behind the first `before`.
std::string behind(const std::string& text, const std::string& before) {
  const std::size_t at = text.find(before);
  return at == std::string::npos ? std::string() : text.substr(at + before.size());
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    parts.push_back(part);
  return parts;
}

/// The complaint of a validator of CLI11 about a value, in our words; our own stays as it is.
std::string about_value(const std::string& complaint) {
  if (complaint.starts_with("Value ") && complaint.find(" not in range ") != std::string::npos) {
    const double low = std::strtod(between(complaint, " not in range ", " to ").c_str(), nullptr);
    const double high = std::strtod(complaint.substr(complaint.rfind(" to ") + 4).c_str(), nullptr);
    constexpr double kNoEnd = 1e300;  // of CLI::PositiveNumber
    const bool whole = complaint.find('.', complaint.rfind(" to ")) == std::string::npos;
    return (whole ? "expected a whole number " : "expected a number ") +
           (high > kNoEnd ? "above " + plain(low)
                          : "between " + plain(low) + " and " + plain(high)) +
           ", found " + between(complaint, "Value ", " not in range ");
  }
  for (const auto& [before, expected] : {std::pair("File does not exist: ", "a file"),
                                         {"Directory does not exist: ", "a folder"},
                                         {"Path does not exist: ", "a file or a folder"}})
    if (complaint.starts_with(before)) {
      const std::string path = behind(complaint, before);
      return std::string("expected ") + expected + ", found nothing at " + path +
             nearest_file(path);
    }
  if (complaint.starts_with("File is actually a directory: "))
    return "expected a file, found the folder " + behind(complaint, ": ");
  if (complaint.starts_with("Directory is actually a file: "))
    return "expected a folder, found the file " + behind(complaint, ": ");
  if (complaint.starts_with("Path already exists: "))
    return "expected a new name, found " + behind(complaint, ": ") + ", which exists";
  if (const std::size_t in = complaint.rfind(" not in {"); in != std::string::npos) {
    const std::string word = complaint.substr(0, in);
    const std::vector<std::string> words = split(between(complaint.substr(in), "{", "}"), ',');
    return "expected " + one_of(words) + ", found " + word + did_you_mean(word, words);
  }
  if (complaint.starts_with("Failed parsing "))
    return "expected a number, found " + between(complaint, "Failed parsing ", " as a ");
  return complaint;
}

/// An error of CLI11 in our words: the place of the mistake, the expected, the found.
std::string in_words(const CLI::App& app, const CLI::ParseError& error) {
  const std::string what = error.what();
  const std::string kind = error.get_name();
  const std::string name = what.substr(0, what.find(": "));
  const std::string rest = behind(what, ": ");
  if (what.starts_with("Could not convert: ")) {
    const std::string option = between(what, ": ", " = ");
    return option + ": expected " + kind_of(app, option) + ", found " + behind(what, " = ");
  }
  if (kind == "RequiredError" && what.starts_with("A subcommand")) {
    const CLI::App& command = *chosen(app).back();
    std::vector<std::string> commands;
    for (const CLI::App* const each : command.get_subcommands({}))
      if (!each->get_name().empty() && !each->get_group().empty())
        commands.push_back(each->get_name());
    return command.get_name() + ": expected a command (" + one_of(commands) + "), found none";
  }
  if (kind == "RequiredError" && what.ends_with(" is required")) {
    const std::string option = what.substr(0, what.rfind(" is required"));
    return option + ": expected a value" + help_of(app, option) + ", found none";
  }
  if (kind == "RequiresError") {
    const std::string other = behind(what, " requires ");
    return what.substr(0, what.find(" requires ")) + ": expected " + other + " beside it" +
           help_of(app, other) + ", found none";
  }
  if (kind == "ExcludesError")
    return what.substr(0, what.find(" excludes ")) + ": expected no " + behind(what, " excludes ") +
           " beside it, found both";
  if (kind == "ArgumentMismatch") {
    const auto values = [](const std::string& number) {
      return number == "1" ? std::string("a value") : number + " values";
    };
    if (const std::string number = between(rest, "At least ", " required"); !number.empty()) {
      const CLI::Option* const option = option_of(app, name);
      const bool exactly =
          option != nullptr && option->get_expected_min() == option->get_expected_max();
      return name + ": expected " + (exactly ? "" : "at least ") + values(number) +
             help_of(app, name) + ", found " + behind(rest, "received ");
    }
    if (const std::string number = between(rest, "At Most ", " required"); !number.empty())
      return name + ": expected " + (number == "1" ? "one value" : "at most " + values(number)) +
             ", found " + behind(rest, "received ");
    if (rest.ends_with(" missing")) {
      const std::string number = rest.substr(0, rest.find(' '));
      return name + ": expected " + values(number) + help_of(app, name) + ", found " +
             (number == "1" ? "none" : "fewer");
    }
    if (const std::string option = between(what, " arguments to ", ", got "); !option.empty())
      return option + ": expected " + (what.starts_with("Expected at least ") ? "at least " : "") +
             values(between(what, what.starts_with("Expected at least ") ? "at least " : "exactly ",
                            " arguments")) +
             help_of(app, option) + ", found " + behind(what, ", got ");
    if (what.ends_with(" was given a disallowed flag override"))
      return what.substr(0, what.find(' ')) + ": expected no value, found one";
  }
  if (kind == "ConversionError") {
    if (what.starts_with("The value "))
      return behind(what, " is not an allowed value for ") +
             ": expected true, false or no value, found " +
             between(what, "The value ", " is not an allowed value");
    return name + ": expected true, false or no value, found another";
  }
  return kind == "ValidationError" && !rest.empty() ? name + ": " + about_value(rest) : what;
}

/// The words about an option name the variable of the environment where that gave the value.
std::string by_variable(const CLI::App& app, const std::string& words,
                        const std::vector<std::string>& typed) {
  const CLI::Option* const option = option_of(app, words.substr(0, words.find(": ")));
  if (option == nullptr || option->get_envname().empty() ||
      std::getenv(option->get_envname().c_str()) == nullptr)
    return words;
  const auto gives = [&](const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    return name.starts_with("--") && option->check_lname(name.substr(2));
  };
  return std::any_of(typed.begin(), typed.end(), gives)
             ? words
             : option->get_envname() + words.substr(option->get_name().size());
}

/// Reports an unknown word, with the most similar option or command.
int not_understood(const CLI::App& app) {
  const CLI::App* const command = chosen(app).back();
  std::vector<std::string> known;
  for (const CLI::App* const each : command->get_subcommands({}))
    known.push_back(each->get_name());
  for (const CLI::Option* const each : command->get_options())
    for (const std::string& name : each->get_lnames())
      known.push_back("--" + name);
  const std::vector<std::string> words = app.remaining(true);
  const std::string word = words.empty() ? "" : words.front();
  std::fprintf(stderr, "%s: \"%.200s\" is not understood%s\n", app.get_name().c_str(), word.c_str(),
               did_you_mean(word, known, "; --help lists the options").c_str());
  return kExitUsage;
}

bool has_default(const std::string& value) {
  return !value.empty();
}
template <class T>
bool has_default(const std::vector<T>& value) {
  return !value.empty();
}
template <class T>
bool has_default(const std::optional<T>& value) {
  return value.has_value();
}
template <class T>
bool has_default(const T& /*value*/) {
  return true;
}

template <class T>
void check_limits(CLI::Option& option, const T* /*value*/) {
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
    option.check(trouble_of_limits<T>);
}
template <class T>
void check_limits(CLI::Option& option, const std::optional<T>* /*value*/) {
  check_limits(option, static_cast<const T*>(nullptr));
}

/// Adds an option for each kind of value.
struct Adder {
  CLI::App& app;
  const std::string& names;
  const std::string& help;

  template <class T>
  CLI::Option* operator()(T* value) const {
    CLI::Option* const option = app.add_option(names, *value, help);
    check_limits(*option, value);
    if (has_default(*value))
      option->capture_default_str();
    return option;
  }
  CLI::Option* operator()(const std::function<void(const std::string&)>& action) const {
    return app.add_option_function<std::string>(names, action, help);
  }
};

}  // namespace

const Option& Option::required() const {
  option_->required()->default_str("");
  return *this;
}

const Option& Option::in_range(int low, int high) const {
  option_->transform(CLI::Range(low, high));  // changes nothing, and comes before the type's limits
  return *this;
}

const Option& Option::in_range(double low, double high) const {
  option_->check(CLI::Range(low, high));
  option_->check([low, high](const std::string& text) {  // the range holds NaN
    return std::isnan(std::strtod(text.c_str(), nullptr))
               ? "expected a number between " + plain(low) + " and " + plain(high) + ", found " +
                     text
               : std::string();
  });
  return *this;
}

const Option& Option::positive() const {
  option_->check(CLI::Validator(
      [](const std::string& text) {
        const double value = std::strtod(text.c_str(), nullptr);
        return std::isfinite(value) && value > 0.0 ? std::string()
                                                   : "expected a number above 0, found " + text;
      },
      "POSITIVE"));
  return *this;
}

const Option& Option::one_of(const std::vector<std::string>& words) const {
  option_->check(CLI::IsMember(words));
  return *this;
}

const Option& Option::existing_file() const {
  option_->check(CLI::ExistingFile);
  return *this;
}

const Option& Option::ipv4() const {
  // The validator of CLI11 names no whole address in its complaint.
  option_->check(CLI::Validator(
      [](const std::string& text) {
        return CLI::ValidIPV4(text).empty()
                   ? std::string()
                   : "expected an IPv4 address, such as 192.168.1.7, found " + text;
      },
      "IPV4"));
  return *this;
}

const Option& Option::check(const std::function<std::string(const std::string&)>& complaint) const {
  option_->check(complaint);
  return *this;
}

const Option& Option::environment(const std::string& name) const {
  option_->envname(name);
  return *this;
}

const Option& Option::separated_by(char separator) const {
  option_->delimiter(separator);
  return *this;
}

const Option& Option::values(int count) const {
  option_->expected(count);
  return *this;
}

const Option& Option::values(int least, int most) const {
  option_->expected(least, most);
  return *this;
}

const Option& Option::one_value_each() const {
  option_->allow_extra_args(false);
  return *this;
}

const Option& Option::last_wins() const {
  option_->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  return *this;
}

const Option& Option::needs(const Option& other) const {
  option_->needs(other.option_);
  return *this;
}

const Option& Option::excludes(const Option& other) const {
  option_->excludes(other.option_);
  return *this;
}

const Option& Option::shows(const std::string& default_text) const {
  option_->default_str(default_text);
  return *this;
}

const Option& Option::describe(const std::string& help) const {
  option_->description(help);
  return *this;
}

const Option& Option::placeholder(const std::string& type) const {
  option_->type_name(type);
  return *this;
}

const Option& Option::hidden() const {
  option_->group("");
  return *this;
}

bool Option::given() const {
  return option_->count() > 0;
}

std::string Option::text() const {
  return given() ? option_->as<std::string>() : std::string();
}

CommandLine::CommandLine(const std::string& description, const std::string& program)
    : app_(std::make_unique<CLI::App>(description, program)) {}

CommandLine::~CommandLine() = default;

Option CommandLine::add(const std::string& names, const OptionValue& value,
                        const std::string& help) {
  return Option(*std::visit(Adder{*app_, names, help}, value));
}

Option CommandLine::add_flag(const std::string& names, bool& value, const std::string& help) {
  return Option(*app_->add_flag(names, value, help));
}

void CommandLine::add_version(const std::string& text) {
  app_->set_version_flag("--version", text);
}

Option CommandLine::option(const std::string& name) const {
  CLI::Option* const option = app_->get_option_no_throw(name);
  if (option == nullptr)
    throw std::out_of_range("no option " + name);
  return Option(*option);
}

std::string CommandLine::program() const {
  return app_->get_name();
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    return not_understood(*app_);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app_->exit(error);
      const std::string lost = flush_standard_output();
      if (lost.empty())
        return 0;
      std::fprintf(stderr, "%s: %s\n", program().c_str(), lost.c_str());
      return kExitBroken;
    }
    const std::string words = by_variable(*app_, in_words(*app_, error), {argv + 1, argv + argc});
    std::fprintf(stderr, "%s: %s\n", program().c_str(), words.c_str());
    return kExitUsage;
  }
  return std::nullopt;
}

int exit_code_of(const std::string& program, const std::function<int()>& body) {
  const auto fails = [&](const std::exception& error, Exit code) {
    std::fprintf(stderr, "%s: %s\n", program.c_str(), error.what());
    return code;
  };
  try {
    return body();
  } catch (const FileError& error) {
    return fails(error, kExitUsage);
  } catch (const UnusableFile& error) {
    return fails(error, kExitUsage);
  } catch (const std::invalid_argument& error) {
    return fails(error, kExitUsage);
  } catch (const std::exception& error) {
    return fails(error, kExitBroken);
  }
}

}  // namespace saphira

#include "saphira/command_line/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "saphira/base/guess.hpp"
#include "saphira/base/numbers.hpp"

namespace saphira {

namespace {

constexpr int kUsage = 2;

/// Reports an unknown word, with the most similar option or command.
int not_understood(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty())
    command = command->get_subcommands().front();
  std::vector<std::string> known;
  for (const CLI::App* const each : command->get_subcommands({}))
    known.push_back(each->get_name());
  for (const CLI::Option* const each : command->get_options())
    for (const std::string& name : each->get_lnames())
      known.push_back("--" + name);
  const std::vector<std::string> words = app.remaining(true);
  const std::string word = words.empty() ? "" : words.front();
  const std::string meant = guess(word, known);
  std::fprintf(
      stderr, "%s: \"%.200s\" is not understood%s\n", app.get_name().c_str(), word.c_str(),
      meant.empty() ? "; --help lists the options" : (": did you mean " + meant + "?").c_str());
  return kUsage;
}

/// The kind of value that the option of that name takes.
std::string kind_of(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command = &app; command != nullptr;
       command = command->get_subcommands().empty() ? nullptr : command->get_subcommands().front())
    for (const CLI::Option* const option : command->get_options())
      if (option->get_name() == name) {
        const std::string type = option->get_type_name();
        return type.starts_with("UINT")  ? "a whole number of 0 or more"
               : type.starts_with("INT") ? "a whole number"
                                         : "a number";
      }
  return "another value";
}

/// An error of CLI11 about a value, in our words; empty for others.
std::string about_value(const CLI::App& app, const std::string& error) {
  const auto between = [&](const std::string& before, const std::string& behind) {
    const std::size_t begin = error.find(before);
    const std::size_t end = begin == std::string::npos ? begin : error.find(behind, begin);
    return end == std::string::npos
               ? std::string()
               : error.substr(begin + before.size(), end - begin - before.size());
  };
  if (const std::string name = between("Could not convert: ", " = "); !name.empty())
    return name + ": expected " + kind_of(app, name) + ", found " +
           error.substr(error.find(" = ") + 3);
  if (const std::string value = between(": Value ", " not in range "); !value.empty()) {
    const double low = std::strtod(between(" not in range ", " to ").c_str(), nullptr);
    const double high = std::strtod(error.substr(error.rfind(" to ") + 4).c_str(), nullptr);
    constexpr double kNoEnd = 1e300;  // of CLI::PositiveNumber
    return error.substr(0, error.find(": Value ")) + ": expected a number " +
           (high > kNoEnd ? "above " + plain(low)
                          : "between " + plain(low) + " and " + plain(high)) +
           ", found " + value;
  }
  return {};
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

/// Adds an option for each kind of value.
struct Adder {
  CLI::App& app;
  const std::string& names;
  const std::string& help;

  template <class T>
  CLI::Option* operator()(T* value) const {
    CLI::Option* const option = app.add_option(names, *value, help);
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
  option_->check(CLI::Range(low, high));
  return *this;
}

const Option& Option::in_range(double low, double high) const {
  option_->check(CLI::Range(low, high));
  return *this;
}

const Option& Option::positive() const {
  option_->check(CLI::PositiveNumber);
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
  option_->check(CLI::ValidIPV4);
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
    if (const std::string text = about_value(*app_, error.what()); !text.empty()) {
      std::fprintf(stderr, "%s: %s\n", program().c_str(), text.c_str());
      return kUsage;
    }
    return app_->exit(error) == 0 ? 0 : kUsage;
  }
  return std::nullopt;
}

}  // namespace saphira

#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "language/program.hpp"
#include "language/reader.hpp"

namespace saphira::intentions {

/// Thrown after a reported error: the form is skipped.
struct Stop {};

/// The positional items and the options (:key value) of a list.
struct Parts {
  std::vector<const Form*> items;
  std::map<std::string, const Form*> options;
  const Form* option(const std::string& key) const;
};

/// *the-name* of an environment variable.
bool starred(std::string_view name);
/// ", found ...": the end of a message.
std::string found(const Form& form);

/// The definition that is being compiled, one (defintention ...): its program, its variables, its
/// errors.
class Definition {
 public:
  Definition(const Reader& reader, const Functions& functions, std::vector<Diagnostic>& troubles)
      : functions_(functions), reader_(reader), troubles_(troubles) {}

  const Functions& functions() const { return functions_; }
  Program& program() { return *program_; }
  std::shared_ptr<Program> release() { return std::move(program_); }

  void complain(const Form& at, std::string message);
  [[noreturn]] void fail(const Form& at, std::string message);
  void warn(const Form& at, std::string message);
  bool wrong() const { return errors_ > 0; }
  std::string line_text(int line) const { return reader_.trouble(line, 1, true, {}).line_text; }

  /// The parts of `form`, from that item on; `known` are the allowed options.
  Parts parts(const Form& form, std::size_t from, const std::set<std::string>& known);

  bool is_local(const std::string& key) const { return slots_.contains(key); }
  /// The slot of a local: a new one at its first mention.
  std::size_t slot(const Form& name);
  void uses(const Form& name) { pending_.emplace(normal(name.text), name); }
  void binds(const Form& name) { assigned_.insert(normal(name.text)); }
  /// Fails for a name that cannot be set.
  void check_variable(const Form& name);
  /// Reports locals that are never bound.
  void check_locals();

 private:
  const Functions& functions_;
  const Reader& reader_;
  std::vector<Diagnostic>& troubles_;
  std::size_t errors_ = 0;
  std::shared_ptr<Program> program_ = std::make_shared<Program>();
  std::map<std::string, std::size_t> slots_;
  std::map<std::string, Form> pending_;  ///< locals by their first use
  std::set<std::string> assigned_;
};

}  // namespace saphira::intentions

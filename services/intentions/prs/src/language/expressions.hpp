#pragma once

#include <map>
#include <memory>
#include <string>

#include "language/definition.hpp"

namespace saphira::intentions {

/// Compiles the expressions of a definition.
class Expressions {
 public:
  explicit Expressions(Definition& definition) : definition_(definition) {}

  /// `actions`: within EXECUTE, where actions are allowed.
  Expression expression(const Form& form, bool actions);

 private:
  Expression variable(const Form& form);
  Expression call(const Form& form, const std::string& name, bool actions);
  void check_blanks(const Form& text, std::size_t given);
  Expression set(const Form& form, bool actions);
  std::shared_ptr<const Function> shared(const Function& function);

  Definition& definition_;
  std::map<std::string, std::shared_ptr<const Function>> kept_;
};

}  // namespace saphira::intentions

#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "language/expressions.hpp"

namespace saphira::intentions {

/// Compiles the goal-sets of a definition to the steps of its program.
class Goals {
 public:
  Goals(Definition& definition, Expressions& expressions)
      : definition_(definition), program_(definition.program()), expressions_(expressions) {}

  void body(const Form& goals);

 private:
  // Functions that compile a goal return true where the code behind it is reachable.
  bool sequence(const std::vector<const Form*>& goals);
  /// A goal, or a list of goals one after the other.
  bool goal_or_goals(const Form& form);
  bool goal(const Form& form);
  bool test(const Form& form);
  bool assign(const Form& form);
  void tell(std::size_t at, const Form& condition);
  Expression duration(const Form& form);
  bool pause(const Form& form);
  bool wait(const Form& form);
  bool ask(const Form& form);
  bool intend(const Form& form);
  bool branch(const Form& form);
  bool fork(const Form& form, Step::Op op);
  bool guard(const Form& form, Step::Op op);

  /// The goals of an :else, behind the step that may fail; both paths join behind them.
  bool otherwise(std::size_t failing, const Form* form);
  void add_branch(std::size_t at, const Form& form, const Form& whole);
  void arguments(const Form& form, Intend& intend, Mention& mention);
  void expect_items(const Form& form, const Parts& given, std::size_t fewest, std::size_t most,
                    const char* pattern);
  /// The expression that the step evaluates.
  void take(std::size_t at, const Form& form, bool actions);
  void check_reached(const std::vector<bool>& completes, const std::vector<const Form*>& places);

  std::size_t add(Step::Op op, const Form& at);
  Step& step(std::size_t index) { return program_.steps[index]; }
  std::size_t here() const { return program_.steps.size(); }

  Definition& definition_;
  Program& program_;
  Expressions& expressions_;
  std::size_t set_ = 0;  ///< the goal-set that is being compiled
  std::map<std::string, std::size_t> labels_;
  std::vector<std::pair<std::size_t, Form>> gotos_;
};

}  // namespace saphira::intentions

#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "saphira/intentions/value.hpp"
#include "saphira/intentions/world.hpp"

namespace saphira::intentions {

/// Thrown by a function or action that fails: the goal that called it fails with this code and
/// reason.
class ActivityError : public std::runtime_error {
 public:
  explicit ActivityError(const std::string& reason, GoalCode code = v1::CODE_ACTIVITY)
      : std::runtime_error(reason), code_(code) {}
  GoalCode code() const { return code_; }

 private:
  GoalCode code_;
};

using Values = std::span<const Value>;

/// An action's ways to affect the world outside of its activity.
class Effects {
 public:
  virtual ~Effects() = default;
  virtual const World& world() const = 0;
  virtual void say(std::string text) = 0;                          ///< to people
  virtual void believe(const std::string& name, Value value) = 0;  ///< an environment variable
  virtual void believe_while(const std::string& name, Value value) = 0;  ///< the intention lasts
  virtual void request(Request request) = 0;                             ///< of registration
  virtual std::uint64_t ask(Request request) = 0;  ///< agents; the number of the question
};

/// A pure function of the activity language.
struct Function {
  std::string name;
  std::size_t fewest = 0;  ///< arguments
  std::size_t most = std::numeric_limits<std::size_t>::max();
  std::function<Value(const World&, Values)> call;
  std::string summary;  ///< one line for people
};

/// A primitive action (paper 3.4, Execute).
struct Action {
  std::string name;
  std::size_t fewest = 0;
  std::size_t most = std::numeric_limits<std::size_t>::max();
  std::function<Value(Effects&, Values)> call;
  std::string summary;
};

/// A fact of the robot or the LPS in a cycle, under a fixed name, such as `stalled` or
/// *cur-region*. Evaluated at most once a cycle for the list of beliefs, and when a condition names
/// it.
struct Condition {
  std::string name;
  std::function<Value(const World&)> value;
  std::string summary;
};

/// The functions, actions and conditions that activities can use, by name.
class Functions {
 public:
  /// Replaces a function of the same name.
  void add(Function function);
  void add(Action action);
  void add(Condition condition);
  /// A function or condition from its parts.
  void add(std::string name, std::size_t fewest, std::size_t most, std::string summary,
           std::function<Value(const World&, Values)> call) {
    add(Function{std::move(name), fewest, most, std::move(call), std::move(summary)});
  }
  void add(std::string name, std::string summary, std::function<Value(const World&)> value) {
    add(Condition{std::move(name), std::move(value), std::move(summary)});
  }
  const Function* function(std::string_view name) const;
  const Action* action(std::string_view name) const;
  const Condition* condition(std::string_view name) const;

  using Conditions = std::map<std::string, Condition, std::less<>>;
  const Conditions& conditions() const { return conditions_; }
  const std::map<std::string, Function, std::less<>>& functions() const { return functions_; }

 private:
  std::map<std::string, Function, std::less<>> functions_;
  std::map<std::string, Action, std::less<>> actions_;
  Conditions conditions_;
};

/// The argument as the expected type; ActivityError with the function's name where it is not.
double number_of(Values arguments, std::size_t index, std::string_view function);
const std::string& text_of(Values arguments, std::size_t index, std::string_view function);
const Point& point_of(Values arguments, std::size_t index, std::string_view function);

/// Questions to agents, and their answers: the compiled form of ASK.
void add_asking(Functions& functions);

/// Arithmetic, comparison, lists, points and fuzzy functions; `say`; conditions of the robot. The
/// table in the README.
Functions core_functions();

}  // namespace saphira::intentions

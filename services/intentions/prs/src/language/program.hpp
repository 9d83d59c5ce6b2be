#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/intentions/activity.hpp"
#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

inline constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

/// The knowledge of an intention about itself and its children, for expressions.
class Own {
 public:
  virtual ~Own() = default;
  virtual Value state_of(const std::string& name) const = 0;
  virtual double level_of(const std::string& name) const = 0;
  virtual const std::string& outcome() const = 0;  ///< of the newest awaited INTEND
  virtual const std::string& reason() const = 0;
  virtual double elapsed() const = 0;  ///< [s] since its beginning
};

/// A compiled expression.
struct Expression {
  enum class Kind {
    kConstant,
    kLocal,
    kBelief,
    kCall,
    kAction,
    kSet,
    kAnd,
    kOr,
    kIf,
    kStateOf,
    kLevelOf,
    kFinished,
    kOutcome,
    kReason,
    kElapsed
  };
  Kind kind = Kind::kConstant;
  Value constant;
  std::size_t slot = 0;  ///< of a local
  std::string name;      ///< of a belief, as written
  std::string key;       ///< its normal form
  std::shared_ptr<const Function> function;
  std::shared_ptr<const Action> action;
  std::vector<Expression> arguments;
};

struct Scope {
  const World& world;
  std::vector<Value>& locals;
  const Own& own;
  Effects& effects;
};

/// ActivityError where a function fails.
Value evaluate(const Expression& expression, Scope& scope);

/// The target of an INTEND.
struct Intend {
  std::string schema;  ///< as written
  std::vector<std::pair<std::string, Expression>> arguments;
  std::string name;  ///< empty: to be assigned
  bool waits = true;
  std::optional<Expression> threshold;  ///< none: until it is finished
  std::optional<Expression> timeout;    ///< [s]
  std::optional<Expression> priority;
};

/// One step of the state machine that a schema is compiled to.
struct Step {
  enum class Op {
    kTest,
    kExecute,
    kAssign,
    kWait,
    kIntend,
    kUnintend,
    kJump,
    kJumpUnless,
    kFork,      ///< AND: a thread for each of `branches`; waits for all
    kSplit,     ///< SPLIT: the same without waiting
    kPreserve,  ///< a thread for branches[0], while the condition holds
    kMaintain,  ///< the same; branches[1] restores the condition
    kEndThread,
    kEndSet,
    kGoto,  ///< target: a set
    kSucceed,
    kFail
  };
  Op op = Op::kJump;
  std::size_t set = 0;
  int line = 0;
  std::string text;   ///< for people
  std::string words;  ///< of a condition of the robot, such as "a wheel is stalled"
  Expression expression;
  std::size_t slot = kNowhere;    ///< of a local; kAssign
  std::size_t target = kNowhere;  ///< of a jump; behind the goal, of those that fork
  std::size_t other = kNowhere;   ///< the step after a failure; kNowhere: the failure goes up
  std::vector<std::size_t> branches;
  std::optional<Expression> timeout;  ///< [s]
  std::optional<Expression> reason;
  std::shared_ptr<const Intend> intend;
};

/// The use of another schema's name, for the check.
struct Mention {
  std::string schema;
  std::vector<std::string> arguments;
  std::vector<int> lines;  ///< of the arguments
  std::vector<int> columns;
  int line = 1;
  int column = 1;
  std::string line_text;
  std::vector<std::string> argument_texts;  ///< their lines
};

/// A compiled activity schema. Does not change: running intentions keep theirs.
struct Program {
  std::string name;
  std::string file;
  int line = 1;
  struct Set {
    std::string label;  ///< upper case; S3 where it has none
    std::size_t begin = 0;
    std::string text;
  };
  std::vector<Set> sets;
  std::vector<Step> steps;
  std::vector<std::string> locals;  ///< parameters first
  std::size_t parameters = 0;
  std::vector<Value> usual;  ///< defaults of the parameters
  std::optional<Expression> level;
  std::optional<Expression> progress;
  double timeout = 0.0;  ///< [s] 0: none
  std::vector<Mention> mentions;
};

/// An instance that begins at the first goal-set.
std::unique_ptr<Activity> make_machine(std::shared_ptr<const Program> program,
                                       const Bindings& bindings);

}  // namespace saphira::intentions

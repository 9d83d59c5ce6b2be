#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/intentions/activity.hpp"
#include "saphira/intentions/goal.hpp"
#include "saphira/intentions/value.hpp"

namespace saphira::intentions {

struct Program;

/// A parameter of a schema.
struct Parameter {
  std::string name;
  ArgumentKind kind = ArgumentKind::number;
  std::string unit;  ///< for people, such as "m/s"; empty for none
  double low = 0.0;  ///< smallest number; points: unused
  double high = 0.0;
  bool required = false;
  bool in_odom = false;                   ///< a number that is meaningless in another odom frame
  std::optional<double> usual;            ///< default of an optional number; none: absent
  std::optional<std::string> usual_text;  ///< the default of an optional text
  bool any = false;                       ///< takes every kind; `kind` does not count
  bool place = false;                     ///< a text that names a place, or a point instead
};

/// A schema that can be intended: its name, its parameters and its factory (manual 8.3). Goals name
/// a schema as their functor. Activities of the language register here like the built-in ones.
struct Schema {
  std::string name;
  std::string summary;  ///< one line for people
  std::vector<Parameter> parameters;
  /// Checks the parameters together: the error, or empty. May be absent.
  std::function<std::string(const Arguments&)> check;
  /// Makes an instance. The arguments are checked and complete, their points in odom or on the map.
  std::function<std::unique_ptr<Activity>(const Arguments&)> make;
  /// A goal of this schema ends all earlier goals that drive, instead of waiting for them.
  bool replaces = false;
  /// A goal of this schema may be underway beside others: it does not drive.
  bool concurrent = false;
  int priority = 0;      ///< larger ones are stepped first
  double timeout = 0.0;  ///< [s] limit for an instance; 0: none
  std::string source;    ///< the file that it comes from; empty: built in
  /// Makes an instance with values of every kind, for another activity. May be absent: then `make`
  /// is used, and lists and references are refused.
  std::function<std::unique_ptr<Activity>(const Bindings&)> bind;
  std::shared_ptr<const Program> program;  ///< of a compiled one
};

/// The signature of a behavior of the behaviors service.
struct BehaviorSignature {
  std::string name;  ///< of the schema, such as FollowCorridor
  std::vector<Parameter> parameters;
};

/// The schemas of intentions, and the known behaviors. Names are the same in either case and with -
/// or _.
class Registry {
 public:
  /// Replaces a schema of the same name: the way for a reloaded activity. Running instances keep
  /// the schema that they began with.
  void add(Schema schema);
  void remove(std::string_view name);
  const Schema* find(std::string_view name) const;
  std::shared_ptr<const Schema> share(std::string_view name) const;
  /// The activity that another one means by a name; none where that is a behavior. A name with a
  /// capital is a behavior's (TurnTo, Stop), unless an activity has exactly that name.
  std::shared_ptr<const Schema> intended(std::string_view name) const;
  /// By name.
  std::vector<const Schema*> all() const;
  /// A hint for an unknown activity: the most similar one, and the place of the list.
  std::string instead_of(std::string_view functor) const;

  /// All existing behaviors; from now on others are errors.
  void know_behaviors(std::vector<BehaviorSignature> behaviors);
  bool knows_behaviors() const { return knows_behaviors_; }
  /// Also by its name without hyphens: follow-corridor is FollowCorridor.
  const BehaviorSignature* behavior(std::string_view name) const;
  /// The schema's name in the behaviors service; where it is unknown, its words with capitals:
  /// follow-corridor is FollowCorridor.
  std::string behavior_name(std::string_view name) const;

 private:
  std::map<std::string, std::shared_ptr<const Schema>, std::less<>> schemas_;
  std::map<std::string, BehaviorSignature, std::less<>> behaviors_;  ///< by names without hyphens
  bool knows_behaviors_ = false;
};

/// The error in the arguments, in words, with the expected and the actual value; empty: none. Then
/// `complete` has the arguments with the defaults filled in.
std::string check_arguments(const Schema& schema, const Arguments& arguments, Arguments& complete);

/// The same, with points from the robot fixed in odom.
Bindings fixed_in_odom(const Bindings& bindings, const Robot& robot);

/// An instance for values of every kind. Points from the robot are fixed in odom. ActivityError
/// where the schema does not take the arguments.
std::unique_ptr<Activity> instantiate(const Schema& schema, const Bindings& bindings,
                                      const Robot& robot);

}  // namespace saphira::intentions

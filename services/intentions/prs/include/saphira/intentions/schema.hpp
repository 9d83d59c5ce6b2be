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
  bool in_odom = false;         ///< a number that means nothing in another odom frame
  std::optional<double> usual;  ///< the default of an optional number; none: absent where not given
  std::optional<std::string> usual_text;  ///< the default of an optional text
  bool any = false;                       ///< takes every kind; `kind` does not count
};

/// A schema that can be intended: its name, what it takes and how it is made (manual 8.3). Goals
/// name one as their functor. The activities of a language register here like the built-in ones.
struct Schema {
  std::string name;
  std::string summary;  ///< one line for people
  std::vector<Parameter> parameters;
  /// Checks the parameters together: the complaint, or empty. May be absent.
  std::function<std::string(const Arguments&)> check;
  /// Makes an instance. The arguments are checked and complete, their points in odom or on the map.
  std::function<std::unique_ptr<Activity>(const Arguments&)> make;
  /// A goal of this schema ends all earlier goals that drive, instead of waiting for them.
  bool replaces = false;
  /// A goal of this schema may be underway beside others: it does not drive.
  bool concurrent = false;
  int priority = 0;      ///< larger ones are stepped first
  double timeout = 0.0;  ///< [s] that an instance may take; 0: as long as it likes
  std::string source;    ///< the file that it comes from; empty: built in
  /// Makes an instance with values of every kind, as another activity intends it. May be absent:
  /// then `make` is used, and lists and references are refused.
  std::function<std::unique_ptr<Activity>(const Bindings&)> bind;
  std::shared_ptr<const Program> program;  ///< of one that was compiled
};

/// All that is known of a behavior, which the behaviors service has.
struct BehaviorSignature {
  std::string name;  ///< of the schema, such as FollowCorridor
  std::vector<Parameter> parameters;
};

/// The schemas of intentions, and what is known of behaviors. Names are the same in either case and
/// with - or _.
class Registry {
 public:
  /// A schema of the same name is replaced: the way a reloaded activity comes in. What is running
  /// goes on with the one that it began with.
  void add(Schema schema);
  void remove(std::string_view name);
  const Schema* find(std::string_view name) const;
  std::shared_ptr<const Schema> share(std::string_view name) const;
  /// The activity that another one means by a name; none where that is a behavior. A name with a
  /// capital is a behavior's (TurnTo, Stop), unless an activity is spelled exactly so.
  std::shared_ptr<const Schema> intended(std::string_view name) const;
  /// By name.
  std::vector<const Schema*> all() const;
  /// Words for an unknown functor: which one may be meant, and where all are listed.
  std::string instead_of(std::string_view functor) const;

  /// All behaviors that there are; from now on others are unknown.
  void know_behaviors(std::vector<BehaviorSignature> behaviors);
  bool knows_behaviors() const { return knows_behaviors_; }
  /// Also by its name without hyphens: follow-corridor is FollowCorridor.
  const BehaviorSignature* behavior(std::string_view name) const;
  /// The schema's name as the behaviors service has it; where it is not known, with its words in
  /// capitals: follow-corridor is FollowCorridor.
  std::string behavior_name(std::string_view name) const;

 private:
  std::map<std::string, std::shared_ptr<const Schema>, std::less<>> schemas_;
  std::map<std::string, BehaviorSignature, std::less<>> behaviors_;  ///< by names without hyphens
  bool knows_behaviors_ = false;
};

/// The trouble with the arguments, in words that say what was expected and what came; empty where
/// nothing is. Where nothing is, `complete` is the arguments with the defaults filled in.
std::string check_arguments(const Schema& schema, const Arguments& arguments, Arguments& complete);

/// The same, with points from the robot fixed in odom.
Bindings fixed_in_odom(const Bindings& bindings, const Robot& robot);

/// An instance for values of every kind. Points from the robot are fixed in odom. ActivityError
/// where the arguments are not what the schema takes.
std::unique_ptr<Activity> instantiate(const Schema& schema, const Bindings& bindings,
                                      const Robot& robot);

}  // namespace saphira::intentions

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

namespace saphira::intentions {

/// What a schema's parameter takes.
struct Parameter {
  std::string name;
  ArgumentKind kind = ArgumentKind::kNumber;
  std::string unit;  ///< for people, such as "m/s"; empty for none
  double low = 0.0;  ///< smallest number; points: unused
  double high = 0.0;
  bool required = false;
  bool in_odom = false;         ///< a number that means nothing in another odom frame
  std::optional<double> usual;  ///< the default of an optional number; none: absent where not given
};

/// A schema that can be intended: its name, what it takes and how it is made (manual 8.3). Goals
/// name one as their functor. The activities of a language register here like the built-in ones.
struct Schema {
  std::string name;
  std::string summary;  ///< one line for people
  std::vector<Parameter> parameters;
  /// What the parameters together have to satisfy; the complaint, or empty. May be absent.
  std::function<std::string(const Arguments&)> check;
  /// Makes an instance. The arguments are checked and complete, their points in odom or on the map.
  std::function<std::unique_ptr<Activity>(const Arguments&)> make;
  /// A goal of this schema ends what is not more important, instead of waiting for it.
  bool replaces = false;
};

class Registry {
 public:
  /// A schema of the same name is replaced: the way a reloaded activity comes in.
  void add(Schema schema);
  const Schema* find(std::string_view name) const;
  /// "drive, go_to, ...": for messages.
  std::string names() const;

 private:
  std::map<std::string, Schema, std::less<>> schemas_;
};

/// What is wrong with the arguments, in words that say what was expected and what came; empty where
/// nothing is. Where nothing is, `complete` is the arguments with the defaults filled in.
std::string check_arguments(const Schema& schema, const Arguments& arguments, Arguments& complete);

}  // namespace saphira::intentions

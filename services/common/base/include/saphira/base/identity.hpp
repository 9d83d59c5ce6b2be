#pragma once

#include <optional>
#include <string>

namespace saphira {

/// A member of the site, or a person at a door of one, as the receiver of their samples has checked
/// them.
struct Identity {
  std::string name;  ///< such as karen, or "karen at flakey", a person at a door [empty: unknown]
  std::string role;  ///< such as operator

  bool operator==(const Identity&) const = default;
  /// "karen (operator)".
  std::string text() const { return name.empty() ? "a stranger" : name + " (" + role + ")"; }
};

/// None: nobody is checked, as on an open bus.
using Checked = std::optional<Identity>;

/// A checked identity before the name that it gives itself: "karen (operator), saphira drive". A
/// name that begins with this identity already, from a program between, stays as it is.
inline std::string named(const std::string& says, const Checked& who) {
  if (!who || says.starts_with(who->text() + ", "))
    return says;
  return who->text() + (says.empty() ? "" : ", " + says);
}

/// True where a checked name, as others publish it, is of the program that calls itself `says`.
inline bool is_named(const std::string& known, const std::string& says) {
  return known == says || (known.size() > says.size() + 2 && known.ends_with(", " + says));
}

/// True where a program of `other` may be another one of the kind of `self`: of its role, or one of
/// them is bridge and services in one. Any member may write a status with any name. Where `self` is
/// checked, one that is not yet checked is none.
inline bool may_be_of_a_kind(const Checked& self, const Identity* other) {
  const auto of_robot = [](const std::string& role) {
    return role == "bridge" || role == "services" || role == "robot";
  };
  return !self || (other && (self->role == other->role ||
                             (of_robot(self->role) && of_robot(other->role) &&
                              (self->role == "robot" || other->role == "robot"))));
}

/// True where `who` may change, replace or end what `owner` has asked for: the owner, operators,
/// and the door at which the owner is a person. A stop is anybody's, and no matter of this.
inline bool may_end(const Checked& who, const Checked& owner) {
  return !who || !owner || who->role == "operator" ||
         (!who->name.empty() &&
          (who->name == owner->name || owner->name.ends_with(" at " + who->name)));
}

/// For whom a sample counts whose writer names a person [empty name: nobody else]. The robot's own
/// services have checked those whose words they pass on. A door is a member of the site: its person
/// has a name within it, and at most its rights.
inline Checked acting_for(const Checked& writer, const Identity& person) {
  if (person.name.empty())
    return writer;
  if (!writer || writer->role == "services" || writer->role == "robot")
    return person;
  if (writer->name.empty() || (writer->role != "operator" && writer->role != "agent"))
    return writer;
  return Identity{person.name + " at " + writer->name, person.role == "operator" ? writer->role
                                                       : person.role == "agent"  ? person.role
                                                                                 : "observer"};
}

}  // namespace saphira

#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::security {

/// The roles on the bus.
struct Role {
  std::string name;
  std::string about;                  ///< for people
  std::vector<std::string> programs;  ///< for other programs see load_credentials()
};

/// Which roles may write and read a topic.
struct TopicRule {
  std::string topic;
  std::set<std::string> writers;
  std::set<std::string> readers;
};

/// The roles of a site and their permissions: config/security/roles.yaml.
struct Roles {
  std::string text;  ///< the file
  std::vector<Role> roles;
  std::vector<TopicRule> topics;
  bool seal_required = false;  ///< announcements without the site's seal are dropped

  const Role* find(std::string_view role) const;
  /// The role that a program has by its name. None where the file does not name it.
  const Role* of_program(std::string_view program) const;
  bool may_write(std::string_view role, std::string_view topic) const;
  bool may_read(std::string_view role, std::string_view topic) const;
  /// The roles that may, for messages: "operator, agent".
  std::string those_that_write(std::string_view topic) const;
  std::string those_that_read(std::string_view topic) const;
};

/// The topics of the contract.
const std::vector<std::string>& topics_of_contract();

/// Reads a file of roles. FileError where it is wrong, and where it names a topic that `topics`
/// does not have or leaves one of them out.
Roles parse_roles(const std::string& text, const std::string& file,
                  const std::vector<std::string>& topics);
/// Reads one that an authority has checked and signed, whose contract may be older than ours.
Roles parse_signed_roles(const std::string& text, const std::string& file);

}  // namespace saphira::security

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "saphira/security/credentials.hpp"

namespace saphira::security {

/// The authority of a site: a folder with its key, the roles, and a folder to carry for each
/// member. All that it writes is replaced durably; keys are readable by its user alone.
///
/// A wrong value from a person is std::invalid_argument, or FileError for a file.
class Authority {
 public:
  /// Makes one where there is none. `roles`: the text of a file of roles.
  static Authority make(const std::string& folder, const std::string& site,
                        const std::string& roles, const std::string& roles_file, std::int64_t now);
  /// Opens the one that is there.
  explicit Authority(const std::string& folder);

  struct Member {
    unsigned issue = 1;
    std::vector<std::string> roles;
    std::string robot;       ///< the only one that it may have to do with [empty: any]
    std::int64_t until = 0;  ///< [s since 1970]
    bool revoked = false;
  };
  const std::map<std::string, Member>& members() const { return members_; }
  const std::string& site() const { return site_; }
  const Roles& roles() const { return roles_; }
  const std::string& folder() const { return folder_; }

  /// A new member, or one again that was revoked. The folder to carry to its machine.
  std::string add(const std::string& name, const std::vector<std::string>& roles,
                  const std::string& robot, int days, std::int64_t now);
  /// New keys and certificates with the roles as the file has them now. The folder to carry.
  std::string renew(const std::string& name, int days, std::int64_t now);
  /// The member's certificates stop to count. The signed list, to be copied into the folders of all
  /// machines.
  std::string revoke(const std::string& name);

  std::string folder_of(const std::string& member) const;
  /// The list of revoked certificates, to be carried to all machines.
  std::string revoked_list() const;

 private:
  void issue(const std::string& name, const Member& member, std::int64_t now);
  std::vector<std::string> site_keys() const;
  void write_shared(const std::string& folder) const;
  void save_members() const;
  void load_members();
  Member& known(const std::string& name);

  std::string folder_;
  std::string site_;
  Roles roles_;
  std::string key_;
  std::string certificate_;
  std::map<std::string, Member> members_;
  Revoked revoked_;
};

}  // namespace saphira::security

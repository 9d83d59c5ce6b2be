#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "saphira/security/roles.hpp"
#include "saphira/security/subject.hpp"

namespace saphira::security {

/// The beginning of every GUID prefix of a subject's participants. PKI-DH makes it of the subject's
/// hash (DDS Security 1.1, 9.3.3), and checks it with the certificate in each handshake.
using PrefixHead = std::array<std::uint8_t, 6>;
PrefixHead prefix_head(const Subject& subject);

/// The files of one role in a folder of credentials.
struct CredentialFiles {
  std::string authority;
  std::string governance;
  std::string certificate;
  std::string key;
  std::string permissions;
  std::string site_key;  ///< empty: there is none
};

/// The credentials of a program, checked: the files are there, belong together, hold now and are
/// signed by the authority of the site.
struct Credentials {
  CredentialFiles files;
  Subject subject;
  std::int64_t until = 0;  ///< [s since 1970]
  std::string robot;       ///< the only one that it may have to do with [empty: any]
  Roles roles;             ///< of the site
  std::string authority;   ///< its certificate, PEM
  /// Of the site, for its seal (seal.hpp); none in a folder that an earlier version made.
  std::vector<std::string> site_keys;
};

/// Credentials that will hold, or a clock that is behind: no mistake of a person, so a program that
/// is started again takes them in time.
class NotYet : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The credentials in a folder for a program. Where the roles of the site name it, those of that
/// role; for any other program the first of operator, agent, observer and recorder in the folder.
/// std::invalid_argument that names the file, the fault and the remedy; NotYet. `now`: [s since
/// 1970].
Credentials load_credentials(const std::string& folder, const std::string& program,
                             std::int64_t now);

/// Those of one role of the folder.
Credentials load_role(const std::string& folder, const std::string& role, std::int64_t now);

/// The fault and the remedy where other users of this machine may read the private key or that of
/// the site; empty otherwise.
std::string trouble_of_key(const Credentials& credentials);

/// The roles that a folder has credentials of.
std::vector<std::string> roles_in(const std::string& folder);

/// Certificates that do not count any more, as their common names (karen.2).
struct Revoked {
  std::uint64_t number = 0;  ///< of the list; a newer one is larger
  std::set<std::string> members;
};
std::string to_text(const Revoked& revoked);
/// Reads DIR/revoked.signed. std::runtime_error where it is no list that this authority signed.
Revoked load_revoked(const std::string& folder, const std::string& authority_certificate);

}  // namespace saphira::security

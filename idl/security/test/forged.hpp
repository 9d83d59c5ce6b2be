#pragma once

#include <regex>
#include <stdexcept>
#include <string>

#include "crypto.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/documents.hpp"

namespace saphira::security::test {

inline KeyPair pair_of(const std::string& folder, const std::string& role) {
  return {read_bytes(folder + "/" + role + "/key.pem"),
          read_bytes(folder + "/" + role + "/certificate.pem")};
}

/// Gives a copied folder of credentials the permission to write and read everything, of every
/// robot, signed with that key.
inline void forge(const std::string& folder, const Grant& grant, const Roles& genuine,
                  const KeyPair& signer) {
  const std::string roles =
      std::regex_replace(genuine.text, std::regex("(write|read): \\[[^\\]]*\\]"), "$1: [any]");
  const auto put = [&](const std::string& file, const std::string& text) {
    if (!replace_file(folder + "/" + file, sign(text, signer)))
      throw std::runtime_error(folder + "/" + file + " cannot be written");
  };
  put("roles.signed", roles);
  put(grant.subject.role + "/permissions.signed",
      permissions(grant, parse_signed_roles(roles, "forged")));
}

}  // namespace saphira::security::test

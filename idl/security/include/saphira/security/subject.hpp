#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace saphira::security {

/// The subject of a certificate: which member of which site it names, in which role. Each
/// certificate of a member has a number of its own, so that one can be revoked and the next not.
struct Subject {
  std::string name;    ///< of the machine or the person, such as karen
  unsigned issue = 1;  ///< which of the member's certificates
  std::string role;
  std::string site;

  bool operator==(const Subject&) const = default;
};

/// Lower-case letters, digits and hyphens, a letter first, at most 32: nothing that a certificate,
/// an XML file or a folder would have to quote.
bool is_name(std::string_view text);

/// The member and its issue: "karen.2".
std::string common_name(const Subject& subject);
/// As RFC 2253 writes it: "CN=karen.2,OU=operator,O=office".
std::string to_text(const Subject& subject);
/// Reads to_text(), also with blanks around its signs, and as OpenSSL writes it in one line
/// ("/O=office/OU=operator/CN=karen.2"), which is how Fast DDS announces it. None where it is no
/// subject of ours.
std::optional<Subject> parse_subject(std::string_view text);

}  // namespace saphira::security

#pragma once

// The names of the files of a folder of credentials.

namespace saphira::security {

inline constexpr const char* kAuthority = "authority.pem";
inline constexpr const char* kRoles = "roles.signed";
inline constexpr const char* kGovernance = "governance.signed";
inline constexpr const char* kRevoked = "revoked.signed";
inline constexpr const char* kSiteKey = "site.key";
// In a folder for each role.
inline constexpr const char* kCertificate = "certificate.pem";
inline constexpr const char* kKey = "key.pem";
inline constexpr const char* kPermissions = "permissions.signed";

}  // namespace saphira::security

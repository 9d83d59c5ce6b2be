#pragma once

#include <cstdint>
#include <string>

namespace saphira::security {

/// Checks a certificate and its private key (PEM), in files that a person named.
/// std::invalid_argument that names the file and the remedy where one cannot be read, or they do
/// not fit. Returns the error of its period of validity, at `now` [s since 1970]; empty: it holds.
std::string check_pair(const std::string& certificate_file, const std::string& key_file,
                       std::int64_t now);

/// std::invalid_argument that names the option, the file, what was expected and the remedy, unless
/// the file of --dial-authority is a certificate (PEM).
void check_dial_authority(const std::string& file);

}  // namespace saphira::security

#pragma once

#include <cstdint>
#include <string>

namespace saphira::security {

/// Checks a certificate and its private key (PEM), in files that a person named.
/// std::invalid_argument that names the file and the remedy where one cannot be read, or they do
/// not fit. Returns the error of its period of validity, at `now` [s since 1970]; empty: it holds.
std::string check_pair(const std::string& certificate_file, const std::string& key_file,
                       std::int64_t now);

}  // namespace saphira::security

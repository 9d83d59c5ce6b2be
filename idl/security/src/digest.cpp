#include "saphira/security/digest.hpp"

#include <openssl/sha.h>

#include <cstdint>
#include <vector>

#include "saphira/base/format.hpp"

namespace saphira::security {

std::string sha256(std::string_view text) {
  std::vector<std::uint8_t> hash(SHA256_DIGEST_LENGTH);
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash.data());
  return hex_text(hash);
}

}  // namespace saphira::security

#include "saphira/security/seal.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/digest.hpp"

namespace saphira::security {
namespace {

// [bytes]
constexpr std::size_t kRtpsHeader = 20;
constexpr std::size_t kSubmessageHeader = 4;
constexpr std::size_t kTime = 8;
constexpr std::size_t kMark = 4;
constexpr std::size_t kCode = 16;
constexpr std::size_t kKeyBytes = 32;
// A submessage that the standard leaves to vendors.
constexpr std::uint8_t kSealKind = 0x9f;
constexpr std::uint8_t kLittleEndian = 1;

using Code = std::array<std::uint8_t, EVP_MAX_MD_SIZE>;

Code code_of(const std::string& key, const std::uint8_t* bytes, std::size_t size) {
  Code code{};
  unsigned length = 0;
  HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), bytes, size, code.data(), &length);
  return code;
}

std::string mark_of(const std::string& key) {
  return sha256("mark " + key).substr(0, kMark);
}

std::size_t size_of(std::size_t keys) {
  return kSubmessageHeader + kTime + keys * (kMark + kCode);
}

}  // namespace

void Seal::close(std::vector<std::uint8_t>& message, std::int64_t time) const {
  if (keys_.empty())
    return;
  const std::size_t body = size_of(keys_.size()) - kSubmessageHeader;
  message.insert(message.end(), {kSealKind, kLittleEndian, static_cast<std::uint8_t>(body), 0});
  for (std::size_t i = 0; i < kTime; ++i)
    message.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(time) >> 8U * i));
  const std::size_t covered = message.size();
  for (const std::string& key : keys_) {
    const std::string mark = mark_of(key);
    const Code code = code_of(key, message.data(), covered);
    message.insert(message.end(), mark.begin(), mark.end());
    message.insert(message.end(), code.begin(), code.begin() + kCode);
  }
}

Seal::Opened Seal::open(const std::uint8_t* message, std::size_t size) const {
  for (std::size_t count = 1; count <= kMostKeys; ++count) {
    const std::size_t length = size_of(count);
    if (size < kRtpsHeader + length)
      break;
    const std::uint8_t* const seal = message + size - length;
    if (seal[0] != kSealKind || seal[1] != kLittleEndian || seal[2] != length - kSubmessageHeader ||
        seal[3] != 0)
      continue;
    Opened opened{size - length, std::nullopt};
    const std::uint8_t* part = seal + kSubmessageHeader + kTime;
    const auto covered = static_cast<std::size_t>(part - message);
    for (; part != message + size; part += kMark + kCode)
      for (const std::string& key : keys_) {
        const std::string mark = mark_of(key);
        if (!std::equal(mark.begin(), mark.end(), part,
                        [](char one, std::uint8_t other) {
                          return static_cast<std::uint8_t>(one) == other;
                        }) ||
            CRYPTO_memcmp(code_of(key, message, covered).data(), part + kMark, kCode) != 0)
          continue;
        std::uint64_t time = 0;
        for (std::size_t i = 0; i < kTime; ++i)
          time |= std::uint64_t{seal[kSubmessageHeader + i]} << 8U * i;
        opened.sealed = static_cast<std::int64_t>(time);
        return opened;
      }
    return opened;
  }
  return {size, std::nullopt};
}

std::string new_site_key() {
  return random_hex(kKeyBytes);
}

std::string site_keys_text(const std::vector<std::string>& keys) {
  return saphira::joined(keys, "\n") + "\n";
}

std::vector<std::string> parse_site_keys(const std::string& text) {
  std::vector<std::string> keys;
  for (const Line& line : split_lines(text)) {
    keys.emplace_back(line.words.front().text);
    if (line.words.size() != 1 || keys.back().size() != 2 * kKeyBytes ||
        keys.size() > Seal::kMostKeys)
      throw std::runtime_error("expected one or two keys of the site");
  }
  if (keys.empty())
    throw std::runtime_error("expected a key of the site");
  return keys;
}

}  // namespace saphira::security

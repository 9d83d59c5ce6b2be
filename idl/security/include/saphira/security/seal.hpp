#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace saphira::security {

/// A seal at the end of an RTPS message, as a submessage of our own, shows that its sender knows a
/// key of the site, before anything else of it is read: the time, and for each key its mark and an
/// HMAC-SHA256 of all before. Others pass over it. A value; from any thread.
class Seal {
 public:
  /// `keys`: of the site; the newest first. Without a key nothing is sealed, and no seal is good.
  explicit Seal(std::vector<std::string> keys) : keys_(std::move(keys)) {}

  bool has_keys() const { return !keys_.empty(); }
  /// Seals a message. time: [s] since 1970.
  void close(std::vector<std::uint8_t>& message, std::int64_t time) const;

  struct Opened {
    std::size_t size = 0;                ///< of the message without its seal
    std::optional<std::int64_t> sealed;  ///< [s] since 1970; none: without a good seal
  };
  Opened open(const std::uint8_t* message, std::size_t size) const;

  static constexpr std::size_t kMostKeys = 2;

 private:
  std::vector<std::string> keys_;
};

/// A new key, and the keys in a file, a line each. std::runtime_error where they are none.
std::string new_site_key();
std::string site_keys_text(const std::vector<std::string>& keys);
std::vector<std::string> parse_site_keys(const std::string& text);

}  // namespace saphira::security

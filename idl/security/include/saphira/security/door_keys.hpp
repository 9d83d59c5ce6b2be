#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::security {

/// The right of a person at a door (the console, MCP over HTTP). Each right includes those before.
enum class DoorRight {
  none,
  watch,   ///< watch and stop
  drive,   ///< drive and talk, and have goals of their own
  operate  ///< also what concerns others: their goals, the emergency stop's reset, micro-tasks
};
const char* name_of(DoorRight right);
/// The role of Person in idl/common.idl, such as agent for drive.
const char* role_of(DoorRight right);

/// The key of one person.
struct DoorKey {
  std::string name;
  DoorRight right = DoorRight::none;
  std::int64_t until = 0;  ///< [s] since 1970, the end of a day
  std::string hash;        ///< SHA-256 of the key, which is random: no guess leads back to it
};

/// The keys of persons, as in a file: a line each, NAME RIGHT LAST-DAY HASH. A value.
class DoorKeys {
 public:
  DoorKeys() = default;
  /// FileError names the line.
  DoorKeys(const std::string& text, const std::string& file);
  std::string text() const;
  const std::vector<DoorKey>& all() const { return keys_; }

  /// The person who has that key, while it holds; nullptr: nobody.
  const DoorKey* find(std::string_view key, std::int64_t now) const;
  /// The person whose key that was, until its end; empty: nobody.
  std::string ended(std::string_view key, std::int64_t now) const;
  /// True while that very key holds, with the same right.
  bool holds(const DoorKey& key, std::int64_t now) const;
  /// Returns the new key. std::invalid_argument for a bad or known name, or a number of days that
  /// is not 1 to 3650.
  std::string add(const std::string& name, DoorRight right, int days, std::int64_t now);
  /// std::invalid_argument that names the known ones where there is no such name.
  void revoke(const std::string& name);

 private:
  std::vector<DoorKey> keys_;
};

/// Where doors look for the file: the user's own (~/.config/saphira/door-keys) and that of the
/// machine (/etc/saphira/door-keys). The first that exists counts.
std::vector<std::string> door_key_files();

/// The file of keys that a door has open. A changed one counts within a second; one with an error
/// does not: the keys before stay.
class DoorKeysFile {
 public:
  explicit DoorKeysFile(std::vector<std::string> candidates = door_key_files())
      : candidates_(std::move(candidates)) {}

  /// Looks for changes; at most once in a second of `now` [s] since 1970. Returns a new trouble in
  /// words; empty: none.
  std::string reload(std::int64_t now);
  const DoorKeys& keys() const { return keys_; }

 private:
  std::vector<std::string> candidates_;
  std::int64_t looked_ = 0;
  std::string text_;
  std::string trouble_;
  DoorKeys keys_;
};

}  // namespace saphira::security

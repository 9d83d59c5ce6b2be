#include "saphira/security/door_keys.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "saphira/base/format.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/digest.hpp"
#include "saphira/security/subject.hpp"

namespace saphira::security {
namespace {

constexpr std::size_t kBytes = 16;       // of a key
constexpr std::int64_t kOneDay = 86400;  // [s]
constexpr int kMostDaysOfKey = 3650;
constexpr std::array kRights{DoorRight::watch, DoorRight::drive, DoorRight::operate};
constexpr const char* kHead =
    "; Keys of persons at the doors (saphira keys): name, right, last day, hash of the key\n";

bool is_hash(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == text.npos;
}

/// The end of that day; none: it is no day.
std::optional<std::int64_t> end_of(const std::string& day) {
  std::tm time{};
  const char* const end = strptime(day.c_str(), "%Y-%m-%d", &time);
  if (end == nullptr || *end != '\0')
    return std::nullopt;
  return timegm(&time) + kOneDay;
}

DoorKey read_key(LineReader line) {
  DoorKey key;
  key.name = line.word("a name");
  if (!is_name(key.name))
    line.fail("expected a name: lower-case letters, digits and hyphens");
  const std::string_view right = line.word("watch, drive or operate");
  for (const DoorRight one : kRights)
    if (right == name_of(one))
      key.right = one;
  if (key.right == DoorRight::none)
    line.fail("expected watch, drive or operate");
  const auto until = end_of(std::string(line.word("the last day")));
  if (!until)
    line.fail("expected a day, such as 2027-05-31");
  key.until = *until;
  key.hash = line.word("the hash of the key");
  if (!is_hash(key.hash))
    line.fail("expected 64 hexadecimal digits");
  line.expect_end();
  return key;
}

}  // namespace

const char* name_of(DoorRight right) {
  constexpr std::array names{"none", "watch", "drive", "operate"};
  return names[static_cast<std::size_t>(right)];
}

const char* role_of(DoorRight right) {
  return right == DoorRight::operate ? "operator"
         : right == DoorRight::drive ? "agent"
                                     : "observer";
}

DoorKeys::DoorKeys(const std::string& text, const std::string& file) {
  expect_last_line_break(text, file);
  for (const Line& line : split_lines(text)) {
    LineReader reader(file, line);
    DoorKey key = read_key(reader);
    if (std::any_of(keys_.begin(), keys_.end(),
                    [&](const DoorKey& other) { return other.name == key.name; })) {
      reader.word("a name");
      reader.fail("this name has a key already");
    }
    keys_.push_back(std::move(key));
  }
}

std::string DoorKeys::text() const {
  std::string text = kHead;
  for (const DoorKey& key : keys_)
    text += key.name + " " + name_of(key.right) + " " + utc_text(key.until - kOneDay, "%Y-%m-%d") +
            " " + key.hash + "\n";
  return text;
}

const DoorKey* DoorKeys::find(std::string_view key, std::int64_t now) const {
  const std::string hash = key.size() == 2 * kBytes ? sha256(key) : "";
  const auto found = std::find_if(keys_.begin(), keys_.end(), [&](const DoorKey& one) {
    return one.hash == hash && now < one.until;
  });
  return found == keys_.end() ? nullptr : &*found;
}

std::string DoorKeys::ended(std::string_view key, std::int64_t now) const {
  const DoorKey* const owner = find(key, 0);
  return owner == nullptr || now < owner->until ? "" : owner->name;
}

bool DoorKeys::holds(const DoorKey& key, std::int64_t now) const {
  return std::any_of(keys_.begin(), keys_.end(), [&](const DoorKey& one) {
    return one.name == key.name && one.hash == key.hash && one.right == key.right &&
           now < one.until;
  });
}

std::string DoorKeys::add(const std::string& name, DoorRight right, int days, std::int64_t now) {
  if (!is_name(name))
    throw std::invalid_argument(
        "a name has up to 32 lower-case letters, digits and hyphens, a letter first");
  if (days < 1 || days > kMostDaysOfKey)
    throw std::invalid_argument("a key holds for 1 to " + std::to_string(kMostDaysOfKey) + " days");
  if (std::any_of(keys_.begin(), keys_.end(), [&](const DoorKey& one) { return one.name == name; }))
    throw std::invalid_argument(name + " has a key; for another one: saphira keys revoke " + name);
  std::string key = random_hex(kBytes);
  keys_.push_back({name, right, (now / kOneDay + days + 1) * kOneDay, sha256(key)});
  return key;
}

void DoorKeys::revoke(const std::string& name) {
  if (std::erase_if(keys_, [&](const DoorKey& one) { return one.name == name; }) == 0)
    throw std::invalid_argument(
        name + " has no key; " +
        (keys_.empty()
             ? "nobody has"
             : "these have: " + joined(keys_, ", ", [](const DoorKey& one) { return one.name; })));
}

std::vector<std::string> door_key_files() {
  std::vector<std::string> files;
  if (const std::string own = user_folder(); !own.empty())
    files.push_back(own + "/door-keys");
  files.emplace_back("/etc/saphira/door-keys");
  return files;
}

std::string DoorKeysFile::reload(std::int64_t now) {
  if (now == looked_)
    return {};
  looked_ = now;
  const auto file = std::find_if(candidates_.begin(), candidates_.end(), [](const auto& one) {
    std::error_code none;
    return std::filesystem::exists(one, none);
  });
  std::string trouble;
  try {
    struct stat state {};
    if (file != candidates_.end() && stat(file->c_str(), &state) == 0 &&
        (state.st_mode & 022U) != 0)
      throw UnusableFile(*file + ": others may change it; chmod go-w it");
    std::string text = file == candidates_.end() ? "" : read_file(*file);
    if (text != text_)
      keys_ = DoorKeys(text, file == candidates_.end() ? "" : *file);
    text_ = std::move(text);
  } catch (const std::runtime_error& error) {
    trouble = std::string(error.what()) + "\nThe keys of persons stay as they were.";
  }
  return trouble == trouble_ ? "" : trouble_ = trouble;
}

}  // namespace saphira::security

#include "saphira/security/audit_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "saphira/base/durable.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/printable.hpp"
#include "saphira/base/text.hpp"
#include "saphira/security/digest.hpp"

namespace saphira::security {
namespace {

namespace fs = std::filesystem;

constexpr double kRepeats = 10.0;  // [s]
constexpr std::size_t kRecent = 32;
constexpr std::size_t kLongest = 500;  // [bytes] of who, and of what

/// A whole line.
struct WholeLine {
  std::uint64_t number = 0;
  std::string_view text;  ///< before the hash
  std::string_view hash;
};

std::optional<WholeLine> entry_of(std::string_view line) {
  const std::size_t tab = line.rfind('\t');
  const auto number =
      number_in<std::uint64_t>(line.substr(0, std::min(line.find('\t'), line.size())));
  if (tab == line.npos || !number)
    return std::nullopt;
  return WholeLine{*number, line.substr(0, tab), line.substr(tab + 1)};
}

std::string chained(std::string_view text, std::string_view before) {
  return sha256(std::string(text) + "\n" + std::string(before));
}

std::string part(const std::string& path, int number) {
  return number == 0 ? path : path + "." + std::to_string(number);
}

std::string head_of(std::uint64_t number, const std::string& hash) {
  return std::to_string(number) + "\t" + hash + "\n";
}

bool is_there(const std::string& path) {
  std::error_code none;
  return fs::exists(path, none);
}

}  // namespace

const char* name_of(AuditEntry::Act act) {
  constexpr std::array names{"drove",   "stopped",  "reset",   "asked",
                             "changed", "canceled", "refused", "let in"};
  return names[static_cast<std::size_t>(act)];
}

AuditFile::AuditFile(std::string path, std::size_t most) : path_(std::move(path)), most_(most) {
  // The head counts where the lines are damaged: the check shows that.
  if (is_there(path_ + ".head"))
    if (const std::string head = read_bytes(path_ + ".head"); !head.empty())
      if (const auto entry = entry_of(std::string_view(head).substr(0, head.size() - 1))) {
        number_ = entry->number;
        hash_ = entry->hash;
      }
  if (!is_there(path_))
    return;
  const std::string text = read_bytes(path_);
  size_ = text.rfind('\n') == text.npos ? 0 : text.rfind('\n') + 1;
  if (size_ < text.size())
    fs::resize_file(path_, size_);
  // A line may have come before a crash, and its head not.
  const std::string_view whole(text.data(), size_);
  const std::size_t begin = size_ < 2 ? 0 : whole.rfind('\n', size_ - 2) + 1;
  if (const auto last = entry_of(whole.substr(begin, whole.size() - std::min(begin + 1, size_)));
      last && last->number == number_ + 1 && last->hash == chained(last->text, hash_)) {
    number_ = last->number;
    hash_ = last->hash;
  }
}

bool AuditFile::rotate() {
  for (int number = kParts; number > 0; --number)
    if (is_there(part(path_, number - 1)) &&
        std::rename(part(path_, number - 1).c_str(), part(path_, number).c_str()) != 0)
      return false;
  size_ = 0;
  return true;
}

std::string AuditFile::write(const AuditEntry& entry, double time) {
  std::erase_if(recent_, [&](const Recent& one) { return time - one.time >= kRepeats; });
  if (std::any_of(recent_.begin(), recent_.end(),
                  [&](const Recent& one) { return one.entry == entry; }))
    return {};
  const auto field = [](const std::string& text) {
    return printable(first_letters(text, kLongest));
  };
  const std::string text = std::to_string(number_ + 1) + "\t" +
                           utc_text(static_cast<std::int64_t>(time), "%Y-%m-%dT%H:%M:%SZ") + "\t" +
                           name_of(entry.act) + "\t" + field(entry.who) + "\t" + field(entry.text);
  std::string hash = chained(text, hash_);
  const std::string line = text + "\t" + hash + "\n";
  if (size_ > 0 && size_ + line.size() > most_ && !rotate())
    return cannot_be(path_, "renamed");
  const int file = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0)
    return cannot_be(path_, "opened");
  const ssize_t written = ::write(file, line.data(), line.size());
  const bool whole = written == static_cast<ssize_t>(line.size());
  const std::string trouble = whole ? "" : cannot_be(path_, "written");
  if (!whole && written > 0 && ftruncate(file, static_cast<off_t>(size_)) != 0)
    size_ = most_;  // half a line stays: the next one begins a part
  close(file);
  if (!whole)
    return trouble;
  size_ += line.size();
  ++number_;
  hash_ = std::move(hash);
  if (recent_.size() >= kRecent)
    recent_.erase(recent_.begin());
  recent_.push_back({entry, time});
  return replace_file(path_ + ".head", head_of(number_, hash_))
             ? ""
             : cannot_be(path_ + ".head", "written");
}

AuditRecord read_audit(const std::string& path, const std::string& known) {
  AuditRecord record;
  const auto note = [&](const std::string& trouble) {
    if (record.trouble.empty())
      record.trouble = trouble;
  };
  int oldest = AuditFile::kParts;
  while (oldest > 0 && !is_there(part(path, oldest)))
    --oldest;
  if (oldest == 0 && !is_there(path))
    throw UnusableFile(path + ": there is no audit");
  std::string head;
  if (is_there(path + ".head"))
    head = read_bytes(path + ".head");
  bool has_head = false;
  bool has_known = known.empty();
  bool first = true;
  for (int number = oldest; number >= 0; --number) {
    const std::string file = part(path, number);
    if (!is_there(file)) {
      if (number > 0)
        note(file + " is missing");
      continue;
    }
    const std::string text = read_bytes(file);
    int row = 0;
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t length = rest.find('\n');
      const std::string_view line = rest.substr(0, length);
      rest.remove_prefix(length == rest.npos ? rest.size() : length + 1);
      const std::string place = file + ":" + std::to_string(++row);
      const auto entry = length == rest.npos ? std::nullopt : entry_of(line);
      if (!entry) {
        note(place + ": this is no whole entry");
        continue;
      }
      // The entries before the oldest part have ended with it, and no other way.
      const bool begins = first && oldest == AuditFile::kParts;
      if (first && !begins && entry->number != 1)
        note(place + ": entry " + std::to_string(entry->number) + " is the first: those before " +
             "were cut off");
      else if (!first && entry->number != record.number + 1)
        note(place + ": entry " + std::to_string(entry->number) + " follows entry " +
             std::to_string(record.number));
      else if (!begins && entry->hash != chained(entry->text, record.hash))
        note(place + ": entry " + std::to_string(entry->number) +
             " or the one before it was changed");
      first = false;
      record.number = entry->number;
      record.hash = entry->hash;
      record.lines.emplace_back(entry->text);
      has_head = has_head || head == head_of(record.number, record.hash);
      has_known = has_known || record.hash == known;
    }
  }
  if (!has_head)
    note(path + ".head names an entry that is not there: the end was cut off or changed");
  if (!has_known)
    note("no entry has the hash " + known +
         ": the audit was written anew, or has ended with its "
         "oldest part");
  return record;
}

}  // namespace saphira::security

#include "saphira/security/audit_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "saphira/base/descriptor.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/enumerators.hpp"
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
constexpr std::size_t kLongest = 500;    // [bytes] of who, and of what
constexpr const char* kEnded = "ended";  // the act of the audit itself
constexpr off_t kRoom = 1 << 15;         // [bytes]

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

const char* name_of(v1::AuditAct act) {
  return word_of(
      act, {"drove", "stopped", "reset", "asked", "changed", "canceled", "refused", "let in"});
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
  // Lines may have come before a crash or on a full disk, and their head not.
  for (std::string_view rest = std::string_view(text).substr(0, size_); !rest.empty();) {
    const std::size_t length = rest.find('\n');
    const auto entry = entry_of(rest.substr(0, length));
    rest.remove_prefix(length + 1);
    if (entry && entry->number == number_ + 1 && entry->hash == chained(entry->text, hash_)) {
      number_ = entry->number;
      hash_ = entry->hash;
    }
  }
}

std::string AuditFile::rotate(double time) {
  const std::string oldest = part(path_, kParts);
  if (is_there(oldest)) {
    std::string text = read_bytes(oldest);
    text.resize(text.size() - (text.ends_with('\n') ? 1 : 0));
    const auto last = entry_of(std::string_view(text).substr(text.rfind('\n') + 1));
    if (last)
      if (std::string trouble =
              append(kEnded, "the audit",
                     std::to_string(last->number) + " " + std::string(last->hash), time);
          !trouble.empty())
        return trouble;
  }
  for (int number = kParts; number > 0; --number)
    if (is_there(part(path_, number - 1)) &&
        std::rename(part(path_, number - 1).c_str(), part(path_, number).c_str()) != 0)
      return cannot_be(path_, "renamed");
  size_ = 0;
  return {};
}

std::string AuditFile::write(v1::AuditEntry entry, double time) {
  entry.time_ns = 0;
  std::erase_if(recent_, [&](const Recent& one) { return time - one.time >= kRepeats; });
  if (std::any_of(recent_.begin(), recent_.end(),
                  [&](const Recent& one) { return one.entry == entry; }))
    return {};
  if (recent_.size() >= kRecent)
    recent_.erase(recent_.begin());
  recent_.push_back({entry, time});
  if (waiting_.size() < kMostWaiting)
    waiting_.push_back({entry, time});
  else
    ++lost_;
  return write_waiting(time);
}

std::string AuditFile::tend(double time) {
  // Room for the next lines on a disk that is full by then. Not every file system has that.
  const Descriptor file = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  fallocate(file, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(size_), kRoom);
  return write_waiting(time);
}

std::string AuditFile::write_waiting(double time) {
  const auto put = [&](const v1::AuditEntry& entry, double then) {
    std::string trouble = size_ > most_ ? rotate(then) : "";
    return trouble.empty() ? append(name_of(entry.act), entry.who, entry.text, then) : trouble;
  };
  for (; !waiting_.empty(); waiting_.pop_front())
    if (std::string trouble = put(waiting_.front().entry, waiting_.front().time); !trouble.empty())
      return trouble;
  if (lost_ > 0) {
    const v1::AuditEntry gap{
        .act = v1::AUDIT_REFUSED,
        .who = "the audit",
        .text = std::to_string(lost_) + " later entries had no room on the disk"};
    if (std::string trouble = put(gap, time); !trouble.empty())
      return trouble;
    lost_ = 0;
  }
  return keep_head() ? "" : cannot_be(path_ + ".head", "written");
}

bool AuditFile::keep_head() {
  const std::string head = head_of(number_, hash_);
  if (head == head_)
    return true;
  if (!replace_file(path_ + ".head", head)) {
    const int why = errno;
    const Descriptor file = open((path_ + ".head").c_str(), O_WRONLY | O_CLOEXEC);
    const bool written = overwrite(file, head);
    errno = why;
    if (!written)
      return false;
  }
  head_ = head;
  return true;
}

std::string AuditFile::append(const std::string& act, const std::string& who,
                              const std::string& what, double time) {
  const auto field = [](const std::string& part) {
    return printable(first_letters(part, kLongest));
  };
  const std::string text = std::to_string(number_ + 1) + "\t" +
                           utc_text(static_cast<std::int64_t>(time), "%Y-%m-%dT%H:%M:%SZ") + "\t" +
                           act + "\t" + field(who) + "\t" + field(what);
  std::string hash = chained(text, hash_);
  const std::string line = text + "\t" + hash + "\n";
  const Descriptor file = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0)
    return cannot_be(path_, "opened");
  const ssize_t written = ::write(file, line.data(), line.size());
  const bool whole = written == static_cast<ssize_t>(line.size());
  const std::string trouble = whole ? "" : cannot_be(path_, "written");
  if (!whole && written > 0 && ftruncate(file, static_cast<off_t>(size_)) != 0)
    size_ = most_ + 1;  // half a line stays: the next one begins a part
  if (!whole)
    return trouble;
  size_ += line.size();
  ++number_;
  hash_ = std::move(hash);
  return {};
}

namespace {

/// The first entry that is there.
struct Begin {
  std::string place;
  std::uint64_t number = 0;
  std::string text;
  std::string hash;
};

/// The number and hash in an entry of the audit itself about a part that ends.
std::optional<std::pair<std::uint64_t, std::string>> ended_in(std::string_view text) {
  const std::string begin = std::string("\t") + kEnded + "\tthe audit\t";
  const std::size_t at = text.find('\t', text.find('\t') + 1);  // behind the time
  if (at == text.npos || !text.substr(at).starts_with(begin))
    return std::nullopt;
  const std::string_view last = text.substr(at + begin.size());
  const std::size_t blank = std::min(last.find(' '), last.size());
  const auto number = number_in<std::uint64_t>(last.substr(0, blank));
  if (!number || blank == last.size())
    return std::nullopt;
  return std::pair(*number, std::string(last.substr(blank + 1)));
}

/// A sign that entries before it were cut off, or that it was changed.
std::string trouble_of(const Begin& begin, const std::map<std::uint64_t, std::string>& ended,
                       bool cut, std::uint64_t& vouched_from) {
  const std::string entry = begin.place + ": entry " + std::to_string(begin.number);
  const auto before = ended.find(begin.number - 1);
  vouched_from = begin.number;
  if (begin.number == 1 || before != ended.end())
    return begin.hash == chained(begin.text, begin.number == 1 ? "" : before->second)
               ? ""
               : entry + " was changed";
  // An earlier version ended parts without a word.
  if (cut && (ended.empty() || begin.number <= ended.begin()->first)) {
    ++vouched_from;
    return {};
  }
  return entry + " is the first: those before were cut off";
}

}  // namespace

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
  std::optional<Begin> begin;
  std::map<std::uint64_t, std::string> ended;  // the last entries of ended parts, with their hashes
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
      if (!begin)
        begin = Begin{place, entry->number, std::string(entry->text), std::string(entry->hash)};
      else if (entry->number != record.number + 1)
        note(place + ": entry " + std::to_string(entry->number) + " follows entry " +
             std::to_string(record.number));
      else if (entry->hash != chained(entry->text, record.hash))
        note(place + ": entry " + std::to_string(entry->number) +
             " or the one before it was changed");
      if (const auto last = ended_in(entry->text))
        ended.insert(*last);
      record.number = entry->number;
      record.hash = entry->hash;
      record.lines.emplace_back(entry->text);
      has_head = has_head || head == head_of(record.number, record.hash);
      has_known = has_known || record.hash == known;
    }
  }
  if (begin)
    note(trouble_of(*begin, ended, oldest == AuditFile::kParts, record.vouched_from));
  const bool empty = record.number == 0 && (head.empty() || head == head_of(0, {}));
  if (!has_head && !empty)
    note(path + ".head names an entry that is not there: the end was cut off or changed");
  if (!has_known)
    note("no entry has the hash " + known +
         ": the audit was written anew, or has ended with its "
         "oldest part");
  return record;
}

}  // namespace saphira::security

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "saphira/idl/system.hpp"

namespace saphira::security {

const char* name_of(v1::AuditAct act);

/// The audit of a robot, a line an entry: NUMBER TIME ACT WHO TEXT HASH, with tabs between. The
/// hash is the SHA-256 of the line before it and of the hash of the entry before. The file PATH
/// grows to `most` bytes and becomes PATH.1, PATH.1 becomes PATH.2, and so on; PATH.8 ends. Before
/// that an entry "ended" has the number and hash of its last entry, so that a cut at the beginning
/// shows. PATH.head has those of the newest entry, so that a cut at the end shows.
class AuditFile {
 public:
  static constexpr int kParts = 8;  ///< beside the one that grows
  static constexpr std::size_t kMost = 1'000'000;

  /// Goes on where the file ends; half a line, as a power cut leaves it, is taken away. Nothing is
  /// written before the first entry.
  explicit AuditFile(std::string path, std::size_t most = kMost);

  /// time: [s] since 1970, instead of the entry's own. An entry that repeats one of the last 10 s
  /// is left out. Returns the reason why it was not written, in words; empty: it was. On a full
  /// disk it waits for tend().
  std::string write(v1::AuditEntry entry, double time);
  /// Writes what waits, and keeps room for the next entries. Now and then.
  std::string tend(double time);

  static constexpr std::size_t kMostWaiting =
      1000;  ///< entries; the others are counted in an entry

 private:
  std::string rotate(double time);
  std::string write_waiting(double time);
  std::string append(const std::string& act, const std::string& who, const std::string& text,
                     double time);
  bool keep_head();

  std::string path_;
  std::size_t most_;
  std::size_t size_ = 0;
  std::uint64_t number_ = 0;  ///< of the newest entry
  std::string hash_;          ///< likewise
  std::string head_;          ///< as written last
  struct Recent {
    v1::AuditEntry entry;
    double time = 0.0;
  };
  std::vector<Recent> recent_;
  std::deque<Recent> waiting_;
  std::size_t lost_ = 0;  ///< behind them
};

/// An audit as it was found.
struct AuditRecord {
  std::vector<std::string> lines;  ///< oldest first, without their hashes
  std::uint64_t number = 0;        ///< of the newest entry; 0: none
  std::string hash;                ///< likewise
  /// The first entry that cannot have been changed unseen. Later than the first one of the lines
  /// where an earlier version cut the chain.
  std::uint64_t vouched_from = 0;
  std::string trouble;  ///< the first sign of a change or a cut; empty: none
};

/// Reads all parts. known: the hash of an entry that somebody has noted elsewhere, which has to be
/// there [empty: none]. UnusableFile where there is no audit.
AuditRecord read_audit(const std::string& path, const std::string& known = {});

}  // namespace saphira::security

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

/// Programs' own files, kept over a restart or a crash. Checksums detect a damaged file (a bad
/// disk, a power cut, an editor); it is set aside and begun anew. No state is worth a refusal to
/// start; but a file of another kind, which a person named by mistake, stays as it is.
namespace saphira {

/// A program that only checks its input (--dry-run) leaves files as they are: kStay.
enum class Files { kChange, kStay };

/// The text behind its checksum, with a line break: "9ae16a3b {...}". A file, or a line of one.
std::string sealed(std::string_view text);
/// The sealed text; none where it has changed or is not whole.
std::optional<std::string_view> unsealed(std::string_view text);
/// The same, or a FileError.
std::string_view unsealed(std::string_view text, const std::string& file);

/// True for a content that was sealed before its damage, by its beginning, and for zero bytes
/// alone, as a power cut leaves them.
bool was_sealed(std::string_view content);

/// Gives the content of a file to `understand`. Where that throws, or the file cannot be read, the
/// file is set aside as "FILE.damaged" (where files stay, it is only said). Returns the error and
/// the consequence, in words. Empty without an error, and for a missing or empty file.
/// std::invalid_argument for a content that never was sealed: the file is left as it is.
std::string read_or_set_aside(const std::string& path,
                              const std::function<void(const std::string& content)>& understand,
                              Files files = Files::kChange);

/// Replaces a file: a crash leaves the old one or the new one, whole. `sync`: also a power cut
/// does, at the cost of disk time. False where it cannot be written: errno gives the reason, and
/// the old file is unchanged. A name that exists must be that of a regular file (a folder: EISDIR;
/// a device, pipe or socket: ENOTSUP).
bool replace_file(const std::string& path, std::string_view text, bool sync = false);

/// The whole content of an open file, in the place of the former one: that has room on a full disk.
/// False, with errno, where it cannot be written.
bool overwrite(int fd, std::string_view text);

/// True where replace_file could begin to write the file, which stays as it is. Otherwise errno
/// gives the reason. Where files stay, no file is begun beside it: its folder tells.
bool can_replace_file(const std::string& path, Files files = Files::kChange);

}  // namespace saphira

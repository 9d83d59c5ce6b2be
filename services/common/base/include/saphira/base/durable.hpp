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

/// The line behind its checksum: "9ae16a3b placed ...".
std::string sealed_line(std::string_view line);
/// The sealed text; none where it has changed.
std::optional<std::string_view> unsealed_line(std::string_view line);

/// A text that ends with a line break, between a first line that marks our files and a last line
/// with its sum. Both are comments of our files: "; memory of saphira", "; sum 1f2e3d4c5b6a7988".
std::string sealed(const std::string& text);
/// The sealed text. FileError where it has changed or is not whole.
std::string_view unsealed(std::string_view text, const std::string& file);

/// True for a content that was sealed, or has sealed lines, before its damage: one of its marks is
/// there, in the first line at least its beginning. Also true for zero bytes alone, as a power cut
/// leaves them.
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

/// True where replace_file could begin to write the file, which stays as it is. Otherwise errno
/// gives the reason. Where files stay, no file is begun beside it: its folder tells.
bool can_replace_file(const std::string& path, Files files = Files::kChange);

}  // namespace saphira

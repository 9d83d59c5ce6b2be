#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

/// Files that programs keep for themselves over a restart or a crash. A file that was
/// damaged (a bad disk, a power cut, somebody's editor) is noticed by its sums, set aside and begun
/// anew: no state is worth not starting for.
namespace saphira {

/// The line behind the sum of its letters: "9ae16a3b placed ...".
std::string sealed_line(std::string_view line);
/// The sealed text; none where it has changed.
std::optional<std::string_view> unsealed_line(std::string_view line);

/// A text that ends with a line break, and a last line with its sum. The line is a comment of our
/// files: "; sum 1f2e3d4c5b6a7988".
std::string sealed(std::string text);
/// The sealed text. FileError where it has changed or is not whole.
std::string_view unsealed(std::string_view text, const std::string& file);

/// Gives the content of a file to `understand`. Where that throws, or the file cannot be read, the
/// file is set aside as "FILE.damaged"; what was wrong, and what became of it, in words. Empty
/// where nothing was wrong, or there is no such file, or it is empty.
std::string read_or_set_aside(const std::string& path,
                              const std::function<void(const std::string& content)>& understand);

/// Puts a text in the place of a file: a crash leaves the old one or the new one, whole. `sync`:
/// also a power cut does, which costs the time of the disk. False where it cannot be written: errno
/// says why, and the old one is as it was.
bool replace_file(const std::string& path, std::string_view text, bool sync = false);

}  // namespace saphira

#pragma once

#include <array>
#include <string>
#include <vector>

#include "saphira/situation/situation.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::cli {

// The same wording for the robot and its programs in every command.
using situation::describe;
using situation::kLostAge;
using situation::latched;
using situation::name_of;
using SeenProcess = situation::Program;

/// Text in aligned columns; numbers (a leading digit) to the right. The first row is the heading.
/// The last column is not padded. Ends with a line break.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// The text on two lines of at most that many characters, divided at a word.
std::array<std::string, 2> two_lines(const std::string& text, std::size_t width);

/// The table of processes, sorted by name; after them those of `unheard` that are not among them.
std::string status_table(std::vector<SeenProcess> processes,
                         const std::vector<std::string>& unheard = {});

/// std::invalid_argument unless the file to be written has the ending of its content.
void expect_ending(const std::string& path, const std::string& ending);

}  // namespace saphira::cli

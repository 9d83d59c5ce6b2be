#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/text.hpp"
#include "saphira/behaviors/behavior.hpp"

// The behavior language (manual 7.2, 7.3): what config/behaviors/*.beh are written in. The whole of
// it is described in services/behaviors/LANGUAGE.md.
namespace saphira::behaviors {

/// The result of compiling a text in the behavior language.
struct Compiled {
  std::vector<Schema> schemas;      ///< in the order of the text; none where there are errors
  std::vector<FileError> errors;    ///< in the order of the text, at most twenty
  std::vector<FileError> warnings;  ///< what can be taken, and is probably a mistake
};

/// Compiles the behaviors of a text. `file` is what messages call it.
Compiled compile(std::string_view text, const std::string& file);

/// For people: every function that Update and Init can call, a line each.
std::vector<std::string> language_functions();

}  // namespace saphira::behaviors

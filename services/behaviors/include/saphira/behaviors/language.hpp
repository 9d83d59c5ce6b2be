#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "saphira/base/text.hpp"
#include "saphira/behaviors/behavior.hpp"

// The behavior language (manual 7.2, 7.3) of config/behaviors/*.beh. Full description:
// services/behaviors/LANGUAGE.md.
namespace saphira::behaviors {

/// The result of compiling a text in the behavior language.
struct Compiled {
  std::vector<Schema> schemas;      ///< in the order of the text; none where there are errors
  std::vector<FileError> errors;    ///< in the order of the text, at most twenty
  std::vector<FileError> warnings;  ///< acceptable, and probably mistakes
};

/// Compiles the behaviors of a text. `file` is its name in messages.
Compiled compile(std::string_view text, const std::string& file);

}  // namespace saphira::behaviors

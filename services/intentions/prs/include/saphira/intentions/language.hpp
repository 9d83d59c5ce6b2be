#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// A mistake in a file of activities, or a doubtful place.
struct Diagnostic {
  bool error = true;  ///< the file is not taken; otherwise a warning
  std::string file;
  int line = 1;    ///< from 1
  int column = 1;  ///< from 1
  std::string message;
  std::string line_text;

  /// As compilers print it, with the line and a caret (FileError).
  std::string text() const;
};

/// The result of loading files of activities.
struct Loaded {
  /// Those of the files without an error.
  std::vector<Schema> schemas;
  std::vector<Diagnostic> troubles;  ///< in the order of the files

  bool ok() const;  ///< no error
};

struct ActivityFile {
  std::string name;  ///< for messages
  std::string content;
};

/// Compiles activities (paper 3.3, Figure 9; the language in README.md). Nothing of a file with an
/// error is given, so that what runs goes on. Activities may name each other across the files and
/// what `known` has; what is named and is neither there nor a behavior that is known is an error,
/// or a warning as long as behaviors are not known (Registry::know_behaviors). One of a file may
/// cover one of another file that is known, but none that is built in.
Loaded load_activities(const std::vector<ActivityFile>& files, const Functions& functions,
                       const Registry& known);
Loaded load_text(const std::string& file, std::string_view content, const Functions& functions,
                 const Registry& known);

/// Checks what compiled schemas name against the registry as it is now: for when behaviors have
/// become known, or a schema changed its parameters.
std::vector<Diagnostic> check_references(const Registry& registry);

}  // namespace saphira::intentions

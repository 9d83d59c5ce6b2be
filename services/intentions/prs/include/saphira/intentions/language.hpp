#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saphira/intentions/functions.hpp"
#include "saphira/intentions/schema.hpp"

namespace saphira::intentions {

/// An error or a warning in a file of activities.
struct Diagnostic {
  bool error = true;  ///< the file is rejected; false: a warning
  std::string file;
  int line = 1;    ///< from 1
  int column = 1;  ///< from 1
  std::string message;
  std::string line_text;

  /// In the form of compiler messages, with the line and a caret (FileError).
  std::string text() const;
};

/// The result of loading files of activities.
struct Loaded {
  /// The schemas of the files without an error.
  std::vector<Schema> schemas;
  std::vector<Diagnostic> troubles;  ///< in the order of the files

  bool ok() const;  ///< no error
};

struct ActivityFile {
  std::string name;  ///< for messages
  std::string content;
};

/// Compiles activities (paper 3.3, Figure 9; the language in README.md). A file with an error gives
/// nothing, so that running activities continue. Activities may name each other across the files,
/// and the schemas of `known`. An unknown name that is not a known behavior either is an error, or
/// a warning while behaviors are unknown (Registry::know_behaviors). An activity of a file may
/// cover a known one of another file, but not a built-in one.
Loaded load_activities(const std::vector<ActivityFile>& files, const Functions& functions,
                       const Registry& known);

/// Checks the names in compiled schemas against the present registry: for newly known behaviors, or
/// changed parameters of a schema.
std::vector<Diagnostic> check_references(const Registry& registry);

}  // namespace saphira::intentions

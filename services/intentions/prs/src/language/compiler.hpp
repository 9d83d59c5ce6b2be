#pragma once

#include <optional>
#include <string>
#include <vector>

#include "language/program.hpp"
#include "language/reader.hpp"

namespace saphira::intentions {

/// Compiles one (defintention ...) that `reader` read from `file`; nothing after an error, which is
/// then in `troubles`.
std::optional<Schema> compile_activity(const Form& form, const std::string& file,
                                       const Reader& reader, const Functions& functions,
                                       std::vector<Diagnostic>& troubles);

}  // namespace saphira::intentions

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "language/program.hpp"
#include "language/reader.hpp"

namespace saphira::intentions {

/// Compiles one (defintention ...) that `reader` read from `file`; nothing where there was a
/// mistake, which is in `troubles` then.
std::optional<Schema> compile_activity(const Form& form, const std::string& file,
                                       const Reader& reader, const Functions& functions,
                                       std::vector<Diagnostic>& troubles);

}  // namespace saphira::intentions

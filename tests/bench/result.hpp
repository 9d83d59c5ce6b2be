#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>

namespace saphira::bench {

/// Prints the figures of a benchmark: on one line for programs (--json), else one below the other.
inline void print(const nlohmann::json& figures, bool json) {
  std::puts(figures.dump(json ? -1 : 2).c_str());
}

}  // namespace saphira::bench

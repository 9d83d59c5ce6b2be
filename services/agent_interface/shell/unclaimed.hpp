#pragma once

#include <chrono>

namespace saphira::agent_interface {

/// A goal that no program has taken up by then is withdrawn.
inline constexpr std::chrono::seconds kTakenUp{5};
inline constexpr const char* kNotTakenUp =
    "no program has taken up the goal: saphira status shows whether intentions runs";

}  // namespace saphira::agent_interface

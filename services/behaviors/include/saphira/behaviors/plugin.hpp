#pragma once

#include "saphira/behaviors/behavior.hpp"

// Behaviors in C++ that are loaded at run time: a shared library with these two names. See
// services/behaviors/examples.
namespace saphira::behaviors {

/// Changes with the part of this library that plug-ins use.
inline constexpr int kPluginVersion = 2;

}  // namespace saphira::behaviors

extern "C" {
/// kPluginVersion, as compiled into the plug-in.
/// NOLINTNEXTLINE(readability-identifier-naming): a symbol that the loader looks up
extern const int saphira_behaviors_plugin;
/// Adds the plug-in's schemas.
void saphira_register_behaviors(saphira::behaviors::Registry& registry);
}

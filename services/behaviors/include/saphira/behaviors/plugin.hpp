#pragma once

#include "saphira/behaviors/behavior.hpp"

// Behaviors in C++ that are loaded at run time: a shared library that has these two names. See
// services/behaviors/examples.
namespace saphira::behaviors {

/// Changes when what plug-ins see of this library changes.
inline constexpr int kPluginVersion = 1;

}  // namespace saphira::behaviors

extern "C" {
/// To be kPluginVersion, as the plug-in was compiled with it.
// NOLINTNEXTLINE(readability-identifier-naming): a symbol by which others find it
extern const int saphira_behaviors_plugin;
/// Adds the plug-in's schemas.
void saphira_register_behaviors(saphira::behaviors::Registry& registry);
}

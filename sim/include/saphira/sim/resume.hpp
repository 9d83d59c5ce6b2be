#pragma once

#include <string>
#include <string_view>

#include "saphira/sim/scene.hpp"

namespace saphira::sim {

/// The places of all that moves, for a simulator that goes on where this one ends. `world`: the
/// names of its files.
std::string places_text(const Scene& scene, const std::string& world);

/// Puts everything at its place again. Returns what has none, in words; empty: nothing.
/// std::runtime_error where the text is not of places_text(); of another world nothing is changed.
std::string resume(Scene& scene, std::string_view text, const std::string& world);

}  // namespace saphira::sim

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "saphira/sim/world.hpp"

namespace saphira::sim {

// Of the numbers in a world file.
inline constexpr double kMillimetre = 0.001;  // [m]
inline constexpr double kMax = 1e7;           // [mm] 10 km: more is a typing error

// The error of a start, a person, a leg of her way, a door, a box or a post whose numbers are each
// valid by themselves; nothing without an error.

std::optional<std::string> trouble_of_start(const World& world, const Pose& start_in_world);
std::optional<std::string> trouble_of_person(const World& world, std::size_t person);
/// Of the way to the target of that line of her script, in the first round and in later ones.
std::optional<std::string> trouble_of_leg(const World& world, std::size_t person, std::size_t leg);
/// Of the way from the end of her script to its beginning.
std::optional<std::string> trouble_of_repeat(const World& world, std::size_t person);
std::optional<std::string> trouble_of_door(const World& world, std::size_t door);
std::optional<std::string> trouble_of_box(const World& world, std::size_t box);
std::optional<std::string> trouble_of_post(const World& world, std::size_t post);

}  // namespace saphira::sim

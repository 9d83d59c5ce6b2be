#pragma once

#include <utility>

#include "saphira/sim/scene.hpp"

namespace saphira::sim {

struct OwnWorld {
  World own_world;
};

/// A scene with a world of its own.
struct WorldScene : private OwnWorld, public Scene {
  explicit WorldScene(World made) : OwnWorld{std::move(made)}, Scene(own_world) {}
};

}  // namespace saphira::sim

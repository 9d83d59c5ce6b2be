#pragma once

#include <string>
#include <utility>

#include "saphira/sim/scene.hpp"
#include "saphira/sim/sonar.hpp"

namespace saphira::sim {

/// A room of 10 m, and things in it.
inline World room(const std::string& things = {}) {
  return parse_world(
      "width 10000 height 10000 0 0 10000 0 10000 0 10000 10000 10000 10000 0 10000 0 10000 0 0\n" +
          things,
      "things.wld");
}

inline protocol::RobotParameters one_sonar(double x = 0.0, double th = 0.0) {
  protocol::RobotParameters parameters;
  parameters.sonars.push_back({0, {x, 0.0, radians(th)}});
  return parameters;
}

/// Sonars without noise.
inline SonarModel exact(double strength = 40.0) {
  SonarModel model;
  model.strength = strength;
  model.noise = model.relative_noise = model.dropout = model.roughness = model.crosstalk =
      model.spread = model.soft_spread = 0.0;
  return model;
}

struct OwnWorld {
  World own_world;
};

/// A scene with a world of its own.
struct WorldScene : private OwnWorld, public Scene {
  explicit WorldScene(World made) : OwnWorld{std::move(made)}, Scene(own_world) {}
};

}  // namespace saphira::sim

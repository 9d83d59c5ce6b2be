// A world file: it loads or gives a FileError, and a loaded world can be searched.

#include <cmath>

#include "fuzz.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/trace.hpp"
#include "saphira/sim/world.hpp"

void saphira::fuzz::run(std::string_view text) {
  reads([&] {
    const auto world = saphira::sim::parse_world(text, "fuzz.wld");
    const double nearest = saphira::sim::distance(world.segments, {1.0, 1.0});
    const auto hit = saphira::sim::cast_ray(world.segments, {1.0, 1.0}, {1.0, 0.0}, 5.0);
    // The hit of a ray is not nearer than the nearest point (except for rounding, far out).
    require(!std::isnan(nearest) && (!hit || *hit >= nearest - 1e-3));
    saphira::sim::plot_svg(world, {}, 0.2);
    // The scene can run.
    saphira::sim::Scene scene(world);
    for (int i = 0; i < 20; ++i)
      scene.tick();
    require(!std::isnan(scene.distance({1.0, 1.0})));
  });
  reads([&] { saphira::sim::parse_trace(text, "fuzz.csv"); });
}

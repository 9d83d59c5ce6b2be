// A world file: it loads or gives a FileError, and a loaded world can be searched.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saphira/base/text.hpp"
#include "saphira/sim/scene.hpp"
#include "saphira/sim/trace.hpp"
#include "saphira/sim/world.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto world = saphira::sim::parse_world(text, "fuzz.wld");
    const double nearest = saphira::sim::distance(world.segments, {1.0, 1.0});
    const auto hit = saphira::sim::cast_ray(world.segments, {1.0, 1.0}, {1.0, 0.0}, 5.0);
    // The hit of a ray is not nearer than the nearest point (except for rounding, far out).
    if (std::isnan(nearest) || (hit && *hit < nearest - 1e-3))
      std::abort();
    saphira::sim::plot_svg(world, {}, 0.2);
    // The scene can run.
    saphira::sim::Scene scene(world);
    for (int i = 0; i < 20; ++i)
      scene.tick();
    if (std::isnan(scene.distance({1.0, 1.0})))
      std::abort();
  } catch (const saphira::FileError& error) {
    if (error.line() < 1 || error.column() < 1)
      std::abort();
  }
  try {
    saphira::sim::parse_trace(text, "fuzz.csv");
  } catch (const saphira::FileError&) {
    return 0;
  }
  return 0;
}

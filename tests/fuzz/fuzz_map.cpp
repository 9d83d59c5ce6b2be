// A map file: it loads or gives a FileError; a loaded map can be written and read again, searched,
// drawn, used for routes and for registration.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saphira/base/text.hpp"
#include "saphira/maps/drawing.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/registration/line_map.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace saphira;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  maps::Map map;
  try {
    map = maps::parse_map(text, "fuzz.map");
  } catch (const FileError& error) {
    if (error.line() < 1 || error.column() < 1)
      std::abort();
    return 0;
  }
  const maps::Map again = maps::parse_map(maps::to_text(map), "again.map");
  if (again.features.size() != map.features.size())
    std::abort();
  // Everything in it can be part of a map that changes.
  maps::Editor editor;
  for (const maps::Feature& feature : map.features)
    editor.add(feature);
  if (editor.map().features.size() != map.features.size())
    std::abort();
  if (map.features.size() > 40)
    return 0;  // the rest takes long with many
  const maps::Topology topology(map);
  const registration::LineMap lines(map);
  for (const registration::Surface& surface : lines.surfaces())
    if (std::isnan(surface.length) || surface.length < 0.0)
      std::abort();
  for (const maps::Feature& feature : map.features) {
    const maps::RouteResult found = maps::find_route(
        topology, map.features.front().pose_in_map.position(), feature.pose_in_map.position());
    if (found.route ? std::isnan(found.route->length) : found.reason.empty())
      std::abort();
  }
  maps::Drawing drawing;
  drawing.map = map;
  maps::to_svg(drawing);
  return 0;
}

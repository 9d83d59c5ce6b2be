// A map file: it loads or gives a FileError; a loaded map can be written and read again, searched,
// drawn, used for routes and for registration.

#include <cmath>

#include "fuzz.hpp"
#include "saphira/maps/drawing.hpp"
#include "saphira/maps/edit.hpp"
#include "saphira/maps/map.hpp"
#include "saphira/maps/route.hpp"
#include "saphira/registration/line_map.hpp"

void saphira::fuzz::run(std::string_view text) {
  using namespace saphira;
  maps::Map map;
  if (!reads([&] { map = maps::parse_map(text, "fuzz.map"); }))
    return;
  const maps::Map again = maps::parse_map(maps::to_text(map), "again.map");
  require(again.features.size() == map.features.size());
  // Everything in it can be part of a map that changes.
  maps::Editor editor;
  for (const maps::Feature& feature : map.features)
    editor.add(feature);
  require(editor.map().features.size() == map.features.size());
  if (map.features.size() > 40)
    return;  // the rest takes long with many
  const maps::Topology topology(map);
  const registration::LineMap lines(map);
  for (const registration::Surface& surface : lines.surfaces())
    require(surface.length >= 0.0);
  for (const maps::Feature& feature : map.features) {
    const maps::RouteResult found = maps::find_route(
        topology, map.features.front().pose_in_map.position(), feature.pose_in_map.position());
    require(found.route ? !std::isnan(found.route->length) : !found.reason.empty());
  }
  maps::Drawing drawing;
  drawing.map = map;
  maps::to_svg(drawing);
}

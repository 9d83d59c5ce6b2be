#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/maps/artifact_traits.hpp"
#include "saphira/maps/map.hpp"

namespace saphira::maps {

/// A rectangle of the floor: of a corridor or lane, a junction, or a room. A room of several
/// rectangles is several regions of one name.
struct Region {
  RegionKind kind = RegionKind::room;
  /// The artifact. A junction of two corridors that the map does not hold has id 0.
  Feature area;
  std::vector<std::size_t> links;  ///< ways out, by index
};

enum class LinkKind {
  door,
  opening,  ///< a BREAK
  meeting   ///< two regions touch or overlap, with nothing between
};

/// A way from one region into another.
struct Link {
  LinkKind kind = LinkKind::meeting;
  std::uint32_t id = 0;  ///< of the door or break; 0 of a meeting
  Pose pose_in_map;      ///< its middle; of doors and breaks the heading is the normal, towards `a`
  double width = 0.0;    ///< [m] of doors and breaks
  std::size_t a = 0;
  std::optional<std::size_t> b;  ///< none: the other side is not on the map
  std::string name;              ///< of the door or break
};

/// The region or link of a name or an id.
struct Place {
  std::string name;                  ///< as it is called in a message
  std::vector<std::size_t> regions;  ///< any of them is a valid target
  std::optional<Vec2> point;         ///< in the map; none: anywhere inside
};

/// The graph of a map: the regions and their connections. Regions and links keep the order of the
/// map's features; the graph is made anew when the map changes.
class Topology {
 public:
  Topology() = default;
  explicit Topology(const Map& map);

  const std::vector<Region>& regions() const { return regions_; }
  const std::vector<Link>& links() const { return links_; }

  /// Every region that the position lies in; in the order of the regions.
  std::vector<std::size_t> at(const Vec2& position_in_map) const;
  /// The region of a robot at that position: a junction before a corridor before a room; if there
  /// is none, the nearest within `tolerance` [m]. With a tolerance, the open floor beside a lane
  /// counts as its, as far as such lanes are apart.
  std::optional<std::size_t> region_at(const Vec2& position_in_map, double tolerance = 0.0) const;
  /// By the id of an artifact, or by a name: of a region, of a position, of a door, in that order;
  /// with the exact case first, then either case; or by kind and id, "door 12" or "door-12".
  std::optional<Place> place(std::string_view name_or_id) const;
  /// A message that there is no such place, with the most similar name and some of the others.
  std::string no_place(std::string_view name) const;
  /// "corridor 2 (central corridor)".
  std::string text(std::size_t region) const;

 private:
  static std::string text(const Link& link);
  bool walled(const Vec2& from_in_map, const Vec2& to_in_map) const;
  std::optional<Place> place_called(std::string_view name_or_id) const;
  void meet(std::size_t a, std::size_t b);
  void open(const Feature& gate, LinkKind kind);
  void join(Link link);

  std::vector<Region> regions_;
  std::vector<Rectangle> boxes_;  ///< of the regions
  std::vector<Link> links_;
  std::vector<Feature> positions_;
  std::vector<Feature> walls_;
};

/// True where two maps have the same regions, ways and places, so that a plan on one holds on the
/// other: objects, walls and zones may differ.
bool same_places(const Map& a, const Map& b);

/// The four corners of a feature's rectangle, counter-clockwise, made larger by `margin` [m] on
/// every side.
std::vector<Vec2> corners(const Feature& feature, double margin = 0.0);

/// The part of the convex polygon `a` that lies in the convex polygon `b`, both counter-clockwise;
/// empty where they do not overlap.
std::vector<Vec2> overlap(const std::vector<Vec2>& a, const std::vector<Vec2>& b);

/// The reason why a position is not within `margin` [m] of the rectangle round the map, in words;
/// none where it is, and for an empty map.
std::optional<std::string> outside(const Map& map, const Vec2& position, double margin);

/// The end points of the middle line along a feature's heading.
Vec2 begin_of(const Feature& feature);
Vec2 end_of(const Feature& feature);

/// The nearest position on the middle line of a feature, which ends `margin` [m] before its ends.
Vec2 on_axis(const Feature& feature, const Vec2& position, double margin = 0.0);

/// [m] of the way from one position straight to another that lies in the feature's rectangle, which
/// is made larger by `margin` [m] on every side.
double length_inside(const Feature& feature, const Vec2& from, const Vec2& to, double margin = 0.0);

/// From a position to the feature's rectangle [m]; 0 inside.
double distance_to(const Feature& feature, const Vec2& position);

}  // namespace saphira::maps

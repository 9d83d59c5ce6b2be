#include "saphira/maps/route.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "saphira/base/shortest_ways.hpp"

namespace saphira::maps {

namespace {

std::string where(const Vec2& position) {
  const auto mm = [](double metres) { return std::to_string(std::lround(metres * 1000.0)); };
  return "(" + mm(position.x()) + ", " + mm(position.y()) + ") mm";
}

std::string with_article(const Place& place) {
  return place.name.empty() ? "the place" : place.name;
}

// The place of a link, seen from one of its regions: before a door, in line with it.
Vec2 before(const Link& link, std::size_t region, double clearance) {
  if (link.kind == LinkKind::meeting)
    return link.pose_in_map.position();
  return transform(link.pose_in_map, {link.a == region ? clearance : -clearance, 0.0});
}

class Search {
 public:
  Search(const Topology& topology, const RouteSettings& settings)
      : topology_(topology), settings_(settings) {}

  RouteResult run(const Vec2& from, const Place& to);

 private:
  bool blocked(std::uint32_t id) const { return id != 0 && settings_.blocked.contains(id); }
  bool usable(std::size_t link) const {
    const Link& l = topology_.links()[link];
    return l.b && wide_enough(l) && !too_narrow(topology_.regions()[l.a]) &&
           !too_narrow(topology_.regions()[*l.b]) && !blocked(l.id) &&
           !settings_.blocked_links.contains(link) && !blocked(topology_.regions()[l.a].area.id) &&
           !blocked(topology_.regions()[*l.b].area.id);
  }
  bool too_narrow(const Region& region) const {
    return region.kind == RegionKind::corridor && region.area.width < settings_.needs_width;
  }
  bool wide_enough(const Link& link) const {
    return link.kind == LinkKind::meeting || link.width >= settings_.needs_width;
  }
  std::string narrow_place(const Route& route) const;
  std::string why_none(const Vec2& from, const std::string& start, const Place& to) const;
  bool wanted(std::size_t region, const Place& to) const {
    return std::find(to.regions.begin(), to.regions.end(), region) != to.regions.end();
  }
  Leg leg(std::size_t region, const Vec2& from, std::optional<std::size_t> came_by,
          std::optional<std::size_t> link, const std::optional<Vec2>& goal) const;

  const Topology& topology_;
  const RouteSettings& settings_;
};

Leg Search::leg(std::size_t region, const Vec2& from, std::optional<std::size_t> came_by,
                std::optional<std::size_t> link, const std::optional<Vec2>& goal) const {
  const Region& here = topology_.regions()[region];
  Leg leg{region, link, {}};
  if (came_by && topology_.links()[*came_by].kind != LinkKind::meeting)
    leg.points.push_back(before(topology_.links()[*came_by], region, settings_.door_clearance));
  const Vec2 inside = leg.points.empty() ? from : leg.points.back();
  const std::optional<Vec2> target =
      link ? std::optional(before(topology_.links()[*link], region, settings_.door_clearance))
           : goal;
  // Along the middle of a corridor, unless it is only a step.
  if (here.kind == RegionKind::corridor && target && (*target - inside).norm() > 1.5) {
    const Vec2 enter = on_axis(here.area, inside);
    const Vec2 leave = on_axis(here.area, *target);
    if ((enter - inside).norm() > 0.3)
      leg.points.push_back(enter);
    if ((leave - *target).norm() > 0.3 && (leave - enter).norm() > 0.3)
      leg.points.push_back(leave);
  }
  if (target)
    leg.points.push_back(*target);
  if (link && topology_.links()[*link].kind != LinkKind::meeting)
    leg.points.push_back(topology_.links()[*link].pose_in_map.position());
  if (leg.points.empty())
    leg.points.push_back(inside);  // inside is enough
  return leg;
}

/// The first door, opening or corridor of a route that is too narrow for the robot.
std::string Search::narrow_place(const Route& route) const {
  const auto says = [&](std::string what, double width) {
    char text[96];
    std::snprintf(text, sizeof text, " is %.2f m wide, and the robot needs %.2f m", width,
                  settings_.needs_width);
    return std::move(what) + text;
  };
  for (const Leg& leg : route.legs) {
    const Region& region = topology_.regions()[leg.region];
    if (too_narrow(region))
      return says(topology_.text(leg.region), region.area.width);
    if (!leg.link)
      continue;
    const Link& link = topology_.links()[*leg.link];
    if (!wide_enough(link) && link.kind != LinkKind::meeting)
      return says((link.kind == LinkKind::door ? "door " : "opening ") + std::to_string(link.id),
                  link.width);
  }
  return "the robot is too wide";
}

std::string Search::why_none(const Vec2& from, const std::string& start, const Place& to) const {
  if (settings_.needs_width > 0.0) {
    RouteSettings thin = settings_;
    thin.needs_width = 0.0;
    if (const RouteResult found = Search(topology_, thin).run(from, to); found.route)
      return "no way from " + start + " to " + with_article(to) +
             " is wide enough: " + narrow_place(*found.route);
  }
  return "no way from " + start + " to " + with_article(to) + " that is known" +
         (settings_.blocked.empty() && settings_.blocked_links.empty() ? "" : " and not closed");
}

RouteResult Search::run(const Vec2& from, const Place& to) {
  if (to.regions.empty())
    return {std::nullopt, with_article(to) + " is in no corridor, junction or room of the map"};
  std::vector<std::size_t> starts = topology_.at(from);
  if (starts.empty())
    if (const auto near = topology_.region_at(from, settings_.tolerance))
      starts = {*near};
  if (starts.empty())
    return {std::nullopt,
            "the start, " + where(from) + ", is in no corridor, junction or room of the map"};

  for (const std::size_t start : starts) {
    if (!wanted(start, to))
      continue;
    Route route;
    route.legs.push_back(leg(start, from, std::nullopt, std::nullopt, to.point));
    for (const Vec2& point : route.legs.back().points)
      route.length += (point - from).norm();
    return {route, {}};
  }

  // Over links; a link is entered on one of its sides, so each has two states.
  const auto& links = topology_.links();
  const std::size_t states = links.size() * 2;
  ShortestWays ways(states);
  // State 2i: gone through link i into its `a`; 2i + 1: into its `b`.
  const auto entered = [&](std::size_t state) {
    const Link& link = links[state / 2];
    return state % 2 == 0 ? link.a : *link.b;
  };
  const auto enter = [&](std::size_t region, const Vec2& at, double so_far,
                         std::optional<std::size_t> by) {
    for (const std::size_t i : topology_.regions()[region].links) {
      if (!usable(i) || (by && i == *by / 2))
        continue;
      const double length = so_far + (links[i].pose_in_map.position() - at).norm() +
                            (settings_.closed.contains(links[i].id) ? settings_.closed_costs : 0.0);
      ways.reach(2 * i + (links[i].a == region ? 1 : 0), length, by);
    }
  };
  for (const std::size_t start : starts)
    enter(start, from, 0.0, std::nullopt);
  std::size_t best = states;
  double best_cost = ShortestWays::kNever;
  while (const auto next = ways.next()) {
    if (ways.cost(*next) >= best_cost)
      break;
    const std::size_t region = entered(*next);
    const Vec2 at = links[*next / 2].pose_in_map.position();
    if (wanted(region, to)) {
      const double whole = ways.cost(*next) + (to.point ? (*to.point - at).norm() : 0.0);
      if (whole < best_cost) {
        best_cost = whole;
        best = *next;
      }
      continue;
    }
    enter(region, at, ways.cost(*next), *next);
  }
  if (best == states)
    return {std::nullopt, why_none(from, topology_.text(starts.front()), to)};

  Route route;
  Vec2 at = from;
  std::optional<std::size_t> came_by;
  const auto add = [&](Leg next) {
    for (const Vec2& point : next.points) {
      route.length += (point - at).norm();
      at = point;
    }
    route.legs.push_back(std::move(next));
  };
  for (const std::size_t state : ways.way_to(best)) {
    const std::size_t link = state / 2;
    const std::size_t region = state % 2 == 0 ? *links[link].b : links[link].a;
    add(leg(region, at, came_by, link, std::nullopt));
    came_by = link;
  }
  add(leg(entered(best), at, came_by, std::nullopt, to.point));
  return {route, {}};
}

}  // namespace

std::vector<Vec2> Route::points() const {
  std::vector<Vec2> all;
  for (const Leg& leg : legs)
    for (const Vec2& point : leg.points)
      // Two regions each name the point where they meet.
      if (all.empty() || (all.back() - point).norm() > 1e-6)
        all.push_back(point);
  return all;
}

RouteResult find_route(const Topology& topology, const Vec2& from_in_map, const Place& to,
                       const RouteSettings& settings) {
  return Search(topology, settings).run(from_in_map, to);
}

RouteResult find_route(const Topology& topology, const Vec2& from_in_map,
                       std::string_view to_name_or_id, const RouteSettings& settings) {
  const auto to = topology.place(to_name_or_id);
  if (!to)
    return {std::nullopt, topology.no_place(to_name_or_id)};
  return find_route(topology, from_in_map, *to, settings);
}

RouteResult find_route(const Topology& topology, const Vec2& from_in_map, const Vec2& to_in_map,
                       const RouteSettings& settings) {
  Place place;
  place.name = "the goal, " + where(to_in_map) + ",";
  place.regions = topology.at(to_in_map);
  if (place.regions.empty())
    if (const auto near = topology.region_at(to_in_map, settings.tolerance))
      place.regions = {*near};
  place.point = to_in_map;
  return find_route(topology, from_in_map, place, settings);
}

RouteResult find_route(const Topology& topology, std::string_view from_name_or_id,
                       std::string_view to_name_or_id, const RouteSettings& settings) {
  const auto from = topology.place(from_name_or_id);
  if (!from)
    return {std::nullopt, topology.no_place(from_name_or_id)};
  if (!from->point && from->regions.empty())
    return {std::nullopt, from->name + " is in no corridor, junction or room of the map"};
  const Vec2 at =
      from->point.value_or(topology.regions()[from->regions.front()].area.pose_in_map.position());
  return find_route(topology, at, to_name_or_id, settings);
}

std::string text(const Topology& topology, const Route& route) {
  std::string out;
  for (const Leg& leg : route.legs) {
    out += (out.empty() ? "" : ", ") + topology.text(leg.region);
    if (!leg.link)
      continue;
    const Link& link = topology.links()[*leg.link];
    if (link.kind != LinkKind::meeting)
      out += (link.kind == LinkKind::door ? ", door " : ", opening ") + std::to_string(link.id);
  }
  return out;
}

}  // namespace saphira::maps

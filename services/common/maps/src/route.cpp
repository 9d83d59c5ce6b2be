#include "saphira/maps/route.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "saphira/base/shortest_ways.hpp"
#include "saphira/base/text.hpp"

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

// [m] A shorter stretch in a zone only touches its edge.
constexpr double kTouches = 0.01;
// [m] A robot that has passed a little beside a door may go back so far in a one-way zone.
constexpr double kSidestep = 0.5;

class Search {
 public:
  Search(const Topology& topology, const RouteSettings& settings, const Vec2& from);

  RouteResult run(const Place& to);
  std::string forbidden(const std::vector<Leg>& legs, const std::optional<Vec2>& end) const;

 private:
  /// A zone, and how near it a way may come.
  struct Held {
    const Zone* zone;
    double margin;         // [m]
    bool leaving = false;  // the robot begins in this keep-out
  };
  double inside(const Held& held, std::size_t region, const Vec2& from, const Vec2& to) const;
  bool breaks(const Held& held, std::size_t region, const Vec2& from, const Vec2& to) const;
  static bool against(const Zone& zone, const Vec2& way);
  double cost(const Leg& leg, const Vec2& from) const;
  const Zone* kept_out(const std::vector<std::size_t>& regions,
                       const std::optional<Vec2>& point) const;
  std::vector<const Zone*> met_by(const Route& route) const;
  std::optional<Route> search(const Place& to, const std::vector<std::size_t>& starts) const;
  RouteSettings without_zones() const;
  void tell_zones(const Place& to, RouteResult& result) const;
  std::string why_zones_forbid(const Route& free, const Place& to) const;

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
  std::string why_none(const std::string& start, const Place& to) const;
  bool wanted(std::size_t region, const Place& to) const {
    return std::find(to.regions.begin(), to.regions.end(), region) != to.regions.end();
  }
  Leg leg(std::size_t region, const Vec2& from, std::optional<std::size_t> came_by,
          std::optional<std::size_t> link, const std::optional<Vec2>& goal) const;

  const Topology& topology_;
  const RouteSettings& settings_;
  Vec2 from_;
  std::vector<Held> held_;
};

Search::Search(const Topology& topology, const RouteSettings& settings, const Vec2& from)
    : topology_(topology), settings_(settings), from_(from) {
  for (const Zone& zone : settings.zones) {
    if (zone.rule != ZoneRule::keep_out) {
      held_.push_back({&zone, 0.0});
      continue;
    }
    const double beside = settings.needs_width / 2;
    const bool leaving = zone.contains(topology, from, zone.area ? 0.0 : settings.tolerance);
    held_.push_back({&zone, zone.contains(topology, from, beside) ? 0.0 : beside, leaving});
  }
}

/// [m] of a straight stretch through a region that lies in the zone.
double Search::inside(const Held& held, std::size_t region, const Vec2& from,
                      const Vec2& to) const {
  if (held.zone->area)
    return length_inside(*held.zone->area, from, to, held.margin);
  return held.zone->covers(region) ? (to - from).norm() : 0.0;
}

/// True where a stretch breaks the rule of a zone. It may lead out of the keep-out in which the
/// robot begins, and not into it again.
bool Search::breaks(const Held& held, std::size_t region, const Vec2& from, const Vec2& to) const {
  const Zone& zone = *held.zone;
  if (zone.rule == ZoneRule::keep_out)
    return !(held.leaving && zone.contains(topology_, from)) &&
           (zone.covers(region) || inside(held, region, from, to) > kTouches);
  return against(zone, to - from) &&
         inside(held, region, from, to) > (from == from_ ? kSidestep : kTouches);
}

/// True where a stretch goes against a one-way zone; across it is no matter.
bool Search::against(const Zone& zone, const Vec2& way) {
  return zone.rule == ZoneRule::one_way && zone.area &&
         way.dot(zone.area->pose_in_map.direction()) < -0.5 * way.norm();
}

/// [m] by which the zones make a leg longer: below 0 in a preferred one, infinite where they forbid
/// it.
double Search::cost(const Leg& leg, const Vec2& from) const {
  double costs = 0.0;
  for (const Held& held : held_) {
    const Zone& zone = *held.zone;
    Vec2 at = from;
    for (const Vec2& point : leg.points) {
      if (breaks(held, leg.region, at, point))
        return ShortestWays::kNever;
      const double length = inside(held, leg.region, at, point);
      at = point;
      if (zone.rule == ZoneRule::slow)
        costs += length * std::max(0.0, settings_.cruise / zone.speed - 1.0);
      else if (zone.rule == ZoneRule::preferred)
        costs -= 0.5 * length;
    }
  }
  return costs;
}

/// The zones on a route: those that it breaks the rule of, and slow and preferred ones.
std::vector<const Zone*> Search::met_by(const Route& route) const {
  std::vector<const Zone*> met;
  for (const Held& held : held_) {
    const Zone& zone = *held.zone;
    bool meets = false;
    Vec2 at = from_;
    for (const Leg& leg : route.legs) {
      for (const Vec2& point : leg.points) {
        const bool rules = zone.rule == ZoneRule::keep_out || zone.rule == ZoneRule::one_way;
        meets = meets || (rules ? breaks(held, leg.region, at, point)
                                : inside(held, leg.region, at, point) > kTouches);
        at = point;
      }
    }
    if (meets)
      met.push_back(&zone);
  }
  return met;
}

RouteSettings Search::without_zones() const {
  RouteSettings free = settings_;
  free.zones.clear();
  return free;
}

/// The zones that led a route another way, and those on it.
void Search::tell_zones(const Place& to, RouteResult& result) const {
  const std::vector<const Zone*> met = met_by(*result.route);
  const RouteResult free = Search(topology_, without_zones(), from_).run(to);
  if (free.route && free.route->legs != result.route->legs)
    for (const Zone* const zone : met_by(*free.route))
      if (std::find(met.begin(), met.end(), zone) == met.end() && zone->rule != ZoneRule::preferred)
        result.around.push_back(zone->text);
  for (const Held& held : held_)
    if (held.leaving && held.zone->rule == ZoneRule::keep_out)
      result.out_of.push_back(held.zone->text);
  for (const Zone* const zone : met)
    if (zone->rule == ZoneRule::slow || zone->rule == ZoneRule::preferred)
      result.through.push_back(zone->text);
}

/// Why no way is allowed, though there is one.
std::string Search::why_zones_forbid(const Route& free, const Place& to) const {
  std::vector<const Zone*> forbidding;
  for (const Zone* const zone : met_by(free))
    if (zone->rule == ZoneRule::keep_out || zone->rule == ZoneRule::one_way)
      forbidding.push_back(zone);
  const Vec2 end = free.legs.back().points.back();
  for (const Zone* const zone : forbidding)
    if (zone->rule == ZoneRule::keep_out &&
        (zone->covers(free.legs.back().region) || (zone->area && maps::contains(*zone->area, end))))
      return with_article(to) + " " + zone->inside;
  const std::string names =
      joined(forbidding, ", ", [&](const Zone* const zone) { return zone->text; });
  return "no way to " + with_article(to) + " keeps the rules of the zones: " + names;
}

Leg Search::leg(std::size_t region, const Vec2& from, std::optional<std::size_t> came_by,
                std::optional<std::size_t> link, const std::optional<Vec2>& goal) const {
  const Region& here = topology_.regions()[region];
  Leg leg{region, link, {}};
  if (came_by && topology_.links()[*came_by].kind != LinkKind::meeting)
    leg.points.push_back(before(topology_.links()[*came_by], region, settings_.door_clearance));
  const Vec2 inside = leg.points.empty() ? from : leg.points.back();
  // Nearer than that to a door, the robot goes straight on.
  const auto clearance = [&](const Link& door) {
    return std::min(settings_.door_clearance, (door.pose_in_map.position() - inside).norm());
  };
  const std::optional<Vec2> target =
      link ? std::optional(
                 before(topology_.links()[*link], region, clearance(topology_.links()[*link])))
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

std::string Search::why_none(const std::string& start, const Place& to) const {
  if (!held_.empty())
    if (const RouteResult free = Search(topology_, without_zones(), from_).run(to); free.route)
      return why_zones_forbid(*free.route, to);
  if (settings_.needs_width > 0.0) {
    RouteSettings thin = settings_;
    thin.needs_width = 0.0;
    if (const RouteResult found = Search(topology_, thin, from_).run(to); found.route)
      return "no way from " + start + " to " + with_article(to) +
             " is wide enough: " + narrow_place(*found.route);
  }
  return "no way from " + start + " to " + with_article(to) + " that is known" +
         (settings_.blocked.empty() && settings_.blocked_links.empty() ? "" : " and not closed");
}

RouteResult Search::run(const Place& to) {
  if (to.regions.empty())
    return {std::nullopt, with_article(to) + " is in no corridor, junction or room of the map"};
  std::vector<std::size_t> starts = topology_.at(from_);
  if (starts.empty())
    if (const auto near = topology_.region_at(from_, settings_.tolerance))
      starts = {*near};
  if (starts.empty())
    return {std::nullopt,
            "the start, " + where(from_) + ", is in no corridor, junction or room of the map"};
  if (const Zone* const zone = kept_out(to.regions, to.point))
    return {std::nullopt, with_article(to) + " " + zone->inside};
  RouteResult result;
  result.route = search(to, starts);
  if (!result.route)
    result.reason = why_none(topology_.text(starts.front()), to);
  else if (!held_.empty())
    tell_zones(to, result);
  return result;
}

std::optional<Route> Search::search(const Place& to, const std::vector<std::size_t>& starts) const {
  for (const std::size_t start : starts) {
    if (!wanted(start, to))
      continue;
    Route route;
    route.legs.push_back(leg(start, from_, std::nullopt, std::nullopt, to.point));
    if (cost(route.legs.back(), from_) == ShortestWays::kNever)
      continue;
    for (const Vec2& point : route.legs.back().points)
      route.length += (point - from_).norm();
    return route;
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
  // A leg of that length: no less than half of it, in preferred zones.
  const auto priced = [&](double length, std::size_t region, const Vec2& at,
                          std::optional<std::size_t> by, std::optional<std::size_t> link,
                          const std::optional<Vec2>& goal) {
    if (held_.empty())
      return length;
    return length + std::max(-0.5 * length, cost(leg(region, at, by, link, goal), at));
  };
  const auto enter = [&](std::size_t region, const Vec2& at, double so_far,
                         std::optional<std::size_t> by) {
    const auto came_by = by ? std::optional(*by / 2) : std::nullopt;
    for (const std::size_t i : topology_.regions()[region].links) {
      if (!usable(i) || came_by == i)
        continue;
      const double length = so_far +
                            priced((links[i].pose_in_map.position() - at).norm(), region, at,
                                   came_by, i, std::nullopt) +
                            (settings_.closed.contains(links[i].id) ? settings_.closed_costs : 0.0);
      if (length < ShortestWays::kNever)
        ways.reach(2 * i + (links[i].a == region ? 1 : 0), length, by);
    }
  };
  for (const std::size_t start : starts)
    enter(start, from_, 0.0, std::nullopt);
  std::size_t best = states;
  double best_cost = ShortestWays::kNever;
  while (const auto next = ways.next()) {
    if (ways.cost(*next) >= best_cost)
      break;
    const std::size_t region = entered(*next);
    const Vec2 at = links[*next / 2].pose_in_map.position();
    if (wanted(region, to)) {
      const double whole = ways.cost(*next) + priced(to.point ? (*to.point - at).norm() : 0.0,
                                                     region, at, *next / 2, std::nullopt, to.point);
      if (whole < best_cost) {
        best_cost = whole;
        best = *next;
      }
      if (whole < ShortestWays::kNever)
        continue;
    }
    enter(region, at, ways.cost(*next), *next);
  }
  if (best == states)
    return std::nullopt;

  Route route;
  Vec2 at = from_;
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
  return route;
}

std::string Search::forbidden(const std::vector<Leg>& legs, const std::optional<Vec2>& end) const {
  if (legs.empty())
    return {};
  Route way;
  Vec2 at = from_;
  std::optional<std::size_t> came_by;
  for (const Leg& each : legs) {
    const bool last = &each == &legs.back();
    way.legs.push_back(
        leg(each.region, at, came_by, each.link, last && !each.link ? end : std::nullopt));
    at = way.legs.back().points.back();
    came_by = each.link;
  }
  for (const Zone* const zone : met_by(way))
    if (zone->rule == ZoneRule::keep_out || zone->rule == ZoneRule::one_way)
      return zone->text;
  const Zone* const there =
      kept_out(end ? std::vector<std::size_t>{} : std::vector{legs.back().region}, end);
  return there == nullptr ? std::string() : there->text;
}

/// The keep-out with the whole of a place: with its point, or else with all its regions.
const Zone* Search::kept_out(const std::vector<std::size_t>& regions,
                             const std::optional<Vec2>& point) const {
  for (const Zone& zone : settings_.zones)
    if (zone.rule == ZoneRule::keep_out &&
        (point ? zone.contains(topology_, *point)
               : std::all_of(regions.begin(), regions.end(),
                             [&](std::size_t region) { return zone.covers(region); })))
      return &zone;
  return nullptr;
}

}  // namespace

std::string forbidden(const Topology& topology, const Vec2& from_in_map,
                      const std::vector<Leg>& legs, const std::optional<Vec2>& end,
                      const RouteSettings& settings) {
  return Search(topology, settings, from_in_map).forbidden(legs, end);
}

std::vector<Vec2> Route::points() const {
  std::vector<Vec2> all;
  for (const Leg& leg : legs)
    for (const Vec2& point : leg.points)
      // Two regions each name the point where they meet.
      if (all.empty() || (all.back() - point).norm() > 1e-6)
        all.push_back(point);
  return all;
}

std::string RouteResult::remark() const {
  std::string text;
  const auto add = [&](const char* how, const std::vector<std::string>& zones) {
    for (const std::string& zone : zones)
      text +=
          &zone == &zones.front() ? (text.empty() ? "" : ", and ") + (how + zone) : " and " + zone;
  };
  add("out of ", out_of);
  add("around ", around);
  add("through ", through);
  return text;
}

RouteResult find_route(const Topology& topology, const Vec2& from_in_map, const Place& to,
                       const RouteSettings& settings) {
  return Search(topology, settings, from_in_map).run(to);
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

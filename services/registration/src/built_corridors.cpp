#include "built_corridors.hpp"

#include <algorithm>
#include <cmath>

#include "saphira/lps/point.hpp"

namespace saphira::registration {

namespace {

using Corridor = BuiltCorridor;

// Echoes from ahead that define the end of a corridor: largest angle and least number.
constexpr double kStraight = radians(10.0);
constexpr std::size_t kEchoes = 4;

class Finder {
 public:
  Finder(const FeatureGraph& graph, const std::vector<SeenPoint>& ahead,
         const MapBuilderSettings& settings)
      : graph_(graph), ahead_(ahead), settings_(settings) {}

  std::vector<Corridor> pairs() const;
  std::vector<Corridor> in_line(std::vector<Corridor> pairs) const;
  std::vector<Corridor> parted(const std::vector<Corridor>& groups) const;
  std::vector<Corridor> outermost(std::vector<Corridor> out) const;
  void end_at_walls_ahead(std::vector<Corridor>& corridors) const;
  void end_at_one_another(std::vector<Corridor>& corridors) const;

 private:
  const FeatureGraph& graph_;
  const std::vector<SeenPoint>& ahead_;
  const MapBuilderSettings& settings_;
};

// Pairs of walls that face one another.
std::vector<Corridor> Finder::pairs() const {
  std::vector<Corridor> pairs;
  for (std::size_t a = 0; a < graph_.lines.size(); ++a)
    for (std::size_t b = a + 1; b < graph_.lines.size(); ++b) {
      const GraphLine& one = graph_.lines[a];
      const GraphLine& other = graph_.lines[b];
      if (one.seen.empty() || other.seen.empty() ||
          std::abs(norm2_angle(one.heading - other.heading + kPi)) > settings_.same_heading)
        continue;
      Corridor corridor;
      const Pose near = one.pose();
      // The stretches of both in the first one's frame, which is also that of its left side.
      const Stretches left = seen_along(near, graph_, other);
      const Stretches right = seen_along(near, graph_, one);
      corridor.both = common(left, right);
      if (total(corridor.both) < settings_.min_both)
        continue;
      const double at = (corridor.both.front().first + corridor.both.back().second) / 2;
      const Vec2 across = transform(near, {at, 0.0});
      const Pose far = other.pose();
      corridor.width = lps::yo(far, {across.x(), across.y(), 0.0});
      if (corridor.width < settings_.min_width || corridor.width > settings_.max_width)
        continue;
      // Only walls with the robot's way between them make a corridor: two walls may face each other
      // through a third one.
      const Vec2 middle = transform(near, {at, corridor.width / 2});
      corridor.frame = {middle.x(), middle.y(),
                        norm2_angle(one.heading + norm2_angle(far.th + kPi - one.heading) / 2)};
      for (auto& s : corridor.both)
        s = {s.first - at, s.second - at};
      corridor.walls = left;
      corridor.walls.insert(corridor.walls.end(), right.begin(), right.end());
      for (auto& s : corridor.walls)
        s = {s.first - at, s.second - at};
      corridor.walls = joined(std::move(corridor.walls), 0.1);
      const bool between =
          std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const GraphNode& node) {
            const Pose in = relative(corridor.frame, node.in_map);
            return std::abs(in.y) < corridor.width / 2 &&
                   std::any_of(corridor.both.begin(), corridor.both.end(),
                               [&](const auto& s) { return in.x > s.first && in.x < s.second; });
          });
      if (between)
        pairs.push_back(corridor);
    }
  return pairs;
}

// Merges pairs that follow one another on one line.
std::vector<Corridor> Finder::in_line(std::vector<Corridor> pairs) const {
  std::stable_sort(pairs.begin(), pairs.end(), [](const Corridor& a, const Corridor& b) {
    return total(a.both) > total(b.both);
  });
  std::vector<Corridor> groups;
  for (const Corridor& pair : pairs) {
    Corridor* home = nullptr;
    for (Corridor& group : groups) {
      const Pose in = relative(group.frame, pair.frame);
      if (std::abs(norm3_angle(in.th)) < settings_.same_heading && std::abs(in.y) < 0.4 &&
          std::abs(pair.width - group.width) < 0.8) {
        home = &group;
        break;
      }
    }
    if (home == nullptr) {
      groups.push_back(pair);
      continue;
    }
    const Pose in = relative(home->frame, pair.frame);
    const double sign = std::cos(in.th) > 0.0 ? 1.0 : -1.0;
    const auto bring = [&](const Stretches& from, Stretches& to) {
      for (const auto& s : from) {
        const double x = in.x + sign * s.first;
        const double y = in.x + sign * s.second;
        to.emplace_back(std::min(x, y), std::max(x, y));
      }
      to = joined(std::move(to), 0.1);
    };
    bring(pair.both, home->both);
    bring(pair.walls, home->walls);
  }
  return groups;
}

// Divides corridors at gaps, unless the robot drove through.
std::vector<Corridor> Finder::parted(const std::vector<Corridor>& groups) const {
  std::vector<Corridor> out;
  for (const Corridor& group : groups) {
    Stretches driven;
    for (const GraphNode& node : graph_.nodes) {
      const Pose in = relative(group.frame, node.in_map);
      if (std::abs(in.y) < group.width / 2)
        driven.emplace_back(in.x - settings_.node_way / 2, in.x + settings_.node_way / 2);
    }
    driven = joined(std::move(driven), 0.2);
    std::vector<Stretches> parts;
    for (const auto& s : group.both) {
      bool follows = false;
      if (!parts.empty()) {
        const double end = parts.back().back().second;
        const double gap = s.first - end;
        const bool drove = std::any_of(driven.begin(), driven.end(), [&](const auto& d) {
          return d.first <= end && d.second >= s.first;
        });
        follows = gap < settings_.max_gap || (drove && gap < settings_.max_driven_gap);
      }
      if (follows)
        parts.back().push_back(s);
      else
        parts.push_back({s});
    }
    for (const Stretches& part : parts) {
      Corridor corridor = group;
      corridor.both = part;
      corridor.from = part.front().first;
      corridor.to = part.back().second;
      for (const auto& w : group.walls) {
        // A wall that continues beyond a wall ahead belongs to another corridor.
        const auto drove = [&](double from, double to) {
          return std::any_of(driven.begin(), driven.end(),
                             [&](const auto& d) { return d.first <= from && d.second >= to; });
        };
        if ((w.second < part.front().first && !drove(w.second, part.front().first)) ||
            (w.first > part.back().second && !drove(part.back().second, w.first)) ||
            w.second < corridor.from - settings_.one_gap ||
            w.first > corridor.to + settings_.one_gap)
          continue;
        corridor.from =
            std::min(corridor.from, std::max(w.first, part.front().first - settings_.one_sided));
        corridor.to =
            std::max(corridor.to, std::min(w.second, part.back().second + settings_.one_sided));
      }
      if (corridor.length() >= std::max(settings_.min_length, settings_.min_ratio * corridor.width))
        out.push_back(corridor);
    }
  }
  return out;
}

// Walls may face one another across a corridor, from a niche to its far side: only the pair with
// the longer stretches of both walls is a corridor.
std::vector<Corridor> Finder::outermost(std::vector<Corridor> out) const {
  std::stable_sort(out.begin(), out.end(), [](const Corridor& a, const Corridor& b) {
    return total(a.both) > total(b.both);
  });
  std::vector<Corridor> kept;
  for (const Corridor& corridor : out) {
    const bool inside = std::any_of(kept.begin(), kept.end(), [&](const Corridor& other) {
      const Pose in = relative(other.frame, corridor.frame);
      const double sign = std::cos(in.th) > 0.0 ? 1.0 : -1.0;
      const double x = in.x + sign * corridor.from;
      const double y = in.x + sign * corridor.to;
      const double overlap =
          std::min(std::max(x, y), other.to) - std::max(std::min(x, y), other.from);
      return std::abs(norm3_angle(in.th)) < settings_.same_heading &&
             std::abs(in.y) < (corridor.width + other.width) / 2 - 0.3 &&
             overlap > corridor.length() / 2;
    });
    if (!inside)
      kept.push_back(corridor);
  }
  return kept;
}

// Ends corridors at a wall ahead.
void Finder::end_at_walls_ahead(std::vector<Corridor>& corridors) const {
  for (Corridor& corridor : corridors) {
    for (const bool upper : {false, true}) {
      double& end = upper ? corridor.to : corridor.from;
      const double sign = upper ? 1.0 : -1.0;
      // The end of the robot's way or of the walls: nearer echoes are outdated. The way counts
      // without gaps only, since the robot may have been beyond a wall, too.
      std::vector<double> been;
      for (const GraphNode& node : graph_.nodes) {
        const Pose in = relative(corridor.frame, node.in_map);
        if (std::abs(in.y) < corridor.width / 2)
          been.push_back(sign * in.x);
      }
      std::sort(been.begin(), been.end());
      double reached = -1e9;
      for (const double at : been) {
        if (at > sign * end - 1.0 && at > reached + 1.5 * settings_.node_way)
          break;
        reached = at;
      }
      std::vector<double> heard;
      for (const SeenPoint& echo : ahead_) {
        const Pose at = compose(graph_.nodes[echo.node].in_map, echo.in_node);
        const Pose in = relative(corridor.frame, at);
        const double heading = upper ? in.th : norm2_angle(in.th + kPi);
        const double beyond = sign * (in.x - end);
        if (std::abs(heading) < kStraight && std::abs(in.y) < corridor.width / 4 && beyond > -0.3 &&
            beyond < 2.5 && sign * in.x > reached + 0.1)
          heard.push_back(sign * in.x);
      }
      if (heard.size() < kEchoes)
        continue;
      std::sort(heard.begin(), heard.end());
      end = sign * heard[heard.size() / 2];
    }
  }
}

// Ends corridors where they meet: at a T one ends at the near wall of the other; at an L both end
// at the outer wall of the other.
void Finder::end_at_one_another(std::vector<Corridor>& corridors) const {
  struct Meeting {
    std::size_t corridor;
    bool upper;
    double near;
    double far;
    bool ends_too;
  };
  std::vector<Meeting> meetings;
  for (std::size_t a = 0; a < corridors.size(); ++a)
    for (std::size_t b = 0; b < corridors.size(); ++b) {
      const Corridor& one = corridors[a];
      const Corridor& other = corridors[b];
      const double angle = norm2_angle(other.frame.th - one.frame.th);
      if (a == b || std::abs(norm3_angle(angle)) < radians(60.0))
        continue;
      // The crossing of the middle lines, along each of them.
      const Vec2 between = other.frame.position() - one.frame.position();
      const Vec2 u = one.frame.direction();
      const Vec2 v = other.frame.direction();
      const double cross = u.x() * v.y() - u.y() * v.x();
      const double at = (between.x() * v.y() - between.y() * v.x()) / cross;
      const double at_other = (between.x() * u.y() - between.y() * u.x()) / cross;
      const double half = other.width / 2;
      const double half_one = one.width / 2;
      if (at_other < other.from - half_one - settings_.reach ||
          at_other > other.to + half_one + settings_.reach)
        continue;
      const bool ends_too =
          at_other < other.from + half_one + 0.6 || at_other > other.to - half_one - 0.6;
      // A corridor continues behind the other one only with both its walls: the part behind one
      // wall, or behind a door that the robot looked through, does not belong to it.
      const auto ends = [&](double end, double sign) {
        const double beyond = sign * (end - at);
        const Stretches there{sign > 0.0 ? std::pair(at + half, end) : std::pair(end, at - half)};
        return std::abs(beyond) < half + settings_.reach ||
               (beyond > 0.0 && total(common(one.both, there)) < settings_.min_both);
      };
      if (ends(one.from, -1.0))
        meetings.push_back({a, false, at + half, at - half, ends_too});
      if (ends(one.to, 1.0))
        meetings.push_back({a, true, at - half, at + half, ends_too});
    }
  for (const Meeting& meeting : meetings) {
    Corridor& corridor = corridors[meeting.corridor];
    double& end = meeting.upper ? corridor.to : corridor.from;
    end = meeting.ends_too ? meeting.far : meeting.near;
  }
}

}  // namespace

std::vector<BuiltCorridor> find_corridors(const FeatureGraph& graph,
                                          const std::vector<SeenPoint>& ahead,
                                          const MapBuilderSettings& settings) {
  const Finder finder(graph, ahead, settings);
  std::vector<Corridor> corridors = finder.outermost(finder.parted(finder.in_line(finder.pairs())));
  finder.end_at_walls_ahead(corridors);
  finder.end_at_one_another(corridors);
  return corridors;
}

}  // namespace saphira::registration
